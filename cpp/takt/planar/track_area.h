// The area that the movers of a track may cover together, reserved while the track is Moving.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/planar/area.h"
#include "takt/planar/track.h"

namespace takt::planar {

struct TrackArea {
  std::vector<Area> stretches;
  std::vector<Extent> extents;  // of `stretches`
  Extent extent{};
  // Equal for linked tracks: traffic keeps their movers apart, not areas.
  std::uint32_t network = 0;
  // The areas of other tracks and the border of an environment count as obstacles for it.
  bool checks_static_objects = true;
};

// Bound by which the area of a track may be too large. A smaller one takes more stretches: one for each 2 mm by which
// the rotation of the mover moves its corners.
inline constexpr double kTrackSlack = 2;  // [mm]

// Returns all that this mover covers anywhere on the track, too large by at most kTrackSlack. Allocates; not for the
// cycle.
TrackArea MakeTrackArea(const Track& track, const Footprint& mover, std::uint32_t network);

// Returns true if an area comes nearer than `clearance` [mm] to that of a track (see Near in area.h). Fit for the
// cycle.
bool Near(const Area& area, const Extent& extent, const TrackArea& track, double clearance) noexcept;

}  // namespace takt::planar
