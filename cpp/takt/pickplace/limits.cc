// Limit switches and SW limits as the module sees them (PP-05, PP-60): nothing moves towards a switch that is on.
#include <algorithm>
#include <numbers>

#include "takt/core/maths.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/members.h"
#include "takt/group/switches.h"
#include "takt/group/systems.h"
#include "takt/kinematics/rotations.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

using group::Directions;
using kinematics::Frame;

constexpr double kLeast = 1e-6;  // [mm], [rad], [u], or per s: below this it is rounding
constexpr int kSamples = 8;      // per leg

// Returns the bit of the group for an axis of the module; nothing if the group has no such axis.
std::optional<std::size_t> BitOf(const Context& c, const group::State& g, std::size_t axis) {
  if (axis < kFirstReal) return group::kMaxAxes + axis;
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    if (g.members[k] != 0 && RealOf(c, g, k) == axis - kFirstReal) return k;
  }
  return std::nullopt;
}

// Returns the pose of the tool in the MCS after a share of a leg.
Frame Along(const Context& c, const Leg& leg, const Frame& from, const Frame& to, double share) {
  Frame at = to;
  if (!leg.arch) {
    at.p = from.p + share * (to.p - from.p);
  } else {
    const auto [sine, cosine] = maths::SinCos(std::numbers::pi * share);
    at.p = from.p + 0.5 * (1 - cosine) * (to.p - from.p);
    at.p += sine * leg.height * c.group.mounting.base_inverse.M.UnitZ();
  }
  const kinematics::GreatArc turn = kinematics::ArcBetween(from.M, to.M);
  at.M = kinematics::About(turn.axis, share * turn.angle) * from.M;
  return at;
}

// Returns the closed directions in which axes and tool move from one pose to another, taken as a motion in 1 s.
Directions Between(const Context& c, const group::State& g, const Directions& closed, const Frame& from,
                   const Frame& to, kinematics::Joints& joints) {
  kinematics::Joints after = joints, change{};
  const bool known = group::JointsAt(c.group, to, joints, after) == kinematics::Reason::kNone;
  for (std::size_t k = 0; known && k < group::kMaxAxes; ++k) change[k] = after[k] - joints[k];
  if (known) joints = after;
  kinematics::MovingFrame tool(to);
  tool.p.v = to.p - from.p;
  tool.M.w = kinematics::TurnBetween(from.M, to.M);
  return group::TakenOf(closed, g, change, &tool, kLeast);
}

void StopFor(const Context& c, bool positive, std::size_t axis, group::State& g, State& s) {
  s.error_axes |= 1u << axis;
  Fail(c, positive ? ErrorId::kModuleLimitSwitchPositive : ErrorId::kModuleLimitSwitchNegative, g, s);
  if (g.state != group::GroupState::kDisabled) StopAxes(c, g, s);
}

// Returns true if an axis moves by itself, not along a path of the group, and does not brake.
bool GoesAlone(const axis::State& member, int sense) {
  return !axis::IsGuided(member) && member.plc != axis::PlcState::kStopping &&
         member.plc != axis::PlcState::kErrorStop && sense * member.setpoint.velocity > kLeast;
}

}  // namespace

void CloseDirections(const Context& c, group::State& g, const State& s) noexcept {
  g.closed = {};
  if (!s.inputs.enable || !s.inputs.enable_hw_limit) return;
  for (std::size_t i = 0; i < kAllAxes; ++i) {
    if (!s.inputs.hw_limit_positive[i] && !s.inputs.hw_limit_negative[i]) continue;
    const std::optional<std::size_t> bit = BitOf(c, g, i);
    if (bit && s.inputs.hw_limit_positive[i]) g.closed.positive |= 1u << *bit;
    if (bit && s.inputs.hw_limit_negative[i]) g.closed.negative |= 1u << *bit;
  }
}

