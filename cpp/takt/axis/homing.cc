#include "takt/axis/homing.h"

#include <cmath>
#include <optional>

#include "takt/axis/coordinates.h"
#include "takt/axis/fit.h"
#include "takt/axis/following.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

using trajectory::Profile;

namespace {

constexpr double kBlockedShare = 0.05;  // of the search velocity: below it an axis is blocked
constexpr int kMostTurns = 3;           // after more reversals both directions were searched in vain

bool BySwitch(RequestKind kind) {
  return kind == RequestKind::kStepAbsSwitch || kind == RequestKind::kStepLimitSwitch;
}

bool Searches(RequestKind kind) {
  return BySwitch(kind) || kind == RequestKind::kStepBlock || kind == RequestKind::kStepRefPulse ||
         kind == RequestKind::kStepDistanceCoded;
}

HomingScope ScopeOf(RequestKind kind) {
  if (BySwitch(kind)) return HomingScope::kSwitches;
  return kind == RequestKind::kStepBlock ? HomingScope::kBlock : HomingScope::kPulse;
}

// Returns true if StepLimitSwitch searches the upper limit switch.
bool Upper(const Request& r) {
  return r.homing.direction == HomingDirection::kPositive || r.homing.direction == HomingDirection::kSwitchPositive;
}

bool SwitchOf(const Request& r, const State& s) {
  if (r.kind == RequestKind::kStepAbsSwitch) return s.reference;
  return Upper(r) ? s.limit_positive : s.limit_negative;
}

// Returns the state of the limit switch ahead in this sense.
bool LimitAhead(const State& s, int sense) {
  return sense > 0 ? s.limit_positive : s.limit_negative;
}

std::int8_t FirstSense(const Request& r, const State& s) {
  const bool on = SwitchOf(r, s);
  int sense = 1;
  switch (r.homing.direction) {
    case HomingDirection::kPositive:
      break;
    case HomingDirection::kNegative:
      sense = -1;
      break;
    case HomingDirection::kSwitchPositive:
      sense = on ? -1 : 1;
      break;
    case HomingDirection::kSwitchNegative:
      sense = on ? 1 : -1;
      break;
  }
  if (BySwitch(r.kind) && LimitAhead(s, sense)) sense = -sense;  // that direction is blocked
  return static_cast<std::int8_t>(sense);
}

struct Edge {
  bool on, off;  // the switch went on; it went off
};

bool Ends(SwitchMode mode, bool on, const Edge& edge, int sense) {
  switch (mode) {
    case SwitchMode::kOn:
      return on;
    case SwitchMode::kOff:
      return !on;
    case SwitchMode::kEdgeOn:
      return edge.on;
    case SwitchMode::kEdgeOff:
      return edge.off;
    case SwitchMode::kEdgeSwitchPositive:
      return sense > 0 ? edge.on : edge.off;
    case SwitchMode::kEdgeSwitchNegative:
      return sense < 0 ? edge.on : edge.off;
  }
  return false;
}

bool Reverses(SwitchMode mode, const Edge& edge) {
  return (mode == SwitchMode::kEdgeOn && edge.off) || (mode == SwitchMode::kEdgeOff && edge.on);
}

// Returns the position [u] of the encoder at its last index pulse.
double PulsePosition(const Context& c, const State& s) {
  return LatchedPosition(c.params.encoder, s.encoder, s.index_counts) - s.correction.now - s.origin;
}

// Handles a mark that was passed: together with the previous one it gives the position. If several came in a cycle
// there is no previous one, as the latch holds only the last.
std::optional<HomingEvent> ReadCode(const Context& c, State& s) {
  HomingState& h = s.homing;
  const double mark = PulsePosition(c, s) + s.origin;
  const double before = h.mark;
  const bool pair = h.mark_known && !s.index_skipped;
  h.mark = mark;
  h.mark_known = true;
  if (!pair) return std::nullopt;
  const std::optional<double> position = MarkPosition(*c.params.encoder.coded_marks, before, mark);
  if (!position) return HomingEvent::kNoCode;
  h.captured = PulsePosition(c, s);
  s.active.homing.set_position = *position;
  return HomingEvent::kFound;
}

bool IsSearching(HomingStage stage) {
  return stage == HomingStage::kSearching || stage == HomingStage::kTurning;
}

// Returns the event of this cycle, the most important one if there are several.
std::optional<HomingEvent> EventOf(const Context& c, State& s) {
  HomingState& h = s.homing;
  const Request& r = s.active;
  if (h.stage == HomingStage::kSearching) {
    if (BySwitch(r.kind)) {
      const bool on = SwitchOf(r, s);
      const Edge edge = {on && !h.switch_before, !on && h.switch_before};
      h.switch_before = on;
      if (!h.found && Ends(r.homing.switch_mode, on, edge, h.sense)) {
        h.captured = s.actual.position;
        h.found = true;
        h.edge = s.actual.position + s.origin;
      }
      // The search continues until each follower has found its own switch.
      const bool waits = h.found && r.kind == RequestKind::kStepAbsSwitch && !FollowersFound(c, s);
      if (h.found && !waits) {
        h.found_cycle = c.cycle.count;
        return HomingEvent::kFound;
      }
      if (!waits && Reverses(r.homing.switch_mode, edge)) return HomingEvent::kWrongEdge;
      if (LimitAhead(s, h.sense)) return waits ? HomingEvent::kTooFar : HomingEvent::kLimit;
    } else if (r.kind == RequestKind::kStepRefPulse && s.index_pulse) {
      h.captured = PulsePosition(c, s);
      return HomingEvent::kFound;
    } else if (r.kind == RequestKind::kStepDistanceCoded && s.index_pulse) {
      const std::optional<HomingEvent> event = ReadCode(c, s);
      if (event) return event;
    } else if (r.kind == RequestKind::kStepBlock && std::abs(s.actual.velocity) < kBlockedShare * r.velocity &&
               h.sense * s.following_error > r.homing.deviation) {
      h.captured = s.actual.position;
      return HomingEvent::kFound;
    }
  }
  if (IsSearching(h.stage)) {
    if (h.stage == HomingStage::kTurning && BySwitch(r.kind)) h.switch_before = SwitchOf(r, s);
    const double elapsed_s = static_cast<double>(c.cycle.count - h.begin_cycle) * c.cycle.period_s;
    if (r.homing.time_limit > 0 && elapsed_s > r.homing.time_limit) return HomingEvent::kTimeOver;
    if (r.homing.distance_limit > 0 && h.way > r.homing.distance_limit) return HomingEvent::kTooFar;
    if (h.turns > kMostTurns) return HomingEvent::kTooFar;
  }
  const bool stands = h.stage != HomingStage::kSearching && s.motion.arrived && AtRest(s);
  if (stands && FollowersSquared(c, s)) return HomingEvent::kStopped;
  return std::nullopt;
}

void Search(const Context& c, const MotionStart& start, State& s) {
  s.homing.found = false;
  s.homing.mark_known = false;
  Profile profile{s.setpoint};
  if (c.planner.ToVelocity(s.setpoint, s.homing.sense * s.active.velocity, s.active.limits(), profile).failed()) {
    return Fail(c, ErrorId::kPlanning, false, s);
  }
  StartMotion(profile, 0, start, s);
}

void Finish(const Context& c, State& s) {
  s.homing.homed = true;
  s.homing.stage = HomingStage::kNone;
  EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
  StartNext(c, 0, s);
}

void GoBack(const Context& c, State& s) {
  Profile profile{s.setpoint};
  if (c.planner.ToPosition(s.setpoint, s.homing.captured, 0, s.active.limits(), profile).failed()) {
    return Fail(c, ErrorId::kPlanning, false, s);
  }
  StartMotion(profile, s.homing.captured, FromThisCycle(c), s);
}

// Sets the position of the point found. Braking and return continue with the new numbers.
void GiveName(State& s) {
  if (!s.active.homing.sets_position) return;
  s.homing.renamed = 0;
  const double by = s.active.homing.set_position - s.homing.captured;
  ShiftCoordinates(by, s);
}

// Continues from the switch to the index pulse.
void SearchPulse(const Context& c, State& s) {
  Request& r = s.active;
  r.kind = RequestKind::kStepRefPulse;
  r.velocity = r.homing.pulse_velocity;
  r.homing.direction = r.homing.pulse_direction;
  r.homing.sets_position = true;
  s.homing.stage = HomingStage::kSearching;
  s.homing.sense = FirstSense(r, s);
  Search(c, FromThisCycle(c), s);
}

// Returns the error of a search that is given up.
ErrorId ErrorOf(HomingEvent event) {
  if (event == HomingEvent::kNoCode) return ErrorId::kMarkDistance;
  return event == HomingEvent::kTimeOver ? ErrorId::kTimeLimit : ErrorId::kDistanceLimit;
}

void Act(const Context& c, const HomingRow& row, State& s) {
  HomingState& h = s.homing;
  h.stage = row.to;
  switch (row.action) {
    case HomingAction::kBrake: {
      if (row.event == HomingEvent::kFound) GiveName(s);
      Profile profile{s.setpoint};
      c.planner.Stop(s.setpoint, c.params.planner_limits(), profile);
      StartMotion(profile, profile.end().position, FromThisCycle(c), s);
      break;
    }
    case HomingAction::kTurnRound:
      h.sense = static_cast<std::int8_t>(-h.sense);
      ++h.turns;
      Search(c, FromThisCycle(c), s);
      break;
    case HomingAction::kGoBack:
      GoBack(c, s);
      break;
    case HomingAction::kPause:
      if (s.active.homing.pulse_velocity > 0) return SearchPulse(c, s);
      if (s.active.homing.ends) return Finish(c, s);
      EndActive(c, FeedbackState::kDone, ErrorId::kNone, s);
      if (s.buffered > 0) StartNext(c, 0, s);
      break;
    case HomingAction::kFinish:
      Finish(c, s);
      break;
    case HomingAction::kGiveUp: {
      EndActive(c, FeedbackState::kError, ErrorOf(row.event), s);
      AbortBuffer(c, s);
      s.active.kind = RequestKind::kHalt;  // of no command: Standstill once at rest
      Profile profile{s.setpoint};
      c.planner.Stop(s.setpoint, c.params.planner_limits(), profile);
      StartMotion(profile, profile.end().position, FromThisCycle(c), s);
      break;
    }
  }
}

Status BeginFlying(const Context& c, Ticket ticket, bool pulse, const HomingRequest& request, State& s) {
  if (!s.loop_closed) return Status::Failed(ErrorId::kPowerOff);
  if (s.plc == PlcState::kHoming || s.plc == PlcState::kErrorStop) return Status::Failed(ErrorId::kState);
  if (!Inside(c.params.limits, request.set_position)) return Status::Failed(ErrorId::kTargetBehindLimit);
  HomingState& h = s.homing;
  if (h.flying_ticket != 0) Report(c, h.flying_ticket, FeedbackState::kAborted);
  h.flying_ticket = ticket;
  h.flying_pulse = pulse;
  h.flying = request;
  h.flying_way = 0;
  h.flying_begin = c.cycle.count;
  h.reference_before = s.reference;
  Report(c, ticket, FeedbackState::kActive);
  return Status::Ok();
}

// A fault if a motion with an end leads out of the SW limits under its new numbers. (Motions without an end are watched
// each cycle.)
void KeepInside(const Context& c, State& s) {
  if (FollowsDemand(s.active.kind)) return;
  const bool waits = s.motion.held && s.active.positions();  // the override holds it before its target
  const double end = (waits ? s.motion.target : s.motion.profile.end().position) + AddedAtEnd(s);
  if ((s.motion.arrived && !waits && !s.superimposed) || Inside(c.params.limits, end)) return;
  const bool above = c.params.limits.upper && end > *c.params.limits.upper;
  if (above ? end < s.setpoint.position : end > s.setpoint.position) return;  // it returns
  Fail(c, above ? ErrorId::kSoftLimitPositive : ErrorId::kSoftLimitNegative, false, s);
}

void EndFlying(const Context& c, FeedbackState feedback, ErrorId error, State& s) {
  Report(c, s.homing.flying_ticket, feedback, error, false, s.homing.captured);
  s.homing.flying_ticket = 0;
}

}  // namespace

