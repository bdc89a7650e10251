// Commands to a module: inputs and settings are changed, changes of cam queued, or refused.
#include <algorithm>

#include "takt/axis/axis.h"
#include "takt/core/describe.h"
#include "takt/core/in_range.h"
#include "takt/flexcam/run.h"

namespace takt::flexcam {

namespace {

// Returns the action that a change of inputs requests. A level that is set already requests nothing: it needs a new
// edge.
Action AskedBy(const Control& command, const Inputs& was, const State& s) {
  if (command.sync_cam) {
    if (*command.sync_cam != was.sync_cam) return *command.sync_cam ? Action::kSyncIn : Action::kSyncOut;
    if (*command.sync_cam && s.state != ModuleState::kSync) return Action::kSyncIn;  // will be refused
  }
  return command.home_execute.value_or(false) && !was.home_execute ? Action::kHome : Action::kNone;
}

// Adds the levels that rise with this command to those that rose earlier in this cycle.
void Note(const Inputs& was, const Inputs& now, Inputs& rose) {
  rose.enable |= now.enable && !was.enable;
  rose.reset_error |= now.reset_error && !was.reset_error;
  rose.regulator_on |= now.regulator_on && !was.regulator_on;
  rose.stop |= now.stop && !was.stop;
  rose.halt |= now.halt && !was.halt;
  rose.enable_hw_limit |= now.enable_hw_limit && !was.enable_hw_limit;
  rose.hw_limit_positive |= now.hw_limit_positive && !was.hw_limit_positive;
  rose.hw_limit_negative |= now.hw_limit_negative && !was.hw_limit_negative;
  rose.sync_out_instant |= now.sync_out_instant && !was.sync_out_instant;
}

// Returns true if a cam that the sequence runs is missing.
bool LacksCam(const State& s, SequenceMode mode) {
  for (const SequencePart part : {SequencePart::kIn, SequencePart::kOut}) {
    for (const SequenceStep& step : StepsOf(mode, part)) {
      if (s.slots[step.slot - 1] == 0) return true;
    }
  }
  return false;
}

bool WithMaster(const State& s) {
  return s.settings.position_control == PositionControl::kMasterDirection;
}

// A command is notified of the end of a ramp only if there is one: the slave follows, and the mode is that of a ramp.
bool Ramps(const State& s, OffsetMode mode) {
  return mode == OffsetMode::kRampIn || (WithMaster(s) && mode == OffsetMode::kDirect);
}
bool Ramps(const State& s, ScalingMode mode) {
  const bool ramp = mode == ScalingMode::kRampAbsolute || mode == ScalingMode::kRampRelative;
  return ramp || (WithMaster(s) && mode == ScalingMode::kAbsolute);
}

void Adjust(const Context& c, Ticket ticket, Adjustment what, State& s) {
  Ticket& mine = s.adjusting[static_cast<std::size_t>(what)];
  const Ticket before = mine;
  mine = ticket;
  if (before == 0 || before == ticket) return;
  for (Ticket& other : s.adjusting) {
    if (other == before) other = 0;
  }
  Report(c, before, FeedbackState::kAborted);
}

// Returns true if the command is done only at the end of a ramp.
bool BeginAdjustments(const Context& c, Ticket ticket, const Inputs& was, State& s) {
  if (s.state != ModuleState::kSync || !IsCoupled(s.clutch)) return false;
  const Inputs& now = s.inputs;
  const Settings& set = s.settings;
  bool any = false;
  const auto look = [&](bool changed, bool ramps, Adjustment what) {
    if (!changed) return;
    Adjust(c, ramps ? ticket : 0, what, s);
    any |= ramps;
  };
  look(now.offset_master != was.offset_master, Ramps(s, set.offset_mode_master), Adjustment::kOffsetMaster);
  look(now.offset_slave != was.offset_slave, Ramps(s, set.offset_mode_slave), Adjustment::kOffsetSlave);
  look(now.scaling_master != was.scaling_master, Ramps(s, set.scaling_mode_master), Adjustment::kScalingMaster);
  look(now.scaling_slave != was.scaling_slave, Ramps(s, set.scaling_mode_slave), Adjustment::kScalingSlave);
  return any;
}

ErrorId MayControl(const Control& command, const State& s) {
  if (command.cam_table && s.slots[*command.cam_table - 1] == 0) return ErrorId::kUnknownTarget;
  const bool sequence = command.cam_sequencer.value_or(false) && !s.inputs.cam_sequencer;
  if (sequence && LacksCam(s, s.settings.cam_sequence_mode)) return ErrorId::kEmptySlot;
  // The slave would have to move back to the zero of its cam.
  const bool to_nothing = command.scaling_slave == 0.0 && s.inputs.scaling_slave != 0;
  if (to_nothing && WithMaster(s)) return ErrorId::kWouldReverse;
  return ErrorId::kNone;
}

void CarryOut(const Context& c, Ticket ticket, double, const Control& command, axis::State&, State& s) {
  if (const ErrorId error = MayControl(command, s); error != ErrorId::kNone) {
    s.warning = error;
    return Report(c, ticket, FeedbackState::kError, error);
  }
  const Inputs was = s.inputs;
  ApplyPatch(command, s.inputs);
  Note(was, s.inputs, s.rose);
  s.instant |= s.inputs.cam_change_instant && !was.cam_change_instant && s.state == ModuleState::kSync;
  Report(c, ticket, FeedbackState::kActive);
  const bool ramps = BeginAdjustments(c, ticket, was, s);
  const Action asked = AskedBy(command, was, s);
  const bool no_edge = asked == Action::kSyncIn && was.sync_cam;
  if (no_edge) {
    s.warning = ErrorId::kState;
    return Report(c, ticket, FeedbackState::kError, ErrorId::kState);
  }
  const bool nothing_to_open = asked == Action::kSyncOut && s.state != ModuleState::kSync;
  if (asked == Action::kSyncOut && s.request == Action::kSyncIn) {  // both edges within one cycle
    Report(c, s.request_ticket, FeedbackState::kAborted);
    s.request = Action::kNone;
  }
  if (asked == Action::kNone || nothing_to_open) {
    if (!ramps) Report(c, ticket, FeedbackState::kDone);
    return;
  }
  for (Ticket& adjusting : s.adjusting) {
    if (adjusting == ticket) adjusting = 0;  // the command ends with the clutch or with homing
  }
  const bool of_clutch = s.request == Action::kSyncIn || s.request == Action::kSyncOut;
  if (asked == Action::kHome && of_clutch) {  // it would be refused, and the other request lost
    s.warning = ErrorId::kState;
    return Report(c, ticket, FeedbackState::kError, ErrorId::kState);
  }
  if (s.request != Action::kNone) Report(c, s.request_ticket, FeedbackState::kAborted);
  s.request = asked;
  s.request_ticket = ticket;
}

void CarryOut(const Context& c, Ticket ticket, double, const Configure& command, axis::State&, State& s) {
  if (command.cam_sequence_mode && s.inputs.cam_sequencer && LacksCam(s, *command.cam_sequence_mode)) {
    s.warning = ErrorId::kEmptySlot;
    return Report(c, ticket, FeedbackState::kError, ErrorId::kEmptySlot);
  }
  if (command.position_control == PositionControl::kMasterDirection && s.inputs.scaling_slave == 0) {
    s.warning = ErrorId::kWouldReverse;
    return Report(c, ticket, FeedbackState::kError, ErrorId::kWouldReverse);
  }
  ApplyPatch(command, s.settings);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
}

void CarryOut(const Context& c, Ticket ticket, double lease_s, const Jog& command, axis::State& slave, State& s) {
  const bool held = command.positive || command.negative;
  const bool jogs = s.state == ModuleState::kJogPos || s.state == ModuleState::kJogNeg;
  const bool opposite = s.jog.ticket == 0 && command.positive && command.negative;
  ErrorId error = ErrorId::kNone;
  if (s.state != ModuleState::kReady && !jogs) error = ErrorId::kState;
  if (opposite) error = ErrorId::kParameter;  // the first key is unknown
  if (!IsOn(slave)) error = ErrorId::kPowerOff;
  if (held && error != ErrorId::kNone) return Report(c, ticket, FeedbackState::kError, error);
  Report(c, ticket, FeedbackState::kActive);
  if (s.jog.ticket != 0) Report(c, s.jog.ticket, FeedbackState::kAborted);
  s.jog = {ticket, command, lease_s, CycleIn(c.slave.cycle, lease_s)};
  if (!held && !jogs) EndJog(c, FeedbackState::kDone, ErrorId::kNone, s);
}

void CarryOut(const Context& c, Ticket ticket, double, const SetCam& command, axis::State&, State& s) {
  const std::optional<std::uint32_t> index = cam::Find(c.slave.machine.cams, command.cam.view());
  if (!index) return Report(c, ticket, FeedbackState::kError, ErrorId::kUnknownTarget);
  s.slots[command.slot - 1] = *index + 1;
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
}

void CarryOut(const Context& c, Ticket ticket, double, const ChangeCam& command, axis::State&, State& s) {
  const bool empty = s.slots[command.cam_table - 1] == 0;
  ErrorId error = ErrorId::kNone;
  if (empty) error = ErrorId::kUnknownTarget;
  // A sequence selects the next cam itself.
  if (s.state != ModuleState::kSync || s.inputs.cam_sequencer) error = ErrorId::kState;
  if (error == ErrorId::kNone && !Enqueue(ticket, command, s)) error = ErrorId::kBufferFull;
  Report(c, ticket, error == ErrorId::kNone ? FeedbackState::kActive : FeedbackState::kError, error);
}

void CarryOut(const Context& c, Ticket ticket, double, const WithdrawChanges&, axis::State&, State& s) {
  AbortChanges(c, s);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
}

}  // namespace

void AbortAdjustments(const Context& c, State& s) noexcept {
  for (std::size_t i = 0; i < kAdjustments; ++i) Adjust(c, 0, static_cast<Adjustment>(i), s);
}

void EndAdjustments(const Context& c, State& s) noexcept {
  for (std::size_t i = 0; i < kAdjustments; ++i) {
    const Ticket ticket = s.adjusting[i];
    const auto what = static_cast<Adjustment>(i);
    if (IsStuck(s, what)) {
      s.warning = ErrorId::kCamOver;
      if (ticket == 0) continue;
      for (Ticket& other : s.adjusting) {
        if (other == ticket) other = 0;
      }
      Report(c, ticket, FeedbackState::kError, ErrorId::kCamOver);
      continue;
    }
    if (ticket == 0 || !IsSettled(s, what)) continue;
    s.adjusting[i] = 0;
    if (std::ranges::find(s.adjusting, ticket) == s.adjusting.end()) Report(c, ticket, FeedbackState::kDone);
  }
}

void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, axis::State& slave,
           State& s) noexcept {
  const auto carry_out = [&](const auto& body) {
    if (!InRange(body)) return Report(c, ticket, FeedbackState::kError, ErrorId::kParameter);
    CarryOut(c, ticket, lease_s, body, slave, s);
  };
  std::visit(carry_out, command);
}

bool Release(const Context&, Ticket ticket, State& s) noexcept {
  if (ticket == 0 || s.jog.ticket != ticket) return false;
  s.jog.keys = {};
  return true;
}

bool Renew(const Context& c, Ticket ticket, State& s) noexcept {
  if (ticket == 0 || s.jog.ticket != ticket || s.jog.lease_s <= 0) return false;
  s.jog.lease_end_cycle = CycleIn(c.slave.cycle, s.jog.lease_s);
  return true;
}

}  // namespace takt::flexcam
