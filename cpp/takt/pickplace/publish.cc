// The published outputs of a module.
#include <algorithm>

#include "takt/group/members.h"
#include "takt/group/systems.h"
#include "takt/pickplace/run.h"

namespace takt::pickplace {

namespace {

constexpr std::array kNumbers = {&AxisNumbers::x,   &AxisNumbers::y,  &AxisNumbers::z,  &AxisNumbers::a,
                                 &AxisNumbers::b,   &AxisNumbers::c,  &AxisNumbers::a1, &AxisNumbers::a2,
                                 &AxisNumbers::a3,  &AxisNumbers::a4, &AxisNumbers::a5, &AxisNumbers::a6,
                                 &AxisNumbers::aux1};

void PublishAxes(const Context& c, const group::State& g, const State& s, Outputs& out) {
  out.error_axes = s.error_axes;
  const bool soft = s.error == ErrorId::kModuleSoftLimitPositive || s.error == ErrorId::kModuleSoftLimitNegative;
  if (soft) out.sw_limit_switches = s.error_axes;
  out.axes_enabled = out.axes_group_homed = group::CountOf(g) > 0;
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    if (g.members[k] == 0) continue;
    const axis::State& m = group::MemberOf(c.group, g, k);
    out.axes_enabled &= m.loop_closed;
    out.axes_group_homed &= m.homing.homed;
    const std::size_t real = RealOf(c, g, k);
    if (real == kRealAxes) continue;
    const std::size_t i = kFirstReal + real;
    const std::uint32_t bit = 1u << i;
    const axis::AxisParams& p = c.group.axes.params[g.members[k] - 1];
    out.position.*kNumbers[i] = axis::Reported(p, m.actual.position);
    out.velocity.*kNumbers[i] = m.actual.velocity;
    if (m.error != ErrorId::kNone) out.error_axes |= bit;
    if (m.limit_positive) out.hw_limit_switches_positive |= bit;
    if (m.limit_negative) out.hw_limit_switches_negative |= bit;
    if (p.limits.lower || p.limits.upper) out.sw_limits_enabled |= bit;
    const bool stopped = m.error == ErrorId::kSoftLimitPositive || m.error == ErrorId::kSoftLimitNegative;
    if (stopped) out.sw_limit_switches |= bit;
  }
  for (std::size_t i = 0; i < kAllAxes; ++i) {
    if (s.inputs.hw_limit_positive[i]) out.hw_limit_switches_positive |= 1u << i;
    if (s.inputs.hw_limit_negative[i]) out.hw_limit_switches_negative |= 1u << i;
  }
  out.hw_limit_switch_active = (out.hw_limit_switches_positive | out.hw_limit_switches_negative) != 0;
  out.sw_limit_switch_active = out.sw_limit_switches != 0;
}

void PublishTool(const Context& c, const group::State& g, Outputs& out) {
  if (!group::HasTool(c.group, g)) return;
  kinematics::JointMotion motion;
  for (std::size_t k = 0; k < group::kMaxAxes; ++k) {
    if (g.members[k] == 0) continue;
    const KinematicState& actual = group::MemberOf(c.group, g, k).actual;
    motion.position[k] = actual.position;
    motion.velocity[k] = actual.velocity;
  }
  kinematics::MovingFrame flange;
  if (kinematics::Forward(*c.group.kinematics, motion, flange) != kinematics::Reason::kNone) return;
  const kinematics::MovingFrame tool = flange * c.group.mounting.tool;
  const kinematics::Pose pose = kinematics::ToPose(tool.GetFrame());
  const std::array position = {pose.x, pose.y, pose.z, pose.a, pose.b, pose.c};
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.position.*kNumbers[k] = position[k];
    out.velocity.*kNumbers[k] = i < 3 ? tool.p.v(i) : KDL::rad2deg * tool.M.w(i - 3);
  }
}

void PublishCounters(const Counters& counters, Outputs& out) {
  out.picked = counters.picked;
  out.placed = counters.placed;
  out.missed = counters.missed;
  out.missed_too_late = counters.too_late;
  out.missed_interrupted = counters.interrupted;
  out.missed_refused = counters.refused;
}

double PicksPerMinute(const Context& c, const State& s) {
  const std::size_t known = std::min<std::size_t>(s.pick_count, kPickTimes);
  if (known < 2) return 0;
  const std::uint64_t last = s.pick_cycles[(s.pick_count - 1) % kPickTimes];
  const std::uint64_t first = s.pick_cycles[(s.pick_count - known) % kPickTimes];
  return 60 * static_cast<double>(known - 1) / (static_cast<double>(last - first) * c.group.cycle.period_s);
}

void PublishOrder(const Context& c, const group::State& g, const State& s, Outputs& out) {
  out.profiles = s.order_count;
  if (s.order_count == 0) return;
  const Order& order = s.orders[0];
  out.target = order.belt;
  out.workpiece = order.workpiece;
  out.gripper_control_active =
      order.gripper_time > 0 && !order.gripper_off && !order.pulse_at_end && !HasOverride(g, s);
  out.synchronised = IsOnWorkpiece(c, g, s);
  if (order.phase != Phase::kGoing) return;
  const std::uint64_t gone = g.done > order.first ? g.done - order.first : 0;
  const auto leg = std::min(order.next_leg + static_cast<std::uint32_t>(gone), order.profile.count);
  out.profile_point_passed = leg;
  const bool carried = order.belt != 0 || (order.start.system == group::CoordinateSystem::kPcs);
  const bool moves = g.begun && g.done >= order.first && leg < order.profile.count;
  if (!carried || !moves) return;
  out.acc_dec_sync = order.profile.legs[leg].turns;
  const bool lifts = leg == 0;
  out.synchronised = !out.acc_dec_sync &&
                     (lifts ? order.start.system == group::CoordinateSystem::kPcs : order.belt != 0) && IsInStep(c, g);
}

}  // namespace

void Publish(const Context& c, const group::State& g, const State& s, Outputs& out) noexcept {
  out = {};
  out.state = s.state;
  out.error = s.error;
  out.warning = s.warning;
  out.warning_belt = s.warning == ErrorId::kTooManyWorkpieces ? s.warning_belt : 0;
  out.held = s.held_count;
  if (s.held_count > 0) {
    out.held_kind = s.held[0].kind;
    out.held_colour = s.held[0].colour;
    out.held_quality = s.held[0].quality;
  }
  out.set_path_velocity = g.begun ? g.pace.now.velocity : 0;
  out.path_preparation_time = s.preparation_time;
  out.precalculated_profile_time = s.profile_time;
  PublishAxes(c, g, s, out);
  PublishTool(c, g, out);
  PublishOrder(c, g, s, out);
  PublishCounters(s.counters, out);
  out.picks_per_minute = PicksPerMinute(c, s);
  out.internal_control_active = s.inputs.internal_control;
  out.axes_group_enabled = g.state != group::GroupState::kDisabled;
  out.done = s.done;
  out.busy = s.order_count > 0 || s.loop.active || s.hold.returning || s.state == PickPlaceState::kHoming;
  out.in_target = s.in_target;
  out.in_position = s.in_target && (!s.settings.watch_position_window || s.out_of_window == 0);
  out.path_hold = s.hold.held && Stands(c, g);
  out.off_path = s.hold.off;
  out.pulse_gripper = s.pulse;
  out.profile_in_preparation = s.order_count == kOrders || s.state == PickPlaceState::kPreparingPath;
  out.in_park_position = s.parked_at != 0 && !s.parking;
}

}  // namespace takt::pickplace
