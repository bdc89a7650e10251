// What the movers of a track cover together, while the track is Moving.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/planar/area.h"
#include "takt/planar/track.h"

namespace takt::planar {

struct TrackArea {
  std::vector<Area> stretches;
  std::vector<Extent> extents;  // of the stretches
  Extent extent{};
  // Tracks that are linked have the same: traffic keeps their movers apart, not areas.
  std::uint32_t network = 0;
  // Whether the areas of other tracks and the border of an environment count for it.
  bool checks_static_objects = true;
};

// What the area of a track may be too large by. Finer takes more stretches: one for each 2 mm that the mover's corners
// go round.
inline constexpr double kTrackSlack = 2;  // mm

// All that this mover covers anywhere on the track, and nothing that is further off than kTrackSlack. Allocates; not
// for the cycle.
TrackArea MakeTrackArea(const Track& track, const Footprint& mover, std::uint32_t network);

// Whether an area comes nearer to that of a track than `clearance`, as Near says. Fit for the cycle.
bool Near(const Area& area, const Extent& extent, const TrackArea& track, double clearance) noexcept;

}  // namespace takt::planar
