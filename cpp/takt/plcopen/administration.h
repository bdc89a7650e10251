// Blocks that switch an axis, clear its faults and change its settings.
#pragma once

#include <optional>

#include "takt/plcopen/block.h"

namespace takt::plcopen {

// Keeps power stage and position loop as the level of Enable says, whoever switched them: gives a command whenever the
// axis is Disabled and Enable true, or the other way round. Status: the loop is closed.
//
// A fault that opened the loop is shown by Error until the axis is reset; then the loop is closed again. Enable true on
// a Disabled axis with a fault leads to ErrorStop. A command that is refused is given again once the axis is in another
// state. After an emergency stop it shows error 3100 until Enable has risen anew: nothing resumes by itself (AX-100).
// One instance an axis: two with different Enable switch it to and fro.
class MC_Power {
 public:
  bool Enable = false;
  bool EnablePositive = true;  // whether the axis may move upwards ...
  bool EnableNegative = true;  // ... and downwards (AX-111)
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
  struct Refusal {  // of a command, and the axis' state then
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
  Feedback feedback_;                                                    // of the command in progress ...
  axis::Power given_;                                                    // ... and that command
  axis::Power taken_{.enable_positive = true, .enable_negative = true};  // the last one that was not refused
  bool level_ = false;                                                   // Enable in the call before
  bool anew_ = false;  // it has risen, and the axis has not been on since
  std::optional<Refusal> refusal_;
  Outputs out_;
};

// Clears the fault of an axis. A reset that another one supersedes follows the axis: it is Busy while the axis still
// brakes, then Done when the fault is cleared, and Error when it is not.
class MC_Reset : public AxisBlock {
 public:
  using AxisBlock::AxisBlock;
  void operator()() noexcept;

 private:
  End EndOfReset() noexcept;
};

// All drives of the machine off and all brakes on at once; faults are cleared, every axis is Disabled, and stays so as
// long as Execute is true, whatever asks for power (AX-100). Done: they all are.
class GT_EStop : public AxisBlock {
 public:
  using AxisBlock::AxisBlock;
  void operator()() noexcept;
  bool Done() const noexcept { return done_; }

 private:
  bool done_ = false;
};

// Keeps the factors of the override as they are at the inputs as long as Enable is true; false, the last ones stay.
// Enabled: they are in force. Several instances an axis: the one whose inputs changed last counts.
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
  bool level_ = false;  // Enable in the call before
};
using MC_SetOverride = OverrideBlock<AxisRef, axis::Command, axis::SetOverride>;

// Switches outputs by the position of the axis as long as Enable is true; the other inputs count when it rises.
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
  bool level_ = false;  // Enable in the call before
};

// Writes a parameter that is a yes or no: 4, 5 or 6. Others are refused, whatever `value` is.
class MC_WriteBoolParameter : public Block<axis::WriteParameter> {
 public:
  using Block::Block;
  bool on = false;
  void operator()() noexcept;
};

}  // namespace takt::plcopen
