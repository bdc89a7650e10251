// The states of a command: Busy -> Active -> Done | Aborted | Error, each at most once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "takt/core/describe_fwd.h"
#include "takt/core/object.h"
#include "takt/core/status.h"

namespace takt {

// Identifies a command to an engine, from 1 in the order of acceptance. 0: none (given by the engine itself).
using Ticket = std::uint64_t;

enum class FeedbackState : std::uint8_t {
  kBusy,     // accepted, waits for its turn
  kActive,   // controls its component
  kDone,     // final: completed
  kAborted,  // final: ended by another command or a fault
  kError,    // final: refused or failed, see the error
};

constexpr bool IsFinal(FeedbackState s) {
  return s >= FeedbackState::kDone;
}

// One step of a command's life. `reached` is set when a command that never ends on its own has reached its goal
// (MC_MoveVelocity's InVelocity): the state stays Active.
struct FeedbackEvent {
  Ticket ticket = 0;
  std::uint64_t cycle = 0;
  FeedbackState state = FeedbackState::kBusy;
  bool reached = false;
  ErrorId error = ErrorId::kNone;
  // Result of the command: when done, the value that it read or captured, for movers' moves their duration [s]; when
  // active, the planned duration [s] of its motion (AX-96).
  double value = 0;
  ObjectInfo object{};       // the object that is in the way; none: no object
  std::uint64_t detail = 0;  // of the error, for its message (group/failures.h); 0: none
};

// The events that components report during a cycle. The storage is external and sized so that it cannot overflow in
// normal use; events that do not fit are counted and dropped.
class FeedbackSink {
 public:
  explicit FeedbackSink(std::span<FeedbackEvent> storage) : storage_(storage) {}

  void Report(const FeedbackEvent& event) noexcept {
    if (event.ticket == 0) {
      if (event.state == FeedbackState::kError) own_error_ = event.error;
      return;
    }
    if (size_ < storage_.size()) {
      storage_[size_++] = event;
    } else {
      ++lost_;
    }
  }
  std::span<const FeedbackEvent> events() const noexcept { return storage_.first(size_); }
  std::uint64_t lost() const noexcept { return lost_; }
  void Clear() noexcept { size_ = 0; }
  // Returns and clears the reason why the last command that the engine gave itself (ticket 0) was refused or failed.
  ErrorId TakeOwnError() noexcept { return std::exchange(own_error_, ErrorId::kNone); }

 private:
  std::span<FeedbackEvent> storage_;
  std::size_t size_ = 0;
  std::uint64_t lost_ = 0;
  ErrorId own_error_ = ErrorId::kNone;
};

void describe(Enumeration<FeedbackState>&);
void describe(Description<FeedbackEvent>&);

}  // namespace takt
