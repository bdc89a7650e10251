// Homing in the given order (PP-04).
#include <algorithm>

#include "takt/group/members.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

constexpr std::uint32_t kLastPlace = 12;

std::uint32_t PlaceInOrder(const Context& c, const group::State& g, const State& s, std::size_t k) {
  const std::size_t real = g.members[k] != 0 ? RealOf(c, g, k) : kRealAxes;
  return real < kRealAxes ? s.settings.homing_order[real] : 0;
}

const axis::HomingParams* OwnHoming(const Context& c, const group::State& g, std::size_t k) {
  const std::string& name = c.group.axes.params[g.members[k] - 1].name;
  const auto found = std::ranges::find(c.params.homing, name, &AxisHoming::axis);
  return found != c.params.homing.end() ? &found->homing : nullptr;
}

// Starts homing of the axes with this place in the order; returns an error if one cannot home.
ErrorId BeginPlace(const Context& c, std::uint32_t place, const group::State& g, const State& s) {
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    if (PlaceInOrder(c, g, s, k) != place) continue;
    const axis::Context of_axis = group::ContextOf(c.group, g, k);
    const axis::HomingParams before = of_axis.params.homing;
    // Copied by the command: afterwards the axis' own parameters are restored.
    if (const axis::HomingParams* own = OwnHoming(c, g, k); own && s.settings.home_by_module) {
      of_axis.params.homing = *own;
    }
    const ErrorId error = group::Tell(c.group, g, k, axis::Home{.position = s.settings.home_position[RealOf(c, g, k)]});
    of_axis.params.homing = before;
    if (error != ErrorId::kNone) return error;
  }
  return ErrorId::kNone;
}

bool IsLooking(const axis::State& member) {
  return member.plc == axis::PlcState::kHoming || member.active.kind != axis::RequestKind::kNone;
}

}  // namespace

void BeginHoming(const Context& c, Ticket ticket, group::State& g, State& s) noexcept {
  ErrorId error = ErrorId::kNone;
  if (s.state != PickPlaceState::kReady || StopIsAsked(s) || s.hold.held) error = ErrorId::kState;
  if (!IsOn(c, g)) error = WhyOff(c, g);
  if (error == ErrorId::kNone && !IsFree(c, g)) error = ErrorId::kState;
  if (error != ErrorId::kNone) {
    s.warning = error;
    return Report(c, ticket, FeedbackState::kError, error);
  }
  Report(c, ticket, FeedbackState::kActive);
  s.homing = {ticket, 0};
  s.done = false;
  s.at_known = false;
  s.parked_at = 0;
  s.warning = ErrorId::kNone;
  Enter(PickPlaceState::kHoming, s);
}

void EndHoming(const Context& c, FeedbackState feedback, ErrorId error, group::State& g, State& s) noexcept {
  if (s.state != PickPlaceState::kHoming) return;
  Report(c, s.homing.ticket, feedback, error);
  s.homing = {};
  s.done = feedback == FeedbackState::kDone;
  if (feedback == FeedbackState::kDone) return;
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    if (g.members[k] != 0 && IsLooking(group::MemberOf(c.group, g, k))) group::Tell(c.group, g, k, axis::Stop{});
  }
}

void InHoming(const Context& c, group::State& g, State& s) noexcept {
  // Another command has stopped the group, switched it off, taken it away or moves it.
  if (g.state != group::GroupState::kStandby || g.task != group::Task::kNone || !IsOn(c, g)) {
    const bool off = !group::AllMembers(c.group, g, [](const axis::State& m) { return m.loop_closed; });
    EndHoming(c, FeedbackState::kAborted, off ? ErrorId::kPowerOff : ErrorId::kNone, g, s);
    return Enter(PickPlaceState::kReady, s);
  }
  if (!group::AllMembers(c.group, g, [](const axis::State& m) { return !IsLooking(m); })) return;
  for (std::size_t k = 0; k < group::kMaxAxes && s.homing.place > 0; ++k) {
    if (PlaceInOrder(c, g, s, k) != s.homing.place || group::MemberOf(c.group, g, k).homing.homed) continue;
    return Fail(c, ErrorId::kNoReference, g, s);
  }
  while (s.homing.place < kLastPlace) {
    ++s.homing.place;
    if (const ErrorId error = BeginPlace(c, s.homing.place, g, s); error != ErrorId::kNone) return Fail(c, error, g, s);
    // Axes with direct homing also count as homing until their next step.
    if (!group::AllMembers(c.group, g, [](const axis::State& m) { return !IsLooking(m); })) return;
  }
  EndHoming(c, FeedbackState::kDone, ErrorId::kNone, g, s);
  Enter(PickPlaceState::kReady, s);
}

}  // namespace takt::pickplace
