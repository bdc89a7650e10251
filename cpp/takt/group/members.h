// A group and its members: membership, commands to them, and their faults.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

void Enter(GroupState to, State& s) noexcept;

// Ends what the group does besides moves, and reports its command unless that has been done.
void EndTask(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;

axis::State& MemberOf(const Context& c, const State& s, std::size_t place) noexcept;
axis::Context ContextOf(const Context& c, const State& s, std::size_t place) noexcept;

// Gives a member a command. Returns the error if it was refused.
ErrorId Tell(const Context& c, const State& s, std::size_t place, const axis::Command& command) noexcept;
// Returns the error that the member would report; changes nothing.
ErrorId Try(const Context& c, const State& s, std::size_t place, const axis::Command& command) noexcept;
// Tell for all members; all get the command. Returns the first error.
ErrorId CommandAll(const Context& c, const State& s, const axis::Command& command) noexcept;

// Switches off all members and the gantry axes that follow them (AX-101). Returns the first error of a member.
ErrorId SwitchOffAll(const Context& c, const State& s) noexcept;

template <typename Test>
bool AllMembers(const Context& c, const State& s, const Test& test) noexcept {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] != 0 && !test(MemberOf(c, s, k))) return false;
  }
  return true;
}

// Returns true if all members are at their demands: in sync, or within max(1e-3 u, TrackingParams::tolerance).
bool AreAtDemand(const Context& c, const State& s) noexcept;

ErrorId Add(const Context& c, const AddAxis& command, State& s) noexcept;
ErrorId Remove(const Context& c, const RemoveAxis& command, State& s) noexcept;
ErrorId Ungroup(const Context& c, State& s) noexcept;

// Returns the error if a member is in ErrorStop, or no longer guided although the group guides its members, and sets
// LookAhead::blame to its axis; kNone if there is no fault.
ErrorId FaultOfMembers(const Context& c, const State& s) noexcept;

}  // namespace takt::group
