// The interface rules of all function blocks with Execute (AX-11). A block is called once per cycle.
//
// Inputs are read at the rising edge of Execute, and keep their values from call to call. While Execute is true,
// exactly one of Busy, Done, CommandAborted and Error is true. Active equals Busy, except for a command that may have
// to wait: then it says that the command is in control. Done, CommandAborted and Error are cleared at the falling edge
// of Execute, but are shown for at least one call. A new rising edge before the end gives the command again; the
// previous one is not reported any more. Velocity, acceleration, deceleration and jerk must not be negative; the engine
// rejects negative ones, which shows one cycle later.
#pragma once

#include <type_traits>

#include "takt/axis/commands.h"
#include "takt/group/commands.h"
#include "takt/plcopen/feedback.h"
#include "takt/plcopen/program.h"

namespace takt::plcopen {

// The part of a block that is the same for all commands.
class ExecuteBlock {
 public:
  bool Execute = false;

  bool Busy() const noexcept { return busy_; }
  bool Active() const noexcept { return active_; }
  bool Done() const noexcept { return end_shown_ == FeedbackState::kDone; }
  bool CommandAborted() const noexcept { return end_shown_ == FeedbackState::kAborted; }
  bool Aborted() const noexcept { return CommandAborted(); }
  bool Error() const noexcept { return end_shown_ == FeedbackState::kError; }
  ErrorId ErrorID() const noexcept { return Error() ? end_error_ : ErrorId::kNone; }
  // True once a command that never ends by itself has reached its goal: InVelocity and the like. Cleared with Execute.
  bool Reached() const noexcept { return reached_; }
  // Returns the value that the command read or captured, once Done; else 0.
  double Value() const noexcept { return Done() ? feedback_.value() : 0; }
  // Returns the value after any end, also an abort or an error; else 0.
  double ValueAtEnd() const noexcept { return IsFinal(end_shown_) ? feedback_.value() : 0; }

 protected:
  explicit ExecuteBlock(Program& program) : feedback_(program) {}

  // The end of a command; kBusy: not ended.
  struct End {
    FeedbackState state = FeedbackState::kBusy;
    ErrorId error = ErrorId::kNone;
  };

  // The parts of a call, in this order. Rises returns true at a rising edge, when the command is to be given.
  bool Rises() noexcept;
  void Start(std::uint32_t target, const engine::CommandBody& body, bool may_wait) noexcept;
  void Show() noexcept { Show(EndOf(feedback_)); }
  void Show(End end) noexcept;

  static End EndOf(const Feedback& feedback) noexcept;
  Feedback& feedback() noexcept { return feedback_; }
  // True if the command was accepted, is not waiting and has not ended.
  bool CommandInControl() const noexcept { return feedback_.active() || (feedback_.busy() && !may_wait_); }
  // True if the goal was reached, whatever Execute is, and the command has not ended.
  bool EverReached() const noexcept { return busy_ && feedback_.reached(); }

 private:
  // Returns true if an output that Execute clears is to be shown: while Execute is true, and for at least one call.
  bool IsDue(bool& seen) const noexcept;

  Feedback feedback_;
  End end_;                // of the command
  bool edge_ = false;      // Execute in this call
  bool may_wait_ = false;  // the command may have to wait; else it is in control at once
  bool end_seen_ = false;  // the output was shown for this command
  bool reached_seen_ = false;
  bool busy_ = false;  // outputs
  bool active_ = false;
  bool reached_ = false;
  FeedbackState end_shown_ = FeedbackState::kBusy;
  ErrorId end_error_ = ErrorId::kNone;
};

// A block of an axis or a group.
template <typename Ref>
class BlockOf : public ExecuteBlock {
 public:
  explicit BlockOf(Ref subject) : ExecuteBlock(subject.program()), subject_(subject) {}

 protected:
  Ref subject() const noexcept { return subject_; }

 private:
  Ref subject_;
};

class AxisBlock : public BlockOf<AxisRef> {
 public:
  using BlockOf::BlockOf;
  AxisRef axis() const noexcept { return subject(); }
};

// The block of a command: the fields of the command are its inputs. `Base`: the block of the component that gets it;
// `Kind`: the variant of its commands.
template <typename Base, typename Kind, typename C>
class CommandBlock : public Base, public C {
 public:
  using Base::Base;

  void operator()() noexcept {
    if (this->Rises()) StartWith(static_cast<const C&>(*this));
    this->Show();
  }

 protected:
  void StartWith(const C& command) noexcept { StartAs(command); }
  // Gives another command, which continues the block's own.
  template <typename Given>
  void StartAs(const Given& command) noexcept {
    bool may_wait = true;
    if constexpr (requires { command.buffer_mode; }) may_wait = command.buffer_mode != axis::BufferMode::kAborting;
    if constexpr (requires { command.execution_mode; }) {
      may_wait = command.execution_mode != group::ExecutionMode::kImmediately;
    }
    this->Start(this->subject().target(), Kind(command), may_wait);
  }
};

// The block of an axis command.
template <typename C>
class Block : public CommandBlock<AxisBlock, axis::Command, C> {
 public:
  using CommandBlock<AxisBlock, axis::Command, C>::CommandBlock;
};

// The block of a command whose inputs may change while Execute is true (AX-111): if ContinuousUpdate is true at the
// rising edge, each change is commanded once the command is in control, and the motion continues from its present
// state. A rejected change is an error of the block; the motion continues unchanged.
template <typename C>
class UpdatedBlock : public Block<C> {
 public:
  using Block<C>::Block;
  bool ContinuousUpdate = false;

  void operator()() noexcept {
    const C& wanted = *this;
    if (this->Rises()) {
      updates_ = ContinuousUpdate;
      given_ = wanted;
      this->StartWith(wanted);
    } else if (updates_ && this->Execute && this->CommandInControl() && wanted != given_) {
      Change(wanted);
      given_ = wanted;
    }
    this->Show();
  }

 protected:
  // Returns the inputs of the command in progress.
  const C& given() const noexcept { return given_; }

 private:
  void Change(C wanted) noexcept {
    if constexpr (requires { wanted.buffer_mode; }) wanted.buffer_mode = axis::BufferMode::kAborting;
    if constexpr (std::is_same_v<C, axis::MoveRelative> || std::is_same_v<C, axis::MoveAdditive>) {
      // The distance counts from the start of the move: the increase is added to its end.
      this->StartAs(axis::MoveAdditive{wanted.distance - given_.distance, wanted.velocity, wanted.acceleration,
                                       wanted.deceleration, wanted.jerk, wanted.buffer_mode, true});
    } else {
      if constexpr (requires { wanted.update; }) wanted.update = true;
      this->StartWith(wanted);
    }
  }

  C given_{};
  bool updates_ = false;  // ContinuousUpdate at the rising edge
};

}  // namespace takt::plcopen
