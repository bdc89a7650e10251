// Blocks that power an axis, clear its faults and change its settings.
#pragma once

#include <optional>

#include "takt/plcopen/block.h"

namespace takt::plcopen {

// Keeps the power stage and the position loop on or off as Enable says, whatever switched them: gives a command if the
// axis is Disabled while Enable is true, or not Disabled while it is false. Status: the loop is closed.
//
// Error shows a fault that opened the loop until the axis is reset; then the loop is closed again. Enable on a Disabled
// axis with a fault leads to ErrorStop. A rejected power on is given again at the next call; one with a wrong
// parameter, and a rejected power off, only once Enable changes or the axis is in another state. After an emergency
// stop the block shows error 3100 until a new rising edge of Enable: nothing resumes by itself (AX-100). Use one
// instance per axis: two with different Enable switch it on and off alternately.
class MC_Power {
 public:
  bool Enable = false;
  bool EnablePositive = true;  // the axis may move upwards
  bool EnableNegative = true;  // the axis may move downwards (AX-111)
  axis::BufferMode buffer_mode = axis::BufferMode::kAborting;

  explicit MC_Power(AxisRef axis) : axis_(axis), feedback_(axis.program()) {}
  void operator()() noexcept;

  bool Status() const noexcept { return out_.status; }
  bool Valid() const noexcept { return Enable && !Error(); }
  bool Busy() const noexcept { return out_.busy; }
  bool Active() const noexcept { return out_.active; }
  bool CommandAborted() const noexcept { return out_.aborted; }
  bool Aborted() const noexcept { return CommandAborted(); }
  bool Error() const noexcept { return out_.error != ErrorId::kNone; }
  ErrorId ErrorID() const noexcept { return out_.error; }

 private:
  struct Refusal {  // error of a command, and the state of the axis then
    axis::PlcState state;
    ErrorId error;
  };
  struct Outputs {
    bool status = false;
    bool busy = false;
    bool active = false;
    bool aborted = false;
    ErrorId error = ErrorId::kNone;
  };
  bool IsDue() const noexcept;
  bool IsHeldOff() const noexcept;
  bool IsPermitted() const noexcept;
  void TakeEnd() noexcept;

  AxisRef axis_;
  Feedback feedback_;                                                    // of the command in progress
  axis::Power given_;                                                    // the command in progress
  axis::Power taken_{.enable_positive = true, .enable_negative = true};  // the last command that was not rejected
  bool level_ = false;                                                   // Enable in the previous call
  bool anew_ = false;  // Enable has risen, and the axis has not been powered since
  std::optional<Refusal> refusal_;
  Outputs out_;
};

// Clears the fault of an axis. A reset superseded by another one follows the axis: it is Busy while the axis still
// brakes, then Done if the fault was cleared, Error if not.
class MC_Reset : public AxisBlock {
 public:
  using AxisBlock::AxisBlock;
  void operator()() noexcept;

 private:
  End EndOfReset() noexcept;
};

// Switches all drives of the machine off and closes all brakes at once; faults are cleared, and every axis is Disabled
// and stays so while Execute is true, whatever requests power (AX-100). Done: all axes are Disabled.
class GT_EStop : public AxisBlock {
 public:
  using AxisBlock::AxisBlock;
  void operator()() noexcept;
  bool Done() const noexcept { return done_; }

 private:
  bool done_ = false;
};

// Applies the inputs as override factors while Enable is true; when it is false, the last ones stay. Enabled: they are
// in force. With several instances for an axis, the one whose inputs changed last counts.
template <typename Ref, typename Kind, typename Set>
class OverrideBlock {
 public:
  bool Enable = false;
  double VelFactor = 1;
  double AccFactor = 1;
  double JerkFactor = 1;

  explicit OverrideBlock(Ref subject) : subject_(subject), feedback_(subject.program()) {}
  void operator()() noexcept {
    const Set wanted = {VelFactor, AccFactor, JerkFactor};
    const bool full = feedback_.failed() && feedback_.error() == ErrorId::kQueueFull;  // then it is tried again
    const bool due = Enable && (!level_ || wanted != given_ || full);
    level_ = Enable;
    if (!due) return;
    given_ = wanted;
    feedback_.Give(subject_.target(), Kind(wanted));
  }

  bool Enabled() const noexcept { return Enable && feedback_.state() == FeedbackState::kDone; }
  bool Busy() const noexcept { return Enable && !Error(); }
  bool Error() const noexcept { return Enable && feedback_.failed(); }
  ErrorId ErrorID() const noexcept { return Error() ? feedback_.error() : ErrorId::kNone; }

 private:
  Ref subject_;
  Feedback feedback_;
  Set given_;
  bool level_ = false;  // Enable in the previous call
};
using MC_SetOverride = OverrideBlock<AxisRef, axis::Command, axis::SetOverride>;

// Switches outputs by the position of the axis while Enable is true; the other inputs are read when it rises.
class MC_DigitalCamSwitch : private axis::DigitalCamSwitch {
 public:
  using axis::DigitalCamSwitch::enable_mask;
  using axis::DigitalCamSwitch::source;
  using axis::DigitalCamSwitch::switches;
  bool Enable = false;

  explicit MC_DigitalCamSwitch(AxisRef axis) : axis_(axis), feedback_(axis.program()) {}
  void operator()() noexcept;

  bool InOperation() const noexcept { return feedback_.active(); }
  bool Busy() const noexcept { return feedback_.busy(); }
  bool Error() const noexcept { return feedback_.failed(); }
  ErrorId ErrorID() const noexcept { return feedback_.error(); }
  std::uint32_t Outputs() const noexcept { return InOperation() ? axis_.outputs().cam_outputs : 0; }

 private:
  AxisRef axis_;
  Feedback feedback_;
  bool level_ = false;  // Enable in the previous call
};

// Writes a Boolean parameter: 4, 5 or 6. Other numbers are rejected, whatever `value` is.
class MC_WriteBoolParameter : public Block<axis::WriteParameter> {
 public:
  using Block::Block;
  bool on = false;
  void operator()() noexcept;
};

}  // namespace takt::plcopen
