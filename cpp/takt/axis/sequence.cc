#include "takt/axis/sequence.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/following.h"
#include "takt/axis/overshoot_guard.h"

namespace takt::axis {

using trajectory::Profile;

void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error, bool reached,
            double value) noexcept {
  c.feedback.Report({ticket, c.cycle.count, feedback, reached, error, value});
}

void ReportEnd(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error, const State& s) noexcept {
  FeedbackEvent end{ticket, c.cycle.count, feedback, false, error, 0};
  const bool touched = feedback == FeedbackState::kDone && s.active.kind == RequestKind::kTouch;
  if (touched) end.value = Reported(c.params, s.motion.target);
  if (error == ErrorId::kAxisFault && s.fault_of != kNoAxis) end.object = {ObjectKind::kAxis, s.fault_of + 1};
  c.feedback.Report(end);
}

void Enter(State& s, PlcState to) noexcept {
  if (!IsLegal(s.plc, to)) ++s.illegal_transitions;
  s.plc = to;
}

namespace {

// Returns true for a continuous move that has passed its position: from there on it is a velocity.
bool HasPassed(const State& s) {
  return s.active.continuous() && s.passed;
}

// Returns the furthest position [u] that the positioning command in control may reach.
double FurthestOf(const Context& c, const State& s) {
  const trajectory::Profile::Range range = s.motion.profile.PositionRange(Elapsed(c, s) - c.cycle.period_s);
  return SenseOfTravel(s.setpoint) > 0 ? std::max(range.max, s.motion.target) : std::min(range.min, s.motion.target);
}

}  // namespace

PlanningContext BasePlanningContext(const Context& c, const State& s) noexcept {
  PlanningContext around;
  around.limit_positive = s.limit_positive || FollowerOnLimit(c, s, 1);
  around.limit_negative = s.limit_negative || FollowerOnLimit(c, s, -1);
  around.bars_positive = Bars(c, s, 1);
  around.bars_negative = Bars(c, s, -1);
  around.homed = s.homing.homed;
  around.last_sense = s.last_sense;
  around.factors = s.override_factors;
  if (!s.active.positions()) return around;
  around.promised = s.motion.target;
  if (s.active.kind == RequestKind::kMoveContinuousRelative) around.begin = s.motion.target - s.active.value;
  if (!HasPassed(s) && s.motion.profile.end().velocity == 0) around.furthest = FurthestOf(c, s);
  return around;
}

PlanningContext SumPlanningContext(const Context& c, const State& s) noexcept {
  PlanningContext around = BasePlanningContext(c, s);
  if (!s.superimposed) return around;
  const double covered = s.setpoint.position - s.overlay.base.position;
  if (around.promised) *around.promised += covered;
  if (around.begin) *around.begin += covered;
  around.furthest.reset();  // that of the base motion alone
  return around;
}

void StartMotion(const Profile& profile, double target, const MotionStart& start, State& s) noexcept {
  s.motion.profile = profile;
  s.motion.target = target;
  s.motion.start_cycle = start.cycle;
  s.motion.start_offset_s = start.offset_s;
  s.motion.held = false;
  s.motion.arrived = false;
}

void StartMotion(const Plan& plan, const MotionStart& start, State& s) noexcept {
  s.limited_by = plan.limited_by;
  StartMotion(plan.profile, plan.target, start, s);
  s.motion.held = plan.held;
}

void StandStill(const Context& c, State& s) noexcept {
  StartMotion(Profile{s.setpoint}, s.setpoint.position, FromCycleBefore(c), s);
  s.motion.arrived = true;
  s.motion.arrived_cycle = c.cycle.count;
}

bool InPosition(const AxisParams& p, const State& s) noexcept {
  return !p.supervision.in_position || std::abs(s.setpoint.position - s.actual.position) <= *p.supervision.in_position;
}

std::span<const Request> BlendingQueue(const State& s) noexcept {
  std::size_t count = 0;
  while (count < s.buffered && s.buffer[count].blends()) ++count;
  return {s.buffer.data(), count};
}

