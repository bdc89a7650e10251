#include "takt/group/group.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/following.h"
#include "takt/axis/guidance.h"
#include "takt/group/boarding.h"
#include "takt/group/clutch.h"
#include "takt/group/jog.h"
#include "takt/group/members.h"
#include "takt/group/plan.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"
#include "takt/group/stream.h"
#include "takt/group/switches.h"
#include "takt/group/sync.h"
#include "takt/group/systems.h"
#include "takt/group/track.h"

namespace takt::group {

namespace {

void Fail(const Context& c, ErrorId error, State& s) {
  if (s.error == ErrorId::kNone) s.error = error;
  if (s.state == GroupState::kErrorStop) return;
  // A fault does not end a power-off.
  if (s.task != Task::kPower || s.power_on) EndTask(c, FeedbackState::kError, error, s);
  EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
  EndStream(c, FeedbackState::kError, error, s);
  AbortMoves(c, error, s);
  EndMotion(c, {.full = true}, true, s);
  s.weighed = 0;
  if (s.state == GroupState::kHoming) CommandAll(c, s, axis::Stop{});
  Enter(GroupState::kErrorStop, s);
}

// No motion is left: the members are at rest and are released.
void ComeToRest(const Context& c, State& s) {
  s.ends = s.begun = s.lets_go = false;
  s.clutches = {};
  s.ridden = {};
  s.rise = {};
  s.brake = {};
  s.active = 0;
  s.way_before += s.pace.now.position;
  s.pace = {};
  s.master = {};
  ForgetPlan(c, s);
  if (s.task == Task::kHalt) EndTask(c, FeedbackState::kDone, ErrorId::kNone, s);
  if (s.task == Task::kStop) {
    if (!s.stop_reported) Report(c, s.ticket, FeedbackState::kDone);
    s.stop_reported = true;
    if (s.holds.Holder() != nullptr) return ReleaseMembers(c, s);
    s.ticket = 0;
    EndTask(c, FeedbackState::kDone, ErrorId::kNone, s);
  }
  // Waiting moves continue from here.
  if (s.queue.count > 0 && s.state != GroupState::kErrorStop) return;
  ReleaseMembers(c, s);
  if (s.task == Task::kPower && !s.power_on) SwitchOffAll(c, s);
  if (s.state != GroupState::kErrorStop) Enter(GroupState::kStandby, s);
}

// The path could not be executed to its end.
void EndCutShort(const Context& c, State& s) {
  const bool singular = s.reason == kinematics::Reason::kSingular;
  const ErrorId error = singular ? ErrorId::kSingular : ErrorId::kUnreachable;
  if (s.queue.count > 0) Pop(c, FeedbackState::kError, error, s, s.blocked_element);
  ComeToRest(c, s);
}

bool IsThrough(const Context& c, const State& s) {
  return IsAtRestAtEnd(c, s) && IsPlanned(c, s);
}

bool HasStopped(const axis::State& member) {
  return axis::AtRest(member) && member.plc != axis::PlcState::kStopping && member.plc != axis::PlcState::kHoming;
}

bool NothingToGo(const Context& c, const State& s) {
  return c.ahead.count == 0 && s.planning.stage == Stage::kIdle && s.planning.move >= s.done + s.queue.count;
}

// Returns true if the next move to be planned waits for its object to be tracked.
bool LeadsToTracking(const State& s) {
  return s.planning.move < s.done + s.queue.count && WaitsForTracking(s, MoveAt(s, s.planning.move));
}

// Returns true if the tool may board for the next move to be planned.
bool LeadsToBoarding(const Context& c, const State& s) {
  return s.planning.move < s.done + s.queue.count && MayBoard(c, s);
}

// Each member brakes individually, off the path.
void BrakeEachAlone(const Context& c, State& s) {
  ReleaseMembers(c, s);
  s.begun = false;
  s.rise = {};
}

void MoveOn(const Context& c, State& s) {
  if (!Advance(c, s)) {
    // It was reachable when the path was verified: a limit switch has become active, or the machine's data are
    // inconsistent.
    BrakeEachAlone(c, s);
    return Fail(c, s.refused.any() ? RefusalOf(c, s) : ErrorId::kUnreachable, s);
  }
  if (!Rests(s)) return;
  const bool rides = !s.lets_go && IsOnCarrier(c, s);
  if (s.ends && rides) {
    // Between two carrier bindings no path could be continued.
    if (IsInTransition(c, s))
      s.lets_go = true;
    else
      RestOnBinding(c, s);
    return;
  }
  if (s.ends && IsOnFreeCarrier(c, s)) return BrakeEachAlone(c, s);
  // The members reach the last set point after this.
  if (rides ? !AreAtDemand(c, s) : !AllMembers(c, s, axis::AtRest)) return;
  if (s.ends) return ComeToRest(c, s);
  if (s.interrupted) {
    if (s.task == Task::kInterrupt) EndTask(c, FeedbackState::kDone, ErrorId::kNone, s);
    return;
  }
  // Before a zone, an object or a carrier to be boarded that the next move waits for, all moves up to there are done.
  const bool for_object = LeadsToTracking(s) && IsAtRestAtEnd(c, s);
  const bool waits = s.waits_for != 0 || LeadsToBoarding(c, s);
  while ((for_object || (waits && IsAtRestAtEnd(c, s))) && s.done < s.planning.move) {
    Pop(c, FeedbackState::kDone, ErrorId::kNone, s);
    s.active = 0;
  }
  if (for_object && !rides) return ComeToRest(c, s);
  if (!IsThrough(c, s) || (rides && IsUncoupled(s))) return;
  if (c.ahead.cut_short) return EndCutShort(c, s);
  if (Jogs(s)) {
    if (AtBorder(c, s)) ComeToRest(c, s);
    return;
  }
  while (s.queue.count > 0) Pop(c, FeedbackState::kDone, ErrorId::kNone, s);
  s.active = 0;
  if (!rides) ComeToRest(c, s);  // else it stays on its carrier until the next command
}

// The first part of the plan can begin.
void BeginMotion(const Context& c, State& s) {
  const ErrorId error = TakeMembers(c, s);
  if (error != ErrorId::kNone) {
    AbortMoves(c, error, s);
    ForgetPlan(c, s);
    if (s.state == GroupState::kMoving) Enter(GroupState::kStandby, s);
    return;
  }
  trajectory::BeginAt(c.ahead.window, c.ahead.window.begin(), c.cycle.period_s, s.pace);
  s.begun = true;
  BeginFollowing(c, MoveAt(s, s.done), s.done, s);
  BeginTiming(c, s);
  if (s.state == GroupState::kStandby) Enter(GroupState::kMoving, s);
}

void WatchHoming(const Context& c, State& s) {
  const bool busy = !AllMembers(c, s, [](const axis::State& member) {
    return member.plc != axis::PlcState::kHoming && member.active.kind == axis::RequestKind::kNone;
  });
  if (busy) return;
  ErrorId error = ErrorId::kNone;
  for (std::size_t k = 0; k < kMaxAxes && error == ErrorId::kNone; ++k) {
    if (s.members[k] == 0) continue;
    const axis::State& member = MemberOf(c, s, k);
    error = !member.loop_closed ? ErrorId::kPowerOff : !member.homing.homed ? ErrorId::kNoReference : ErrorId::kNone;
    c.ahead.blame = {error, s.members[k]};
  }
  EndTask(c, error == ErrorId::kNone ? FeedbackState::kDone : FeedbackState::kError, error, s);
  Enter(GroupState::kStandby, s);
}

void WatchPower(const Context& c, State& s) {
  if (AllMembers(c, s, [&](const axis::State& member) { return member.loop_closed == s.power_on; })) {
    EndTask(c, FeedbackState::kDone, ErrorId::kNone, s);
    if (s.state == GroupState::kHoming) Enter(GroupState::kStandby, s);
    return;
  }
  const ErrorId fault = FaultOfMembers(c, s);
  if (s.power_on && fault != ErrorId::kNone) return EndTask(c, FeedbackState::kError, fault, s);
  if (!s.power_on) return;
  // Meanwhile a command has switched a member off, alone or with the machine.
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const axis::State& member = MemberOf(c, s, k);
    const bool switches_off = member.active.kind == axis::RequestKind::kPower && !member.active.enable;
    if (member.enable && !switches_off) continue;
    c.ahead.blame = {ErrorId::kPowerOff, s.members[k]};
    return EndTask(c, FeedbackState::kAborted, ErrorId::kPowerOff, s);
  }
}

void WatchReset(const Context& c, State& s) {
  const bool still = AllMembers(c, s, [](const axis::State& member) {
    return member.plc != axis::PlcState::kErrorStop && !member.reset_pending;
  });
  if (s.guides || (!still && !AllMembers(c, s, [](const axis::State& m) { return !m.reset_pending; }))) return;
  s.resetting = false;
  if (!still) return Report(c, s.reset_ticket, FeedbackState::kError, ErrorId::kAxisFault);
  s.error = ErrorId::kNone;
  if (s.state == GroupState::kErrorStop) Enter(GroupState::kStandby, s);
  Report(c, s.reset_ticket, FeedbackState::kDone);
}

// Members can be reset once they are released.
void AskForReset(const Context& c, State& s) {
  if (s.guides || s.reset_asked) return;
  s.reset_asked = true;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] != 0 && MemberOf(c, s, k).error != ErrorId::kNone) Tell(c, s, k, axis::Reset{});
  }
}

