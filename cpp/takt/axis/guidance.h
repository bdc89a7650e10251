// An axis whose set points come from another component of the machine, cycle by cycle: a cam module, a group.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/demand_follower.h"
#include "takt/trajectory/limits.h"

namespace takt::axis {

struct Context;
struct State;

// The component writes `demand` before the axis moves; the axis follows it within its limits
// (trajectory/demand_follower.h). A demand that they allow is taken bit for bit.
struct GuidanceState {
  KinematicState demand;  // over all turns: position + origin
  trajectory::DemandFollowerState chase;
  // In a fault with the loop closed the axis goes on by the set points, which the component brings to rest; else it
  // brakes by itself.
  bool brakes_with_others = false;
  bool comes_to_rest = false;  // the component brakes it, by a command
};

// Ramp on which an axis brakes after a fault, where a component has set one.
struct FaultRamp {
  double deceleration = 0;  // u/s²; 0: the axis' own
  double jerk = 0;          // u/s³
  // The demand is known to leave the SW limits: the axis brakes in time for this ramp. Else its own limits bring it to
  // rest inside, and only where the demand does not turn before.
  bool leaves_limits = false;
};

// Puts the component in control; what was in control is aborted. From the next Move on the axis follows `demand`, which
// begins as the axis moves now. Refuses like a command: kErrorStop, kPowerOff, kAxisStopping, kNoConstants, kState.
Status Guide(const Context& c, State& s) noexcept;
bool IsGuided(const State& s) noexcept;
// The component lets go: an axis that moves comes to rest, in ErrorStop on the ramp of its fault (StopLimits).
void LetGoOfGuidance(const Context& c, State& s) noexcept;
// The jerk [u/s³] with which an axis is braked whose ramp has `jerk` and whose own limit is `own` (0: none): where it
// speeds up, so much more that it gains no more than 5 % of its velocity until it slows down.
double BrakingJerk(const KinematicState& from, double jerk, double own) noexcept;
// The axis' own limits, with the ramp for faults where there is one.
trajectory::Limits WithFaultRamp(const Context& c, const State& s) noexcept;
// The same; the axis' own limits where that ramp would end beyond the SW limits.
trajectory::Limits FaultLimits(const Context& c, const State& s) noexcept;
// The next set point of a guided axis.
void FollowGuidance(const Context& c, State& s) noexcept;

void describe(Description<GuidanceState>&);
void describe(Description<FaultRamp>&);

}  // namespace takt::axis
