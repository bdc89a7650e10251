// Commands on arrival: executed, buffered or rejected.
#include <algorithm>

#include "takt/axis/cam_switch.h"
#include "takt/axis/fit.h"
#include "takt/axis/following.h"
#include "takt/axis/guidance.h"
#include "takt/axis/override.h"
#include "takt/axis/probe.h"
#include "takt/axis/sequence.h"
#include "takt/axis/settings.h"

namespace takt::axis {

namespace {

bool SwitchingOff(const State& s) {
  return s.active.kind == RequestKind::kPower && !s.active.enable;
}
bool SwitchingOn(const State& s) {
  return s.active.kind == RequestKind::kPower && s.active.enable;
}

Status Enqueue(const Context& c, const Request& r, State& s) {
  const Request& last = s.buffered > 0 ? s.buffer[s.buffered - 1u] : s.active;
  const bool last_switches_off = last.kind == RequestKind::kPower && !last.enable;
  if (!RulesOf(last.kind).may_be_followed || last_switches_off) return Status::Failed(ErrorId::kState);
  if (s.buffered == kBufferSize) return Status::Failed(ErrorId::kBufferFull);
  s.buffer[s.buffered++] = r;
  Report(c, r.ticket, FeedbackState::kBusy);
  const bool all_blend = std::all_of(s.buffer.begin(), s.buffer.begin() + s.buffered,
                                     [](const Request& waiting) { return waiting.blends(); });
  if (all_blend) ReplanActive(c, s);  // there is more room ahead
  // Beneath an overlay no command is in control: the command begins now.
  if (s.buffered == 1 && s.active.kind == RequestKind::kNone && Carries(r) && BaseAtRest(s)) {
    const ScopedBaseMotion beneath(s);
    StartNext(c, 0, s);
  }
  return Status::Ok();
}

// Replaces a jog by one with other keys, another velocity or other ramps: the motion continues.
void ChangeJog(const Context& c, const Request& r, State& s) {
  Report(c, s.active.ticket, FeedbackState::kAborted);
  const bool key_held = s.jog_sense > 0 ? r.forward : r.backward;
  Grant(c, r, s);
  if (s.jog_sense == 0 || !key_held) return;
  Request held = r;  // the first key wins, whatever the other key does
  held.forward = s.jog_sense > 0;
  const ScopedBaseMotion base(s);
  Plan plan;
  if (PlanJog(c, held, s, plan).failed()) return;
  StartMotion(plan, FromCycleBefore(c), s);
}

Status JogBy(const Context& c, const Request& r, State& s) {
  if (s.plc == PlcState::kHoming) return Status::Failed(ErrorId::kState);
  if (s.active.kind == RequestKind::kJog) {
    ChangeJog(c, r, s);
    return Status::Ok();
  }
  Plan plan;
  const Status status = r.forward != r.backward ? PlanJog(c, r, s, plan) : Status::Ok();
  if (status.failed()) return status;
  const std::optional<double> furthest = SumPlanningContext(c, s).furthest;
  AbortAll(c, s);
  if (s.plc != PlcState::kStandstill) ComeToRest(c, r.limits(), FromCycleBefore(c), s, furthest);
  Grant(c, r, s);
  s.jog_armed = true;
  return Status::Ok();
}

// Returns true if the command that a request would change has ended: it must not take over from a later one.
bool ComesTooLate(const Request& r, const State& s) {
  const RequestKind now = s.active.kind;
  const bool adds = r.kind == RequestKind::kMoveAdditive && now == RequestKind::kMoveRelative;
  return r.update && now != r.kind && !adds;
}

// Returns true if a request that changes the one in control keeps its position in the same table; others begin anew.
bool KeepsPlace(const Request& r, const State& s) {
  const Request& now = s.active;
  const bool kept = FollowsTable(r.kind) || r.kind == RequestKind::kCamIn;
  return kept && r.kind == now.kind && r.table.index == now.table.index &&
         r.coupling.terms[0].master == now.coupling.terms[0].master &&
         r.coupling.terms[0].source == now.coupling.terms[0].source && r.coupling.periodic == now.coupling.periodic;
}

// Changes the command in control (AX-111): buffered commands and an overlay stay.
Status Change(const Context& c, const Request& r, State& s) {
  const ScopedBaseMotion base(s);
  if (FollowsDemand(r.kind)) {
    if (const Status status = MayFollow(c, r, s); status.failed()) return status;
    const bool gear = r.kind == RequestKind::kGearIn || r.kind == RequestKind::kCombineAxes;
    if (!gear && !KeepsPlace(r, s)) {
      EndActive(c, FeedbackState::kAborted, ErrorId::kNone, s);
      BeginFollowing(c, r, FromCycleBefore(c), s);
      return Status::Ok();
    }
    Report(c, s.active.ticket, FeedbackState::kAborted, ErrorId::kNone, s.reported);
    gear ? CoupleAgain(c, r, s) : FollowsTable(r.kind) ? UpdateTable(c, r, s) : UpdateCam(c, r, s);
    return Status::Ok();
  }
  Plan plan;
  const PlanningContext around = BasePlanningContext(c, s);
  const Status status = PlanRequest(c.params, around, c.planner, s.setpoint, r, BlendingQueue(s), plan);
  if (status.failed()) return status;
  if (r.positions() && !Inside(c.params.limits, plan.target + AddedAtEnd(s))) {
    return Status::Failed(ErrorId::kTargetBehindLimit);
  }
  EndActive(c, FeedbackState::kAborted, ErrorId::kNone, s);
  TakeControl(c, r, plan, FromCycleBefore(c), s);
  return Status::Ok();
}

Status TakeOver(const Context& c, const Request& r, State& s) {
  if (Homes(r.kind)) return BeginHoming(c, r, true, s);
  if (s.plc == PlcState::kHoming && !MayFollowStep(r.kind)) return Status::Failed(ErrorId::kState);
  if (r.update) return Change(c, r, s);
  if (FollowsDemand(r.kind)) {
    const Status status = MayFollow(c, r, s);
    if (status.failed()) return status;
    AbortAll(c, s);
    BeginFollowing(c, r, FromCycleBefore(c), s);
    return Status::Ok();
  }
  Plan plan;
  const Status status = PlanRequest(c.params, SumPlanningContext(c, s), c.planner, s.setpoint, r, {}, plan);
  if (status.failed()) return status;
  AbortAll(c, s);
  TakeControl(c, r, plan, FromCycleBefore(c), s);
  return Status::Ok();
}

Status SwitchOn(const Context& c, const Request& r, State& s) {
  if (s.emergency == Emergency::kHeld) return Status::Failed(ErrorId::kEmergencyStop);
  if (s.plc == PlcState::kErrorStop) return Status::Failed(ErrorId::kErrorStop);
  if (SwitchingOff(s)) return Status::Failed(ErrorId::kAxisStopping);
  if (s.loop_closed && SwitchingOn(s)) {  // the brake is opening: that counts for this command, too
    EndActive(c, FeedbackState::kAborted, ErrorId::kNone, s);
    Grant(c, r, s);
    return Status::Ok();
  }
  if (s.loop_closed) {
    if (r.buffer_mode == BufferMode::kBuffered && s.active.kind != RequestKind::kNone) return Enqueue(c, r, s);
    Report(c, r.ticket, FeedbackState::kActive);
    Report(c, r.ticket, FeedbackState::kDone);
    return Status::Ok();
  }
  if (s.error != ErrorId::kNone) {
    Enter(s, PlcState::kErrorStop);
    return Status::Failed(ErrorId::kErrorStop);
  }
  EndActive(c, FeedbackState::kAborted, ErrorId::kNone,
            s);  // an earlier power on; commands buffered behind it stay
  Grant(c, r, s);
  if (!s.enable) s.enable_cycle = c.cycle.count;
  s.enable = true;
  s.emergency = Emergency::kNone;
  s.direct_voltage_v = 0;
  return Status::Ok();
}

Status SwitchOff(const Context& c, const Request& r, State& s) {
  const bool moves = s.active.kind != RequestKind::kNone || s.superimposed;
  const bool waits = r.buffer_mode == BufferMode::kBuffered && moves && !SwitchingOff(s);
  if (waits && s.plc != PlcState::kErrorStop) return Enqueue(c, r, s);
  const bool guided = IsGuided(s);  // in a fault its component brakes it: it has no motion of its own
  AbortAll(c, s);
  s.direct_voltage_v = 0;
  Grant(c, r, s);
  if (!s.loop_closed || AtRest(s)) {
    if (s.loop_closed) StandStill(c, s);
    Conclude(c, 0, s);
    return Status::Ok();
  }
  const bool brakes = s.plc == PlcState::kErrorStop && !guided;
  if (s.plc != PlcState::kErrorStop) Enter(s, PlcState::kStopping);
  if (!brakes) Brake(c, c.params.planner_limits(), FromCycleBefore(c), s);
  return Status::Ok();
}

Status Admit(const Context& c, const Request& r, State& s) {
  if (r.kind == RequestKind::kPower) return r.enable ? SwitchOn(c, r, s) : SwitchOff(c, r, s);
  if (s.plc == PlcState::kErrorStop) return Status::Failed(ErrorId::kErrorStop);
  if (c.params.await_constants && !s.constants_set) return Status::Failed(ErrorId::kNoConstants);
  const bool stops = r.kind == RequestKind::kHalt || r.kind == RequestKind::kStop;
  if (c.params.follows && stops) StopStraightening(c, r.limits(), s);
  if (c.params.follows) return Status::Failed(ErrorId::kState);
  const bool moves = s.active.kind != RequestKind::kNone || s.superimposed;
  const bool buffered = r.buffer_mode != BufferMode::kAborting && moves;
  if (ComesTooLate(r, s)) return Report(c, r.ticket, FeedbackState::kAborted), Status::Ok();
  if (SwitchingOn(s)) {  // the drive becomes ready or the brake opens
    if (buffered) return Enqueue(c, r, s);
    if (!stops) return Status::Failed(ErrorId::kPowerOff);
    // A drive that homes moves without set points: only switching it off ends that motion.
    if (s.drive_homes && !s.drive_ready) {
      Request off;
      off.kind = RequestKind::kPower;
      SwitchOff(c, off, s);
    }
    return StopAtOnce(c, r, s), Status::Ok();
  }
  if (stops && s.direct_voltage_v != 0) {  // output with the loop open
    s.direct_voltage_v = 0;
    return StopAtOnce(c, r, s), Status::Ok();
  }
  if (!s.loop_closed) return Status::Failed(ErrorId::kPowerOff);
  if (SwitchingOff(s)) return Status::Failed(ErrorId::kAxisStopping);
  if (buffered) return Enqueue(c, r, s);
  if (s.plc == PlcState::kStopping) {
    const bool both_stop = r.kind == RequestKind::kStop && s.active.kind == RequestKind::kStop;
    return both_stop ? JoinStop(c, r, s), Status::Ok() : Status::Failed(ErrorId::kAxisStopping);
  }
  if (r.kind == RequestKind::kInch && s.plc != PlcState::kStandstill) return Status::Failed(ErrorId::kState);
  if (r.kind == RequestKind::kLetGo) return LetGo(c, r, s);
  return r.kind == RequestKind::kJog ? JogBy(c, r, s) : TakeOver(c, r, s);
}

void BeginReset(const Context& c, Ticket ticket, State& s) {
  if (s.reset_pending) Report(c, s.reset_ticket, FeedbackState::kAborted);
  s.reset_pending = true;
  s.reset_ticket = ticket;
  Report(c, ticket, FeedbackState::kActive);
}

// Commands that do not take control of the axis: executed besides the motion in progress. The caller reports an error;
// they report everything else themselves.
Status CarryOut(const Context& c, Ticket ticket, const Reset&, State& s) {
  BeginReset(c, ticket, s);
  return Status::Ok();
}
// The lookup has found the cam already.
Status CarryOut(const Context& c, Ticket ticket, const CamTableSelect&, State&) {
  Report(c, ticket, FeedbackState::kDone);
  return Status::Ok();
}
// Sets the directions that a power command enables or disables: from now on, also while it is buffered (AX-111).
void Permit(const Context& c, const Power& power, State& s) {
  if (power.enable_positive || power.enable_negative) s.bars_cycle = c.cycle.count;
  if (power.enable_positive) s.bars_positive = !*power.enable_positive;
  if (power.enable_negative) s.bars_negative = !*power.enable_negative;
}

// Never called: these commands take control.
template <typename T>
Status CarryOut(const Context&, Ticket, const T&, State&) {
  return Status::Failed(ErrorId::kInternal);
}

// Returns the command with this ticket, in control or buffered; null if there is none.
Request* Find(Ticket ticket, State& s) {
  if (ticket == 0) return nullptr;
  if (s.active.ticket == ticket) return &s.active;
  for (std::size_t i = 0; i < s.buffered; ++i) {
    if (s.buffer[i].ticket == ticket) return &s.buffer[i];
  }
  return nullptr;
}

}  // namespace

bool AsksToMove(const Command& command) noexcept {
  return std::visit(
      []<typename T>(const T& body) {
        if constexpr (std::is_same_v<T, Power>) return body.enable;
        constexpr bool kRests =
            std::is_same_v<T, Reset> || std::is_same_v<T, Halt> || std::is_same_v<T, Stop> ||
            std::is_same_v<T, HaltSuperimposed> || std::is_same_v<T, CamTableSelect> ||
            std::is_same_v<T, SetConstants> || std::is_same_v<T, SetLoad> || std::is_same_v<T, WriteParameter> ||
            std::is_same_v<T, ReadParameter> || std::is_same_v<T, SetSoftLimits> || std::is_same_v<T, WriteOutput> ||
            std::is_same_v<T, SetPosition> || std::is_same_v<T, SetOverride> || std::is_same_v<T, TouchProbe> ||
            std::is_same_v<T, AbortTrigger> || std::is_same_v<T, AbortPassiveHoming> ||
            std::is_same_v<T, StreamPoint> || std::is_same_v<T, DigitalCamSwitch>;
        return !kRests;
      },
      command);
}

namespace {

// Returns true for a motion command to an axis that is held stopped but not in Stopping: with power off, or after it.
bool BarsHeld(const Command& command, const State& s) {
  if (s.plc == PlcState::kStopping || s.plc == PlcState::kErrorStop || !IsHeldStopped(s)) return false;
  return AsksToMove(command) && !std::holds_alternative<Power>(command);
}

}  // namespace

void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, State& s) noexcept {
  Request request;
  Status status = MakeRequest(command, c.params, request);
  if (status.ok()) status = FindNamed(c, request);
  if (status.ok() && s.leads && s.loop_closed && s.plc != PlcState::kErrorStop && AsksToMove(command)) {
    status = FollowersReady(c, s);
  }
  if (status.ok() && s.stops.count > 0 && BarsHeld(command, s)) status = Status::Failed(ErrorId::kAxisStopping);
  if (status.ok() && request.kind == RequestKind::kNone) {
    status = std::visit([&](const auto& body) { return CarryOut(c, ticket, body, s); }, command);
  } else if (status.ok()) {
    request.ticket = ticket;
    request.lease_s = lease_s;
    status = Admit(c, request, s);
    if (status.ok() && request.kind == RequestKind::kPower) Permit(c, std::get<Power>(command), s);
    const bool halts = request.kind == RequestKind::kHalt || request.kind == RequestKind::kStop;
    if (halts && status.ok()) EndFlyingByHalt(c, s);
  }
  if (status.failed()) Report(c, ticket, FeedbackState::kError, status.error);
}

bool Release(const Context& c, Ticket ticket, State& s) noexcept {
  if (EndProbing(c, ticket, s) || (ticket != 0 && s.stops.LetGo(ticket))) return true;
  Request* const request = Find(ticket, s);
  if (request == nullptr) return false;
  request->hold = false;
  request->forward = false;
  request->backward = false;
  return true;
}

bool Renew(const Context& c, Ticket ticket, State& s) noexcept {
  if (s.stops.Renew(c.cycle, ticket)) return true;
  const Request* const request = Find(ticket, s);
  if (request == nullptr || request->lease_s <= 0) return false;
  if (request == &s.active) s.lease_end_cycle = CycleIn(c.cycle, request->lease_s);
  return true;
}

}  // namespace takt::axis