std::uint32_t AxesOf(const Context& c, const group::State& g, const Directions& directions) noexcept {
  std::uint32_t axes = 0;
  const std::uint32_t bits = directions.positive | directions.negative;
  for (std::size_t i = 0; i < kAllAxes; ++i) {
    const std::optional<std::size_t> bit = BitOf(c, g, i);
    if (bit && (bits & (1u << *bit)) != 0) axes |= 1u << i;
  }
  return axes;
}

void WatchSwitches(const Context& c, group::State& g, State& s) noexcept {
  if (!s.inputs.enable_hw_limit) return;
  const bool was = s.before.enable_hw_limit;
  for (std::size_t i = 0; i < kAllAxes; ++i) {
    const bool positive = s.inputs.hw_limit_positive[i], negative = s.inputs.hw_limit_negative[i];
    if (!positive && !negative) continue;
    if (s.state != PickPlaceState::kError) {
      if (Rises(positive, was && s.before.hw_limit_positive[i])) return StopFor(c, true, i, g, s);
      if (Rises(negative, was && s.before.hw_limit_negative[i])) return StopFor(c, false, i, g, s);
    }
    const std::optional<std::size_t> k = i >= kFirstReal ? BitOf(c, g, i) : std::nullopt;
    if (!k) continue;
    const axis::State& member = group::MemberOf(c.group, g, *k);
    if (positive && GoesAlone(member, 1)) return StopFor(c, true, i, g, s);
    if (negative && GoesAlone(member, -1)) return StopFor(c, false, i, g, s);
  }
}

Directions ClosedOn(const Context& c, const group::State& g, const Profile& profile, std::uint32_t first,
                    const Place& start, bool keep_orientation) noexcept {
  const Directions closed = group::ClosedNow(c.group, g);
  if (!closed.any()) return {};
  const auto frame = [&](const Place& place) {
    return group::SystemFrame(c.group, g, place.system, place.pcs - 1) * kinematics::ToFrame(place.pose);
  };
  kinematics::Joints joints = group::PresentJoints(c.group, g);
  Frame from = frame(start);
  if (keep_orientation) from.M = group::Present(c.group, g).tool.M;
  group::JointsAt(c.group, from, joints, joints);
  for (std::uint32_t i = first; i < profile.count; ++i) {
    const Leg& leg = profile.legs[i];
    Frame to = frame(leg.to);
    if (keep_orientation || !leg.turns) to.M = from.M;
    Frame at = from;
    for (int k = 1; k <= kSamples; ++k) {
      const Frame next = Along(c, leg, from, to, static_cast<double>(k) / kSamples);
      const Directions taken = Between(c, g, closed, at, next, joints);
      if (taken.any()) return taken;
      at = next;
    }
    // In step with its carrier.
    if (leg.to.system == group::CoordinateSystem::kPcs) {
      const kinematics::MovingFrame carrier = group::PlaceOf(c.group, g.cargoes[leg.to.pcs - 1]);
      const bool moves = g.cargoes[leg.to.pcs - 1].carrier != 0;
      const Directions taken = group::TakenOf(closed, g, {}, &carrier, kLeast);
      if (moves && taken.any()) return taken;
    }
    from = to;
  }
  return {};
}

Directions BeyondRanges(const Context& c, const group::State& g, const kinematics::Joints& joints) noexcept {
  Directions beyond;
  const std::size_t moved = group::InKinematics(c.group, g);
  const double none = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    if (g.members[k] == 0) continue;
    const axis::AxisLimits& limits = c.group.axes.params[g.members[k] - 1].limits;
    double lower = limits.lower.value_or(-none), upper = limits.upper.value_or(none);
    if (k < moved) {
      lower = std::max(lower, c.group.kinematics->ranges[k].lower);
      upper = std::min(upper, c.group.kinematics->ranges[k].upper);
    }
    if (joints[k] > upper) beyond.positive |= 1u << k;
    if (joints[k] < lower) beyond.negative |= 1u << k;
  }
  return beyond;
}

}  // namespace takt::pickplace
