// How near to its ends a mover on a track counts for movers on other tracks that start or end there, too. Not for the
// cycle.
#pragma once

#include <cstddef>

#include "takt/track/tracks.h"

namespace takt::track {

struct CollisionRanges {
  double at_start = 0;  // mm along the track
  double at_end = 0;
};

// Given, or such that movers further away cannot touch others, however they are turned. 0 for a track without length.
CollisionRanges RangesOf(const Tracks& tracks, std::size_t track);

}  // namespace takt::track
