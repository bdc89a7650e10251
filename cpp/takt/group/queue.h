// The moves that wait, and those being gone.
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

// False: there is no room.
bool Push(const Request& move, State& s) noexcept;
// The oldest one is over.
void Pop(const Context& c, FeedbackState feedback, ErrorId error, State& s, std::uint32_t element = 0) noexcept;
// A move ends with an error before it began, and those behind it are aborted. `element` of a path, from 1; 0: no path.
void RefuseFrom(const Context& c, std::uint64_t move, ErrorId error, std::uint32_t element, State& s) noexcept;
// Those behind a move are aborted.
void AbortBehind(const Context& c, std::uint64_t move, State& s) noexcept;
// All are, the first with an error if there is one.
void AbortMoves(const Context& c, ErrorId error, State& s) noexcept;

}  // namespace takt::group
