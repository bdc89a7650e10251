// Ranges and units that many descriptions of movers share.
#pragma once

#include "takt/core/describe.h"

namespace takt::mover {

// Wide enough for any machine, narrow enough for squares and quotients to be finite.
inline constexpr Range kPlaces = between(-1e9, 1e9);          // [mm]
inline constexpr Range kAngles = between(-1e6, 1e6);          // [deg]
inline constexpr Range kSpeeds = between(1e-6, 1e9);          // [mm/s, deg/s]
inline constexpr Range kAccelerations = between(1e-6, 1e12);  // [mm/s², deg/s²]
inline constexpr Range kJerks = between(1e-6, 1e15);          // [mm/s³, deg/s³]
inline constexpr Range kTimes = between(0, 1e9);              // [s]
inline constexpr Range kVisits = between(0, 1e15);            // numbers of visits

inline constexpr Unit kOwn{"u", "mm; of an angle: deg"};
inline constexpr Unit kOwnSpeed{"u/s", "mm/s; of an angle: deg/s"};
inline constexpr Unit kOwnAcceleration{"u/s2", "mm/s2; of an angle: deg/s2"};
inline constexpr Unit kOwnJerk{"u/s3", "mm/s3; of an angle: deg/s3"};

}  // namespace takt::mover
