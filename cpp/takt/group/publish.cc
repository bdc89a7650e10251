// Outputs of a group.
#include "takt/group/carrier_bindings.h"
#include "takt/group/group.h"
#include "takt/group/members.h"
#include "takt/group/plan.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"
#include "takt/group/systems.h"
#include "takt/group/track.h"

namespace takt::group {

namespace {

// Returns the motion of the members, commanded or actual.
kinematics::JointMotion MotionOf(const Context& c, const State& s, bool actual) {
  kinematics::JointMotion motion;
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] == 0) continue;
    const axis::State& member = c.axes.states[s.members[k] - 1];
    const KinematicState& state = actual ? member.actual : member.setpoint;
    motion.position[k] = state.position;
    motion.velocity[k] = state.velocity;
    motion.acceleration[k] = state.acceleration;
  }
  return motion;
}

void PublishTracking(const Context& c, const State& s, const kinematics::MovingFrame& tcp, Outputs& out) {
  out.track_state = TrackStateOf(c, s);
  out.track_lag = out.object_x = out.object_y = out.object_z = out.object_a = out.object_b = out.object_c = kNotGiven;
  out.in_sync = out.track_state == TrackState::kInSync;
  if (!IsOnCarrier(c, s)) return;
  const Stretch& stretch = *Here(c, s);
  // Until the transition begins the tool is on the previous binding.
  const double way = stretch.from + s.pace.now.position - stretch.begin;
  const std::uint64_t number = ShareAt(c.ahead, stretch, way).position > 0 ? stretch.to_ride : stretch.from_ride;
  const CarriedTarget& cargo = c.ahead.rides[number % kRides].cargo;
  if (cargo.carrier == 0) return;
  const kinematics::Pose on = kinematics::ToPose(PlaceOf(c, cargo).GetFrame().Inverse() * tcp.GetFrame());
  out.object_x = on.x;
  out.object_y = on.y;
  out.object_z = on.z;
  out.object_a = on.a;
  out.object_b = on.b;
  out.object_c = on.c;
  for (const Clutch& clutch : s.clutches) {
    if (!clutch.used || clutch.ride != number) continue;
    out.track_lag = CarrierOf(c, cargo).travel.position - clutch.travel.position;
  }
}

}  // namespace

void Publish(const Context& c, const State& s, Outputs& out) noexcept {
  out = {};
  out.state = s.state;
  out.error = s.error;
  const Frame& tool = c.mounting.tool;
  kinematics::MovingFrame commanded, measured;
  kinematics::Joints due{};
  for (std::size_t k = 0; k < kMaxAxes; ++k) {
    if (s.members[k] != 0) due[k] = c.axes.states[s.members[k] - 1].due;
  }
  kinematics::Pose set{kNotGiven, kNotGiven, kNotGiven, kNotGiven, kNotGiven, kNotGiven};
  kinematics::Pose actual = set;
  out.velocity = out.acceleration = out.actual_velocity = out.path_error = kNotGiven;
  const auto known = kinematics::Reason::kNone;
  if (HasTool(c, s)) {
    Frame due_tool;
    if (kinematics::Forward(*c.kinematics, MotionOf(c, s, false), commanded) == known) {
      const kinematics::MovingFrame tcp = commanded * tool;
      set = kinematics::ToPose(tcp.GetFrame());
      out.velocity = tcp.p.v.Norm();
      out.acceleration = tcp.p.dv.Norm();
    }
    if (kinematics::Forward(*c.kinematics, MotionOf(c, s, true), measured) == known) {
      const kinematics::MovingFrame tcp = measured * tool;
      actual = kinematics::ToPose(tcp.GetFrame());
      out.actual_velocity = tcp.p.v.Norm();
      // An axis that is off has no commanded position.
      const bool on = AllMembers(c, s, [](const axis::State& member) { return member.loop_closed; });
      out.path_error = on ? kNotGiven : 0;
      if (on && ToolAt(c, due, due_tool) == known) out.path_error = (due_tool.p - tcp.p.p).Norm();
    }
  }
  out.x = set.x;
  out.y = set.y;
  out.z = set.z;
  out.a = set.a;
  out.b = set.b;
  out.c = set.c;
  out.actual_x = actual.x;
  out.actual_y = actual.y;
  out.actual_z = actual.z;
  out.actual_a = actual.a;
  out.actual_b = actual.b;
  out.actual_c = actual.c;
  if (s.begun) {
    out.path_position = s.pace.now.position;
    out.path_velocity = s.pace.now.velocity;
    out.path_acceleration = s.pace.now.acceleration;
    const LookAhead& ahead = c.ahead;
    if (ahead.count > 0) out.path_left = ahead[ahead.end() - 1].end() - s.pace.now.position;
  }
  out.time_left = TimeLeft(c, s);
  out.override_factor = s.velocity_factor;
  out.command = s.active;
  out.buffered = s.queue.count > 0 ? s.queue.count - 1 : 0;
  out.axes = static_cast<std::uint32_t>(CountOf(s));
  std::uint32_t* const members[] = {&out.member1, &out.member2, &out.member3, &out.member4,
                                    &out.member5, &out.member6, &out.member7, &out.member8};
  for (std::size_t k = 0; k < kMaxAxes; ++k) *members[k] = s.members[k];
  for (std::size_t k = 0; k < kProductSystems; ++k) {
    const bool moves = s.cargoes[k].carrier != 0;
    out.*kPublishedSystems[k] = moves ? kinematics::ToPose(PlaceOf(c, s.cargoes[k]).GetFrame()) : s.product_systems[k];
  }
  PublishTracking(c, s, commanded * tool, out);
  out.kinematics_on = HasTool(c, s);
  out.in_position = s.state == GroupState::kStandby && s.queue.count == 0;
  out.interrupted = s.interrupted;
  out.synchronized = s.master.in_step;
  out.reason = s.reason;
  out.problem = s.problem;
  out.blocked_at = s.blocked_at;
  out.blocked_element = s.blocked_element;
  out.trouble = s.answer.trouble;
  out.first_part = s.answer.first;
  out.second_part = s.answer.second;
  out.on_blend = s.answer.on_blend;
  out.checking = s.planning.stage == Stage::kCheck;
  out.zones = s.zones;
  out.waits_for = s.waits_for;
  out.waits_zone = s.waits_zone;
  out.tool = ToolOnFlange(c, s);
}

}  // namespace takt::group
