// Boarding: how a tool at rest gets onto a belt or table that moves.
//
// A move from rest to a place on such a carrier begins with boarding: the tool sits down where it stands, and a clutch
// takes it along. The travel of the clutch begins where the carrier overtakes it just when it is as fast, so that it
// only has to speed up. The path lies on the carrier from its beginning and begins at the same time. Where both need an
// axis, they share its acceleration and jerk in the ratio of the velocities they give it; behind the place that the
// path can have reached when the tool is in step (Boarding::reach), all of them are the path's.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Whether the tool may board for the move that is planned next, from rest: not where something has to be known before
// the tool moves, nor where the carrier is not steady. Then it goes over along the path (rides.h).
bool MayBoard(const Context& c, const State& s) noexcept;

// Whether it can board now for the move that is to be joined.
bool CanBoard(const Context& c, const State& s) noexcept;

// Begins to board; the move is planned anew from there. False: the members cannot be controlled, nothing was changed.
bool Board(const Context& c, State& s) noexcept;

// Lets go again: the move cannot be carried out so, and is planned from rest to go over along the path.
void GiveUpBoarding(const Context& c, State& s) noexcept;

}  // namespace takt::group
