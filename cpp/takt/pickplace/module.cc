#include "takt/pickplace/module.h"

#include <algorithm>

#include "takt/group/members.h"
#include "takt/group/run.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

using group::GroupState;

constexpr double kLeastRamps = 0.1;  // least factor of accelerations and jerks under an override

// Returns true if a stop input has risen that stops harder than the present state.
bool StopRises(const State& s) {
  return Rises(s.inputs.stop_all, s.before.stop_all) || Rises(s.inputs.path_stop, s.before.path_stop);
}

// Returns the manual's number for the reason that stopped an axis, if it has one.
ErrorId ErrorOf(ErrorId axis_error) {
  switch (axis_error) {
    case ErrorId::kLimitSwitchPositive:
      return ErrorId::kModuleLimitSwitchPositive;
    case ErrorId::kLimitSwitchNegative:
      return ErrorId::kModuleLimitSwitchNegative;
    case ErrorId::kSoftLimitPositive:
      return ErrorId::kModuleSoftLimitPositive;
    case ErrorId::kSoftLimitNegative:
      return ErrorId::kModuleSoftLimitNegative;
    default:
      return axis_error;
  }
}

void WatchFaults(const Context& c, group::State& g, State& s) {
  if (g.state == GroupState::kErrorStop) {
    ErrorId error = TroubleOf(g);
    s.error_axes |= AxesOf(c, g, g.refused);
    group::AllMembers(c.group, g, [&](const axis::State& m) {
      if (m.error == ErrorId::kNone) return true;
      error = ErrorOf(m.error);
      return false;
    });
    return Fail(c, error, g, s);
  }
}

// Returns true if the module is active with its group.
bool IsBusy(const State& s) {
  return Jogs(s) || s.state == PickPlaceState::kHoming || s.state == PickPlaceState::kPreparingPath ||
         s.state == PickPlaceState::kMovePp || s.state == PickPlaceState::kPathInterrupt;
}

void ForgetAll(const Context& c, FeedbackState feedback, ErrorId error, group::State& g, State& s) {
  Report(c, s.hold.ticket, feedback, error);
  EndOrders(c, feedback, error, s);
  EndJog(c, feedback, error, s);
  EndHoming(c, feedback, error, g, s);
}

PathRamps PathRampsOf(const State& s) {
  const Settings& p = s.settings;
  return {p.path_velocity, p.path_acceleration, p.path_deceleration, p.path_jerk};
}

// Completes everything that is done in this cycle.
void ArriveAll(const Context& c, const group::State& g, State& s) {
  while (Arrive(c, g, s)) {
  }
}

// Drops everything and brings the tool to rest, as high as it can. A pick on its workpiece ends as with ack_gripper.
void Leave(const Context& c, FeedbackState feedback, ErrorId error, group::State& g, State& s) {
  ArriveAll(c, g, s);
  if (IsOnWorkpiece(c, g, s)) Complete(c, s);
  const bool moves = IsOn(c, g) && !IsFree(c, g);
  if (moves && (s.lifting || IsLow(c, g, s))) {
    const PathRamps ramps = s.order_count > 0 ? s.orders[0].ramps : PathRampsOf(s);
    ComeToRest(c, ramps, g, s);
    return ForgetAll(c, feedback, error, g, s);
  }
  ForgetAll(c, feedback, error, g, s);
  if (moves) HaltGroup(c, g, s);
}

// Returns true while the group or a member is being switched off: it brakes, or its brake closes, and it refuses power
// until then.
bool SwitchesOff(const Context& c, const group::State& g) {
  if (g.task == group::Task::kPower && !g.power_on) return true;
  return !group::AllMembers(
      c.group, g, [](const axis::State& m) { return m.active.kind != axis::RequestKind::kPower || m.active.enable; });
}

void SwitchPower(const Context& c, group::State& g, State& s) {
  const bool rises = s.inputs.enable && s.inputs.regulator_on && (!s.before.regulator_on || !s.before.enable);
  const bool falls = !s.inputs.regulator_on && s.before.regulator_on;
  if (IsOn(c, g)) s.enables = false;  // enabled, by any command: a `disable` given later holds
  if (rises) s.powers = true;
  if (!s.inputs.enable || !s.inputs.regulator_on) s.powers = false;
  if (s.powers && !SwitchesOff(c, g)) {
    if (!IsOn(c, g)) {
      Tell(c, group::Power{.enable = true}, g);
      s.enables = true;
    }
    s.powers = false;
  }
  if (falls) {
    ForgetAll(c, FeedbackState::kAborted, ErrorId::kPowerOff, g, s);
    Tell(c, group::Power{.enable = false}, g);
    s.enables = s.halting = false;
    const bool waits = s.state == PickPlaceState::kInit || s.state == PickPlaceState::kError ||
                       s.state == PickPlaceState::kStop || s.state == PickPlaceState::kService;
    if (!waits) Enter(PickPlaceState::kReady, s);
  }
  if (!s.enables || !s.inputs.regulator_on || g.state != GroupState::kDisabled) return;
  const bool stands = group::AllMembers(
      c.group, g, [](const axis::State& m) { return m.loop_closed && m.plc == axis::PlcState::kStandstill; });
  if (stands && Tell(c, group::Enable{}, g) == ErrorId::kNone) s.enables = false;
}

