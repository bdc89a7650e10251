// What a mover needs of the ground for its motions, and how it gets it from its group (planar/group_registry.h).
#pragma once

#include "takt/mover/on_parts.h"
#include "takt/mover/run.h"

namespace takt::mover {

// What is in the way of motions of X, Y and C that begin when this cycle does, or go on; on a track: of C alone. None:
// they may be.
ObjectInfo InTheWay(const Context& c, const PlaneMove& plane, const CoordinateMove& turn, bool on_track) noexcept;
// Those of the state are reserved, whatever is in the way.
void Reserve(const Context& c, const State& s, bool on_track) noexcept;
// What is in the way of a mover that comes to rest from this set point, at the end of this cycle, as hard as it can;
// X and Y in the plane. None: that is reserved from now on, in place of what was.
ObjectInfo TakeStop(const Context& c, const State& s, const SetPoint& at) noexcept;
// The same of one on a track whose middle stays between these places.
ObjectInfo TakeStopOff(const Context& c, const PlacesOff& places, const SetPoint& at) noexcept;
// Where X, Y and C lead as commanded; on a track, and moved from outside, X and Y are where they are.
planar::Pose GoalOf(const Context& c, const State& s) noexcept;
// Where the mover is when this cycle begins, for others; what it has left is free.
void Stand(const Context& c, const State& s) noexcept;

}  // namespace takt::mover
