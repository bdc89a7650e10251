// Ranges of values shared by descriptions of tracks.
#pragma once

#include "takt/core/describe.h"

namespace takt::track {

inline constexpr Range kPlaces = between(-1e6, 1e6);  // [mm]
inline constexpr Range kSizes = between(1, 10000);    // [mm]
inline constexpr Range kRanges = between(0, 1e9);     // [mm]

}  // namespace takt::track