// The last hold has ended: a group at rest leaves GroupStopping.
void EndStopping(const Context& c, State& s) {
  if (s.task != Task::kStop || s.holds.Holder() != nullptr || s.begun || s.ends) return;
  s.ticket = 0;
  EndTask(c, FeedbackState::kDone, ErrorId::kNone, s);
  Enter(GroupState::kStandby, s);
}

// Ends expired leases, and enters GroupStopping again if the group is held and has come to rest otherwise (powered,
// reset, enabled since).
void FollowHolds(const Context& c, State& s) {
  if (s.holds.EndLeases(c.cycle)) EndStopping(c, s);
  const axis::StopRequest* const holder = s.holds.Holder();
  if (holder == nullptr || s.state != GroupState::kStandby || s.task != Task::kNone) return;
  if (!AllMembers(c, s, [](const axis::State& member) { return member.loop_closed; })) return;
  s.task = Task::kStop;
  s.ticket = holder->ticket;
  s.stop_reported = true;
  Enter(GroupState::kStopping, s);
}

void WatchLease(const Context& c, State& s) {
  if (s.lease_s <= 0 || c.cycle.count < s.lease_end_cycle || !Jogs(s)) return;
  Report(c, MoveAt(s, s.done).ticket, FeedbackState::kAborted, ErrorId::kLeaseExpired);
  EndJog(c, 0, s);
}

