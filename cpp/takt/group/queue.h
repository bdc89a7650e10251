// The moves that wait, and the one in execution.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

inline Request& MoveAt(State& s, std::uint64_t number) noexcept {
  return s.queue.moves[(s.queue.first + static_cast<std::uint32_t>(number - s.done)) % kQueue];
}
inline const Request& MoveAt(const State& s, std::uint64_t number) noexcept {
  return s.queue.moves[(s.queue.first + static_cast<std::uint32_t>(number - s.done)) % kQueue];
}

void Report(const Context& c, Ticket ticket, FeedbackState feedback, ErrorId error = ErrorId::kNone,
            double value = 0) noexcept;

// Returns false if the queue is full.
bool Push(const Request& move, State& s) noexcept;
// Removes the oldest move and reports it.
void Pop(const Context& c, FeedbackState feedback, ErrorId error, State& s, std::uint32_t element = 0) noexcept;
// Ends a move with an error before it has begun, and aborts those after it. `element` of a path, from 1; 0: no path.
void RefuseFrom(const Context& c, std::uint64_t move, ErrorId error, std::uint32_t element, State& s) noexcept;
// Aborts the moves after `move`.
void AbortBehind(const Context& c, std::uint64_t move, State& s) noexcept;
// Aborts all moves; the first one with `error` if that is not kNone.
void AbortMoves(const Context& c, ErrorId error, State& s) noexcept;

}  // namespace takt::group
