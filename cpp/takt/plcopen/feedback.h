// Feedback of the last command that a block gave.
#pragma once

#include <cstdint>

#include "takt/core/feedback.h"
#include "takt/engine/command.h"
#include "takt/plcopen/program.h"

namespace takt::plcopen {

class Feedback {
 public:
  explicit Feedback(Program& program);
  ~Feedback();
  Feedback(const Feedback&) = delete;
  Feedback& operator=(const Feedback&) = delete;

  // Gives a command; the previous one is not reported any more. If the engine has no room, the command is in error at
  // once.
  void Give(std::uint32_t target, const engine::CommandBody& body) noexcept;
  // Releases a level-sensitive command. To be called until released(), as the engine's queue may be full.
  void Release() noexcept;
  // Ignores the command from now on; it continues.
  void Forget() noexcept;

  bool given() const noexcept { return given_; }
  bool answered() const noexcept { return given_ && last_.state != FeedbackState::kBusy; }
  bool busy() const noexcept { return given_ && !IsFinal(last_.state); }
  bool active() const noexcept { return given_ && last_.state == FeedbackState::kActive; }
  bool aborted() const noexcept { return given_ && last_.state == FeedbackState::kAborted; }
  bool failed() const noexcept { return given_ && last_.state == FeedbackState::kError; }
  bool released() const noexcept { return released_; }
  bool reached() const noexcept { return reached_; }
  FeedbackState state() const noexcept { return last_.state; }
  ErrorId error() const noexcept { return last_.error; }
  double value() const noexcept { return last_.value; }

 private:
  friend class Program;
  void Take(const FeedbackEvent& event) noexcept;

  Program& program_;
  FeedbackEvent last_;
  bool given_ = false;
  bool reached_ = false;
  bool released_ = false;
};

}  // namespace takt::plcopen
