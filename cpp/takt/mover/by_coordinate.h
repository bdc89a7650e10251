// X and Y each by itself (PL-86): moves to a position, by a distance and by velocity, and halts.
//
// Both are profiles of one motion, whose frame is that of X and Y (plane.h); each has the share kEach of the mover's
// maxima, so the vectors keep them whatever the other one does. So a command of one replaces the profile of that
// coordinate, and the other profile goes on as it was. The guard (planar/guard.h) sees one motion, as of any other
// command: a mover that it holds brakes X and Y, and goes on with both.
#pragma once

#include "takt/mover/run.h"

namespace takt::mover {

inline constexpr double kFar = 1e9;  // mm, deg: where a move by velocity ends at the latest

// At rest, after it was held or came to rest for the first of them: both go to their goals. False: no such motion.
bool PlanToGoals(const Context& c, const PlaneState& from, PlaneMove& move) noexcept;

// Moves of X and of Y by itself are over: another command takes over both.
void EndEach(const Context& c, State& s) noexcept;

// Reports, as of this cycle, a move by velocity that has its velocity when that of `c` begins.
void NoteVelocity(const Context& c, std::uint64_t cycle, State& s) noexcept;
// A command of X, Y or C alone is over: done, or, of a move by velocity, there is no more room.
void Conclude(const Context& c, Slot slot, State& s) noexcept;

}  // namespace takt::mover