bool EndsSearch(SwitchMode mode, bool on, bool before, int sense) noexcept {
  return Ends(mode, on, {on && !before, !on && before}, sense);
}

bool Homes(RequestKind kind) noexcept {
  return kind >= RequestKind::kStepAbsSwitch && kind <= RequestKind::kFinishHoming;
}

bool MayFollowStep(RequestKind kind) noexcept {
  return Homes(kind) || kind == RequestKind::kStop || kind == RequestKind::kPower;
}

bool OwnsLimitSwitches(const State& s) noexcept {
  return s.plc == PlcState::kHoming && (BySwitch(s.active.kind) || s.homing.stage == HomingStage::kWaiting);
}

bool OwnsLag(const State& s) noexcept {
  const bool pushes = s.plc == PlcState::kHoming && s.active.kind == RequestKind::kStepBlock;
  return pushes && s.homing.sense * s.following_error > 0;
}

Status BeginHoming(const Context& c, const Request& r, bool aborts, State& s) noexcept {
  // A search that reverses is at rest for a moment, too.
  const bool between = s.homing.stage == HomingStage::kNone || s.homing.stage == HomingStage::kWaiting;
  const bool from_here = s.plc == PlcState::kStandstill || (s.plc == PlcState::kHoming && between);
  if (!from_here || !AtRest(s)) return Status::Failed(ErrorId::kState);
  if (r.kind == RequestKind::kFinishHoming && s.plc != PlcState::kHoming) return Status::Failed(ErrorId::kState);
  if (r.kind == RequestKind::kStepAbsolute && c.params.position_encoder().type != EncoderType::kAbsoluteSsi) {
    return Status::Failed(ErrorId::kState);
  }
  if (r.kind == RequestKind::kStepDistanceCoded && !c.params.encoder.coded_marks) {
    return Status::Failed(ErrorId::kNoCodedMarks);
  }
  if (Searches(r.kind)) {  // a search of a switch reverses at a limit switch
    const int sense = FirstSense(r, s);
    const Status status = MayMove(c, s, sense);
    if (status.failed()) return status;
  }
  // As define_position: no position beyond a SW limit.
  const bool names = (r.homing.sets_position || r.homing.pulse_velocity > 0) && r.kind != RequestKind::kFinishHoming &&
                     r.kind != RequestKind::kStepAbsolute && r.kind != RequestKind::kStepDistanceCoded;
  if (names && !Inside(c.params.limits, r.homing.set_position)) return Status::Failed(ErrorId::kTargetBehindLimit);
  HomingState& h = s.homing;
  const MotionStart start = aborts ? FromCycleBefore(c) : FromThisCycle(c);  // buffered: this cycle is done
  Plan plan;
  if (r.kind == RequestKind::kFinishHoming && r.value != 0) {
    Request leave = r;
    leave.kind = RequestKind::kMoveRelative;
    PlanningContext around = BasePlanningContext(c, s);
    around.factors = {};
    const Status status = PlanRequest(c.params, around, c.planner, s.setpoint, leave, {}, plan);
    if (status.failed()) return status;
  }
  if (aborts) AbortAll(c, s);
  if (h.flying_ticket != 0) EndFlying(c, FeedbackState::kAborted, ErrorId::kNone, s);  // this reference is newer
  Grant(c, r, s);
  Enter(s, PlcState::kHoming);
  s.limited_by = LimitedBy::kNothing;
  h.begin_cycle = c.cycle.count;
  h.way = 0;
  h.turns = 0;
  switch (r.kind) {
    case RequestKind::kFinishHoming:
      h.stage = HomingStage::kLeaving;
      if (r.value == 0) {
        Finish(c, s);
      } else {
        StartMotion(plan.profile, plan.target, start, s);
      }
      break;
    case RequestKind::kStepDirect:
      h.captured = s.setpoint.position;
      GiveName(s);
      Finish(c, s);
      break;
    case RequestKind::kStepAbsolute:
      ShiftCoordinates(s.origin, s);
      h.renamed = 0;
      Finish(c, s);
      break;
    default:
      h.homed = false;
      h.stage = HomingStage::kSearching;
      h.sense = FirstSense(r, s);
      h.switch_before = SwitchOf(r, s);
      Search(c, start, s);
  }
  return Status::Ok();
}

