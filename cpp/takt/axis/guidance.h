// An axis whose set points come from another component of the machine, each cycle: a cam module, a group.
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
// (trajectory/demand_follower.h). A demand within these limits is taken bit for bit.
struct GuidanceState {
  KinematicState demand;  // over all turns: position + origin
  trajectory::DemandFollowerState chase;
  // In a fault with the loop closed, other than at a SW limit, the axis keeps following the demand, which the component
  // brings to rest; else it brakes by itself.
  bool brakes_with_others = false;
  bool comes_to_rest = false;  // the component is braking it, by a command
};

// Ramp for braking after a fault, if a component has set one.
struct FaultRamp {
  double deceleration = 0;  // [u/s²] 0: the axis' own
  double jerk = 0;          // [u/s³]
  // True: the demand is known to leave the SW limits, so the axis brakes early enough for this ramp. False: it brakes
  // only when it needs its own limits to stop inside, as the demand may turn before.
  bool leaves_limits = false;
};

// Puts the component in control; the command in control is aborted. From the next Move on the axis follows `demand`,
// which starts at the present set point. Rejected like a command: kErrorStop, kPowerOff, kAxisStopping, kNoConstants,
// kState, kNotInStep.
Status Guide(const Context& c, State& s) noexcept;
// Returns true while a component gives the set points.
bool IsGuided(const State& s) noexcept;
// Ends the guidance: an axis that moves comes to rest, in ErrorStop on the ramp of its fault (StopLimits).
void EndGuidance(const Context& c, State& s) noexcept;
// Returns the jerk [u/s³] for braking on a ramp with `jerk` an axis whose own limit is `own` (0: none). If the axis is
// speeding up, the jerk is raised so that it gains at most 5 % of its velocity before it slows down.
double BrakingJerk(const KinematicState& from, double jerk, double own) noexcept;
// Returns the axis' own limits, with the ramp for faults if there is one.
trajectory::Limits WithFaultRamp(const Context& c, const State& s) noexcept;
// Returns the same, but the axis' own limits if that ramp would end beyond the SW limits.
trajectory::Limits FaultLimits(const Context& c, const State& s) noexcept;
// Computes the next set point of a guided axis.
void FollowGuidance(const Context& c, State& s) noexcept;

void describe(Description<GuidanceState>&);
void describe(Description<FaultRamp>&);

}  // namespace takt::axis