void SetOverride(const Context& c, group::State& g, State& s) {
  const double factor = s.inputs.override_factor;
  if (factor == s.override_given) return;
  // Moves keep the accelerations and jerks of the time at which they were given. A hold (0) leaves these factors
  // unchanged.
  const auto ramps = [&](double given) { return factor > 0 ? std::max(factor, kLeastRamps) : given; };
  Tell(c, group::SetOverride{factor, ramps(g.acceleration_factor), ramps(g.jerk_factor)}, g);
  s.override_given = factor;
}

// Returns the deceleration of the current path, or of the next one.
double PathDeceleration(const State& s) {
  return s.order_count > 0 ? s.orders[0].ramps.deceleration : s.settings.path_deceleration;
}

// Notes where the path is held, for the return.
void NoteHold(const Context& c, const group::State& g, State& s) {
  const Place place = PresentPlace(c, g);
  s.hold.pose = place.pose;
  s.hold.aux1 = place.aux1;
  const bool going = s.order_count > 0 && s.orders[0].phase == Phase::kGoing && g.done > s.orders[0].first;
  s.hold.legs = going ? static_cast<std::uint32_t>(g.done - s.orders[0].first) : 0;
}

void Interrupt(const Context& c, double deceleration, double jerk, group::State& g, State& s) {
  s.hold.held = true;
  NoteHold(c, g, s);
  Tell(c, group::Interrupt{.deceleration = std::max(deceleration, PathDeceleration(s)), .jerk = jerk}, g);
}

// Stops on the path; a tool that is low over a belt rises in step first, and its order begins again from there (PP-61).
// A pick that has arrived ends at once, whatever its height, as with ack_gripper: the tool does not return to that
// workpiece. It is missed if the tool is not on it: another command had interrupted the group.
void StopOnPath(const Context& c, double deceleration, double jerk, group::State& g, State& s) {
  const std::uint32_t orders = s.order_count;
  ArriveAll(c, g, s);
  if (s.order_count == 0 && orders > 0 && !s.loop.active) return;  // nothing of the path is left
  const bool stays = s.order_count > 0 && s.orders[0].phase == Phase::kStaying;
  const bool low = s.lifting || IsLow(c, g, s);
  if (!stays && !low) return Interrupt(c, deceleration, jerk, g, s);
  if (IsOnWorkpiece(c, g, s)) Complete(c, s);
  s.hold.held = s.order_count > 0 || s.loop.active;
  PathRamps ramps = PathRampsOf(s);
  ramps.deceleration = std::max(deceleration, PathDeceleration(s));
  ramps.jerk = jerk;
  if (low) return ComeToRest(c, ramps, g, s);
  LosePath(c, false, s);
  HaltGroup(c, g, s, {.deceleration = ramps.deceleration, .jerk = jerk});
}

void EndReturn(const Context& c, FeedbackState feedback, State& s) {
  Report(c, s.hold.ticket, feedback);
  s.hold.returning = false;
  s.hold.ticket = 0;
  s.given = 0;
}

void BeginStop(const Context& c, group::State& g, State& s) {
  const Settings& p = s.settings;
  const bool stop = s.inputs.path_stop;
  const double deceleration = stop ? p.path_stop_deceleration : p.path_halt_deceleration;
  const double jerk = stop ? p.path_stop_jerk : p.path_jerk;
  const bool path = (s.order_count > 0 || s.loop.active) && !Jogs(s) && !s.hold.returning;
  EndJog(c, FeedbackState::kAborted, ErrorId::kNone, s);
  EndHoming(c, FeedbackState::kAborted, ErrorId::kNone, g, s);
  if (s.order_count > 0) s.orders[0].gripper_off = true;
  if (s.inputs.stop_all) {
    if (s.hold.returning) EndReturn(c, FeedbackState::kAborted, s);
    ArriveAll(c, g, s);
    LosePath(c, false, s);
    s.hold = {};
    s.hold.held = s.order_count > 0 || s.loop.active;
    s.halting = false;
    if (g.state != GroupState::kDisabled) StopAxes(c, g, s);
  } else if (path) {
    StopOnPath(c, deceleration, jerk, g, s);
  } else {
    if (s.hold.returning) EndReturn(c, FeedbackState::kAborted, s);
    if (s.lifting || IsLow(c, g, s)) {
      ComeToRest(c, PathRampsOf(s), g, s);
    } else if (IsOn(c, g) && !IsFree(c, g)) {
      const group::Halt halt{.deceleration = deceleration, .jerk = jerk};
      s.halting = Tell(c, halt, g) == ErrorId::kNone;
    }
    ForgetPlace(s);
  }
  if (s.state != PickPlaceState::kStop) Enter(PickPlaceState::kStop, s);
}

