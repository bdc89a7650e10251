// Where a track is nearest to a place.
#pragma once

#include "takt/planar/point.h"
#include "takt/planar/track.h"

namespace takt::planar {

struct Nearest {
  double s = 0;  // mm along the track
  Place place;
  double distance = 0;  // mm
};

// Of places that are equally near the first one along the track. Every cell is looked at twice, for a few nanoseconds;
// only those that may hold the nearest place are searched, each by a bounded number of halvings. Allocates nothing.
Nearest NearestTo(const Track& track, const Place& place) noexcept;

}  // namespace takt::planar
