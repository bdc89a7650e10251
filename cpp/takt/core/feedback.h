// What becomes of a command: Busy -> Active -> Done | Aborted | Error, once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "takt/core/describe_fwd.h"
#include "takt/core/object.h"
#include "takt/core/status.h"

namespace takt {

// Names one command given to an engine, from 1 on in the order they were accepted. 0: none (given by the engine
// itself).
using Ticket = std::uint64_t;

enum class FeedbackState : std::uint8_t {
  kBusy,     // accepted, waiting for its turn
  kActive,   // in control of its component
  kDone,     // final: reached what it was for
  kAborted,  // final: another command or a fault took over
  kError,    // final: refused or failed, see the error
};

constexpr bool IsFinal(FeedbackState s) {
  return s >= FeedbackState::kDone;
}

// One step of a command's life. `reached` is set when a command that never ends by itself has what it was given for
// (MC_MoveVelocity's InVelocity): the state stays Active.
struct FeedbackEvent {
  Ticket ticket = 0;
  std::uint64_t cycle = 0;
  FeedbackState state = FeedbackState::kBusy;
  bool reached = false;
  ErrorId error = ErrorId::kNone;
  // What the command found out: done: what it was to read or capture, of movers' moves: s that it took; active: s its
  // motion takes as planned (AX-96).
  double value = 0;
  ObjectInfo object{};       // that is in the way; none where nothing is
  std::uint64_t detail = 0;  // of the error, for its sentence (group/failures.h); 0: none
};

// Where components report during a cycle. Storage is given from outside and sized so that it cannot overflow in normal
// use; what does not fit is counted, never written.
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
  // Why the last command that the engine gave itself (ticket 0) was refused or failed; asking forgets it.
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
