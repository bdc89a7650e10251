#include "takt/axis/overlay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "takt/axis/fit.h"
#include "takt/axis/following.h"
#include "takt/axis/overlay_plan.h"
#include "takt/axis/overshoot_guard.h"
#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

using trajectory::Limits;
using trajectory::Profile;

namespace {

KinematicState Plus(const KinematicState& a, const KinematicState& b) {
  return {a.position + b.position, a.velocity + b.velocity, a.acceleration + b.acceleration};
}

bool Stands(const KinematicState& x) {
  return x.velocity == 0 && x.acceleration == 0;
}

double OverlayTime(const Context& c, const OverlayState& o) {
  return static_cast<double>(c.cycle.count - o.start_cycle) * c.cycle.period_s;
}

// Returns the motion added up to the previous set point. If the axis lags behind the sum, the plan continues from what
// was really added: the lag is dropped.
KinematicState AddedMotion(const Context& c, const State& s) {
  if (!s.superimposed) return {};
  const OverlayState& o = s.overlay;
  KinematicState added = o.profile.At(OverlayTime(c, o) - c.cycle.period_s);
  if (!o.chase.in_step) added.position = s.setpoint.position - o.base.position;
  return added;
}

// Returns true if the base motion follows masters or a table over time, not a profile.
bool FollowsNow(const State& s) {
  return Couples(s.active.kind) || (FollowsTable(s.active.kind) && !s.time_table.over);
}

// Returns true if the base motion has no known end: it follows something, or ends with a velocity.
bool IsEndless(const State& s) {
  return FollowsNow(s) || s.motion.profile.end().velocity != 0;
}

BaseAhead AheadOf(const Context& c, double late_s, const State& s) {
  const KinematicState& now = s.superimposed ? s.overlay.base : s.setpoint;
  if (FollowsNow(s)) return {nullptr, 0, now};
  return {&s.motion.profile, Elapsed(c, s) - late_s, now};
}

// Returns the end of a base motion that has one, also if an override holds the axis before it.
double BaseEnd(const State& s) {
  return s.motion.held && s.active.positions() ? s.motion.target : s.motion.profile.end().position;
}

// Returns the end of the sum, as far as it is known now.
double EndWith(double added, const State& s) {
  const KinematicState& now = s.superimposed ? s.overlay.base : s.setpoint;
  return (IsEndless(s) ? now.position : BaseEnd(s)) + added;
}

// Returns true if the sum ends inside the SW limits. An axis that moves on without an end is watched each cycle
// instead.
bool EndsInside(const Context& c, double added, const State& s) {
  const KinematicState& now = s.superimposed ? s.overlay.base : s.setpoint;
  return (IsEndless(s) && !Stands(now)) || Inside(c.params.limits, EndWith(added, s));
}

// Brakes the added motion as commanded, but not so weakly that it would reverse or get further than without the halt:
// then with the axis' own limits. If the added motion would come to rest beyond a SW limit, before which an axis that
// lags behind the sum may already be at rest, it ends at that limit.
Status PlanHalt(const Context& c, const KinematicState& from, const Limits& limits, const State& s, Profile& out) {
  const Limits own = c.params.planner_limits();
  const double promised = AddedAtEnd(s);
  Profile strongest{from};
  if (const Status status = c.planner.Stop(from, own, strongest); status.failed()) return status;
  const double sense = from.velocity < 0 ? -1 : 1;
  const double furthest = std::max(sense * strongest.end().position, sense * promised);
  const Status status = c.planner.Stop(from, limits, out);
  if (status.failed()) return status;
  const Profile::Range velocity = out.VelocityRange();
  const double backwards = sense < 0 ? velocity.max : -velocity.min;
  if (backwards > Rounding(0) || sense * out.end().position > furthest + Rounding(furthest)) out = strongest;
  const double end = out.end().position;
  if (EndsInside(c, end, s)) return Status::Ok();
  const double base = EndWith(0, s);
  const AxisLimits& sw = c.params.limits;
  const double inside = std::min(std::max(base + end, sw.lower.value_or(-HUGE_VAL)), sw.upper.value_or(HUGE_VAL));
  return c.planner.ToPosition(from, inside - base, 0, own, out);
}

// Returns the command with the overrides applied.
Request Overridden(const Context& c, const OverlayState& o) {
  Request r;
  r.kind = RequestKind::kMoveRelative;
  r.velocity = o.velocity;
  r.acceleration = o.acceleration;
  r.deceleration = o.deceleration;
  r.jerk = o.jerk;
  LimitedBy clamped = LimitedBy::kNothing;
  return Scaled(c.params, o.factors, r, clamped);
}

bool IsHeld(const OverlayState& o) {
  return o.factors.velocity == 0 && !o.halting;
}

// Plans the remainder to be added, from `from` on, `late_s` before this cycle; if held: a stop.
Status PlanRest(const Context& c, const OverlayState& o, const KinematicState& from, const Limits& limits,
                double late_s, const State& s, Profile& out) {
  if (IsHeld(o)) return c.planner.Stop(from, limits, out);
  return PlanOverlay(c.params, c.planner, AheadOf(c, late_s, s), from, o.target, limits, out);
}

Status MayBeOnTop(const Context& c, const State& s) {
  if (s.plc == PlcState::kErrorStop) return Status::Failed(ErrorId::kErrorStop);
  if (c.params.await_constants && !s.constants_set) return Status::Failed(ErrorId::kNoConstants);
  if (!s.loop_closed) return Status::Failed(ErrorId::kPowerOff);
  if (s.plc == PlcState::kStopping) return Status::Failed(ErrorId::kAxisStopping);
  const bool wrong = c.params.follows || s.plc == PlcState::kHoming || !Carries(s.active);
  return wrong ? Status::Failed(ErrorId::kState) : Status::Ok();
}

void RememberBase(State& s) {
  s.overlay.base_start_cycle = s.motion.start_cycle;
  s.overlay.base_start_offset_s = s.motion.start_offset_s;
}

// Puts a planned motion on top, in place of the present one.
void Begin(const Context& c, Ticket ticket, const KinematicState& from, OverlayState planned, State& s) {
  OverlayState& o = s.overlay;
  if (s.superimposed) {
    Report(c, o.ticket, FeedbackState::kAborted, ErrorId::kNone, false, from.position - o.begin);
    planned.chase = o.chase;
    planned.limited_by = o.limited_by;
  }
  planned.base = s.superimposed ? o.base : s.setpoint;
  planned.start_cycle = c.cycle.count - 1;
  planned.ticket = ticket;
  planned.begin = from.position;
  o = planned;
  s.superimposed = true;
  RememberBase(s);
  if (s.plc == PlcState::kStandstill) Enter(s, PlcState::kDiscreteMotion);
  Report(c, ticket, FeedbackState::kActive, ErrorId::kNone, false, o.profile.duration());
}

// Plans the remainder anew after the base motion or the overrides changed. Weaker ramps do not make it overshoot its
// target.
void PlanAgain(const Context& c, const KinematicState& added, State& s) {
  OverlayState& o = s.overlay;
  const bool overridden = o.factors != s.override_factors;
  RememberBase(s);
  o.factors = s.override_factors;
  if (o.halting || (FollowsNow(s) && !overridden)) return;
  Request r = Overridden(c, o);
  const bool ahead = added.velocity * (o.target - added.position) > 0;
  if (overridden && ahead && !StopsBy(added, r.limits(), o.target)) {
    r = WithStrongerRamps(c.params, added, r, {o.target, true});
  }
  if (PlanRest(c, o, added, r.limits(), 0, s, o.profile).ok()) o.start_cycle = c.cycle.count;
}

// Makes the added distance part of the base motion.
void Fold(double added, State& s) {
  s.motion.profile.Shift(added);
  s.motion.target += added;
  if (Couples(s.active.kind)) s.coupling.chase.offset += added;
  if (FollowsTable(s.active.kind)) s.time_table.chase.offset += added;
}

void End(const Context& c, FeedbackState feedback, ErrorId error, State& s) {
  OverlayState& o = s.overlay;
  Fold(o.chase.in_step ? o.profile.end().position : s.setpoint.position - o.base.position, s);
  s.superimposed = false;
  Report(c, o.ticket, feedback, error, false, o.covered);
  if (s.motion.arrived) s.motion.arrived_cycle = c.cycle.count;
  if (error != ErrorId::kNone) AbortBuffer(c, s);
  if (s.active.kind == RequestKind::kNone && (AtRest(s) || s.buffered > 0)) StartNext(c, 0, s);
}

// Returns true if the base motion with the added distance stays inside the SW limits to its end, and could stop there.
bool StaysInside(const Context& c, const State& s) {
  if (FollowsNow(s) || s.plc == PlcState::kContinuousMotion) return true;  // watched each cycle
  const Profile::Range range = s.motion.profile.PositionRange(Elapsed(c, s));
  const double stop = trajectory::StopPosition(s.motion.profile.end(), c.params.planner_limits());
  return Inside(c.params.limits, std::min({range.min, stop, BaseEnd(s)}) + AddedAtEnd(s)) &&
         Inside(c.params.limits, std::max({range.max, stop, BaseEnd(s)}) + AddedAtEnd(s));
}

// Ends the overlay once all of its distance is planned and added.
void EndWhenDue(const Context& c, State& s) {
  const OverlayState& o = s.overlay;
  const double over_s = OverlayTime(c, o) - o.profile.duration();
  if (over_s < 0 || IsHeld(o)) return;
  const bool alone = s.active.kind == RequestKind::kNone && Stands(o.base);
  if (o.chase.in_step) {
    if (!StaysInside(c, s)) return;
    if (!alone || InPosition(c.params, s)) return End(c, FeedbackState::kDone, ErrorId::kNone, s);
    if (over_s > c.params.supervision.in_position_timeout_s) End(c, FeedbackState::kError, ErrorId::kDeviationLimit, s);
  } else if (AtRest(s) && Stands(o.base) && !IsEndless(s) && !Inside(c.params.limits, EndWith(AddedAtEnd(s), s))) {
    End(c, FeedbackState::kError, ErrorId::kTargetBehindLimit, s);  // the base motion ended elsewhere than promised
  }
}

// Returns true if a buffered command that carries no overlay is to take over from a moving axis.
bool NextEndsOverlay(const State& s) {
  return s.active.kind == RequestKind::kNone && s.buffered > 0 && !Carries(s.buffer[0]) && !Stands(s.overlay.base);
}

// Returns the reason why the axis lags behind the sum; the previous one if the sum itself is within the limits again.
LimitedBy WhatHoldsBack(const Limits& own, const KinematicState& demand, const OverlayState& o) {
  if (IsHeld(o)) return LimitedBy::kOverride;
  if (o.chase.in_step) return LimitedBy::kNothing;
  const LimitedBy beyond = Beyond(own, demand, false);
  if (beyond != LimitedBy::kNothing) return beyond;
  return o.limited_by != LimitedBy::kNothing ? o.limited_by : LimitedBy::kJerk;
}

// Computes the next set point, before the check of the SW limits.
KinematicState NextSetpoint(const Context& c, const KinematicState& before, State& s) {
  OverlayState& o = s.overlay;
  const KinematicState added = o.profile.At(OverlayTime(c, o));
  const KinematicState demand = Plus(o.base, added);
  const Limits own = c.params.planner_limits();
  const KinematicState next =
      FollowDemand({own, c.planner, own, c.cycle.period_s}, trajectory::DemandMode::kPosition, before, demand, o.chase);
  o.limited_by = WhatHoldsBack(own, demand, o);
  const bool other = o.base_start_cycle != s.motion.start_cycle || o.base_start_offset_s != s.motion.start_offset_s;
  if (other || o.factors != s.override_factors) PlanAgain(c, added, s);
  return next;
}

}  // namespace

