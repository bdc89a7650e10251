#include "takt/flexcam/module.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "takt/axis/coupling.h"
#include "takt/axis/guidance.h"
#include "takt/axis/homing.h"
#include "takt/axis/sequence.h"
#include "takt/flexcam/run.h"

namespace takt::flexcam {

namespace {

// Limits a ramp of the module to the slave's own limit.
double Within(double asked, double own) {
  return own > 0 ? std::min(asked, own) : asked;
}

// The module's homing parameters replace those of the slave only while it is homing: every exit restores the slave's
// own.
void Enter(const Context& c, ModuleState to, State& s) {
  if (s.state == ModuleState::kHoming && to != ModuleState::kHoming) c.slave.params.homing = c.homing;
  s.state = to;
}

// Commands the slave; returns why it was refused, if it was.
ErrorId Tell(const Context& c, const axis::Command& command, axis::State& slave) {
  c.slave.feedback.TakeOwnError();
  axis::Apply(c.slave, 0, 0, command, slave);
  return c.slave.feedback.TakeOwnError();
}

void EndAction(const Context& c, FeedbackState feedback, ErrorId error, State& s) {
  if (feedback == FeedbackState::kError) s.warning = error;
  if (s.action == Action::kNone) return;
  Report(c, s.action_ticket, feedback, error);
  s.done = feedback == FeedbackState::kDone;
  s.action = Action::kNone;
  s.action_ticket = 0;
}

// Accept: the requested action replaces the running one. Refuse: the request is refused; the running action continues.
void Accept(const Context& c, State& s) {
  EndAction(c, FeedbackState::kAborted, ErrorId::kNone, s);
  s.action = s.request;
  s.action_ticket = s.request_ticket;
  s.request = Action::kNone;
  s.warning = ErrorId::kNone;
}
void Refuse(const Context& c, ErrorId error, State& s) {
  if (s.request == Action::kNone) return;
  Report(c, s.request_ticket, FeedbackState::kError, error);
  s.request = Action::kNone;
  s.warning = error;
}

void Brake(const Context& c, double deceleration, double jerk, bool hold, axis::State& slave) {
  const trajectory::Limits own = c.slave.params.planner_limits();
  const double within = Within(deceleration, own.deceleration);
  const double within_jerk = axis::BrakingJerk(slave.setpoint, Within(jerk, own.jerk), own.jerk);
  if (hold || slave.plc == axis::PlcState::kHoming) {  // a search accepts no halt
    Tell(c, axis::Stop{.deceleration = within, .jerk = within_jerk, .hold = hold}, slave);
  } else {
    Tell(c, axis::Halt{.deceleration = within, .jerk = within_jerk}, slave);
  }
}

// Stops the slave and holds it until the module releases the stop.
void HoldStopped(const Context& c, axis::State& slave, State& s) {
  Brake(c, s.settings.stop_deceleration, s.settings.stop_jerk, true, slave);
  s.holds = axis::HoldsStop(0, slave);
}
void LetGoOfStop(axis::State& slave, State& s) {
  if (s.holds) slave.stops.LetGo(0);
  s.holds = false;
}

// Clears the clutch, after it was opened for any reason; the module no longer moves the slave.
void Abandon(const Context& c, State& s) {
  s.clutch = {};
  s.sequencer = {};
  s.instant = false;
  s.master.coasts = false;
  AbortChanges(c, s);
  AbortAdjustments(c, s);
  EndAction(c, FeedbackState::kAborted, ErrorId::kNone, s);
}

// Returns the manual's error number for the error that stopped the slave, if it has one.
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

void Fail(const Context& c, ErrorId error, axis::State& slave, State& s) {
  if (s.error == ErrorId::kNone) s.error = error;
  if (s.state == ModuleState::kError) return;
  Enter(c, ModuleState::kError, s);
  EndAction(c, FeedbackState::kError, error, s);
  EndJog(c, FeedbackState::kError, error, s);
  Abandon(c, s);
  if (IsOn(slave) && slave.emergency == axis::Emergency::kNone) HoldStopped(c, slave, s);
}

void FailAtSwitch(const Context& c, int sense, axis::State& slave, State& s) {
  Fail(c, sense > 0 ? ErrorId::kModuleLimitSwitchPositive : ErrorId::kModuleLimitSwitchNegative, slave, s);
}

// Returns true if the motion that the slave has begun at rest is in this direction.
bool Begins(const Context& c, int sense, const axis::State& slave) {
  const double least = 1e-9 * c.slave.params.limits.velocity;  // smaller ones are rounding
  if (axis::IsGuided(slave)) {
    const KinematicState& demand = slave.guidance.demand;
    const double way = demand.position - slave.origin - slave.setpoint.position;
    return sense * demand.velocity > least || sense * way > least;
  }
  if (slave.active.kind == axis::RequestKind::kJog) {
    return sense > 0 ? slave.active.forward && slave.jog_sense >= 0 : slave.active.backward && slave.jog_sense <= 0;
  }
  return sense * slave.motion.profile.At(axis::Elapsed(c.slave, slave)).velocity > least;
}

// No motion begins towards an active limit switch of the module, as with those of the axis itself.
void WatchBeginnings(const Context& c, axis::State& slave, State& s) {
  const bool own = s.state == ModuleState::kJogPos || s.state == ModuleState::kJogNeg ||
                   s.state == ModuleState::kHoming || s.state == ModuleState::kSync;
  if (!own || !s.inputs.enable_hw_limit || !axis::AtRest(slave)) return;
  if (s.inputs.hw_limit_positive && Begins(c, 1, slave)) return FailAtSwitch(c, 1, slave, s);
  if (s.inputs.hw_limit_negative && Begins(c, -1, slave)) FailAtSwitch(c, -1, slave, s);
}

void WatchLimits(const Context& c, axis::State& slave, State& s) {
  if (slave.error != ErrorId::kNone) return Fail(c, ErrorOf(slave.error), slave, s);
  if (!s.inputs.enable_hw_limit) return;
  // On a new edge, or while the slave moves further beyond the switch.
  const double v = slave.setpoint.velocity;
  const auto hits = [&](bool now, bool rose, double sense) { return rose || (now && sense * v > 0); };
  const bool looks = s.rose.enable_hw_limit;
  if (hits(s.inputs.hw_limit_positive, s.rose.hw_limit_positive || (looks && s.inputs.hw_limit_positive), 1)) {
    FailAtSwitch(c, 1, slave, s);
  } else if (hits(s.inputs.hw_limit_negative, s.rose.hw_limit_negative || (looks && s.inputs.hw_limit_negative), -1)) {
    FailAtSwitch(c, -1, slave, s);
  }
}

void SwitchPower(const Context& c, axis::State& slave, State& s) {
  const bool rises = s.inputs.enable && s.inputs.regulator_on && (s.rose.regulator_on || s.rose.enable);
  const bool falls = !s.inputs.regulator_on && s.before.regulator_on;
  if (rises && !slave.enable) Tell(c, axis::Power{.enable = true}, slave);
  if (falls) Tell(c, axis::Power{.enable = false}, slave);
}

// Returns true if the slave moves without the module.
bool IsBusyItself(const axis::State& slave) {
  using K = axis::RequestKind;
  const K kind = slave.active.kind;
  const bool power = kind == K::kPower;
  return (kind != K::kNone && kind != K::kGuided && !power) || slave.superimposed ||
         slave.plc == axis::PlcState::kHoming || slave.plc == axis::PlcState::kContinuousMotion;
}

ErrorId TellJog(const Context& c, axis::State& slave, const State& s) {
  const axis::AxisLimits& own = c.slave.params.limits;
  const trajectory::Limits limits = c.slave.params.planner_limits();
  return Tell(c,
              axis::Jog{.forward = s.jog.keys.positive,
                        .backward = s.jog.keys.negative,
                        .velocity = Within(s.settings.jog_velocity, own.velocity),
                        .acceleration = Within(s.settings.jog_acceleration, limits.acceleration),
                        .deceleration = Within(s.settings.jog_deceleration, limits.deceleration),
                        .jerk = Within(s.settings.jog_jerk, limits.jerk)},
              slave);
}

ClutchContext ClutchOf(const Context& c, const axis::State& slave, const KinematicState& wanted_before,
                       const State& s) {
  return {.cycle = c.slave.cycle,
          .planner = c.slave.planner,
          .settings = s.settings,
          .slave = c.slave.params,
          .table = TableOf(c, s),
          .master_turn = TurnOf(c.slave, c.master),
          .master_zero = ZeroOf(c.slave, c.master),
          .measured = c.master && SeeMaster(c.slave, *c.master, c.params.source).measured,
          .slave_zero = slave.origin,
          .master = s.master.now,
          .master_before = s.master.before,
          .own_before = {slave.setpoint.position + slave.origin, slave.setpoint.velocity, slave.setpoint.acceleration},
          .wanted_before = wanted_before,
          .in_step = slave.guidance.chase.in_step,
          .at_rest = axis::AtRest(slave)};
}

void BeginHoming(const Context& c, axis::State& slave, State& s) {
  if (s.settings.home_by_module && c.params.homing) c.slave.params.homing = *c.params.homing;
  const ErrorId error = Tell(c, axis::Home{.position = s.settings.home_position}, slave);
  if (error != ErrorId::kNone) {
    c.slave.params.homing = c.homing;
    return Refuse(c, error, s);
  }
  Accept(c, s);
  Enter(c, ModuleState::kHoming, s);
}

ErrorId MaySync(const Context& c, const axis::State& slave, const State& s) {
  if (c.master && !SeeMaster(c.slave, *c.master, c.params.source).known) return ErrorId::kMasterOff;
  const bool no_reference = c.slave.params.requires_reference && !slave.homing.homed;
  return s.settings.slave_absolute && no_reference ? ErrorId::kNoReference : ErrorId::kNone;
}

void BeginSync(const Context& c, axis::State& slave, State& s) {
  if (const ErrorId error = MaySync(c, slave, s); error != ErrorId::kNone) return Refuse(c, error, s);
  if (const Status status = axis::Guide(c.slave, slave); status.failed()) return Refuse(c, status.error, s);
  Accept(c, s);
  Enter(c, ModuleState::kSync, s);
  s.master.coasts = false;
  TakeUp(c, slave, s);
  BeginClosing(ClutchOf(c, slave, s.wanted, s), s.clutch);
}

// A request while the slave is off must be repeated once it is on. In SYNC the clutch handles requests itself.
void Requests(const Context& c, axis::State& slave, State& s) {
  if (s.request == Action::kNone) return;
  const bool sync = s.request == Action::kSyncIn || s.request == Action::kSyncOut;
  if (!IsOn(slave)) return Refuse(c, ErrorId::kPowerOff, s);
  if (s.state == ModuleState::kSync && sync) return;
  if (s.state != ModuleState::kReady) return Refuse(c, ErrorId::kState, s);
  if (s.request == Action::kHome) return BeginHoming(c, slave, s);
  if (s.request == Action::kSyncIn && !s.inputs.sync_out_instant) return BeginSync(c, slave, s);
  Refuse(c, ErrorId::kState, s);
}

void BeginStop(const Context& c, axis::State& slave, State& s) {
  const bool stop = s.inputs.stop || s.rose.stop;
  if (IsOn(slave)) {
    stop ? HoldStopped(c, slave, s) : Brake(c, s.settings.halt_deceleration, s.settings.jerk, false, slave);
  }
  EndJog(c, FeedbackState::kAborted, ErrorId::kNone, s);
  if (s.state == ModuleState::kSync && s.request == Action::kSyncOut) {  // the stop has opened the clutch
    Report(c, s.request_ticket, FeedbackState::kDone);
    s.request = Action::kNone;
  }
  Abandon(c, s);
  Enter(c, ModuleState::kStop, s);
}

void InStop(const Context& c, axis::State& slave, State& s) {
  if (s.rose.stop) return BeginStop(c, slave, s);
  if (s.inputs.stop || s.inputs.halt) {
    // Nothing else may move it meanwhile.
    using K = axis::RequestKind;
    const K kind = slave.active.kind;
    const bool strays = kind != K::kNone && kind != K::kStop && kind != K::kHalt && kind != K::kPower;
    if (strays || (s.inputs.stop && !s.holds && IsOn(slave))) BeginStop(c, slave, s);
    return;
  }
  LetGoOfStop(slave, s);
  using K = axis::RequestKind;
  const K kind = slave.active.kind;
  const bool stops = kind == K::kStop || kind == K::kHalt || kind == K::kPower;
  // else a command of the slave's own has taken over
  if (!slave.loop_closed || !stops) Enter(c, ModuleState::kReady, s);
}

void InReady(const Context& c, axis::State& slave, State& s) {
  if (s.jog.ticket == 0) return;
  // Switched off since: a held key does not move the slave once it is on again.
  if (!IsOn(slave)) return EndJog(c, FeedbackState::kAborted, ErrorId::kPowerOff, s);
  if (!s.jog.keys.positive && !s.jog.keys.negative) return EndJog(c, FeedbackState::kDone, ErrorId::kNone, s);
  if (const ErrorId error = TellJog(c, slave, s); error != ErrorId::kNone) {
    s.warning = error;
    return EndJog(c, FeedbackState::kError, error, s);
  }
  Enter(c, s.jog.keys.positive ? ModuleState::kJogPos : ModuleState::kJogNeg, s);
}

void InJog(const Context& c, axis::State& slave, State& s) {
  const bool held = s.jog.keys.positive || s.jog.keys.negative;
  if (slave.active.kind == axis::RequestKind::kJog) {
    if (!held) {
      slave.active.forward = slave.active.backward = false;
      return;
    }
    if (s.jog.keys.positive != slave.active.forward || s.jog.keys.negative != slave.active.backward) {
      TellJog(c, slave, s);
    }
    if (slave.jog_sense != 0) Enter(c, slave.jog_sense > 0 ? ModuleState::kJogPos : ModuleState::kJogNeg, s);
    return;
  }
  EndJog(c, held ? FeedbackState::kAborted : FeedbackState::kDone, ErrorId::kNone, s);
  Enter(c, ModuleState::kReady, s);
}

// Returns true if something has ended the search early: a stop of the axis or of the machine, or power off.
bool IsStopped(const axis::State& slave) {
  using K = axis::RequestKind;
  const K kind = slave.active.kind;
  return !IsOn(slave) || slave.plc == axis::PlcState::kStopping || kind == K::kStop || kind == K::kHalt ||
         (kind == K::kPower && !slave.active.enable);
}

void InHoming(const Context& c, const axis::State& slave, State& s) {
  if (IsStopped(slave)) {
    Enter(c, ModuleState::kReady, s);
    return EndAction(c, FeedbackState::kAborted, slave.loop_closed ? ErrorId::kNone : ErrorId::kPowerOff, s);
  }
  if (slave.plc == axis::PlcState::kHoming || IsBusyItself(slave)) return;
  Enter(c, ModuleState::kReady, s);
  if (slave.homing.homed) return EndAction(c, FeedbackState::kDone, ErrorId::kNone, s);
  EndAction(c, FeedbackState::kError, slave.error == ErrorId::kNone ? ErrorId::kNoReference : slave.error, s);
}

// Returns true if the cam, continued as it is, would move the slave out of its SW limits: then it is stopped early
// enough for the module's own ramp.
bool LeavesLimits(const Context& c, const axis::State& slave, const State& s) {
  const axis::AxisLimits& limits = c.slave.params.limits;
  const bool on_cam = s.clutch.phase == ClutchPhase::kClosed || s.clutch.phase == ClutchPhase::kWaitingOut;
  if (!on_cam || (!limits.lower && !limits.upper)) return false;
  const cam::Table& table = TableOf(c, s);
  const double stroke = s.way.profiler.once ? 0 : table.stroke();
  const double sense = s.x.velocity < 0 ? -1 : 1;
  const Conversion& out = s.way.to_slave;
  const double zero = s.at.y - s.at.y_in_cam;
  const auto slave_at = [&](double y) {
    return out.factor * (zero + y - out.in_zero) + out.out_zero + out.offset - slave.origin;
  };
  const bool over = limits.upper && (sense * stroke > 0 || slave_at(table.highest()) > *limits.upper);
  const bool under = limits.lower && (sense * stroke < 0 || slave_at(table.lowest()) < *limits.lower);
  return over || under;
}

void InSync(const Context& c, axis::State& slave, State& s) {
  if (s.clutch.phase == ClutchPhase::kReleased) {
    if (slave.active.kind != axis::RequestKind::kNone) return;
    Abandon(c, s);
    Enter(c, ModuleState::kReady, s);
    return;
  }
  if (!axis::IsGuided(slave)) {  // a command of the slave's own has taken over, or the slave is off
    if (slave.emergency != axis::Emergency::kNone) return Fail(c, ErrorId::kEmergencyStop, slave, s);
    Abandon(c, s);
    if (!IsOn(slave)) s.warning = ErrorId::kPowerOff;
    Enter(c, ModuleState::kReady, s);
    return;
  }
  if (!s.master.known && !s.master.coasts) return Fail(c, ErrorId::kMasterOff, slave, s);
  if (s.inputs.sync_out_instant || s.rose.sync_out_instant) {
    Brake(c, s.settings.sync_out_instant_deceleration, s.settings.jerk, false, slave);
    s.clutch.phase = ClutchPhase::kReleased;
    return;
  }
  const KinematicState wanted_before = s.wanted;
  RunWay(c, s);
  ClutchContext clutch = ClutchOf(c, slave, wanted_before, s);
  if (s.request == Action::kSyncIn) {
    BeginClosing(clutch, s.clutch);
    Accept(c, s);
  } else if (s.request != Action::kNone) {
    BeginOpening(clutch, s.clutch);
    Accept(c, s);
  }
  const double zero = s.way.to_slave.out_zero;
  const bool on_ramp = IsOnRamp(s.clutch);
  KinematicState demand = {clutch.own_before.position, 0, 0};
  if (const Status status = StepClutch(clutch, s.wanted, s.way, s.clutch, demand); status.failed()) {
    EndAction(c, FeedbackState::kError, status.error, s);
  }
  if (s.clutch.waits == ClutchWait::kAway) s.warning = ErrorId::kSyncPassed;
  if (on_ramp && (s.clutch.stretched || !clutch.in_step)) s.warning = ErrorId::kSlaveLimits;
  s.wanted.position += s.way.to_slave.out_zero - zero;
  slave.guidance.demand = demand;
  slave.fault_ramp.leaves_limits = LeavesLimits(c, slave, s);
  if (s.clutch.phase == ClutchPhase::kOpen) {
    axis::EndGuidance(c.slave, slave);
    if (s.action == Action::kSyncOut) EndAction(c, FeedbackState::kDone, ErrorId::kNone, s);
    Abandon(c, s);
    Enter(c, ModuleState::kReady, s);
  } else if (s.clutch.phase == ClutchPhase::kClosed && slave.guidance.chase.in_step && s.action == Action::kSyncIn) {
    EndAction(c, FeedbackState::kDone, ErrorId::kNone, s);
  }
}

void InError(const Context& c, axis::State& slave, State& s) {
  if (s.rose.reset_error) {
    LetGoOfStop(slave, s);
    Tell(c, axis::Reset{}, slave);
    s.error = ErrorId::kNone;
    s.warning = ErrorId::kNone;
  }
  const bool stands = !slave.loop_closed || axis::AtRest(slave);
  if (s.error == ErrorId::kNone && slave.error == ErrorId::kNone && stands && !slave.reset_pending) {
    Enter(c, ModuleState::kReady, s);
    const bool stopped = slave.emergency != axis::Emergency::kNone;  // then power must be requested anew
    if (s.inputs.regulator_on && !slave.enable && !stopped) Tell(c, axis::Power{.enable = true}, slave);
  }
}

void WatchLease(const Context& c, State& s) {
  if (s.jog.lease_s <= 0 || c.slave.cycle.count < s.jog.lease_end_cycle) return;
  s.jog.keys = {};
  s.jog.lease_s = 0;
}

// Switches between READY and SERVICE: motion of the slave by itself is a service.
void ReadyOrService(const Context& c, const axis::State& slave, State& s) {
  if (s.state != ModuleState::kReady && s.state != ModuleState::kService) return;
  const bool led = axis::IsGuided(slave);  // by a group: for the module itself the state would be SYNC
  const bool service = s.inputs.internal_control || led || IsBusyItself(slave);
  Enter(c, service ? ModuleState::kService : ModuleState::kReady, s);
}

// Takes the slave off the cam and releases it. An error remains.
void Disable(const Context& c, axis::State& slave, State& s) {
  Refuse(c, ErrorId::kState, s);
  if (s.state == ModuleState::kInit) return;
  axis::EndGuidance(c.slave, slave);
  if (s.state == ModuleState::kJogPos || s.state == ModuleState::kJogNeg) {
    slave.active.forward = slave.active.backward = false;
  }
  if (s.state == ModuleState::kHoming) Brake(c, s.settings.halt_deceleration, s.settings.jerk, false, slave);
  LetGoOfStop(slave, s);
  EndJog(c, FeedbackState::kAborted, ErrorId::kNone, s);
  Abandon(c, s);
  Enter(c, ModuleState::kInit, s);
}

void StepState(const Context& c, axis::State& slave, State& s) {
  switch (s.state) {
    case ModuleState::kReady:
      return InReady(c, slave, s);
    case ModuleState::kJogPos:
    case ModuleState::kJogNeg:
      return InJog(c, slave, s);
    case ModuleState::kHoming:
      return InHoming(c, slave, s);
    case ModuleState::kSync:
      return InSync(c, slave, s);
    case ModuleState::kStop:
      return InStop(c, slave, s);
    case ModuleState::kError:
      return InError(c, slave, s);
    default:
      return;
  }
}

void RunStates(const Context& c, axis::State& slave, State& s) {
  if (s.state == ModuleState::kInit) s.state = s.error == ErrorId::kNone ? ModuleState::kReady : ModuleState::kError;
  WatchLimits(c, slave, s);
  const bool stops = s.inputs.stop || s.inputs.halt || s.rose.stop || s.rose.halt;
  if (s.state != ModuleState::kError && s.state != ModuleState::kStop && stops) {
    BeginStop(c, slave, s);
  }
  ReadyOrService(c, slave, s);
  Requests(c, slave, s);
  StepState(c, slave, s);
  WatchBeginnings(c, slave, s);
  Refuse(c, ErrorId::kState, s);
  // A key that was pressed when something else began does not cause motion later.
  const bool jogs =
      s.state == ModuleState::kReady || s.state == ModuleState::kJogPos || s.state == ModuleState::kJogNeg;
  if (!jogs && s.jog.ticket != 0) EndJog(c, FeedbackState::kAborted, ErrorId::kNone, s);
}

BoundsOf WhatToBound(const State& s) {
  BoundsOf of;
  const auto add = [&](std::uint32_t slot) {
    if (s.slots[slot - 1] != 0 && of.count < kSlots) of.cams[of.count++] = s.slots[slot - 1] - 1;
  };
  if (s.inputs.cam_sequencer) {
    for (const SequencePart part : {SequencePart::kIn, SequencePart::kOut}) {
      for (const SequenceStep& step : StepsOf(s.settings.cam_sequence_mode, part)) add(step.slot);
    }
  } else {
    add(s.inputs.cam_table);
  }
  of.velocity = s.inputs.scaling_master * s.settings.master_max_velocity;
  of.acceleration = s.inputs.scaling_master * s.settings.master_max_acceleration;
  return of;
}

}  // namespace

bool IsOn(const axis::State& slave) noexcept {
  return slave.loop_closed && slave.plc != axis::PlcState::kErrorStop;
}

void EndJog(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  if (s.jog.ticket != 0) Report(c, s.jog.ticket, feedback, error);
  s.jog = {};
}

// All actions end, including those that were requested in this cycle and have not begun.
void EmergencyStop(const Context& c, axis::State& slave, State& s) noexcept {
  Refuse(c, ErrorId::kEmergencyStop, s);
  const bool moves = s.state == ModuleState::kJogPos || s.state == ModuleState::kJogNeg ||
                     s.state == ModuleState::kHoming || s.state == ModuleState::kSync;
  if (moves) return Fail(c, ErrorId::kEmergencyStop, slave, s);
  EndJog(c, FeedbackState::kAborted, ErrorId::kEmergencyStop, s);
}

bool UsesCam(const State& s, std::uint32_t index) noexcept {
  const auto bounded = std::span(s.bounds.of.cams).first(s.bounds.of.count);
  return std::ranges::find(s.slots, index + 1) != s.slots.end() || s.way.profiler.cam == index ||
         s.entry.profiler.cam == index || std::ranges::find(bounded, index) != bounded.end();
}

State MakeState(const FlexCamParams& params, const std::array<std::uint32_t, kSlots>& slots) noexcept {
  State s;
  s.rose = Inputs{.enable = false};
  s.settings = params.settings;
  s.slots = slots;
  s.way.profiler.cam = slots[0] - 1;
  return s;
}

void Step(const Context& c, axis::State& slave, State& s) noexcept {
  const bool coast = s.state == ModuleState::kSync && s.settings.on_master_fault == MasterFault::kCoast;
  if (s.state != ModuleState::kSync) s.master.coasts = false;
  const bool coasted = s.master.coasts;
  Follow(c.slave, c.master, c.params.source, s.settings, s.inputs.virtual_velocity, coast, s.master);
  if (s.master.coasts && !coasted) s.warning = ErrorId::kMasterOff;
  slave.reference |= s.inputs.home_abs_switch;
  SwitchPower(c, slave, s);
  slave.fault_ramp = {};
  if (s.inputs.enable) {
    slave.fault_ramp = {s.settings.stop_deceleration, s.settings.stop_jerk, false};
    WatchLease(c, s);
    RunStates(c, slave, s);
  } else {
    Disable(c, slave, s);
  }
  if (s.state != ModuleState::kSync || s.clutch.phase == ClutchPhase::kReleased) ShowWay(c, slave, s);
  if (s.settings.calculate_bounds) {
    WorkOut(WhatToBound(s), c.slave.machine.cams, s.bounds);
  } else if (s.bounds.valid) {
    s.bounds = {};
  }
  EndAdjustments(c, s);
  s.before = s.inputs;
  s.rose = Inputs{.enable = false};
}

}  // namespace takt::flexcam