// A held path is lost as soon as its group is no longer interrupted, due to another move, a halt, a stop, power off or
// disable: the moves that the group counts as over then do not tell the position of the tool. A path that has to be
// given again is lost when the group moves meanwhile.
void WatchHold(const Context& c, group::State& g, State& s) {
  if (!s.hold.held || s.hold.off) return;
  if (g.interrupted) return NoteHold(c, g, s);
  const Phase phase = s.order_count > 0 ? s.orders[0].phase : Phase::kNew;
  s.hold.off = phase == Phase::kGoing || (phase == Phase::kHeld && !Stands(c, g));
  if (phase != Phase::kGoing && !s.parking) return;
  // Continued by another command it would lead to a workpiece that is no longer the order's.
  const bool goes_on = g.failed < (phase == Phase::kGoing ? s.orders[0].first : s.parking_move) && g.queue.count > 0;
  LosePath(c, true, s);
  if (goes_on) HaltGroup(c, g, s);
}

void Abort(const Context& c, group::State& g, State& s) {
  if (s.state == PickPlaceState::kMovePp && s.loop.active) return EndLoopBehindThis(c, s);
  const bool prepares = s.state == PickPlaceState::kPreparingPath && !g.begun;
  const bool holds = s.hold.held && !s.hold.returning && Stands(c, g);
  if (!prepares && !holds) {
    s.warning = ErrorId::kState;
    return;
  }
  EndOrders(c, FeedbackState::kAborted, ErrorId::kNone, s);
  if (g.interrupted || g.queue.count > 0) HaltGroup(c, g, s);
  if (prepares || s.state == PickPlaceState::kPathInterrupt) Enter(PickPlaceState::kReady, s);
}

void InStop(const Context& c, group::State& g, State& s) {
  if (StopRises(s)) return BeginStop(c, g, s);
  if (s.hold.held && s.jog.ticket != 0) return BeginJog(c, g, s);
  if (!StopIsAsked(s) && Stands(c, g)) Enter(PickPlaceState::kReady, s);
}

void InInterrupt(const Context& c, group::State& g, State& s) {
  if (s.inputs.path_interrupt) return BeginJog(c, g, s);
  if (s.hold.off) {
    s.warning = ErrorId::kOffPath;
    return Enter(PickPlaceState::kReady, s);
  }
  GoOn(c, g, s);
  Enter(PickPlaceState::kMovePp, s);
}

void InReturn(const Context& c, group::State& g, State& s) {
  if (g.ends && g.reason != kinematics::Reason::kNone) return Fail(c, TroubleOf(g), g, s);
  if (g.ends || g.failed >= s.hold.move) {  // another command has stopped the group: the tool stays off its path
    EndReturn(c, FeedbackState::kAborted, s);
    return Enter(PickPlaceState::kReady, s);
  }
  if (s.given > g.done + g.queue.count) return Fail(c, TroubleOf(g), g, s);
  if (g.done <= s.hold.move || !IsFree(c, g)) return;
  EndReturn(c, FeedbackState::kDone, s);
  s.hold.off = false;
  Enter(PickPlaceState::kReady, s);
}

void InMove(const Context& c, group::State& g, State& s) {
  if (s.state == PickPlaceState::kMovePp && s.inputs.path_interrupt && !s.hold.returning) {
    StopOnPath(c, s.settings.path_stop_deceleration, s.settings.path_stop_jerk, g, s);
    if (s.order_count > 0) s.orders[0].pulse_at_end = true;
    return Enter(PickPlaceState::kPathInterrupt, s);
  }
  s.hold.returning ? InReturn(c, g, s) : RunOrders(c, g, s);
}

