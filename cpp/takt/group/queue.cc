#include "takt/group/queue.h"

#include <utility>

namespace takt::group {

void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error, double value) noexcept {
  const bool unreachable = error == ErrorId::kUnreachable || error == ErrorId::kSingular;
  // Reported once: later failures have their own causes. Moves without a ticket are reported by their module.
  const std::uint64_t detail = unreachable && ticket != 0 ? std::exchange(c.ahead.failures, 0) : 0;
  const Blame& blame = c.ahead.blame;
  const bool names = error != ErrorId::kNone && error == blame.error && blame.axis != 0;
  const ObjectInfo object = names ? ObjectInfo{ObjectKind::kAxis, blame.axis} : ObjectInfo{};
  c.feedback.Report({ticket, c.cycle.count, feedback, false, error, value, object, detail});
}

bool Push(const Request& move, State& s) noexcept {
  if (s.queue.count == kQueue) return false;
  ++s.queue.count;
  MoveAt(s, s.done + s.queue.count - 1) = move;
  return true;
}

void Pop(const Context& c, FeedbackState feedback, ErrorId error, State& s, std::uint32_t element) noexcept {
  Report(c, MoveAt(s, s.done).ticket, feedback, error, element);
  MoveAt(s, s.done) = {};
  if (feedback != FeedbackState::kDone) s.failed = s.done;
  s.queue.first = (s.queue.first + 1) % kQueue;
  --s.queue.count;
  ++s.done;
}

void AbortBehind(const Context& c, std::uint64_t move, State& s) noexcept {
  for (std::uint64_t i = s.done + s.queue.count; i > move + 1; --i) {
    Report(c, MoveAt(s, i - 1).ticket, FeedbackState::kAborted);
    MoveAt(s, i - 1) = {};
    --s.queue.count;
  }
}

void RefuseFrom(const Context& c, std::uint64_t move, ErrorId error, std::uint32_t element, State& s) noexcept {
  AbortBehind(c, move, s);
  Report(c, MoveAt(s, move).ticket, FeedbackState::kError, error, element);
  MoveAt(s, move) = {};
  --s.queue.count;
}

void AbortMoves(const Context& c, ErrorId error, State& s) noexcept {
  for (bool first = true; s.queue.count > 0; first = false) {
    const bool fails = first && error != ErrorId::kNone;
    Pop(c, fails ? FeedbackState::kError : FeedbackState::kAborted, fails ? error : ErrorId::kNone, s);
  }
}

}  // namespace takt::group