void StepHoming(const Context& c, State& s) noexcept {
  HomingState& h = s.homing;
  if (s.plc != PlcState::kHoming) h.stage = HomingStage::kNone;
  if (h.stage == HomingStage::kNone || h.stage == HomingStage::kWaiting) return;
  h.way += std::abs(s.setpoint.velocity) * c.cycle.period_s;
  const std::optional<HomingEvent> event = EventOf(c, s);
  if (!event) return;
  const HomingScope scope = ScopeOf(s.active.kind);
  for (const HomingRow& row : kHomingTable) {
    const bool holds = row.scope == HomingScope::kAll || row.scope == scope;
    if (row.from == h.stage && row.event == *event && holds) return Act(c, row, s);
  }
}

void WatchFlying(const Context& c, State& s) noexcept {
  HomingState& h = s.homing;
  if (!s.loop_closed || s.plc == PlcState::kErrorStop || s.plc == PlcState::kHoming) {
    return EndFlying(c, FeedbackState::kAborted, ErrorId::kNone, s);
  }
  h.flying_way += std::abs(s.setpoint.velocity) * c.cycle.period_s;
  const Edge edge = {s.reference && !h.reference_before, !s.reference && h.reference_before};
  h.reference_before = s.reference;
  const int sense = s.actual.velocity < 0 ? -1 : 1;
  const bool found = h.flying_pulse ? s.index_pulse : Ends(h.flying.switch_mode, s.reference, edge, sense);
  if (found) {
    h.captured = h.flying_pulse ? PulsePosition(c, s) : s.actual.position;
    ShiftCoordinates(h.flying.set_position - h.captured, s);
    if (!BlendingQueue(s).empty()) ReplanActive(c, s);  // to the same point, which has another number now
    h.captured = h.flying.set_position;
    h.renamed = 0;
    h.homed = true;
    EndFlying(c, FeedbackState::kDone, ErrorId::kNone, s);
    return KeepInside(c, s);
  }
  const double elapsed_s = static_cast<double>(c.cycle.count - h.flying_begin) * c.cycle.period_s;
  if (h.flying.time_limit > 0 && elapsed_s > h.flying.time_limit) {
    EndFlying(c, FeedbackState::kError, ErrorId::kTimeLimit, s);
  } else if (h.flying.distance_limit > 0 && h.flying_way > h.flying.distance_limit) {
    EndFlying(c, FeedbackState::kError, ErrorId::kDistanceLimit, s);
  }
}