ScopedBaseMotion::ScopedBaseMotion(State& state) noexcept : state_(state) {
  Swap();
}

ScopedBaseMotion::~ScopedBaseMotion() {
  Swap();
}

void ScopedBaseMotion::Swap() noexcept {
  if (state_.superimposed) std::swap(state_.setpoint, state_.overlay.base);
}

void Superimpose(const Context& c, State& s) noexcept {
  OverlayState& o = s.overlay;
  const KinematicState before = s.setpoint;
  KinematicState next = NextSetpoint(c, before, s);
  if (!CanStopInside(c.params, before, next)) {
    if (s.plc != PlcState::kDiscreteMotion) {
      const bool upwards = next.position > before.position;
      Fail(c, upwards ? ErrorId::kSoftLimitPositive : ErrorId::kSoftLimitNegative, false, s);
      s.setpoint = s.motion.profile.At(Elapsed(c, s));
      return;
    }
    Profile brake{before};
    c.planner.Stop(before, c.params.planner_limits(), brake);
    next = brake.At(c.cycle.period_s);
    o.chase.in_step = false;
    o.limited_by = LimitedBy::kPosition;
  }
  s.setpoint = next;
  o.covered = next.position - o.base.position - o.begin;
  if (next.velocity != 0) s.last_sense = next.velocity > 0 ? 1 : -1;
  if (NextEndsOverlay(s)) {
    AbortOverlay(c, FeedbackState::kAborted, ErrorId::kNone, s);
    return StartNext(c, 0, s);
  }
  EndWhenDue(c, s);
}

