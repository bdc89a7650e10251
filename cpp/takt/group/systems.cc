#include "takt/group/systems.h"

#include <algorithm>
#include <cmath>

#include "takt/group/rides.h"
#include "takt/kinematics/solutions.h"

namespace takt::group {

Mounting MakeMounting(const GroupParams& params) {
  const Frame base = kinematics::ToFrame(params.base);
  const Frame tool = kinematics::ToFrame(params.tool);
  return {base, base.Inverse(), tool, tool.Inverse()};
}

std::size_t CountOf(const State& s) noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(s.members, [](std::uint32_t member) { return member != 0; }));
}

std::size_t InKinematics(const Context& c, const State& s) noexcept {
  return HasTool(c, s) ? c.kinematics->count : 0;
}

bool HasTool(const Context& c, const State& s) noexcept {
  if (!c.kinematics || !s.kinematics_on) return false;
  return std::all_of(s.members.begin(), s.members.begin() + static_cast<std::ptrdiff_t>(c.kinematics->count),
                     [](std::uint32_t member) { return member != 0; });
}

Frame SystemFrame(const Context& c, const State& s, CoordinateSystem system, std::uint32_t pcs) noexcept {
  switch (system) {
    case CoordinateSystem::kWcs:
      return c.mounting.base_inverse;
    case CoordinateSystem::kPcs:
      if (s.cargoes[pcs].carrier != 0) return PlaceOf(c, s.cargoes[pcs]).GetFrame();
      return kinematics::ToFrame(s.product_systems[pcs]);
    default:
      return Frame::Identity();
  }
}

kinematics::Reason ToolAt(const Context& c, const kinematics::Joints& joints, Frame& tcp) noexcept {
  Frame flange;
  const kinematics::Reason reason = kinematics::Forward(*c.kinematics, joints, flange);
  if (reason == kinematics::Reason::kNone) tcp = flange * c.mounting.tool;
  return reason;
}

kinematics::Reason JointsAt(const Context& c, const Frame& tcp, const kinematics::Joints& near,
                            kinematics::Joints& joints) noexcept {
  kinematics::Joints found{};
  const Frame flange = tcp * c.mounting.tool_inverse;
  const kinematics::Reason reason = kinematics::Inverse(*c.kinematics, flange, {}, near, found);
  if (reason != kinematics::Reason::kNone) return reason;
  std::copy(near.begin() + static_cast<std::ptrdiff_t>(c.kinematics->count), near.end(),
            found.begin() + static_cast<std::ptrdiff_t>(c.kinematics->count));
  joints = found;
  return reason;
}

namespace {

// Both the SW limits of a member and the range of the kinematics.
kinematics::JointRange RangeOf(const Context& c, const State& s, std::size_t k) {
  const axis::AxisLimits& limits = c.axes.params[s.members[k] - 1].limits;
  const kinematics::JointRange& own = c.kinematics->ranges[k];
  return {std::max(own.lower, limits.lower.value_or(own.lower)), std::min(own.upper, limits.upper.value_or(own.upper))};
}

// The turn of a rotary axis within its range that is nearest. False: there is none.
bool TakeTurn(const kinematics::JointRange& range, double near, double& position) {
  constexpr double kTurn = 360;
  position += kTurn * std::round((near - position) / kTurn);
  if (position < range.lower) position += kTurn * std::ceil((range.lower - position) / kTurn);
  if (position > range.upper) position -= kTurn * std::ceil((position - range.upper) / kTurn);
  return position >= range.lower;
}

}  // namespace

kinematics::Reason NearestJointsAt(const Context& c, const State& s, const Frame& tcp,
                                   const kinematics::Configuration& wanted, const kinematics::Joints& near,
                                   kinematics::Joints& joints) noexcept {
  const kinematics::Kinematics& kinematics = *c.kinematics;
  kinematics::Solutions all = kinematics::SolutionsOf(kinematics, tcp * c.mounting.tool_inverse, wanted, near);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.count; ++i) {
    kinematics::Joints& one = all.of[i];
    bool admissible = true;
    double slowest = 0, sum = 0;
    for (std::size_t k = 0; k < kinematics.count && admissible; ++k) {
      const kinematics::JointRange range = RangeOf(c, s, k);
      if (kinematics.kinds[k] == kinematics::JointKind::kRotary) {
        admissible = TakeTurn(range, near[k], one[k]);
      } else {
        admissible = one[k] >= range.lower && one[k] <= range.upper;
      }
      const double time = std::abs(one[k] - near[k]) / c.axes.params[s.members[k] - 1].limits.velocity;
      slowest = std::max(slowest, time);
      sum += time;
    }
    // Where the slowest axis is the same the others decide.
    const double cost = slowest + 1e-3 * sum;
    if (!admissible || cost >= least) continue;
    least = cost;
    std::copy_n(one.begin(), kinematics.count, joints.begin());
  }
  if (least < std::numeric_limits<double>::infinity()) return kinematics::Reason::kNone;
  return all.count > 0 ? kinematics::Reason::kAxisLimit : all.reason;
}

bool WithinRanges(const Context& c, const State& s, const kinematics::Joints& joints) noexcept {
  const std::size_t moved = InKinematics(c, s);
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    if (k < moved) {  // a URDF has limits of its own
      const kinematics::JointRange& range = c.kinematics->ranges[k];
      if (joints[k] < range.lower || joints[k] > range.upper) return false;
    }
    const axis::AxisLimits& limits = c.axes.params[s.members[k] - 1].limits;
    if (limits.lower && joints[k] < *limits.lower) return false;
    if (limits.upper && joints[k] > *limits.upper) return false;
  }
  return true;
}

kinematics::Joints PresentJoints(const Context& c, const State& s) noexcept {
  kinematics::Joints joints{};
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] != 0) joints[k] = c.axes.states[s.members[k] - 1].setpoint.position;
  }
  return joints;
}

End Present(const Context& c, const State& s) noexcept {
  End end;
  end.joints = PresentJoints(c, s);
  if (HasTool(c, s)) ToolAt(c, end.joints, end.tool);
  return end;
}

}  // namespace takt::group
