// How long a motion takes round a corner between two lines: with a stop there, and past a blend.
//
// Both times count from the middle of the first line to the middle of the second one, so that those of all corners of a
// path add up to its own. With a stop it is half of either line's least time from rest to rest. Past a blend the motion
// is that of PathPace: the raw motion has come down to the speed of the blend T/2 before it and keeps it until T/2
// behind it, and between speeding up and braking it holds its speed for T, the time in which accelerations build up.
#pragma once

#include "takt/trajectory/path_limits.h"

namespace takt::trajectory {

// Returns the limits along the path at a point where the coordinates change evenly with it: those along the path, or
// those of the coordinate that binds.
AlongPath AlongLine(const PathPoint& point, const CoordinateLimits& limits) noexcept;

// Half of the least time [s] from rest to rest over `length` [mm] > 0.
double HalfLineWithStops(double length, const AlongPath& limits) noexcept;

// The time [s] from a blend's end to the middle of a line of `length` [mm] whose first `blended` [mm] belong to the
// blend, which is passed at `speed` [mm/s] > 0.
double HalfLineWithBlends(double length, double blended, double speed, const AlongPath& limits) noexcept;

// How much longer [s] than HalfLineWithStops half of a line of `length` [mm] takes from rest where accelerations build
// up in T, as on long lines. 0 where the line is long enough for that to be the quickest.
double LossFromRest(double length, const AlongPath& limits) noexcept;

}  // namespace takt::trajectory