void InError(const Context& c, group::State& g, State& s) {
  if (s.reset) {
    Tell(c, group::Reset{}, g);
    s.error = s.warning = ErrorId::kNone;
    s.error_axes = 0;
  }
  const bool well = g.state != GroupState::kErrorStop && !g.resetting && Stands(c, g);
  if (s.error != ErrorId::kNone || !well) return;
  Enter(PickPlaceState::kReady, s);
  const bool stopped =
      !group::AllMembers(c.group, g, [](const axis::State& m) { return m.emergency == axis::Emergency::kNone; });
  // After an emergency stop power has to be requested again.
  if (!s.inputs.regulator_on || IsOn(c, g) || stopped) return;
  Tell(c, group::Power{.enable = true}, g);
  s.enables = g.state == GroupState::kDisabled;
}

// Switches between READY and SERVICE: motions of the group that are not the module's are a service.
void ReadyOrService(const Context& c, const group::State& g, State& s) {
  if (s.state != PickPlaceState::kReady && s.state != PickPlaceState::kService) return;
  const bool moves =
      g.state == GroupState::kMoving || g.state == GroupState::kHoming || g.state == GroupState::kStopping;
  const bool service = s.inputs.internal_control || (moves && !s.hold.held && !s.halting && !s.lifting);
  const PickPlaceState wanted = service ? PickPlaceState::kService : PickPlaceState::kReady;
  if (wanted == s.state) return;
  EndJog(c, FeedbackState::kAborted, ErrorId::kNone, s);
  Enter(wanted, s);
}

// Returns true if power was requested and the group will be enabled once it is on.
bool WillBeOn(const Context& c, const group::State& g, const State& s) {
  return s.enables && group::AllMembers(c.group, g, [](const axis::State& m) { return m.enable; });
}

// The group was taken away, stopped or switched off by another command: the module's activity ends, and does not
// continue by itself when the group is available again.
void WatchGroup(const Context& c, group::State& g, State& s) {
  if ((!IsBusy(s) && s.jog.ticket == 0) || IsOn(c, g) || WillBeOn(c, g, s)) return;
  if (s.state == PickPlaceState::kError || s.state == PickPlaceState::kHoming) return;  // see InError, InHoming
  const bool off = !group::AllMembers(c.group, g, [](const axis::State& m) { return m.loop_closed; });
  const ErrorId error = off ? ErrorId::kPowerOff : ErrorId::kNone;
  if (!IsBusy(s)) return EndJog(c, FeedbackState::kAborted, error, s);
  if (s.hold.returning) EndReturn(c, FeedbackState::kAborted, s);
  const PickPlaceState to = Jogs(s) && s.back == PickPlaceState::kStop ? s.back : PickPlaceState::kReady;
  ForgetAll(c, FeedbackState::kAborted, error, g, s);
  s.halting = s.lifting = s.rises = false;
  Enter(to, s);
}

void WatchLease(const Context& c, State& s) {
  if (s.jog.lease_s <= 0 || c.group.cycle.count < s.jog.lease_end_cycle) return;
  s.jog.keys = {};
  s.jog.lease_s = 0;
}

void Disable(const Context& c, group::State& g, State& s) {
  if (s.state == PickPlaceState::kInit) return;
  if (s.state == PickPlaceState::kService) {
    ForgetAll(c, FeedbackState::kAborted, ErrorId::kNone, g, s);
  } else {
    Leave(c, FeedbackState::kAborted, ErrorId::kNone, g, s);
  }
  Enter(PickPlaceState::kInit, s);
}

void StepState(const Context& c, group::State& g, State& s) {
  switch (s.state) {
    case PickPlaceState::kReady:
      return BeginJog(c, g, s);
    case PickPlaceState::kJogPos:
    case PickPlaceState::kJogNeg:
      return InJog(c, g, s);
    case PickPlaceState::kHoming:
      return InHoming(c, g, s);
    case PickPlaceState::kPreparingPath:
    case PickPlaceState::kMovePp:
      return InMove(c, g, s);
    case PickPlaceState::kPathInterrupt:
      return InInterrupt(c, g, s);
    case PickPlaceState::kStop:
      return InStop(c, g, s);
    case PickPlaceState::kError:
      return InError(c, g, s);
    default:
      return;
  }
}

