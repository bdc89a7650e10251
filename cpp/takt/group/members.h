// A group and its members: who belongs to it, what they do, what becomes of it in their faults.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

void Enter(GroupState to, State& s) noexcept;

// What is being done besides moves is over: its command is told, if it was not before.
void EndTask(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;

axis::State& MemberOf(const Context& c, const State& s, std::size_t place) noexcept;
axis::Context ContextOf(const Context& c, const State& s, std::size_t place) noexcept;

// Gives a member a command; why it was refused, if it was.
ErrorId Tell(const Context& c, const State& s, std::size_t place, const axis::Command& command) noexcept;
// What the member would answer; nothing changes.
ErrorId Try(const Context& c, const State& s, std::size_t place, const axis::Command& command) noexcept;
// The same for all; the first refusal, the others are told all the same.
ErrorId TellAll(const Context& c, const State& s, const axis::Command& command) noexcept;

// Switches all members off, and what follows them as members of gantries (AX-101). The first refusal, as above.
ErrorId SwitchOffAll(const Context& c, const State& s) noexcept;

template <typename Test>
bool AllMembers(const Context& c, const State& s, const Test& test) noexcept {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] != 0 && !test(MemberOf(c, s, k))) return false;
  }
  return true;
}

// All members are where they are told to be, so far as anybody can see: what is asked of them is within their limits.
bool AreInStep(const Context& c, const State& s) noexcept;

ErrorId Add(const Context& c, const AddAxis& command, State& s) noexcept;
ErrorId Remove(const Context& c, const RemoveAxis& command, State& s) noexcept;
ErrorId Ungroup(const Context& c, State& s) noexcept;

// A member is in ErrorStop, or no longer goes by the group while it should: the error, whose feedback names the axis;
// kNone: all is well.
ErrorId FaultOfMembers(const Context& c, const State& s) noexcept;

}  // namespace takt::group
