// Ranges and sentences that many descriptions of groups share.
#pragma once

#include "takt/core/describe.h"

namespace takt::group {

inline constexpr Range kPlaces = between(-1e9, 1e9);           // mm
inline constexpr Range kAngles = between(-1e6, 1e6);           // deg
inline constexpr Range kAxisPositions = between(-1e12, 1e12);  // u

}  // namespace takt::group
