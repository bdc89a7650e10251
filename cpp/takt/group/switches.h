// Active limit switches: no motion towards them is permitted (PP-60). Directions in which MC_Power of a member permits
// no motion are closed in the same way (AX-111).
//
// Invariant: while a switch is active, no motion along a path leads towards it except one that is braked for it.
// Planning refuses moves that would (RefusalOf); where a motion turns towards it afterwards, because of carriers or
// interrupts, each axis brakes individually before the set point is given.
#pragma once

#include "takt/group/group.h"
#include "takt/kinematics/frames.h"

namespace takt::group {

// Returns the directions that are closed now: by the limit switches and the power commands of the members, and by
// State::closed.
Directions ClosedNow(const Context& c, const State& s) noexcept;

// Returns the error for a motion that takes closed directions: kAwayFromLimitOnly if a switch closes one of them, else
// kDirection (not enabled by MC_Power). Sets LookAhead::blame to the axis.
ErrorId RefusalOf(const Context& c, const State& s, Directions taken) noexcept;
// The same for State::refused.
inline ErrorId RefusalOf(const Context& c, const State& s) noexcept {
  return RefusalOf(c, s, s.refused);
}

// Returns the closed directions that a motion takes faster than `least` (in u/s, mm/s and rad/s, or per mm along a
// path). `velocity`: of the axes; `tool`: in the MCS, null if there is none.
Directions TakenOf(const Directions& closed, const State& s, const kinematics::Joints& velocity,
                   const kinematics::MovingFrame* tool, double least) noexcept;

}  // namespace takt::group