namespace {

Request TakeFirst(State& s) {
  const Request first = s.buffer[0];
  for (std::size_t i = 1; i < s.buffered; ++i) s.buffer[i - 1] = s.buffer[i];
  --s.buffered;
  s.buffer[s.buffered] = Request{};
  return first;
}

// The motion in control has ended; an overlay may not have.
void EnterRest(State& s) {
  Enter(s, s.superimposed ? PlcState::kDiscreteMotion : PlcState::kStandstill);
}

double ArrivedFor(const Context& c, const State& s) {
  return static_cast<double>(c.cycle.count - s.motion.arrived_cycle) * c.cycle.period_s;
}

void ConcludePositioning(const Context& c, double late_s, State& s) {
  const bool leaves_moving = s.motion.profile.end().velocity != 0;
  // Beneath another motion the axis does not stop at its end.
  if (leaves_moving || s.superimposed || InPosition(c.params, s)) {
    EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
    StartNext(c, leaves_moving ? late_s : 0, s, leaves_moving);
  } else if (ArrivedFor(c, s) > c.params.supervision.in_position_timeout_s) {
    EndActive(c, FeedbackState::kError, ErrorId::kDeviationLimit, s);
    AbortBuffer(c, s);
    Enter(s, PlcState::kStandstill);
  }
}

void NoteReached(const Context& c, State& s) {
  if (s.reported) return;
  Report(c, s.active.ticket, FeedbackState::kActive, ErrorId::kNone, true);
  s.reported = true;
}

// Hands over from a command that never ends by itself to the next one.
void HandOver(const Context& c, State& s) {
  if (s.buffered == 0) return;
  const Ticket ticket = s.active.ticket;
  if (Couples(s.active.kind)) Uncouple(c, false, s);
  // Beneath an overlay the next command may have to wait: the axis keeps its present velocity.
  if (FollowsDemand(s.active.kind)) {
    StartMotion(Profile{s.setpoint}, s.setpoint.position, FromThisCycle(c), s);
  }
  s.active = Request{};
  Report(c, ticket, FeedbackState::kAborted, ErrorId::kNone, s.reported);
  StartNext(c, 0, s);
}

// Handles a command that never ends by itself and has reached its goal.
void ConcludeReached(const Context& c, State& s) {
  NoteReached(c, s);
  HandOver(c, s);
}

// Returns the request for the velocity with which a continuous move continues from its position.
Request Onward(const State& s) {
  Request onward = s.active;
  onward.kind = RequestKind::kMoveVelocity;
  onward.velocity = s.active.end_velocity;
  return onward;
}

// Brakes from the end of the motion in progress, `late_s` ago.
void BrakeFromEnd(const Context& c, double late_s, State& s) {
  s.setpoint = s.motion.profile.end();
  Brake(c, c.params.planner_limits(), {c.cycle.count, late_s}, s);
  s.setpoint = s.motion.profile.At(Elapsed(c, s));
}

// Continues from the position of a continuous move that passed it at another velocity than its end velocity. Returns
// kTargetBehindLimit if there is no room for that. A buffered command takes over at a set point from which the axis can
// stop inside the SW limits: its plan must keep them from there.
Status GoOn(const Context& c, double late_s, State& s) {
  const Profile passing = s.motion.profile;
  Plan plan;
  const Status status = PlanRequest(c.params, BasePlanningContext(c, s), c.planner, passing.end(), Onward(s), {}, plan);
  if (status.failed()) {
    BrakeFromEnd(c, late_s, s);
    return status;
  }
  plan.target = s.motion.target;
  if (plan.limited_by == LimitedBy::kNothing) plan.limited_by = s.limited_by;  // until the end velocity is reached
  StartMotion(plan, {c.cycle.count, late_s}, s);
  s.setpoint = s.motion.profile.At(Elapsed(c, s));
  if (s.buffered > 0 && !s.superimposed && !CanStopInside(c.params, passing.end(), s.setpoint)) {
    s.motion.profile = passing;
    BrakeFromEnd(c, late_s, s);
  }
  return status;
}

// Returns true if the motion ends with the end velocity of the continuous move, scaled by the override.
bool HasEndVelocity(const Context& c, const State& s) {
  LimitedBy clamped = LimitedBy::kNothing;
  const double due = Scaled(c.params, s.override_factors, s.active, clamped).end_velocity;
  const KinematicState end = s.motion.profile.end();
  return end.acceleration == 0 && std::abs(std::abs(end.velocity) - due) <= Rounding(due);
}

// A continuous move reaches its goal with its end velocity, at or beyond its position (AX-102).
void ConcludeContinuous(const Context& c, double late_s, State& s) {
  const bool arrives = !s.passed;
  s.passed = true;
  if (arrives) s.active.direction = s.last_sense < 0 ? Direction::kNegative : Direction::kPositive;
  if (!arrives || HasEndVelocity(c, s)) {
    if (!s.reported && s.limited_by == LimitedBy::kDistance) s.limited_by = LimitedBy::kNothing;
    NoteReached(c, s);
  } else if (s.buffered == 0 || s.motion.profile.end().acceleration != 0) {
    const Status status = GoOn(c, late_s, s);
    if (status.failed() && s.buffered == 0) {
      EndActive(c, FeedbackState::kError, status.error, s);
      return ComeToRest(c, c.params.planner_limits(), FromThisCycle(c), s);
    }
  }
  HandOver(c, s);
}

void ConcludeCam(const Context& c, State& s) {
  if (s.coupling.in_step) NoteReached(c, s);
  if (s.coupling.cam.over) HandOver(c, s);
}

// The last velocity is kept.
void ConcludeVelocityProfile(const Context& c, double late_s, State& s) {
  EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
  if (s.buffered > 0) StartNext(c, late_s, s);
}

// At rest: closes the brake, then opens the loop.
void ConcludePower(const Context& c, State& s) {
  if (!s.loop_closed) return SwitchedOff(c, s);
  if (!s.brake_falls) {
    s.brake_falls = true;
    s.brake_cycle = c.cycle.count;
  }
  const double closing_s = static_cast<double>(c.cycle.count - s.brake_cycle) * c.cycle.period_s;
  if (closing_s >= c.params.drive.brake_closes_s) return SwitchedOff(c, s);
  if (s.plc != PlcState::kStopping && IsLegal(s.plc, PlcState::kStopping)) Enter(s, PlcState::kStopping);
}

// Stopping is visible for at least one cycle.
void ConcludeStop(const Context& c, State& s) {
  if (FollowersStraighten(c, s)) return;  // they must come to rest, too
  const bool just_arrived = c.cycle.count == s.motion.arrived_cycle;
  ReportStopped(c, just_arrived, s);
  if (just_arrived || IsHeldStopped(s)) return;
  s.active = Request{};
  StartNext(c, 0, s);
}

}  // namespace

