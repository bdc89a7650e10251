// Units and ranges shared by the descriptions of belts.
#pragma once

#include "takt/core/describe.h"

namespace takt::conveyor {

// Wide enough for any real machine, narrow enough for squares and quotients to be finite.
inline constexpr Range kPlaces = between(-1e9, 1e9);           // [mm], [deg] of a table
inline constexpr Range kAngles = between(-1e6, 1e6);           // [deg]
inline constexpr Range kAxisPositions = between(-1e12, 1e12);  // [u]
inline constexpr Range kRatios = between(-1e9, 1e9);
inline constexpr Unit kAlong{"mm", "deg of a table"};

}  // namespace takt::conveyor
