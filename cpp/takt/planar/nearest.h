// The point of a track nearest to a given point.
#pragma once

#include "takt/planar/point.h"
#include "takt/planar/track.h"

namespace takt::planar {

struct Nearest {
  double s = 0;  // [mm] along the track
  Place place;
  double distance = 0;  // [mm]
};

// Returns the nearest point; of several at equal distance, the first along the track. Every cell is checked twice, for
// a few nanoseconds; only cells that may contain the nearest point are searched, by a bounded number of halvings. Does
// not allocate.
Nearest NearestTo(const Track& track, const Place& place) noexcept;

}  // namespace takt::planar