void Grant(const Context& c, const Request& request, State& s, double travel_s) noexcept {
  s.active = request;
  s.reported = false;
  s.passed = false;
  s.lease_end_cycle = CycleIn(c.cycle, request.lease_s);
  Report(c, request.ticket, FeedbackState::kActive, ErrorId::kNone, false, travel_s);
  if (request.kind == RequestKind::kStop) BeginStop(c, request, s);
}

void TakeControl(const Context& c, const Request& request, const Plan& plan, const MotionStart& start,
                 State& s) noexcept {
  Grant(c, request, s, plan.held ? 0 : plan.profile.duration() - start.offset_s);
  StartMotion(plan, start, s);
  // Keeps the present sense, also when it is planned anew later.
  if (request.kind == RequestKind::kMoveVelocity && request.direction == Direction::kCurrent) {
    s.active.direction = s.last_sense < 0 ? Direction::kNegative : Direction::kPositive;
  }
  Enter(s, RulesOf(request.kind).state);
}

Status MayFollow(const Context& c, const Request& request, const State& s) noexcept {
  if (Streams(request.kind)) return Status::Ok();
  return Couples(request.kind) ? MayCouple(c, request, s) : MayFollowTable(c, request, s);
}

void BeginFollowing(const Context& c, const Request& request, const MotionStart& start, State& s) noexcept {
  if (Streams(request.kind)) return BeginStream(c, request, s);
  Couples(request.kind) ? Couple(c, request, s) : BeginTable(c, request, start, s);
}

void EndActive(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  if (s.active.kind == RequestKind::kStop) {
    EndStops(c, feedback, error, s);
  } else if (s.active.kind != RequestKind::kNone) {
    ReportEnd(c, s.active.ticket, feedback, error, s);
  }
  if (Couples(s.active.kind)) Uncouple(c, feedback == FeedbackState::kError, s);
  s.active = Request{};
  s.reported = false;
  s.passed = false;
  s.motion.held = false;
  s.jog_sense = 0;
}

void AbortBuffer(const Context& c, State& s) noexcept {
  for (std::size_t i = 0; i < s.buffered; ++i) {
    Report(c, s.buffer[i].ticket, FeedbackState::kAborted);
    s.buffer[i] = Request{};
  }
  s.buffered = 0;
}

void AbortAll(const Context& c, State& s) noexcept {
  EndActive(c, FeedbackState::kAborted, ErrorId::kNone, s);
  AbortBuffer(c, s);
  AbortOverlay(c, FeedbackState::kAborted, ErrorId::kNone, s);
}

