#include "takt/group/systems.h"

#include <algorithm>
#include <cmath>

#include "takt/group/carrier_bindings.h"
#include "takt/kinematics/solutions.h"

namespace takt::group {

Mounting MakeMounting(const GroupParams& params) {
  const Frame base = kinematics::ToFrame(params.base);
  const Frame tool = kinematics::ToFrame(params.tool);
  return {base, base.Inverse(), tool, tool.Inverse()};
}

void MountTool(const Frame& tool, Mounting& mounting) noexcept {
  mounting.tool = tool;
  mounting.tool_inverse = tool.Inverse();
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

// Returns the intersection of the SW limits of a member and, for the first `moved` ones, the range of the kinematics: a
// URDF has its own.
kinematics::JointRange RangeOf(const Context& c, const State& s, std::size_t k, std::size_t moved) {
  const axis::AxisLimits& limits = c.axes.params[s.members[k] - 1].limits;
  const kinematics::JointRange own = k < moved ? c.kinematics->ranges[k] : kinematics::JointRange{};
  return {std::max(own.lower, limits.lower.value_or(own.lower)), std::min(own.upper, limits.upper.value_or(own.upper))};
}

// Moves a rotary position to the nearest turn within the range. Returns false if there is none.
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
                                   kinematics::Joints& joints, Failures& failures) noexcept {
  const kinematics::Kinematics& kinematics = *c.kinematics;
  failures = {};
  kinematics::Solutions all = kinematics::SolutionsOf(kinematics, tcp * c.mounting.tool_inverse, wanted, near);
  for (std::size_t i = 0; i < all.failed_count; ++i) failures.Add(all.failed[i], all.failed_for[i]);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.count; ++i) {
    kinematics::Joints& one = all.of[i];
    bool admissible = true;
    double slowest = 0, sum = 0;
    for (std::size_t k = 0; k < kinematics.count && admissible; ++k) {
      const kinematics::JointRange range = RangeOf(c, s, k, kinematics.count);
      if (kinematics.kinds[k] == kinematics::JointKind::kRotary) {
        admissible = TakeTurn(range, near[k], one[k]);
      } else {
        admissible = one[k] >= range.lower && one[k] <= range.upper;
      }
      if (!admissible) failures.AddLimit(all.in[i], k, one[k] > range.upper);
      const double time = std::abs(one[k] - near[k]) / c.axes.params[s.members[k] - 1].limits.velocity;
      slowest = std::max(slowest, time);
      sum += time;
    }
    // If the slowest axes are equal the others decide.
    const double cost = slowest + 1e-3 * sum;
    if (!admissible || cost >= least) continue;
    least = cost;
    std::copy_n(one.begin(), kinematics.count, joints.begin());
  }
  if (least < std::numeric_limits<double>::infinity()) return kinematics::Reason::kNone;
  return all.count > 0 ? kinematics::Reason::kAxisLimit : all.reason;
}

Failures FailuresOf(const Context& c, const State& s, const kinematics::Joints& joints) noexcept {
  Failures failures;
  const std::size_t moved = InKinematics(c, s);
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const kinematics::JointRange range = RangeOf(c, s, k, moved);
    if (joints[k] >= range.lower && joints[k] <= range.upper) continue;
    failures.AddLimit({}, k, joints[k] > range.upper);
    break;
  }
  return failures;
}

Failures FailuresAt(const Context& c, const State& s, const Frame& tcp, kinematics::Reason reason,
                    const kinematics::Joints& near) noexcept {
  Failures failures;
  if (reason != kinematics::Reason::kAxisLimit) {
    failures.Add({}, reason);
    return failures;
  }
  const kinematics::Solutions all = kinematics::SolutionsOf(*c.kinematics, tcp * c.mounting.tool_inverse, {}, near);
  kinematics::Joints nearest = near;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.count; ++i) {
    double way = 0;
    for (std::size_t k = 0; k < c.kinematics->count; ++k) way = std::max(way, std::abs(all.of[i][k] - near[k]));
    if (way >= least) continue;
    least = way;
    std::copy_n(all.of[i].begin(), c.kinematics->count, nearest.begin());
  }
  failures = FailuresOf(c, s, nearest);
  if (failures.Detail(c.number) != 0) return failures;
  // It is only just out of range: returns the axis that is closest to a limit.
  std::size_t axis = 0;
  bool upper = false;
  least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < c.kinematics->count; ++k) {
    const kinematics::JointRange range = RangeOf(c, s, k, c.kinematics->count);
    const double below = near[k] - range.lower, above = range.upper - near[k];
    if (std::min(below, above) >= least) continue;
    least = std::min(below, above);
    axis = k;
    upper = above < below;
  }
  failures.AddLimit({}, axis, upper);
  return failures;
}

bool WithinRanges(const Context& c, const State& s, const kinematics::Joints& joints, std::size_t count) noexcept {
  const std::size_t moved = InKinematics(c, s);
  for (std::size_t k = 0; k < count; ++k) {
    if (s.members[k] == 0) continue;
    const kinematics::JointRange range = RangeOf(c, s, k, moved);
    if (joints[k] < range.lower || joints[k] > range.upper) return false;
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
