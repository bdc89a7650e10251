#include "takt/group/members.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/guidance.h"
#include "takt/group/queue.h"
#include "takt/group/systems.h"

namespace takt::group {

namespace {

constexpr double kSame = 1e-3;  // [u]

}  // namespace

void Enter(GroupState to, State& s) noexcept {
  if (!IsLegal(s.state, to)) ++s.illegal_transitions;
  s.state = to;
}

void EndTask(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  const bool stopped = s.task == Task::kStop && s.stop_reported;
  if (s.task != Task::kNone && !stopped) Report(c, s.ticket, feedback, error);
  s.task = Task::kNone;
  s.ticket = 0;
}

axis::State& MemberOf(const Context& c, const State& s, std::size_t place) noexcept {
  return c.axes.states[s.members[place] - 1];
}

axis::Context ContextOf(const Context& c, const State& s, std::size_t place) noexcept {
  return c.axes.Of(s.members[place] - 1);
}

ErrorId Tell(const Context& c, const State& s, std::size_t place, const axis::Command& command) noexcept {
  c.feedback.TakeOwnError();
  axis::Apply(ContextOf(c, s, place), 0, 0, command, MemberOf(c, s, place));
  return c.feedback.TakeOwnError();
}

ErrorId Try(const Context& c, const State& s, std::size_t place, const axis::Command& command) noexcept {
  axis::State copy = MemberOf(c, s, place);
  c.feedback.TakeOwnError();
  axis::Apply(ContextOf(c, s, place), 0, 0, command, copy);
  return c.feedback.TakeOwnError();
}

bool AreAtDemand(const Context& c, const State& s) noexcept {
  const double same = std::max(kSame, c.params.tracking.tolerance), period = c.cycle.period_s;
  return AllMembers(c, s, [&](const axis::State& member) {
    // Before the members have moved in this cycle they are at their demands of the previous one.
    const KinematicState& demand = member.guidance.demand;
    const double lag = demand.position - member.origin - member.setpoint.position;
    const double moved = period * (demand.velocity - 0.5 * period * demand.acceleration);
    return member.guidance.chase.in_step || std::min(std::abs(lag), std::abs(lag - moved)) <= same;
  });
}

ErrorId CommandAll(const Context& c, const State& s, const axis::Command& command) noexcept {
  ErrorId first = ErrorId::kNone;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const ErrorId error = Tell(c, s, k, command);
    if (first == ErrorId::kNone) first = error;
  }
  return first;
}

ErrorId SwitchOffAll(const Context& c, const State& s) noexcept {
  const axis::Power off{.enable = false};
  const ErrorId error = CommandAll(c, s, off);
  for (std::size_t i = 0; i < c.axes.states.size(); ++i) {
    if (!c.axes.params[i].follows) continue;
    const axis::Context follower = c.axes.Of(i);
    const bool follows_us = !AllMembers(c, s, [&](const axis::State& member) { return &member != follower.master; });
    if (follows_us) axis::Apply(follower, 0, 0, off, c.axes.states[i]);
  }
  return error;
}

ErrorId Add(const Context& c, const AddAxis& command, State& s) noexcept {
  const std::uint32_t axis = axis::FindAxis(c.axes.params, command.axis.view());
  if (axis == axis::kNoAxis) return ErrorId::kUnknownTarget;
  if (c.axes.params[axis].follows) return ErrorId::kState;
  if (c.group_of[axis] == c.number) return ErrorId::kGroupMember;
  if (c.group_of[axis] != 0) return ErrorId::kOtherGroupMember;
  const axis::PlcState plc = c.axes.states[axis].plc;
  if (plc != axis::PlcState::kDisabled && plc != axis::PlcState::kStandstill) return ErrorId::kState;
  if (command.ident > kMaxAxes || s.members[command.ident - 1] != 0) return ErrorId::kGroupFull;
  s.members[command.ident - 1] = axis + 1;
  c.group_of[axis] = c.number;
  return ErrorId::kNone;
}

ErrorId Remove(const Context& c, const RemoveAxis& command, State& s) noexcept {
  std::uint32_t& member = s.members[command.ident - 1];
  if (member == 0) return CountOf(s) == 0 ? ErrorId::kGroupEmpty : ErrorId::kNotGroupMember;
  c.group_of[member - 1] = 0;
  member = 0;
  return ErrorId::kNone;
}

ErrorId Ungroup(const Context& c, State& s) noexcept {
  if (CountOf(s) == 0) return ErrorId::kGroupEmpty;
  for (std::uint32_t& member : s.members) {
    if (member != 0) c.group_of[member - 1] = 0;
    member = 0;
  }
  return ErrorId::kNone;
}

ErrorId FaultOfMembers(const Context& c, const State& s) noexcept {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const axis::State& member = MemberOf(c, s, k);
    if (member.plc == axis::PlcState::kErrorStop) {
      const ErrorId error = member.error == ErrorId::kDeviation ? ErrorId::kGroupDeviation : member.error;
      const bool of_follower = member.error == ErrorId::kAxisFault && member.fault_of != axis::kNoAxis;
      c.ahead.blame = {error, of_follower ? member.fault_of + 1 : s.members[k]};
      return error;
    }
    if (s.guides && !axis::IsGuided(member)) {
      c.ahead.blame = {ErrorId::kPowerOff, s.members[k]};
      return ErrorId::kPowerOff;
    }
  }
  return ErrorId::kNone;
}

}  // namespace takt::group
