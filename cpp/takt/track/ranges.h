// Collision ranges: the distances from the ends of a track within which a mover counts for movers on other tracks that
// start or end there. Not for the cycle.
#pragma once

#include <cstddef>

#include "takt/track/tracks.h"

namespace takt::track {

struct CollisionRanges {
  double at_start = 0;  // [mm] along the track
  double at_end = 0;
};

// Returns the given ranges, or those beyond which movers cannot touch others at any angle. 0 for a track without
// length.
CollisionRanges RangesOf(const Tracks& tracks, std::size_t track);

}  // namespace takt::track
