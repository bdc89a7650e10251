// The group as a pick and place module sees it.
#include <algorithm>

#include "takt/group/members.h"
#include "takt/group/run.h"
#include "takt/group/systems.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

using group::GroupState;

ErrorId Tell(const Context& c, const group::Command& command, group::State& g) noexcept {
  c.group.feedback.TakeOwnError();
  group::Apply(c.group, 0, 0, command, g);
  return c.group.feedback.TakeOwnError();
}

bool IsOn(const Context& c, const group::State& g) noexcept {
  const bool takes = g.state == GroupState::kStandby || g.state == GroupState::kMoving;
  return takes && group::AllMembers(c.group, g, [](const axis::State& m) { return m.loop_closed; });
}

ErrorId WhyOff(const Context& c, const group::State& g) noexcept {
  if (IsOn(c, g)) return ErrorId::kNone;
  if (!group::AllMembers(c.group, g, [](const axis::State& m) { return m.loop_closed; })) return ErrorId::kPowerOff;
  switch (g.state) {
    case GroupState::kDisabled:
      return ErrorId::kGroupDisabled;
    case GroupState::kStopping:
      return ErrorId::kAxisStopping;
    case GroupState::kErrorStop:
      return ErrorId::kErrorStop;
    default:
      return ErrorId::kState;
  }
}

bool Stands(const Context& c, const group::State& g) noexcept {
  if (!group::AllMembers(c.group, g, axis::AtRest)) return false;
  return !g.begun || (g.interrupted && group::Rests(g));
}

bool IsFree(const Context& c, const group::State& g) noexcept {
  return g.state == GroupState::kStandby && g.queue.count == 0 && g.task == group::Task::kNone && Stands(c, g);
}

void StopAxes(const Context& c, group::State& g, State& s) noexcept {
  s.lifting = s.rises = false;
  if (Tell(c, group::Disable{}, g) == ErrorId::kNone) s.enables = true;
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    if (g.members[k] == 0) continue;
    const axis::State& member = group::MemberOf(c.group, g, k);
    if (!member.loop_closed || member.plc == axis::PlcState::kErrorStop) continue;
    const std::size_t real = RealOf(c, g, k);
    axis::Stop stop;
    if (real < kRealAxes) {
      const trajectory::Limits own = c.group.axes.params[g.members[k] - 1].planner_limits();
      const double jerk = s.settings.stop_jerk[kFirstReal + real];
      stop.deceleration = std::min(s.settings.stop_deceleration[kFirstReal + real], own.deceleration);
      stop.jerk = own.jerk > 0 ? std::min(jerk, own.jerk) : jerk;
    }
    group::Tell(c.group, g, k, stop);
  }
}

bool HasOverride(const group::State& g, const State& s) noexcept {
  return s.inputs.override_factor != 1 || g.velocity_factor != 1 || g.acceleration_factor != 1 || g.jerk_factor != 1;
}

double OverrideOf(const group::State& g) noexcept {
  constexpr double kLeast = 1e-3;
  return std::clamp(std::min({g.velocity_factor, g.acceleration_factor, g.jerk_factor}), kLeast, 1.0);
}

Place PresentPlace(const Context& c, const group::State& g) noexcept {
  const group::End end = group::Present(c.group, g);
  Place place{.pose = kinematics::ToPose(end.tool)};
  if (const std::size_t aux1 = Aux1Of(c, g); aux1 < group::kMaxAxes) place.aux1 = end.joints[aux1];
  return place;
}

Place Levelled(const Context& c, const group::State& g, const Place& place) noexcept {
  const kinematics::Kinematics* kinematics = group::HasTool(c.group, g) ? c.group.kinematics : nullptr;
  if (!kinematics || std::holds_alternative<kinematics::SixAxis>(kinematics->mechanism) ||
      std::holds_alternative<kinematics::Serial>(kinematics->mechanism)) {
    return place;
  }
  const kinematics::Frame system = group::SystemFrame(c.group, g, place.system, place.pcs - 1);
  const kinematics::Pose tool = kinematics::ToPose(system.Inverse() * group::Present(c.group, g).tool);
  Place level = place;
  level.pose.a = tool.a;
  level.pose.b = tool.b;
  return level;
}

std::size_t Aux1Of(const Context& c, const group::State& g) noexcept {
  const std::size_t behind = group::InKinematics(c.group, g);
  return behind > 0 && behind < group::kMaxAxes && g.members[behind] != 0 ? behind : group::kMaxAxes;
}

std::size_t RealOf(const Context& c, const group::State& g, std::size_t place) noexcept {
  if (place == Aux1Of(c, g)) return kRealAxes - 1;
  return place < kRealAxes - 1 && g.members[place] != 0 ? place : kRealAxes;
}

ErrorId TroubleOf(const group::State& g) noexcept {
  const bool closed = g.error == ErrorId::kNone || g.error == ErrorId::kAwayFromLimitOnly;
  if (closed && g.refused.any()) {
    return g.refused.positive != 0 ? ErrorId::kModuleLimitSwitchPositive : ErrorId::kModuleLimitSwitchNegative;
  }
  if (g.error != ErrorId::kNone) return g.error;
  if (g.zone_circle) return ErrorId::kZoneCircle;
  if (g.problem != path::Problem::kNone) return ErrorId::kPathGeometry;
  if (g.answer.trouble != workspace::Trouble::kNone) return ErrorId::kCollision;
  return g.reason == kinematics::Reason::kSingular ? ErrorId::kSingular : ErrorId::kUnreachable;
}

}  // namespace takt::pickplace
