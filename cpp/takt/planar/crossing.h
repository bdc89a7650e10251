// Where a track crosses itself.
#pragma once

#include <optional>

#include "takt/planar/track.h"

namespace takt::planar {

struct Crossing {
  double first = 0;   // mm along the track
  double second = 0;  // further on
};

// Nearer than this to itself, a track touches itself.
inline constexpr double kTouch = 1e-3;  // mm

// One place where the track crosses or touches itself; where a closed loop is closed does not count. Not for the cycle:
// looks at all pairs of cells.
std::optional<Crossing> SelfCrossing(const Track& track) noexcept;

}  // namespace takt::planar
