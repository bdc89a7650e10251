// Boarding: how a tool at rest gets onto a belt or table that moves.
//
// A move from rest to a place on such a carrier begins with boarding (TrackingParams::board): a clutch moves the tool
// into step by a time-optimal profile along the carrier's travel, which may begin ahead of the carrier. The path lies
// on the carrier from its beginning and starts at the same time. The profile is sampled through the kinematics: what it
// takes of the velocity, acceleration and jerk of each coordinate is reserved from the path up to the place that the
// path can have reached when the tool is in step (Boarding::reach). Profiles with several shares of the limits and
// several leads are compared by the estimated time of the move.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Whether the tool may board for the move that is planned next, from rest: not where something has to be known before
// the tool moves, nor where the carrier is not steady. Then the path has a transition between rides (rides.h).
bool MayBoard(const Context& c, const State& s) noexcept;

// Whether it can board now for the move that is to be joined.
bool CanBoard(const Context& c, const State& s) noexcept;

// Begins to board; the move is planned anew from there. False: no profile keeps the limits, or the members cannot be
// controlled; nothing was changed.
bool Board(const Context& c, State& s) noexcept;

// Ends boarding for a move that cannot be carried out that way: the tool stops, then the move is planned from rest with
// a transition between rides.
void GiveUpBoarding(const Context& c, State& s) noexcept;

}  // namespace takt::group