void AbortOverlay(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  if (!s.superimposed) return;
  s.superimposed = false;
  Report(c, s.overlay.ticket, feedback, error, false, s.overlay.covered);
}

bool BaseAtRest(const State& s) noexcept {
  return Stands(s.overlay.base);
}

bool Carries(const Request& r) noexcept {
  const bool switches_off = r.kind == RequestKind::kPower && !r.enable;
  return !switches_off && !Homes(r.kind) && r.kind != RequestKind::kStop && r.kind != RequestKind::kTorqueControl &&
         r.kind != RequestKind::kTouch && r.kind != RequestKind::kStream && r.kind != RequestKind::kGuided;
}

double AddedAtEnd(const State& s) noexcept {
  return s.superimposed ? s.overlay.target : 0;
}

bool Fill(const RequestBuilder& m, const MoveSuperimposed& c) {
  return m.In("distance", c.distance, -kMaxPosition, kMaxPosition) &&
         m.Take("velocity_difference", c.velocity_difference, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}

bool Fill(const RequestBuilder& m, const HaltSuperimposed& c) {
  return m.Braking(c);
}

Status CarryOut(const Context& c, Ticket ticket, const MoveSuperimposed& command, State& s) noexcept {
  if (command.update && (!s.superimposed || s.overlay.halting)) {
    return Report(c, ticket, FeedbackState::kAborted), Status::Ok();
  }
  if (const Status status = MayBeOnTop(c, s); status.failed()) return status;
  const KinematicState from = AddedMotion(c, s);
  const double begin = command.update ? s.overlay.begin : from.position;
  const double target = begin + command.distance;
  const double way = target - from.position;
  if (const Status status = MayMove(c, s, way > 0 ? 1 : way < 0 ? -1 : 0); status.failed()) return status;
  if (!EndsInside(c, target, s)) return Status::Failed(ErrorId::kTargetBehindLimit);
  Request r;
  Refusal why;
  Fill(RequestBuilder{c.params, r, why}, command);
  OverlayState planned;
  planned.factors = s.override_factors;
  planned.target = target;
  planned.velocity = r.velocity;
  planned.acceleration = r.acceleration;
  planned.deceleration = r.deceleration;
  planned.jerk = r.jerk;
  const Limits limits = Overridden(c, planned).limits();
  const Status status = PlanRest(c, planned, from, limits, c.cycle.period_s, s, planned.profile);
  if (status.failed()) return status;
  Begin(c, ticket, from, planned, s);
  s.overlay.begin = begin;
  return Status::Ok();
}

Status CarryOut(const Context& c, Ticket ticket, const HaltSuperimposed& command, State& s) noexcept {
  if (const Status status = MayBeOnTop(c, s); status.failed()) return status;
  if (!s.superimposed) {
    Report(c, ticket, FeedbackState::kActive);
    Report(c, ticket, FeedbackState::kDone);
    return Status::Ok();
  }
  Request r;
  Refusal why;
  Fill(RequestBuilder{c.params, r, why}, command);
  const KinematicState from = AddedMotion(c, s);
  OverlayState planned;
  if (const Status status = PlanHalt(c, from, r.limits(), s, planned.profile); status.failed()) return status;
  planned.factors = s.override_factors;
  planned.target = planned.profile.end().position;
  planned.halting = true;
  Begin(c, ticket, from, planned, s);
  return Status::Ok();
}

void describe(Description<OverlayState>& d) {
  using O = OverlayState;
  d.about("A motion superimposed on the motion in progress.");
  d.internal<&O::base>("Set point of the base motion, unwrapped.");
  d.internal<&O::profile>("Superimposed motion.");
  d.internal<&O::start_cycle>("Cycle its time counts from.");
  d.internal<&O::base_start_cycle>("Cycle in which the base motion began for which it was planned ...");
  d.internal<&O::base_start_offset_s>(unit::s, "... and the time before that cycle.");
  d.internal<&O::chase>("State of the follower of the sum.");
  d.internal<&O::ticket>("Ticket of the command.");
  d.internal<&O::factors>("Overrides for which it was planned.");
  d.internal<&O::target>(unit::u, "Total distance to be added.");
  d.internal<&O::begin>(unit::u, "Distance added before the command.");
  d.internal<&O::covered>(unit::u, "Distance added by the command.");
  d.internal<&O::velocity>(unit::u_s, "Largest velocity added.");
  d.internal<&O::acceleration>(unit::u_s2, "Largest acceleration added.");
  d.internal<&O::deceleration>(unit::u_s2, "Largest deceleration added.");
  d.internal<&O::jerk>(unit::u_s3, "Largest jerk added; 0: unlimited.");
  d.internal<&O::halting>("The motion is being halted.");
  d.internal<&O::limited_by>("Limit that keeps the axis from following the sum.");
}

}  // namespace takt::axis