// Returns the distance that a member moves while path and carriers come to rest [u].
double WayAlongPath(const Context& c, const axis::State& member, const State& s) {
  const double speed = std::abs(member.setpoint.velocity), along = s.pace.now.velocity;
  double way = along > 0 ? speed / along * (RestAt(c, s) - s.pace.now.position) : 0;
  for (const Clutch& clutch : s.clutches) {
    const double travel = std::abs(clutch.travel.velocity);
    if (clutch.used && travel > 0) way = std::max(way, 0.5 * speed * travel / clutch.deceleration);
  }
  return way;
}

// Returns true if a member moves further onto a limit switch, or in a direction that is not enabled, along the path
// than by the ramp that the machine file gives it for that (AX-112). Each fault is compared once, in the cycle after
// it, when the path is braked.
bool GoesFurtherThanAlone(const Context& c, State& s) {
  constexpr double kSame = 1.05;  // paths are braked with a little less than the limits
  constexpr double kCycles = 2;   // until faults are noticed and compared
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    const std::uint32_t bit = 1u << k;
    if (s.members[k] == 0 || (s.weighed & bit) != 0) continue;
    const axis::State& member = MemberOf(c, s, k);
    const axis::Context own = ContextOf(c, s, k);
    const double v = member.setpoint.velocity;
    if (v == 0 || member.plc != axis::PlcState::kErrorStop || !axis::IsGuided(member)) continue;
    s.weighed |= bit;
    const bool at_switch = v > 0 ? member.limit_positive : member.limit_negative;
    const bool barred = at_switch || axis::BlockingFollower(own, member, v > 0 ? 1 : -1) != axis::kNoAxis ||
                        axis::Bars(own, member, v > 0 ? 1 : -1);
    // Without a ramp of its own its distance is not bounded: the path takes precedence (GR-03).
    const axis::StopRamp& own_ramp = at_switch ? own.params.limit_stop : own.params.fault_stop;
    if (!barred || !(own_ramp.deceleration || own_ramp.jerk)) continue;
    const trajectory::Limits ramp = axis::StopLimits(own.params, member.error);
    const double alone = std::abs(trajectory::StopPosition(member.setpoint, ramp) - member.setpoint.position);
    if (WayAlongPath(c, member, s) > kSame * alone + kCycles * std::abs(v) * c.cycle.period_s) return true;
  }
  return false;
}