Status CarryOut(const Context& c, Ticket ticket, const StepRefFlyingSwitch& f, State& s) noexcept {
  HomingRequest request;
  request.switch_mode = f.switch_mode;
  request.set_position = f.set_position;
  request.time_limit = f.time_limit;
  request.distance_limit = f.distance_limit;
  request.until_halt = f.until_halt;
  return BeginFlying(c, ticket, false, request, s);
}

Status CarryOut(const Context& c, Ticket ticket, const StepRefFlyingRefPulse& f, State& s) noexcept {
  HomingRequest request;
  request.set_position = f.set_position;
  request.time_limit = f.time_limit;
  request.distance_limit = f.distance_limit;
  request.until_halt = f.until_halt;
  return BeginFlying(c, ticket, true, request, s);
}

Status CarryOut(const Context& c, Ticket ticket, const AbortPassiveHoming&, State& s) noexcept {
  if (s.homing.flying_ticket != 0) EndFlying(c, FeedbackState::kAborted, ErrorId::kNone, s);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
  return Status::Ok();
}

void EndFlyingByHalt(const Context& c, State& s) noexcept {
  if (s.homing.flying_ticket == 0 || !s.homing.flying.until_halt) return;
  EndFlying(c, FeedbackState::kAborted, ErrorId::kNone, s);
}

}  // namespace takt::axis
