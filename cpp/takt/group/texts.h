// Ranges shared by many descriptions of groups.
#pragma once

#include "takt/core/describe.h"

namespace takt::group {

// Wider than any machine, narrow enough for their squares and quotients to be finite.
inline constexpr Range kPlaces = between(-1e9, 1e9);           // [mm]
inline constexpr Range kAngles = between(-1e6, 1e6);           // [deg]
inline constexpr Range kLengths = between(0, 1e9);             // [mm]
inline constexpr Range kTurns = between(0, 1e6);               // [deg]
inline constexpr Range kAxisPositions = between(-1e12, 1e12);  // [u]
inline constexpr Range kSpeeds = between(1e-6, 1e9);           // [mm/s, deg/s]
inline constexpr Range kJogSpeeds = between(-1e9, 1e9);        // [mm/s, deg/s, u/s]
inline constexpr Range kAccelerations = between(1e-6, 1e12);   // [mm/s², deg/s²]
inline constexpr Range kJerks = between(1e-6, 1e15);           // [mm/s³, deg/s³]
inline constexpr Range kFactors = between(1e-3, 1);

}  // namespace takt::group