void WatchMembers(const Context& c, State& s) {
  if (s.state == GroupState::kDisabled) return;
  const bool brakes = s.state == GroupState::kErrorStop && s.guides && s.begun;
  if (brakes && GoesFurtherThanAlone(c, s)) BrakeEachAlone(c, s);
  const ErrorId fault = FaultOfMembers(c, s);
  if (fault != ErrorId::kNone) return Fail(c, fault, s);
  // Moves that wait for a zone or an object do not start by themselves when a member is switched on again.
  const bool waits = s.queue.count > 0 || s.track.ticket != 0;
  if (s.guides || !waits) return;
  if (AllMembers(c, s, [](const axis::State& member) { return member.loop_closed; })) return;
  EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
  AbortMoves(c, ErrorId::kNone, s);
  if (s.ends) return;  // it is coming to rest
  ForgetPlan(c, s);
  s.interrupted = s.lets_go = false;
  if (s.state == GroupState::kMoving) Enter(GroupState::kStandby, s);
}

}  // namespace

void EmergencyStop(const Context& c, State& s) noexcept {
  const bool moves = s.guides || s.begun || s.queue.count > 0 || s.state == GroupState::kMoving ||
                     s.state == GroupState::kHoming || s.state == GroupState::kStopping;
  if (moves && s.state != GroupState::kDisabled) return Fail(c, ErrorId::kEmergencyStop, s);
  EndTask(c, FeedbackState::kAborted, ErrorId::kEmergencyStop, s);
  EndTracking(c, FeedbackState::kAborted, ErrorId::kEmergencyStop, s);
}

State MakeState(std::span<const std::uint32_t> axes) noexcept {
  State s;
  for (std::size_t k = 0; k < std::min<std::size_t>(axes.size(), kMaxAxes); ++k) s.members[k] = axes[k] + 1;
  return s;
}

void Step(const Context& c, State& s) noexcept {
  c.ahead.blame = {};
  WatchLease(c, s);
  if (s.holds.count > 0) FollowHolds(c, s);
  WatchMembers(c, s);
  if (s.resetting) {
    AskForReset(c, s);
    if (s.reset_asked) WatchReset(c, s);
  }
  if (s.task == Task::kPower) WatchPower(c, s);
  if (s.state == GroupState::kHoming && s.task != Task::kPower) WatchHoming(c, s);
  WatchCarriers(c, s);
  const bool plans = s.state == GroupState::kStandby || s.state == GroupState::kMoving;
  if (plans && !Streams(s)) {
    if (!s.interrupted) StepTracking(c, s);
    if (!s.ends && !s.interrupted) Plan(c, s);
    if (!s.begun && !s.ends && MayBegin(c)) BeginMotion(c, s);
  }
  if (Streams(s)) {
    FollowStream(c, s);
  } else if (s.begun) {
    if (!s.ends && !s.interrupted) Rehearse(c, s);
    MoveOn(c, s);
  } else if (s.ends ? AllMembers(c, s, HasStopped) : s.state == GroupState::kMoving && NothingToGo(c, s)) {
    // Moves to the present position are done.
    while (!s.ends && s.queue.count > 0) Pop(c, FeedbackState::kDone, ErrorId::kNone, s);
    ComeToRest(c, s);
  } else if (!s.interrupted && c.ahead.count == 0 && LeadsToTracking(s)) {
    while (s.done < s.planning.move) Pop(c, FeedbackState::kDone, ErrorId::kNone, s);
  }
  if (const ErrorId error = StepZones(c, s); error != ErrorId::kNone) Fail(c, error, s);
  WatchTracking(c, s);
  LeadSynced(c, s);
}

bool Owns(const State& s) noexcept {
  return s.state != GroupState::kDisabled;
}

bool Release(const Context& c, Ticket ticket, State& s) noexcept {
  if (IsJogOf(ticket, s)) {
    EndJog(c, ticket, s);
    return true;
  }
  if (!s.holds.LetGo(ticket)) return false;
  EndStopping(c, s);
  return true;
}

bool Renew(const Context& c, Ticket ticket, State& s) noexcept {
  if (s.holds.Renew(c.cycle, ticket)) return true;
  if (!IsJogOf(ticket, s) || s.lease_s <= 0) return false;
  s.lease_end_cycle = CycleIn(c.cycle, s.lease_s);
  return true;
}

}  // namespace takt::group