void Brake(const Context& c, const trajectory::Limits& limits, const MotionStart& start, State& s,
           std::optional<double> furthest) noexcept {
  Profile profile{s.setpoint};
  PlanStop(c.params, c.planner, s.setpoint, limits, furthest, profile);
  StartMotion(profile, profile.end().position, start, s);
}

void ComeToRest(const Context& c, const trajectory::Limits& limits, const MotionStart& start, State& s,
                std::optional<double> furthest) noexcept {
  s.active = Request{};
  s.active.kind = RequestKind::kHalt;
  Brake(c, limits, start, s, furthest);
  Enter(s, PlcState::kDiscreteMotion);
}

void SwitchedOff(const Context& c, State& s) noexcept {
  OpenLoop(s);
  Enter(s, PlcState::kDisabled);
  EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
}

void OpenLoop(State& s) noexcept {
  s.enable = false;
  s.loop_closed = false;
  s.brake_falls = false;
  s.blind = false;
  s.homing.stage = HomingStage::kNone;
  s.voltage_v = 0;
  s.limited_by = LimitedBy::kNothing;
  s.setpoint = {s.actual.position, 0, 0};
  s.motion = Motion{};
  s.motion.arrived = true;
}

void StartNext(const Context& c, double late_s, State& s, bool committed) noexcept {
  s.limited_by = LimitedBy::kNothing;
  if (s.homing.stage == HomingStage::kWaiting && s.buffered > 0 && !MayFollowStep(s.buffer[0].kind)) {
    Report(c, TakeFirst(s).ticket, FeedbackState::kError, ErrorId::kState);
    return AbortBuffer(c, s);
  }
  const bool homes_on = s.plc == PlcState::kHoming && s.buffered > 0 && Homes(s.buffer[0].kind);
  if (AtRest(s) && IsLegal(s.plc, PlcState::kStandstill) && !homes_on) EnterRest(s);
  const bool seamless = s.motion.profile.end().velocity != 0 && late_s > 0;
  PlanningContext around = BasePlanningContext(c, s);
  around.committed = committed;
  while (s.buffered > 0) {
    if (s.superimposed && !Carries(s.buffer[0])) return;
    const Request next = TakeFirst(s);
    if (next.kind == RequestKind::kPower && next.enable) {  // it is already on
      Report(c, next.ticket, FeedbackState::kActive);
      Report(c, next.ticket, FeedbackState::kDone);
      continue;
    }
    const KinematicState from = seamless ? s.motion.profile.end() : s.setpoint;
    Plan plan;
    const bool homes = Homes(next.kind);
    const bool follows = FollowsDemand(next.kind);
    const bool begins = AtRest(s) && next.kind != RequestKind::kHalt && next.kind != RequestKind::kStop &&
                        next.kind != RequestKind::kPower;
    Status status = begins ? FollowersReady(c, s) : Status::Ok();
    if (status.ok()) {
      status = homes     ? BeginHoming(c, next, false, s)
               : follows ? MayFollow(c, next, s)
                         : PlanRequest(c.params, around, c.planner, from, next, BlendingQueue(s), plan);
    }
    if (status.ok() && next.positions() && !Inside(c.params.limits, plan.target + AddedAtEnd(s)))
      status = Status::Failed(ErrorId::kTargetBehindLimit);
    if (status.ok() && homes) return;
    if (status.ok() && follows) return BeginFollowing(c, next, FromThisCycle(c), s);
    if (status.ok()) {
      TakeControl(c, next, plan, {c.cycle.count, seamless ? late_s : 0}, s);
      s.setpoint = s.motion.profile.At(Elapsed(c, s));
      return;
    }
    Report(c, next.ticket, FeedbackState::kError, status.error);
    AbortBuffer(c, s);
  }
  if (s.plc == PlcState::kHoming && AtRest(s)) {  // the buffered step was rejected
    if (s.homing.stage != HomingStage::kWaiting) Enter(s, PlcState::kStandstill);
    return;
  }
  // No command takes over: the axis comes to rest if it still moves.
  const bool stands = s.plc == PlcState::kStandstill || (s.superimposed && AtRest(s));
  if (stands) return;
  if (seamless) s.setpoint = s.motion.profile.end();
  ComeToRest(c, c.params.planner_limits(), {c.cycle.count, seamless ? late_s : 0}, s);
  if (seamless) s.setpoint = s.motion.profile.At(late_s);
}

