// The areas that a mover needs for its motions, and how its group grants them (planar/group_registry.h).
#pragma once

#include "takt/mover/on_parts.h"
#include "takt/mover/run.h"

namespace takt::mover {

// Returns the obstacle to motions of X, Y and C that begin in this cycle or are in progress (on a track: to that of C
// alone); none: the motions are admissible.
ObjectInfo FindObstacle(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) noexcept;
// Reserves the motions of the state, without a check for obstacles.
void Reserve(const Context& c, const State& s, bool on_track) noexcept;
// Returns the obstacle to a mover that stops from this set point, at the end of this cycle, with its maximum dynamics,
// X and Y in the plane. None: the area of that stop replaces what the mover had reserved.
ObjectInfo TakeStop(const Context& c, const State& s, const SetPoint& at) noexcept;
// The same for a mover on a track whose centre stays within the hull of these positions.
ObjectInfo TakeStopOff(const Context& c, const DisplacedHull& places, const SetPoint& at) noexcept;
// Returns the commanded target pose; on a track and with external set points, X and Y are the set position.
planar::Pose GoalOf(const Context& c, const State& s) noexcept;
// Publishes the state of the mover at the beginning of this cycle to its group and the guard, and frees the area that
// it has left.
void Stand(const Context& c, const State& s) noexcept;

}  // namespace takt::mover
