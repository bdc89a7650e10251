#include "takt/group/stream.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/fit.h"
#include "takt/core/angle.h"
#include "takt/core/describe.h"
#include "takt/group/members.h"
#include "takt/group/plan.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"
#include "takt/group/switches.h"
#include "takt/group/systems.h"
#include "takt/group/track.h"
#include "takt/group/zones.h"
#include "takt/kinematics/frames.h"
#include "takt/trajectory/planner.h"

namespace takt::group {

namespace {

using kinematics::Joints;
using kinematics::Reason;

constexpr double kTurnsTowards = 1e-6;  // [u/s, mm/s or rad/s]: less is rounding

// Returns the set point in the coordinates of the group: relative to the origins when it took its members.
KinematicState SetOf(const Context& c, const State& s, std::size_t k) {
  const axis::State& member = MemberOf(c, s, k);
  KinematicState set = member.setpoint;
  set.position += member.origin - s.origins[k];
  return set;
}

Joints JointsNow(const Context& c, const State& s) {
  Joints joints{};
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] != 0) joints[k] = SetOf(c, s, k).position;
  }
  return joints;
}

ErrorId ErrorFor(Reason reason, State& s) {
  s.reason = reason;
  return reason == Reason::kSingular ? ErrorId::kSingular : ErrorId::kUnreachable;
}

// A set point as given, converted to the axes.
struct Point {
  std::array<std::optional<double>, kToolNumbers> tool, tool_velocity;
  std::array<std::optional<double>, kMaxAxes> axes, axes_velocity;
  CoordinateSystem system = CoordinateSystem::kMcs;
  std::uint32_t pcs = 0;

  explicit Point(const StreamPoint& m)
      : tool{m.x, m.y, m.z, m.a, m.b, m.c},
        tool_velocity{m.vx, m.vy, m.vz, m.wx, m.wy, m.wz},
        axes{m.a1, m.a2, m.a3, m.a4, m.a5, m.a6, m.a7, m.a8},
        axes_velocity{m.v1, m.v2, m.v3, m.v4, m.v5, m.v6, m.v7, m.v8},
        system(m.coordinate_system),
        pcs(m.pcs - 1) {}

  template <typename T>
  static bool Any(const T& numbers) {
    return std::ranges::any_of(numbers, [](const auto& number) { return number.has_value(); });
  }

  // Returns an error if these coordinates may not be given for this group.
  ErrorId Admissible(const Context& c, const State& s) const {
    const bool of_axes = system == CoordinateSystem::kAcs, of_tool = Any(tool) || Any(tool_velocity);
    if (!of_axes && !HasTool(c, s)) return ErrorId::kState;
    if ((of_axes && of_tool) || (!Any(tool) && !Any(axes))) return ErrorId::kParameter;
    if (system == CoordinateSystem::kPcs && s.cargoes[pcs].carrier != 0) return ErrorId::kParameter;
    const std::size_t moved = of_axes ? 0 : c.kinematics->count;
    for (std::size_t k = 0; k < kMaxAxes; ++k) {
      if (!axes[k] && !axes_velocity[k]) continue;
      if (s.members[k] == 0) return ErrorId::kNotGroupMember;
      if (k < moved) return ErrorId::kParameter;
    }
    return ErrorId::kNone;
  }

  // Computes position and velocity of the axes, as far as given; `motion`: in, those of the previous set point.
  ErrorId ToAxes(const Context& c, State& s, kinematics::JointMotion& motion, std::array<bool, kMaxAxes>& known) const {
    if (Any(tool) || Any(tool_velocity)) {
      const Frame frame = SystemFrame(c, s, system, pcs);
      Frame before;
      if (const Reason reason = ToolAt(c, motion.position, before); reason != Reason::kNone) {
        return ErrorFor(reason, s);
      }
      kinematics::Pose pose = kinematics::ToPose(frame.Inverse() * before);
      double* const numbers[] = {&pose.x, &pose.y, &pose.z, &pose.a, &pose.b, &pose.c};
      for (std::size_t i = 0; i < kToolNumbers; ++i) *numbers[i] = tool[i].value_or(*numbers[i]);
      const Frame there = Any(tool) ? frame * kinematics::ToFrame(pose) : before;
      const auto three = [&](std::size_t i) {
        return frame.M * KDL::Vector(tool_velocity[i].value_or(0), tool_velocity[i + 1].value_or(0),
                                     tool_velocity[i + 2].value_or(0));
      };
      kinematics::MovingFrame moving(there);
      moving.p.v = three(0);
      moving.M.w = three(3) * kDegree;
      kinematics::JointMotion found;
      const Reason reason =
          kinematics::Inverse(*c.kinematics, moving * c.mounting.tool_inverse, {}, motion.position, found);
      if (reason != Reason::kNone) return ErrorFor(reason, s);
      for (std::size_t k = 0; k < c.kinematics->count; ++k) {
        motion.position[k] = found.position[k];
        motion.velocity[k] = found.velocity[k];
        known[k] = Any(tool_velocity);
      }
    }
    for (std::size_t k = 0; k < kMaxAxes; ++k) {
      if (axes[k]) motion.position[k] = Unwrapped(c, s, k, *axes[k], motion.position[k]);
      if (axes_velocity[k]) {
        motion.velocity[k] = *axes_velocity[k];
        known[k] = true;
      }
    }
    return ErrorId::kNone;
  }