void RunStates(const Context& c, group::State& g, State& s) {
  if (s.state == PickPlaceState::kInit) {
    Enter(s.error == ErrorId::kNone ? PickPlaceState::kReady : PickPlaceState::kError, s);
  }
  if (s.state != PickPlaceState::kError) WatchFaults(c, g, s);
  WatchSwitches(c, g, s);
  // A jog from STOP continues while the level that led to STOP is still true.
  const bool jogs = Jogs(s) && s.back == PickPlaceState::kStop;
  const bool stops = jogs ? StopRises(s) : StopIsAsked(s);
  if (s.state != PickPlaceState::kError && s.state != PickPlaceState::kStop && stops) BeginStop(c, g, s);
  if (s.halting && IsFree(c, g)) s.halting = false;
  WatchHold(c, g, s);
  WatchGroup(c, g, s);
  ReadyOrService(c, g, s);
  if (s.abort) Abort(c, g, s);
  StepState(c, g, s);
}

// Returns true if there is not enough time left for the approached workpiece.
bool IsTooLate(const Context& c, const group::State& g, const State& s) {
  if (s.order_count == 0 || s.orders[0].workpiece == 0) return false;
  const Order& order = s.orders[0];
  return !StaysWithin(c, g, order, TimeToGo(c, g, order, s) + order.own.sync_time);
}

// Returns true if the group moves along its path, or a member away from its position.
bool MovesOn(const Context& c, const group::State& g) {
  return g.begun ? g.pace.now.velocity > 0 : !group::AllMembers(c.group, g, axis::AtRest);
}

// Returns true if the tool is no longer at a place in the MCS: its frame, or the position of an axis, was set anew.
bool IsElsewhere(const Context& c, const group::State& g, const Place& place) {
  constexpr double kSamePosition = 0.01;     // [mm]
  constexpr double kSameOrientation = 1e-4;  // [rad] of the elements of the rotation matrix
  const kinematics::Frame present = kinematics::ToFrame(PresentPlace(c, g).pose);
  const kinematics::Frame then = kinematics::ToFrame(place.pose);
  return !KDL::Equal(present.p, then.p, kSamePosition) || !KDL::Equal(present.M, then.M, kSameOrientation);
}

void WatchWindow(const Context& c, State& s) {
  const double cycles = s.settings.position_window_ms / 1000 / c.group.cycle.period_s;
  if (c.path_error > s.settings.position_window) {
    s.out_of_window = static_cast<std::uint32_t>(cycles) + 1;
  } else if (s.out_of_window > 0) {
    --s.out_of_window;
  }
}

}  // namespace

void GoOn(const Context& c, group::State& g, State& s) noexcept {
  s.hold.held = false;
  if (!g.interrupted) return;
  if (!IsTooLate(c, g, s)) {
    Tell(c, group::Continue{}, g);
    return;
  }
  ComeToRest(c, s.orders[0].ramps, g, s);
}

void Fail(const Context& c, ErrorId error, group::State& g, State& s) noexcept {
  if (s.error == ErrorId::kNone) s.error = error;
  if (s.state == PickPlaceState::kError) return;
  Leave(c, FeedbackState::kError, error, g, s);
  Enter(PickPlaceState::kError, s);
}

void EmergencyStop(const Context& c, group::State& g, State& s) noexcept {
  s.enables = s.powers = false;
  if (IsBusy(s) || s.order_count > 0 || s.loop.active || s.lifting) return Fail(c, ErrorId::kEmergencyStop, g, s);
  EndJog(c, FeedbackState::kAborted, ErrorId::kEmergencyStop, s);
}

State MakeState(const PickPlaceParams& params) noexcept {
  State s;
  s.settings = params.settings;
  for (std::size_t i = 0; i < params.belts.size(); ++i) s.belts[i] = params.belts[i].settings;
  return s;
}

void Step(const Context& c, group::State& g, State& s) noexcept {
  s.pulse = false;
  const bool moves = MovesOn(c, g);
  if (moves) s.in_target = false;
  if (s.parked_at != 0 && !s.parking && (moves || IsElsewhere(c, g, s.at))) ForgetPlace(s);  // moved by other commands
  SwitchPower(c, g, s);
  SetOverride(c, g, s);
  CloseDirections(c, g, s);
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    const std::size_t real = g.members[k] != 0 ? RealOf(c, g, k) : kRealAxes;
    if (real < kRealAxes) group::MemberOf(c.group, g, k).reference |= s.inputs.home_abs_switch[real];
  }
  if (s.inputs.enable) {
    WatchLease(c, s);
    RunStates(c, g, s);
  } else {
    Disable(c, g, s);
  }
  if (s.state != PickPlaceState::kMovePp && s.state != PickPlaceState::kPreparingPath) StepLift(c, g, s);
  StepGripper(c, g, s);
  NoteHeight(g, s);
  CountLost(c, s);
  WatchWindow(c, s);
  s.before = s.inputs;
  s.reset = s.abort = s.ack = false;
}

}  // namespace takt::pickplace
