// X and Y each by itself (PL-86): moves to a position, by a distance and by velocity, and halts.
//
// Both are profiles of one motion whose frame is that of X and Y (plane.h). Each has the share kEach of the mover's
// maxima, so the vectors keep the maxima whatever the other coordinate does. A command of one coordinate replaces its
// profile, and the other profile continues unchanged. The guard (planar/guard.h) sees one motion, as of any other
// command: a mover that it holds brakes X and Y, and later continues both.
#pragma once

#include "takt/mover/run.h"

namespace takt::mover {

inline constexpr double kFar = 1e9;  // [mm, deg] a move by velocity ends here at the latest

// Plans X and Y each to its goal, from their present state or after a stop. Returns false if there is no such motion.
bool PlanToGoals(const Context& c, const PlaneState& from, PlaneMove& move) noexcept;

// Aborts the moves of X and of Y alone: another command takes over both.
void EndEach(const Context& c, State& s) noexcept;

// Reports, dated `cycle`, the moves by velocity that have reached their velocity when the cycle of `c` begins.
void NoteVelocity(const Context& c, std::uint64_t cycle, State& s) noexcept;
// Ends the command of a single coordinate: done; a move by velocity that ran out of room fails with its reason, and the
// buffer is aborted.
void Conclude(const Context& c, Slot slot, State& s) noexcept;

}  // namespace takt::mover
