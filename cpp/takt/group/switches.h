// Limit switches that are on: nothing moves towards them (PP-60). Directions in which MC_Power of a member enables no
// motion are closed in the same way (AX-111).
//
// Invariant: while a switch is on, no motion along a path goes towards it but that which is braked for it. Planning
// refuses a move that would (RefusalOf); where a motion turns to it afterwards, as carriers and interrupts may
// make it, each axis brakes by itself before the set point is given.
#pragma once

#include "takt/group/group.h"
#include "takt/kinematics/frames.h"

namespace takt::group {

// The directions that are closed now: by the limit switches and the power commands of the members, and by
// State::closed.
Directions ClosedNow(const Context& c, const State& s) noexcept;

// Why a motion that takes closed directions is refused: kAwayFromLimitOnly, or kDirection where all of them are not
// enabled. The feedback of that error names the axis (LookAhead::blame).
ErrorId RefusalOf(const Context& c, const State& s, Directions taken) noexcept;
// The same of State::refused.
inline ErrorId RefusalOf(const Context& c, const State& s) noexcept {
  return RefusalOf(c, s, s.refused);
}

// Which of these directions a motion of the axes takes, and of the tool in the MCS (null: it has none): faster than
// `least`, in u/s, mm/s and rad/s, or per mm along a path.
Directions TakenOf(const Directions& closed, const State& s, const kinematics::Joints& velocity,
                   const kinematics::MovingFrame* tool, double least) noexcept;

}  // namespace takt::group
