// Jog of one axis at a time (PP-03): a long move of the group that is stopped when the key is released.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "takt/core/angle.h"
#include "takt/group/jog.h"
#include "takt/group/systems.h"
#include "takt/kinematics/solutions.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

using group::CoordinateSystem;

constexpr double kFarthest = 16'384;  // [mm] or [u]
constexpr double kWidest = 170;       // [deg]: beyond half a turn the motion would take the opposite sense
constexpr double kUprightest = 89.9;  // [deg] of B
constexpr double kShort = 1e-3;       // margin to the end of what can be reached
constexpr double kOfTurn = 0.1;       // share of a requested turn

struct Ramps {
  double velocity, acceleration, deceleration, jerk;
};

Ramps RampsOf(const State& s) {
  const Settings& p = s.settings;
  if (s.jog_axis <= SelectAxis::kZ) {
    return {p.cartesian_jog_velocity, p.cartesian_jog_acceleration, p.cartesian_jog_deceleration, p.cartesian_jog_jerk};
  }
  if (s.jog_axis <= SelectAxis::kC) {
    return {p.orientation_jog_velocity, p.orientation_jog_acceleration, p.orientation_jog_deceleration,
            p.orientation_jog_jerk};
  }
  return {p.real_axis_jog_velocity, p.real_axis_jog_acceleration, p.real_axis_jog_deceleration, p.real_axis_jog_jerk};
}

// Returns the SW limits that the axes would violate with the tool there; none if the tool cannot be there at all.
group::Directions EndsAt(const Context& c, const group::State& g, const kinematics::Frame& tool,
                         const kinematics::Joints& near) {
  const kinematics::Solutions all =
      kinematics::SolutionsOf(*c.group.kinematics, tool * c.group.mounting.tool_inverse, {}, near);
  kinematics::Joints joints = near;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.count; ++i) {
    double way = 0;
    for (std::size_t k = 0; k < c.group.kinematics->count; ++k) way += std::abs(all.of[i][k] - near[k]);
    if (way >= least) continue;
    least = way;
    std::copy_n(all.of[i].begin(), c.group.kinematics->count, joints.begin());
  }
  return all.count > 0 ? BeyondRanges(c, g, joints) : group::Directions{};
}

double& NumberOf(kinematics::Pose& pose, SelectAxis axis) {
  double* const numbers[] = {&pose.x, &pose.y, &pose.z, &pose.a, &pose.b, &pose.c};
  return *numbers[static_cast<std::size_t>(axis) - 1];
}

// Returns a move of the tool along or about an axis of the MCS.
group::MoveLinearAbsolute ToolMove(const Context& c, const group::State& g, double& way, State& s) {
  const group::End present = group::Present(c.group, g);
  const kinematics::Pose from = kinematics::ToPose(present.tool);
  const auto at = [&](double way) {
    kinematics::Pose pose = from;
    NumberOf(pose, s.jog_axis) += s.jog_sense * way;
    return pose;
  };
  const auto may = [&](double way) {
    kinematics::Joints joints = present.joints;
    const kinematics::Frame tool = kinematics::ToFrame(at(way));
    if (group::JointsAt(c.group, tool, present.joints, joints) != kinematics::Reason::kNone) return false;
    // Mechanisms without a wrist accept any orientation as their own.
    kinematics::Frame reached;
    const bool turns = s.jog_axis > SelectAxis::kZ;
    if (turns && (group::ToolAt(c.group, joints, reached) != kinematics::Reason::kNone ||
                  !KDL::Equal(reached.M, tool.M, kOfTurn * kDegree * way))) {
      return false;
    }
    return group::WithinRanges(c.group, g, joints);
  };
  double most = s.jog_axis <= SelectAxis::kZ ? kFarthest : kWidest;
  if (s.jog_axis == SelectAxis::kB) most = std::clamp(kUprightest - s.jog_sense * from.b, 0.0, kWidest);
  way = group::Furthest(most, 1, kShort, may);
  s.jog_end = EndsAt(c, g, kinematics::ToFrame(at(way + 3 * kShort)), present.joints);
  const kinematics::Pose to = at(way);
  return {.x = to.x, .y = to.y, .z = to.z, .a = to.a, .b = to.b, .c = to.c};
}

group::MoveLinearAbsolute AxisMove(const Context& c, const group::State& g, std::size_t k, double& way, State& s) {
  const bool up = s.jog_sense > 0;
  const double from = group::PresentJoints(c.group, g)[k];
  double to = from + s.jog_sense * kFarthest;
  const axis::AxisLimits& limits = c.group.axes.params[g.members[k] - 1].limits;
  if (const auto& limit = up ? limits.upper : limits.lower) to = up ? std::min(to, *limit) : std::max(to, *limit);
  if (k < group::InKinematics(c.group, g)) {
    const kinematics::JointRange& range = c.group.kinematics->ranges[k];
    to = up ? std::min(to, range.upper) : std::max(to, range.lower);
  }
  group::MoveLinearAbsolute move;
  move.coordinate_system = CoordinateSystem::kAcs;
  const std::array axes = {&move.a1, &move.a2, &move.a3, &move.a4, &move.a5, &move.a6, &move.a7, &move.a8};
  const bool ends = std::abs(to - from) < kFarthest;
  if (ends) (up ? s.jog_end.positive : s.jog_end.negative) |= 1u << k;
  way = std::max(0.0, s.jog_sense * (to - from) - kShort);
  *axes[k] = from + s.jog_sense * way;
  return move;
}