  // Returns the position of a rotary axis in the turn nearest to `near`.
  static double Unwrapped(const Context& c, const State& s, std::size_t k, double position, double near) {
    const axis::AxisParams& params = c.axes.params[s.members[k] - 1];
    return params.rotary() ? near + std::remainder(position - near, params.modulus) : position;
  }
};

// Returns true if an axis would have to exceed 1.5 times its velocity limit.
bool Jumps(const Context& c, const State& s, const Joints& from, const Joints& to, double time_s) {
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const double velocity = c.axes.params[s.members[k] - 1].limits.velocity;
    if (!(std::abs(to[k] - from[k]) <= axis::kStreamJumpFactor * velocity * time_s)) return true;
  }
  return false;
}

Joints JointsOf(const StreamState& k, std::size_t place) {
  Joints joints{};
  for (std::size_t i = 0; i < kMaxAxes; ++i) joints[i] = k.of[i].points[place].position;
  return joints;
}

// Returns an error if these set points may not be given to the members.
ErrorId MayBe(const Context& c, const kinematics::JointMotion& next, State& s) {
  Joints rest{};
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const axis::State& member = MemberOf(c, s, k);
    const axis::AxisParams& params = c.axes.params[s.members[k] - 1];
    const KinematicState set = {next.position[k] + s.origins[k] - member.origin, next.velocity[k],
                                next.acceleration[k]};
    if (!axis::CanStopInside(params, member.setpoint, set)) return ErrorId::kTargetBehindLimit;
    rest[k] = trajectory::StopPosition({next.position[k], set.velocity, set.acceleration}, params.planner_limits());
  }
  kinematics::MovingFrame flange;
  const bool has_tool = HasTool(c, s);
  if (has_tool) {
    Frame tool;
    if (const Reason reason = ToolAt(c, rest, tool); reason != Reason::kNone) return ErrorFor(reason, s);
    if (const Reason reason = kinematics::Forward(*c.kinematics, next, flange); reason != Reason::kNone) {
      return ErrorFor(reason, s);
    }
  }
  const Directions closed = ClosedNow(c, s);
  if (!closed.any()) return ErrorId::kNone;
  const kinematics::MovingFrame tool = flange * c.mounting.tool;
  s.refused = TakenOf(closed, s, next.velocity, has_tool ? &tool : nullptr, kTurnsTowards);
  return s.refused.any() ? RefusalOf(c, s) : ErrorId::kNone;
}

}  // namespace

bool Streams(const State& s) noexcept {
  return s.stream.ticket != 0;
}

ErrorId BeginStream(const Context& c, Ticket ticket, const Stream& command, State& s) noexcept {
  if (const ErrorId error = TakeMembers(c, s); error != ErrorId::kNone) return error;
  if (Streams(s)) {
    Report(c, s.stream.ticket, FeedbackState::kAborted);
  } else {
    EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
    EndTask(c, FeedbackState::kAborted, ErrorId::kNone, s);
    AbortMoves(c, ErrorId::kNone, s);
    s.way_before += s.pace.now.position;
    ForgetPlan(c, s);
    c.ahead.failures = 0;
    s.begun = s.ends = s.interrupted = s.lets_go = false;
    s.clutches = {};
    s.ridden = {};
    s.rise = {};
    s.brake = {};
    s.pace = {};
    s.master = {};
  }
  s.stream = {};
  s.stream.ticket = s.active = ticket;
  s.stream.key = command.key;
  s.stream.delay = command.delay;
  s.stream.timeout = command.timeout;
  s.stream.velocity_factor = command.velocity_factor;
  s.stream.acceleration_factor = command.acceleration_factor;
  s.stream.jerk_factor = command.jerk_factor;
  if (s.state == GroupState::kStandby) Enter(GroupState::kMoving, s);
  Report(c, ticket, FeedbackState::kActive);
  return ErrorId::kNone;
}

