#include "takt/plcopen/administration.h"

namespace takt::plcopen {

namespace {

bool Brakes(const axis::Outputs& axis) {
  return axis.loop_closed && (axis.set_velocity != 0 || axis.set_acceleration != 0);
}

}  // namespace

void MC_Power::operator()() noexcept {
  const axis::Outputs& axis = axis_.outputs();
  out_ = {};
  TakeEnd();
  if (Enable != level_ || (refusal_ && refusal_->state != axis.state)) refusal_.reset();
  anew_ = Enable && !axis.loop_closed && (anew_ || !level_);
  level_ = Enable;
  if (IsDue()) {
    const bool on = Enable && axis.loop_closed;  // only the directions change
    given_ = {.enable = Enable,
              .buffer_mode = on ? axis::BufferMode::kAborting : buffer_mode,
              .enable_positive = EnablePositive,
              .enable_negative = EnableNegative};
    feedback_.Give(axis_.target(), axis::Command(given_));
    TakeEnd();
  }
  out_.status = axis.loop_closed;
  if (refusal_) out_.error = refusal_->error;
  if (Enable && !axis.loop_closed && axis.state == axis::PlcState::kErrorStop) out_.error = axis.error;
  if (IsHeldOff()) out_.error = ErrorId::kEmergencyStop;
  if (out_.aborted) {
    out_.error = ErrorId::kNone;
  } else if (out_.error == ErrorId::kNone) {
    const bool waits = feedback_.given() && !feedback_.active() && given_.buffer_mode != axis::BufferMode::kAborting;
    out_.busy = feedback_.given() || (Enable && !axis.loop_closed);
    out_.active = out_.busy && !waits;
  }
}

// Takes over the result of a command that has ended since the previous call, for this call.
void MC_Power::TakeEnd() noexcept {
  if (!feedback_.given() || feedback_.busy()) return;
  out_.aborted = feedback_.aborted();
  out_.error = feedback_.error();
  if (!feedback_.failed()) taken_ = given_;
  if (out_.error == ErrorId::kEmergencyStop) anew_ = false;
  const bool hopeless = out_.error == ErrorId::kParameter || !given_.enable;
  const bool refused = feedback_.failed() && out_.error != ErrorId::kQueueFull && hopeless;
  if (given_.enable == Enable && (refused || (out_.aborted && !Enable))) {
    refusal_ = {axis_.outputs().state, out_.error};
  }
  feedback_.Forget();
}

// Returns true after an emergency stop until Enable has requested power again.
bool MC_Power::IsHeldOff() const noexcept {
  return Enable && !anew_ && axis_.outputs().emergency_stopped;
}

// Returns true if the enabled directions are those of the last accepted command.
bool MC_Power::IsPermitted() const noexcept {
  return taken_.enable_positive == EnablePositive && taken_.enable_negative == EnableNegative;
}

bool MC_Power::IsDue() const noexcept {
  if (refusal_ || IsHeldOff()) return false;
  if (feedback_.given()) return given_.enable && !Enable;
  const axis::Outputs& axis = axis_.outputs();
  if (Enable && axis.loop_closed && axis.state != axis::PlcState::kErrorStop && !IsPermitted()) return true;
  const bool disabled = axis.state == axis::PlcState::kDisabled;
  return Enable ? disabled && axis.active_command == 0 : !disabled;
}

void MC_Reset::operator()() noexcept {
  if (Rises()) Start(axis().target(), axis::Command(axis::Reset{}), false);
  Show(feedback().aborted() ? EndOfReset() : EndOf(feedback()));
}

ExecuteBlock::End MC_Reset::EndOfReset() noexcept {
  const axis::Outputs& now = axis().outputs();
  if (now.state != axis::PlcState::kErrorStop && now.error == ErrorId::kNone) return {FeedbackState::kDone};
  return Brakes(now) ? End{} : End{FeedbackState::kError, ErrorId::kAxisFault};
}

void GT_EStop::operator()() noexcept {
  if (Rises()) Start(engine::kMachineTarget, engine::MachineCommand(engine::EmergencyStop{.hold = true}), false);
  if (!Execute) feedback().Release();
  Show();
  done_ = Execute && ExecuteBlock::Done() && axis().program().AllDisabled();
}

void MC_DigitalCamSwitch::operator()() noexcept {
  const bool full = feedback_.failed() && feedback_.error() == ErrorId::kQueueFull;  // then it is tried again
  if (Enable == level_ && !full) return;
  level_ = enable = Enable;
  const axis::Command command = static_cast<const axis::DigitalCamSwitch&>(*this);
  feedback_.Give(axis_.target(), command);
}

void MC_WriteBoolParameter::operator()() noexcept {
  axis::WriteParameter command = *this;
  command.value = on ? 1 : 0;
  if (number < 4 || number > 6) command.number = 0;  // no such parameter
  if (Rises()) StartWith(command);
  Show();
}

}  // namespace takt::plcopen