namespace {

void ReplanPositioning(const Context& c, State& s) {
  if (!s.active.positions() || HasPassed(s) || (s.motion.arrived && !s.motion.held)) return;
  PlanningContext around = BasePlanningContext(c, s);
  around.again = true;
  around.passes = s.motion.profile.end().velocity != 0;
  Plan plan;
  plan.target = s.motion.target;
  if (Replan(c.params, around, c.planner, s.setpoint, s.active, BlendingQueue(s), plan).failed()) return;
  StartMotion(plan, FromCycleBefore(c), s);
}

}  // namespace

void ReplanActive(const Context& c, State& s) noexcept {
  const ScopedBaseMotion base(s);
  ReplanPositioning(c, s);
}

void PlanAgain(const Context& c, State& s) noexcept {
  if (!s.loop_closed || !Overridden(s.active.kind) || s.plc == PlcState::kErrorStop) return;
  const ScopedBaseMotion base(s);
  Plan plan;
  Status status;
  if (s.active.kind == RequestKind::kJog) {
    if (s.jog_sense == 0) return;
    Request held = s.active;  // the first key wins, whatever the other key does
    held.forward = s.jog_sense > 0;
    status = PlanJog(c, held, s, plan);
  } else if (s.active.kind == RequestKind::kMoveVelocity || HasPassed(s)) {
    const Request velocity = HasPassed(s) ? Onward(s) : s.active;
    PlanningContext around = BasePlanningContext(c, s);
    around.again = true;
    status = PlanRequest(c.params, around, c.planner, s.setpoint, velocity, {}, plan);
  } else {
    return ReplanPositioning(c, s);
  }
  if (status.failed()) return;
  plan.target = s.motion.target;
  StartMotion(plan, FromCycleBefore(c), s);
}

void Conclude(const Context& c, double late_s, State& s) noexcept {
  switch (s.active.kind) {
    case RequestKind::kMoveAbsolute:
    case RequestKind::kMoveRelative:
    case RequestKind::kMoveAdditive:
    case RequestKind::kInch:
    case RequestKind::kTouch:
    case RequestKind::kPositionProfile:
      ConcludePositioning(c, late_s, s);
      break;
    case RequestKind::kMoveContinuousAbsolute:
    case RequestKind::kMoveContinuousRelative:
      ConcludeContinuous(c, late_s, s);
      break;
    case RequestKind::kMoveVelocity:
    case RequestKind::kTorqueControl:
    case RequestKind::kGearIn:
    case RequestKind::kGearInPos:
    case RequestKind::kCombineAxes:
    case RequestKind::kStream:
      ConcludeReached(c, s);
      break;
    case RequestKind::kCamIn:
      ConcludeCam(c, s);
      break;
    case RequestKind::kVelocityProfile:
    case RequestKind::kAccelerationProfile:
      ConcludeVelocityProfile(c, late_s, s);
      break;
    case RequestKind::kHalt:
      EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
      StartNext(c, 0, s);
      break;
    case RequestKind::kStop:
      ConcludeStop(c, s);
      break;
    case RequestKind::kPower:
      ConcludePower(c, s);
      break;
    case RequestKind::kJog:
      if (s.jog_sense == 0 && !s.active.forward && !s.active.backward) {
        EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
        EnterRest(s);
      }
      break;
    default:
      break;
  }
}

void FollowKeys(const Context& c, State& s) noexcept {
  const bool up = s.active.forward;
  const bool down = s.active.backward;
  if (s.jog_sense != 0 && !(s.jog_sense > 0 ? up : down)) {
    s.jog_sense = 0;
    Enter(s, PlcState::kDiscreteMotion);
    Brake(c, s.active.limits(), FromCycleBefore(c), s);
  }
  if (!up && !down) s.jog_armed = true;
  if (s.jog_sense != 0 || !s.jog_armed || up == down) return;

  s.jog_armed = false;
  Plan plan;
  const Status status = PlanJog(c, s.active, s, plan);
  if (status.failed()) {
    const trajectory::Limits limits = s.active.limits();
    EndActive(c, FeedbackState::kError, status.error, s);
    return ComeToRest(c, limits, FromCycleBefore(c), s);
  }
  s.jog_sense = up ? 1 : -1;
  StartMotion(plan, FromCycleBefore(c), s);
  Enter(s, PlcState::kContinuousMotion);
}

Status PlanJog(const Context& c, const Request& jog, const State& s, Plan& plan) noexcept {
  Request move = jog;
  move.kind = RequestKind::kMoveVelocity;
  move.direction = jog.forward ? Direction::kPositive : Direction::kNegative;
  return PlanRequest(c.params, BasePlanningContext(c, s), c.planner, s.setpoint, move, {}, plan);
}

}  // namespace takt::axis
