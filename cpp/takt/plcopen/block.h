// The interface rules that all function blocks with Execute keep (AX-11). A block is called once a cycle.
//
// Inputs count on the rising edge of Execute, and keep their values from call to call. While Execute is true, exactly
// one of Busy, Done, CommandAborted and Error is. Active is as Busy, but for a command that may have to wait, where it
// says that the command is in control. Done, CommandAborted and Error are cleared with the falling edge of Execute, but
// are seen in one call at least. A new rising edge before the end starts the command again; of the one before nothing
// more is heard. Velocity, acceleration, deceleration and jerk are never negative; the engine refuses them, which shows
// one cycle later.
#pragma once

#include <type_traits>

#include "takt/axis/commands.h"
#include "takt/group/commands.h"
#include "takt/plcopen/feedback.h"
#include "takt/plcopen/program.h"

namespace takt::plcopen {

// What is the same whatever the command.
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
  // A command that never ends by itself has what it was given for: InVelocity and the like. Cleared with Execute.
  bool Reached() const noexcept { return reached_; }
  // What the command was to read or capture, once done.
  double Value() const noexcept { return Done() ? feedback_.value() : 0; }
  // The same however it ended.
  double ValueAtEnd() const noexcept { return IsFinal(end_shown_) ? feedback_.value() : 0; }

 protected:
  explicit ExecuteBlock(Program& program) : feedback_(program) {}

  // How a command ended; kBusy: it has not.
  struct End {
    FeedbackState state = FeedbackState::kBusy;
    ErrorId error = ErrorId::kNone;
  };

  // One call has these parts, in this order. True: a rising edge, so the command is to be given.
  bool Rises() noexcept;
  void Start(std::uint32_t target, const engine::CommandBody& body, bool may_wait) noexcept;
  void Show() noexcept { Show(EndOf(feedback_)); }
  void Show(End end) noexcept;

  static End EndOf(const Feedback& feedback) noexcept;
  Feedback& feedback() noexcept { return feedback_; }
  // The command was accepted, does not wait any more, and has not ended.
  bool CommandInControl() const noexcept { return feedback_.active() || (feedback_.busy() && !may_wait_); }
  // Reached once, whatever Execute does.
  bool EverReached() const noexcept { return busy_ && feedback_.reached(); }

 private:
  // Whether an output that Execute clears is to be shown: while it is true, and in one call at least.
  bool IsDue(bool& seen) const noexcept;

  Feedback feedback_;
  End end_;                // of the command
  bool edge_ = false;      // Execute in this call
  bool may_wait_ = false;  // the command; else it is in control from the first moment on
  bool end_seen_ = false;  // outputs that were shown for this command
  bool reached_seen_ = false;
  bool busy_ = false;  // outputs
  bool active_ = false;
  bool reached_ = false;
  FeedbackState end_shown_ = FeedbackState::kBusy;
  ErrorId end_error_ = ErrorId::kNone;
};

// Of an axis or a group.
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

// The block of a command: the command's own fields are its inputs. `Base` is the block of what it is given to, `Kind`
// the commands of that.
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
  // As another command, that carries on with its own.
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

// Of a command of axes.
template <typename C>
class Block : public CommandBlock<AxisBlock, axis::Command, C> {
 public:
  using CommandBlock<AxisBlock, axis::Command, C>::CommandBlock;
};

// Of a command whose inputs may change while Execute is true (AX-111): with ContinuousUpdate true at the rising edge
// each change is commanded, once the command is in control, and the motion goes on from where it is. A change that is
// refused is an error of the block; the motion goes on as it did.
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
  // The inputs of the command in progress.
  const C& given() const noexcept { return given_; }

 private:
  void Change(C wanted) noexcept {
    if constexpr (requires { wanted.buffer_mode; }) wanted.buffer_mode = axis::BufferMode::kAborting;
    if constexpr (std::is_same_v<C, axis::MoveRelative> || std::is_same_v<C, axis::MoveAdditive>) {
      // The distance counts from where the move began: what it has more now is added to where that ends.
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
