#include "takt/axis/guidance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/axis/fit.h"
#include "takt/axis/following.h"
#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

namespace {

constexpr double kGained = 0.05;  // of its velocity, while braking an axis that is speeding up

Status MayGuide(const Context& c, const State& s) {
  if (s.plc == PlcState::kErrorStop) return Status::Failed(ErrorId::kErrorStop);
  if (c.params.await_constants && !s.constants_set) return Status::Failed(ErrorId::kNoConstants);
  if (c.params.follows || s.plc == PlcState::kHoming) return Status::Failed(ErrorId::kState);
  if (!s.loop_closed) return Status::Failed(ErrorId::kPowerOff);
  if (s.plc == PlcState::kStopping || IsHeldStopped(s)) return Status::Failed(ErrorId::kAxisStopping);
  return FollowersReady(c, s);
}

// Returns what restricts an axis that is not in step. If the demand is within the axis' limits it may have jumped: then
// the limit at which the axis catches up.
LimitedBy HeldBackBy(const trajectory::Limits& own, const KinematicState& demand, const KinematicState& set,
                     bool in_step) {
  const LimitedBy beyond = Beyond(own, demand, in_step);
  if (in_step || beyond != LimitedBy::kNothing) return beyond;
  constexpr double kNear = 0.98;
  if (std::abs(set.velocity) >= kNear * own.velocity) return LimitedBy::kVelocity;
  const double ramp = set.velocity * set.acceleration > 0 ? own.acceleration : own.deceleration;
  return own.jerk == 0 || std::abs(set.acceleration) >= kNear * ramp ? LimitedBy::kAcceleration : LimitedBy::kJerk;
}

}  // namespace

Status Guide(const Context& c, State& s) noexcept {
  if (const Status status = MayGuide(c, s); status.failed()) return status;
  AbortAll(c, s);
  Request guided;
  guided.kind = RequestKind::kGuided;
  Grant(c, guided, s);
  s.guidance = {{s.setpoint.position + s.origin, s.setpoint.velocity, s.setpoint.acceleration}, {}, false};
  s.limited_by = LimitedBy::kNothing;
  s.motion.profile = trajectory::Profile{s.setpoint};
  s.motion.target = s.setpoint.position;
  s.motion.arrived = false;
  Enter(s, PlcState::kSynchronizedMotion);
  return Status::Ok();
}

bool IsGuided(const State& s) noexcept {
  return s.active.kind == RequestKind::kGuided;
}

void EndGuidance(const Context& c, State& s) noexcept {
  if (!IsGuided(s)) return;
  EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
  if (s.plc == PlcState::kErrorStop) {
    s.active = {};
    return BrakeInFault(c, s.error, s);
  }
  if (!AtRest(s)) return ComeToRest(c, c.params.planner_limits(), FromCycleBefore(c), s);
  StandStill(c, s);
  Enter(s, PlcState::kStandstill);
}

void FollowGuidance(const Context& c, State& s) noexcept {
  const trajectory::Limits own = c.params.planner_limits();
  KinematicState demand = s.guidance.demand;
  demand.position -= s.origin;
  trajectory::DemandFollowerState& chase = s.guidance.chase;
  s.setpoint = FollowDemand({own, c.planner, own, c.cycle.period_s}, trajectory::DemandMode::kPosition, s.setpoint,
                            demand, chase);
  s.limited_by = HeldBackBy(own, demand, s.setpoint, chase.in_step);
  if (!AtRest(s)) s.motion.arrived_cycle = c.cycle.count;
}

double BrakingJerk(const KinematicState& from, double jerk, double own) noexcept {
  const double most = own > 0 ? own : std::numeric_limits<double>::infinity();
  double least = jerk;
  if (jerk > 0 && from.velocity * from.acceleration > 0) {
    least = std::max(jerk, from.acceleration * from.acceleration / (2 * kGained * std::abs(from.velocity)));
  }
  return least < most ? least : own;
}

trajectory::Limits WithFaultRamp(const Context& c, const State& s) noexcept {
  trajectory::Limits limits = c.params.planner_limits();
  if (s.fault_ramp.deceleration == 0) return limits;
  limits.deceleration = std::min(limits.deceleration, s.fault_ramp.deceleration);
  limits.jerk = BrakingJerk(s.setpoint, s.fault_ramp.jerk, limits.jerk);
  return limits;
}

trajectory::Limits FaultLimits(const Context& c, const State& s) noexcept {
  const trajectory::Limits limits = WithFaultRamp(c, s);
  return Inside(c.params.limits, trajectory::StopPosition(s.setpoint, limits)) ? limits : c.params.planner_limits();
}

void describe(Description<FaultRamp>& d) {
  d.about("Ramp on which an axis brakes after a fault.");
  d.internal<&FaultRamp::deceleration>(unit::u_s2, "Deceleration; 0: the axis' own.");
  d.internal<&FaultRamp::jerk>(unit::u_s3, "Jerk of that ramp.");
  d.internal<&FaultRamp::leaves_limits>("The demand is known to leave the SW limits.");
}

void describe(Description<GuidanceState>& d) {
  d.about("Set points of another component of the machine.");
  d.internal<&GuidanceState::demand>("Demand of the component, over all turns.");
  d.internal<&GuidanceState::chase>("State of the follower of that demand.");
  d.internal<&GuidanceState::comes_to_rest>("The component brakes the axis by a command.");
  d.internal<&GuidanceState::brakes_with_others>("The component brings it to rest in a fault.");
}

}  // namespace takt::axis
