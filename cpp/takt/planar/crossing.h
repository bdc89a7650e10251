// Self-crossings of a track.
#pragma once

#include <optional>

#include "takt/planar/track.h"

namespace takt::planar {

struct Crossing {
  double first = 0;   // [mm] along the track
  double second = 0;  // [mm] > first
};

// A track that comes nearer than this to itself touches itself.
inline constexpr double kTouch = 1e-3;  // [mm]

// Returns one point where the track crosses or touches itself; the joint of a closed loop does not count. Not for the
// cycle: examines all pairs of cells.
std::optional<Crossing> SelfCrossing(const Track& track) noexcept;

}  // namespace takt::planar