// Returns the index in the group of the selected real axis; none: kMaxAxes.
std::size_t PlaceOf(const Context& c, const group::State& g, const State& s) {
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    const std::size_t real = g.members[k] != 0 ? RealOf(c, g, k) : kRealAxes;
    if (real < kRealAxes && real + kFirstReal + 1 == static_cast<std::size_t>(s.jog_axis)) return k;
  }
  return group::kMaxAxes;
}

ErrorId GiveMove(const Context& c, group::State& g, State& s) {
  group::MoveLinearAbsolute move;
  double way = 0;
  s.jog_end = {};
  if (s.jog_axis == SelectAxis::kNone) return ErrorId::kParameter;
  if (s.jog_axis <= SelectAxis::kC) {
    if (!group::HasTool(c.group, g)) return ErrorId::kParameter;
    move = ToolMove(c, g, way, s);
  } else {
    const std::size_t k = PlaceOf(c, g, s);
    if (k == group::kMaxAxes) return ErrorId::kNotGroupMember;
    move = AxisMove(c, g, k, way, s);
  }
  if (way <= 0 && !s.jog_end.any()) return ErrorId::kUnreachable;
  const Ramps ramps = RampsOf(s);
  move.velocity = ramps.velocity;
  move.acceleration = ramps.acceleration;
  move.deceleration = ramps.deceleration;
  move.jerk = ramps.jerk;
  return Tell(c, move, g);
}

}  // namespace

void EndJog(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  if (s.jog.ticket != 0) Report(c, s.jog.ticket, feedback, error);
  s.jog = {};
}

namespace {

// Gives the jog's move, from the present place of the tool. Returns false if it is refused; that is reported.
bool BeginMove(const Context& c, group::State& g, State& s) {
  s.jog_axis = s.inputs.select_axis;
  s.jog_released = false;
  if (const ErrorId error = GiveMove(c, g, s); error != ErrorId::kNone) {
    s.warning = error;
    EndJog(c, FeedbackState::kError, error, s);
    return false;
  }
  s.given = g.done + g.queue.count;
  return true;
}

}  // namespace

void BeginJog(const Context& c, group::State& g, State& s) noexcept {
  // A lift ends first: a stop would wait for it.
  if (s.jog.ticket == 0 || s.halting || s.lifting || !IsOn(c, g) || !Stands(c, g)) return;
  if (!s.jog.keys.positive && !s.jog.keys.negative) return EndJog(c, FeedbackState::kDone, ErrorId::kNone, s);
  s.jog_sense = s.jog.keys.positive ? 1 : -1;
  const bool on_path = s.hold.held && g.interrupted;
  if (s.hold.held) LosePath(c, on_path, s);
  s.hold.off |= on_path;
  s.at_known = false;
  s.parked_at = 0;
  if (!BeginMove(c, g, s)) return;
  s.back = s.state;
  Enter(s.jog_sense > 0 ? PickPlaceState::kJogPos : PickPlaceState::kJogNeg, s);
}

void InJog(const Context& c, group::State& g, State& s) noexcept {
  const Ramps ramps = RampsOf(s);
  const bool held = s.jog_sense > 0 ? s.jog.keys.positive : s.jog.keys.negative;
  const bool any = s.jog.keys.positive || s.jog.keys.negative;
  const bool refused = s.given > g.done + g.queue.count;
  if (!held && !s.halting && !IsFree(c, g)) {
    const group::Halt halt{.deceleration = ramps.deceleration, .jerk = ramps.jerk};
    s.halting = s.jog_released = Tell(c, halt, g) == ErrorId::kNone;
    s.given = 0;
  }
  if (g.ends && !s.halting && g.reason == kinematics::Reason::kNone) {  // another command has stopped it
    EndJog(c, FeedbackState::kAborted, ErrorId::kNone, s);
    s.given = 0;
    return Enter(s.back, s);
  }
  if (!IsFree(c, g)) return;
  s.halting = false;
  if (held && s.jog_released) {  // the key was pressed again meanwhile
    if (!BeginMove(c, g, s)) Enter(s.back, s);
    return;
  }
  if (held && !refused) {  // it has reached the end of its range
    if (!s.jog_end.any()) s.warning = ErrorId::kUnreachable;
    if (!s.jog_end.any()) return;
    s.given = 0;
    s.error_axes |= AxesOf(c, g, s.jog_end);
    return Fail(c, s.jog_end.positive != 0 ? ErrorId::kModuleSoftLimitPositive : ErrorId::kModuleSoftLimitNegative, g,
                s);
  }
  if (any && !refused) return;
  const ErrorId error = refused ? TroubleOf(g) : ErrorId::kNone;
  if (refused) s.warning = error;
  EndJog(c, refused ? FeedbackState::kError : FeedbackState::kDone, error, s);
  s.given = 0;
  Enter(s.back, s);
}

}  // namespace takt::pickplace