ErrorId TakePoint(const Context& c, const StreamPoint& command, State& s) noexcept {
  StreamState& k = s.stream;
  if (!Streams(s)) return ErrorId::kState;
  if (command.key != k.key) return ErrorId::kStreamKey;
  const Point given(command);
  if (const ErrorId error = given.Admissible(c, s); error != ErrorId::kNone) return error;
  axis::StreamState& first = k.of[0];
  const double time = command.time.value_or(static_cast<double>(c.cycle.count) * c.cycle.period_s);
  const auto [late, place] = axis::SlotOf(first, time);
  if (late != ErrorId::kNone) return late;
  kinematics::JointMotion motion;
  const Joints before = place > 0 ? JointsOf(k, place - 1) : JointsNow(c, s);
  motion.position = before;
  std::array<bool, kMaxAxes> known{};
  if (const ErrorId error = given.ToAxes(c, s, motion, known); error != ErrorId::kNone) return error;
  if (!WithinRanges(c, s, motion.position)) {
    s.reason = Reason::kAxisLimit;
    return given.system == CoordinateSystem::kAcs ? ErrorId::kTargetBehindLimit : ErrorId::kUnreachable;
  }
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    if (s.members[i] == 0 || !known[i]) continue;
    if (std::abs(motion.velocity[i]) > c.axes.params[s.members[i] - 1].limits.velocity) return ErrorId::kStreamJump;
  }
  if (place > 0 && Jumps(c, s, before, motion.position, time - first.points[place - 1].time)) {
    return ErrorId::kStreamJump;
  }
  const bool between = place < first.count;
  const Joints after = between ? JointsOf(k, place) : motion.position;
  const double until = between ? first.points[place].time : time;
  if (between && Jumps(c, s, motion.position, after, until - time)) return ErrorId::kStreamJump;
  if (!EnterZonesOf(c, before, motion.position, after, until, s)) return ErrorId::kZoneTaken;
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    axis::Keep(c.cycle, {time, motion.position[i], motion.velocity[i], known[i]}, place, k.delay, k.of[i]);
  }
  return ErrorId::kNone;
}

void EndStream(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept {
  if (!Streams(s)) return;
  Report(c, s.stream.ticket, feedback, error);
  s.stream = {};
  s.active = 0;
  ReleaseMembers(c, s);
  s.ends = true;
}

void FollowStream(const Context& c, State& s) noexcept {
  StreamState& k = s.stream;
  const double period = c.cycle.period_s;
  const bool has_points = k.of[0].count > 0;
  const double silent_s = static_cast<double>(c.cycle.count - k.of[0].heard_cycle) * period;
  if (has_points && silent_s > k.timeout) return EndStream(c, FeedbackState::kError, ErrorId::kStreamEnded, s);
  kinematics::JointMotion next;
  bool in_step = has_points;
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    axis::StreamState& of = k.of[i];
    if (has_points) of.clock += period;
    if (s.members[i] == 0) {
      if (has_points) next.position[i] = axis::DemandAt(of).position;
      continue;
    }
    const axis::Context member = ContextOf(c, s, i);
    const KinematicState before = SetOf(c, s, i);
    // Before the first set point, the axis comes to rest where it is.
    const KinematicState demand =
        has_points ? axis::DemandAt(of) : KinematicState{before.position + period * before.velocity, 0, 0};
    const trajectory::Limits own = member.params.planner_limits();
    const trajectory::Limits catching_up = {own.velocity * k.velocity_factor, own.acceleration * k.acceleration_factor,
                                            own.deceleration * k.acceleration_factor, own.jerk * k.jerk_factor};
    const auto mode = has_points ? trajectory::DemandMode::kPosition : trajectory::DemandMode::kVelocity;
    const KinematicState set =
        trajectory::FollowDemand({own, member.planner, catching_up, period}, mode, before, demand, of.chase);
    next.position[i] = set.position;
    next.velocity[i] = set.velocity;
    next.acceleration[i] = set.acceleration;
    in_step = in_step && of.chase.in_step;
  }
  if (const ErrorId error = MayBe(c, next, s); error != ErrorId::kNone) {
    return EndStream(c, FeedbackState::kError, error, s);
  }
  s.joints = next.position;
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    if (s.members[i] == 0) continue;
    axis::GuidanceState& guidance = MemberOf(c, s, i).guidance;
    guidance.demand = {next.position[i] + s.origins[i], next.velocity[i], next.acceleration[i]};
    guidance.comes_to_rest = false;
  }
  if (!in_step || k.reached) return;
  k.reached = true;
  c.feedback.Report({k.ticket, c.cycle.count, FeedbackState::kActive, true, ErrorId::kNone, 0});
}

Joints JointsBraked(const Context& c, const State& s) noexcept {
  Joints joints{};
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    joints[k] = trajectory::StopPosition(MemberOf(c, s, k).setpoint, c.axes.params[s.members[k] - 1].planner_limits());
  }
  return joints;
}

void describe(Description<StreamState>& d) {
  using K = StreamState;
  d.about("Set points of a group that are streamed from outside.");
  d.internal<&K::ticket>("Ticket of the command; 0: none.");
  d.internal<&K::key>("Key that set points must carry.");
  d.internal<&K::delay>(unit::s, "Time from the arrival of the first set point until it is due.");
  d.internal<&K::timeout>(unit::s, "Longest time without a set point.");
  d.internal<&K::velocity_factor>("Factor of the axes' velocity limits for catching up.");
  d.internal<&K::acceleration_factor>("Factor of the axes' acceleration limits for catching up.");
  d.internal<&K::jerk_factor>("Factor of the axes' jerk limits for catching up.");
  d.internal<&K::reached>("All axes have been on their curves once.");
  d.internal<&K::of>("State of the stream of each member.");
  d.internal<&K::zones_until>("End of the set points in each zone.");
  d.internal<&K::zones>("Zones claimed for set points, a mask.");
}

}  // namespace takt::group
