// Commands as they arrive: inputs and settings changed, changes of cam queued, or refused.
#include "takt/axis/axis.h"
#include "takt/core/describe.h"
#include "takt/core/in_range.h"
#include "takt/flexcam/run.h"

namespace takt::flexcam {

namespace {

// What a change of inputs asks for. A level that is there already asks for nothing: it needs a new edge.
Action AskedBy(const Control& command, const Inputs& was, const State& s) {
  if (command.sync_cam) {
    if (*command.sync_cam != was.sync_cam) return *command.sync_cam ? Action::kSyncIn : Action::kSyncOut;
    if (*command.sync_cam && s.state != ModuleState::kSync) return Action::kSyncIn;  // and is refused
  }
  return command.home_execute.value_or(false) && !was.home_execute ? Action::kHome : Action::kNone;
}

void CarryOut(const Context& c, Ticket ticket, double, const Control& command, axis::State&, State& s) {
  if (command.cam_table && s.slots[*command.cam_table - 1] == 0) {
    return Report(c, ticket, FeedbackState::kError, ErrorId::kUnknownTarget);
  }
  const Inputs was = s.inputs;
  TakeGiven(command, s.inputs);
  s.instant |= s.inputs.cam_change_instant && !was.cam_change_instant && s.state == ModuleState::kSync;
  Report(c, ticket, FeedbackState::kActive);
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
  if (asked == Action::kNone || nothing_to_open) return Report(c, ticket, FeedbackState::kDone);
  if (s.request != Action::kNone) Report(c, s.request_ticket, FeedbackState::kAborted);
  s.request = asked;
  s.request_ticket = ticket;
}

void CarryOut(const Context& c, Ticket ticket, double, const Configure& command, axis::State&, State& s) {
  TakeGiven(command, s.settings);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
}

void CarryOut(const Context& c, Ticket ticket, double lease_s, const Jog& command, axis::State& slave, State& s) {
  const bool held = command.positive || command.negative;
  const bool jogs = s.state == ModuleState::kJogPos || s.state == ModuleState::kJogNeg;
  const bool opposite = s.jog.ticket == 0 && command.positive && command.negative;
  ErrorId error = ErrorId::kNone;
  if (s.state != ModuleState::kReady && !jogs) error = ErrorId::kState;
  if (opposite) error = ErrorId::kParameter;  // nobody knows which key was first
  if (!IsOn(slave)) error = ErrorId::kPowerOff;
  if (held && error != ErrorId::kNone) return Report(c, ticket, FeedbackState::kError, error);
  Report(c, ticket, FeedbackState::kActive);
  if (s.jog.ticket != 0) Report(c, s.jog.ticket, FeedbackState::kAborted);
  s.jog = {ticket, command, lease_s, CycleIn(c.slave.cycle, lease_s)};
  if (!held && !jogs) EndJog(c, FeedbackState::kDone, ErrorId::kNone, s);
}

void CarryOut(const Context& c, Ticket ticket, double, const SetCam& command, axis::State&, State& s) {
  for (std::size_t i = 0; i < c.slave.machine.cams.size(); ++i) {
    if (c.slave.machine.cams[i].name() != command.cam.view()) continue;
    s.slots[command.slot - 1] = static_cast<std::uint32_t>(i) + 1;
    Report(c, ticket, FeedbackState::kActive);
    return Report(c, ticket, FeedbackState::kDone);
  }
  Report(c, ticket, FeedbackState::kError, ErrorId::kUnknownTarget);
}

void CarryOut(const Context& c, Ticket ticket, double, const ChangeCam& command, axis::State&, State& s) {
  const bool empty = s.slots[command.cam_table - 1] == 0;
  ErrorId error = ErrorId::kNone;
  if (empty) error = ErrorId::kUnknownTarget;
  // A sequence decides itself what comes next.
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
