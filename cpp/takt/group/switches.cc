#include "takt/group/switches.h"

#include "takt/axis/following.h"
#include "takt/group/members.h"

namespace takt::group {

namespace {

// Returns the first axis, from 1, whose switch or power command closes one of these directions, followers included; 0:
// an input of a module does.
std::uint32_t AxisThatCloses(const Context& c, const State& s, const Directions& taken) {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    for (const int sense : {1, -1}) {
      const std::uint32_t directions = sense > 0 ? taken.positive : taken.negative;
      if (s.members[k] == 0 || (directions & (1u << k)) == 0) continue;
      const axis::State& member = MemberOf(c, s, k);
      const bool own =
          sense > 0 ? member.limit_positive || member.bars_positive : member.limit_negative || member.bars_negative;
      if (own) return s.members[k];
      const std::uint32_t follower = axis::BlockingFollower(ContextOf(c, s, k), member, sense);
      if (follower != axis::kNoAxis) return follower + 1;
    }
  }
  return 0;
}

}  // namespace

Directions ClosedNow(const Context& c, const State& s) noexcept {
  Directions closed = s.closed;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const axis::State& member = MemberOf(c, s, k);
    // While the group brakes by a command, directions that are not enabled are ignored. If the path is continued before
    // it rests, the axis reports the fault in the next cycle, and the group brakes along the path.
    const bool rests = s.ends || s.interrupted || (s.begun && member.guidance.comes_to_rest);
    // Followers of a gantry count for their master.
    const axis::Context own = ContextOf(c, s, k);
    if (!rests && !member.bars_positive && axis::Bars(own, member, 1)) closed.positive |= 1u << k;
    if (!rests && !member.bars_negative && axis::Bars(own, member, -1)) closed.negative |= 1u << k;
    // A switch that becomes active is a fault of the axis, for which all members brake along the path.
    if (member.limit_positive && member.limit_positive_before) closed.positive |= 1u << k;
    if (member.limit_negative && member.limit_negative_before) closed.negative |= 1u << k;
    if (axis::FollowerOnLimit(own, member, 1, true)) closed.positive |= 1u << k;
    if (axis::FollowerOnLimit(own, member, -1, true)) closed.negative |= 1u << k;
    // Likewise a direction that is no longer enabled: the axis checks it after the group.
    if (rests || member.bars_cycle == c.cycle.count) continue;
    if (member.bars_positive) closed.positive |= 1u << k;
    if (member.bars_negative) closed.negative |= 1u << k;
  }
  return closed;
}

ErrorId RefusalOf(const Context& c, const State& s, Directions taken) noexcept {
  Directions by_switch = taken;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const axis::State& member = MemberOf(c, s, k);
    const axis::Context own = ContextOf(c, s, k);
    const std::uint32_t bit = 1u << k;
    const bool up = member.limit_positive || axis::FollowerOnLimit(own, member, 1);
    const bool down = member.limit_negative || axis::FollowerOnLimit(own, member, -1);
    if (axis::Bars(own, member, 1) && !up) by_switch.positive &= ~bit | s.closed.positive;
    if (axis::Bars(own, member, -1) && !down) by_switch.negative &= ~bit | s.closed.negative;
  }
  const ErrorId error = by_switch.any() ? ErrorId::kAwayFromLimitOnly : ErrorId::kDirection;
  c.ahead.blame = {error, AxisThatCloses(c, s, by_switch.any() ? by_switch : taken)};
  return error;
}

Directions TakenOf(const Directions& closed, const State& s, const kinematics::Joints& velocity,
                   const kinematics::MovingFrame* tool, double least) noexcept {
  Directions taken;
  const auto look = [&](std::size_t bit, double v) {
    if (v > least) taken.positive |= closed.positive & (1u << bit);
    if (v < -least) taken.negative |= closed.negative & (1u << bit);
  };
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] != 0) look(k, velocity[k]);
  }
  if (!tool) return taken;
  for (int i = 0; i < 3; ++i) {
    look(kMaxAxes + static_cast<std::size_t>(i), tool->p.v(i));
    look(kMaxAxes + 3 + static_cast<std::size_t>(i), tool->M.w(i));
  }
  return taken;
}

}  // namespace takt::group
