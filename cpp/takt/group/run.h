// Moving along what is planned.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Puts the group in control of its members. An error: a member cannot be.
ErrorId TakeMembers(const Context& c, State& s) noexcept;
void LetGoOfMembers(const Context& c, State& s) noexcept;

// The next set points of the members; ends moves that are over. False: the axes cannot be there, nothing was set.
bool Advance(const Context& c, State& s) noexcept;

// At rest, with everything ended: nothing to do but what waits in the queue.
bool Rests(const State& s) noexcept;

// Comes to rest on the path, which is then forgotten. mm/s²; 0: as the path says.
void EndMotion(const Brake& brake, State& s) noexcept;

}  // namespace takt::group
