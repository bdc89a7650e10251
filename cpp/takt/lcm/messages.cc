#include "takt/lcm/messages.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "takt/conveyor/objects.h"
#include "takt/core/angle.h"
#include "takt/core/drive_errors.h"
#include "takt/core/schema.h"
#include "takt/engine/path_checks.h"

namespace takt::lcm {
namespace {

std::int64_t Signed(std::uint64_t bits) {
  return static_cast<std::int64_t>(bits);
}

std::int64_t TimeNs(std::uint64_t cycle, const engine::Machine& machine) {
  return Signed(cycle) * std::llround(machine.cycle.period_s * 1e9);
}

msgs::pose ToMessage(const kinematics::Pose& pose) {
  return {.x = pose.x, .y = pose.y, .z = pose.z, .a = pose.a, .b = pose.b, .c = pose.c};
}

msgs::axis_numbers ToMessage(const pickplace::AxisNumbers& n) {
  return {.x = n.x,
          .y = n.y,
          .z = n.z,
          .a = n.a,
          .b = n.b,
          .c = n.c,
          .a1 = n.a1,
          .a2 = n.a2,
          .a3 = n.a3,
          .a4 = n.a4,
          .a5 = n.a5,
          .a6 = n.a6,
          .aux1 = n.aux1};
}

constexpr std::size_t kFingerprint = 8;  // [bytes]

// Drive processes from before drive_error and later_s still work: their messages are read as if these were 0.
constexpr std::uint64_t kFeedbackBefore = 0x21B308B742C4984C;
constexpr std::size_t kFeedbackAdded = 16;  // [bytes] at the end

bool IsFeedbackBefore(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kFingerprint) return false;
  std::uint64_t fingerprint = 0;
  for (const std::uint8_t byte : bytes.first(kFingerprint)) fingerprint = fingerprint << 8 | byte;
  return fingerprint == kFeedbackBefore;
}

// Fields after the fingerprint: 'i' eight bytes of any type, 'b' one byte, 's' a string.
bool FitsLayout(std::span<const std::uint8_t> bytes, std::string_view layout) {
  if (bytes.size() < kFingerprint) return false;
  bytes = bytes.subspan(kFingerprint);
  for (const char field : layout) {
    std::size_t size = field == 'b' ? 1 : 8;
    if (field == 's') {
      if (bytes.size() < 4) return false;
      size = std::size_t{bytes[0]} << 24 | std::size_t{bytes[1]} << 16 | std::size_t{bytes[2]} << 8 | bytes[3];
      bytes = bytes.subspan(4);
      if (size == 0 || size > bytes.size()) return false;
      const auto* end = std::find(bytes.data(), bytes.data() + size, std::uint8_t{0});
      if (end != bytes.data() + size - 1) return false;
    }
    if (size > bytes.size()) return false;
    bytes = bytes.subspan(size);
  }
  return bytes.empty();
}

template <typename Message>
std::optional<Message> Decode(std::span<const std::uint8_t> bytes, std::string_view layout) {
  if (!FitsLayout(bytes, layout)) return {};
  Message message{};
  if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return {};
  return message;
}

}  // namespace

msgs::axis_state ToMessage(const engine::AxisSnapshot& snapshot, const engine::Machine& machine) {
  const axis::Outputs& o = snapshot.outputs;
  msgs::axis_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.axes[snapshot.index].name;
  m.set_position = o.set_position;
  m.set_velocity = o.set_velocity;
  m.set_acceleration = o.set_acceleration;
  m.actual_position = o.actual_position;
  m.actual_velocity = o.actual_velocity;
  m.following_error = o.following_error;
  m.voltage_v = o.voltage_v;
  m.torque_nm = o.torque_nm;
  m.active_command = Signed(o.active_command);
  m.error = static_cast<std::int32_t>(o.error);
  m.state = static_cast<std::int8_t>(o.state);
  m.limited_by = static_cast<std::int8_t>(o.limited_by);
  m.buffered_commands = o.buffered_commands;
  m.loop_closed = o.loop_closed;
  m.in_position = o.in_position;
  m.in_step = o.in_step;
  m.synchronizing = o.synchronizing;
  m.superimposed = o.superimposed;
  m.covered_distance = o.covered_distance;
  m.phase_shift = o.phase_shift;
  m.covered_phase_shift = o.covered_phase_shift;
  m.end_of_profile = o.end_of_profile;
  m.profile_ends = o.profile_ends;
  m.homed = o.homed;
  m.master1 = o.master1;
  m.master2 = o.master2;
  m.probe_position = o.probe_position;
  m.probe_captures = o.probe_captures;
  m.cam_outputs = o.cam_outputs;
  m.override_factor = o.override_factor;
  m.true_position = o.true_position;
  m.emergency_stopped = o.emergency_stopped;
  m.drive_heard = o.drive_heard;
  m.drive_ready = o.drive_ready;
  m.drive_error = o.drive_error;
  if (o.drive_error != 0) m.drive_error_text = DriveErrorText(o.drive_error);
  m.skew = o.skew;
  m.skewed = o.skewed;
  m.fault_of = o.fault_of;
  m.enable_positive = o.enable_positive;
  m.enable_negative = o.enable_negative;
  m.digital_outputs = o.digital_outputs;
  m.encoder_correction = o.encoder_correction;
  m.limit_positive = o.limit_positive;
  m.limit_negative = o.limit_negative;
  m.reference = o.reference;
  m.touch_probe = o.touch_probe;
  return m;
}

msgs::flex_cam_state ToMessage(const engine::FlexCamSnapshot& snapshot, const engine::Machine& machine) {
  const flexcam::Outputs& o = snapshot.outputs;
  msgs::flex_cam_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.flex_cams[snapshot.index].name;
  m.set_offset_master = o.set_offset_master;
  m.set_offset_slave = o.set_offset_slave;
  m.set_scaling_master = o.set_scaling_master;
  m.set_scaling_slave = o.set_scaling_slave;
  m.set_x_position = o.set_x_position;
  m.set_x_velocity = o.set_x_velocity;
  m.set_x_acceleration = o.set_x_acceleration;
  m.set_y_position = o.set_y_position;
  m.set_y_velocity = o.set_y_velocity;
  m.set_y_acceleration = o.set_y_acceleration;
  m.actual_slave_position = o.actual_slave_position;
  m.actual_slave_velocity = o.actual_slave_velocity;
  m.slave_max_position = o.slave_max_position;
  m.slave_min_position = o.slave_min_position;
  m.slave_max_velocity = o.slave_max_velocity;
  m.slave_max_acceleration = o.slave_max_acceleration;
  m.ip01_set_scaling_master = o.ip01_set_scaling_master;
  m.ip02_scaling_mode_master = static_cast<std::int8_t>(o.ip02_scaling_mode_master);
  m.ip03_set_offset_master = o.ip03_set_offset_master;
  m.ip04_set_offset_slave = o.ip04_set_offset_slave;
  m.ip05_offset_mode_slave = static_cast<std::int8_t>(o.ip05_offset_mode_slave);
  m.ip06_set_scaling_slave = o.ip06_set_scaling_slave;
  m.ip07_scaling_mode_slave = static_cast<std::int8_t>(o.ip07_scaling_mode_slave);
  m.ip08_cam_table1 = o.ip08_cam_table1;
  m.ip09_cam_table2 = o.ip09_cam_table2;
  m.ip10_cam_table3 = o.ip10_cam_table3;
  m.ip11_cam_table4 = o.ip11_cam_table4;
  m.mp01_set_master_position = o.mp01_set_master_position;
  m.mp02_set_slave_position = o.mp02_set_slave_position;
  m.mp03_master_to_x_position = o.mp03_master_to_x_position;
  m.mp04_cam_profiler_position_out = o.mp04_cam_profiler_position_out;
  m.mp05_set_y_position = o.mp05_set_y_position;
  m.mp06_y_to_slave_position = o.mp06_y_to_slave_position;
  m.op01_set_x_position_out = o.op01_set_x_position_out;
  m.op02_set_y_position_out = o.op02_set_y_position_out;
  m.clutch_position = o.clutch_position;
  m.clutch_distance = o.clutch_distance;
  m.clutch_master_velocity = o.clutch_master_velocity;
  m.error = static_cast<std::int32_t>(o.error);
  m.warning = static_cast<std::int32_t>(o.warning);
  m.state = static_cast<std::int8_t>(o.state);
  m.clutch = static_cast<std::int8_t>(o.clutch);
  m.clutch_waits = static_cast<std::int8_t>(o.clutch_waits);
  m.cam_table = o.cam_table;
  m.cam_number = o.cam_number;
  m.next_cam_table = o.next_cam_table;
  m.pending_changes = o.pending_changes;
  m.cam_ends = o.cam_ends;
  m.internal_control_active = o.internal_control_active;
  m.axis_enabled = o.axis_enabled;
  m.done = o.done;
  m.busy = o.busy;
  m.is_homed = o.is_homed;
  m.hw_limit_switch_positive = o.hw_limit_switch_positive;
  m.hw_limit_switch_negative = o.hw_limit_switch_negative;
  m.sw_limit_enabled = o.sw_limit_enabled;
  m.sw_limit_switch_active = o.sw_limit_switch_active;
  m.cam_synchronised = o.cam_synchronised;
  m.acc_dec_sync = o.acc_dec_sync;
  m.end_of_profile = o.end_of_profile;
  m.sequencer_active = o.sequencer_active;
  m.bounds_valid = o.bounds_valid;
  m.master_lost = o.master_lost;
  m.offset_master_busy = o.offset_master_busy;
  m.offset_slave_busy = o.offset_slave_busy;
  m.scaling_master_busy = o.scaling_master_busy;
  m.scaling_slave_busy = o.scaling_slave_busy;
  m.offset_master_done = o.offset_master_done;
  m.offset_slave_done = o.offset_slave_done;
  m.scaling_master_done = o.scaling_master_done;
  m.scaling_slave_done = o.scaling_slave_done;
  return m;
}

msgs::group_state ToMessage(const engine::GroupSnapshot& snapshot, const engine::Machine& machine) {
  const group::Outputs& o = snapshot.outputs;
  msgs::group_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.groups[snapshot.index].name;
  m.state = static_cast<std::int8_t>(o.state);
  m.error = static_cast<std::int32_t>(o.error);
  m.x = o.x;
  m.y = o.y;
  m.z = o.z;
  m.a = o.a;
  m.b = o.b;
  m.c = o.c;
  m.actual_x = o.actual_x;
  m.actual_y = o.actual_y;
  m.actual_z = o.actual_z;
  m.actual_a = o.actual_a;
  m.actual_b = o.actual_b;
  m.actual_c = o.actual_c;
  m.velocity = o.velocity;
  m.acceleration = o.acceleration;
  m.actual_velocity = o.actual_velocity;
  m.path_position = o.path_position;
  m.path_velocity = o.path_velocity;
  m.path_acceleration = o.path_acceleration;
  m.path_left = o.path_left;
  m.time_left = o.time_left;
  m.path_error = o.path_error;
  m.override_factor = o.override_factor;
  m.command = Signed(o.command);
  m.buffered = o.buffered;
  m.axes = o.axes;
  m.member1 = o.member1;
  m.member2 = o.member2;
  m.member3 = o.member3;
  m.member4 = o.member4;
  m.member5 = o.member5;
  m.member6 = o.member6;
  m.member7 = o.member7;
  m.member8 = o.member8;
  m.pcs1 = ToMessage(o.pcs1);
  m.pcs2 = ToMessage(o.pcs2);
  m.pcs3 = ToMessage(o.pcs3);
  m.pcs4 = ToMessage(o.pcs4);
  m.pcs5 = ToMessage(o.pcs5);
  m.pcs6 = ToMessage(o.pcs6);
  m.pcs7 = ToMessage(o.pcs7);
  m.pcs8 = ToMessage(o.pcs8);
  m.pcs9 = ToMessage(o.pcs9);
  m.pcs10 = ToMessage(o.pcs10);
  m.pcs11 = ToMessage(o.pcs11);
  m.pcs12 = ToMessage(o.pcs12);
  m.pcs13 = ToMessage(o.pcs13);
  m.pcs14 = ToMessage(o.pcs14);
  m.pcs15 = ToMessage(o.pcs15);
  m.pcs16 = ToMessage(o.pcs16);
  m.track_state = static_cast<std::int8_t>(o.track_state);
  m.in_sync = o.in_sync;
  m.track_lag = o.track_lag;
  m.object_x = o.object_x;
  m.object_y = o.object_y;
  m.object_z = o.object_z;
  m.object_a = o.object_a;
  m.object_b = o.object_b;
  m.object_c = o.object_c;
  m.kinematics_on = o.kinematics_on;
  m.in_position = o.in_position;
  m.interrupted = o.interrupted;
  m.synchronized = o.synchronized;
  m.reason = static_cast<std::int8_t>(o.reason);
  m.problem = static_cast<std::int8_t>(o.problem);
  m.blocked_at = o.blocked_at;
  m.blocked_element = o.blocked_element;
  m.trouble = static_cast<std::int8_t>(o.trouble);
  m.first_part = o.first_part;
  m.second_part = o.second_part;
  m.on_blend = o.on_blend;
  m.checking = o.checking;
  m.zones = o.zones;
  m.waits_for = o.waits_for;
  m.waits_zone = o.waits_zone;
  m.tool = ToMessage(o.tool);
  return m;
}

msgs::belt_state ToMessage(const engine::BeltSnapshot& snapshot, const engine::Machine& machine) {
  const conveyor::Outputs& o = snapshot.outputs;
  msgs::belt_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.belts[snapshot.index].name;
  m.position = o.position;
  m.velocity = o.velocity;
  m.acceleration = o.acceleration;
  m.known = o.known;
  m.object_count = o.object_count;
  m.visible_count = o.visible_count;
  m.taken_count = o.taken_count;
  m.in_range_count = o.in_range_count;
  m.last_number = o.last_number;
  m.lost_count = o.lost_count;
  m.refused_count = o.refused_count;
  m.first_number = o.first_number;
  m.first_kind = o.first_kind;
  m.first_colour = o.first_colour;
  m.first_quality = o.first_quality;
  m.first_place = o.first_place;
  m.first_pose = ToMessage(o.first_pose);
  m.first_time_left = o.first_time_left;
  return m;
}

msgs::belt_objects ToMessage(const engine::ObjectsSnapshot& snapshot, const engine::Machine& machine) {
  const conveyor::BeltParams& belt = machine.belts[snapshot.index];
  msgs::belt_objects m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = belt.name;
  for (const conveyor::Object& object : conveyor::ObjectsOf(snapshot.state)) {
    const conveyor::Seen seen = conveyor::See(belt, snapshot.state, object);
    m.objects.push_back({.number = object.number,
                         .state = static_cast<std::int8_t>(object.state),
                         .place = seen.place,
                         .pose = ToMessage(seen.pose),
                         .in_range = seen.in_range,
                         .kind = object.attributes.kind,
                         .colour = object.attributes.colour,
                         .quality = object.attributes.quality});
  }
  m.count = static_cast<std::int32_t>(m.objects.size());
  return m;
}

msgs::cam_piece ToMessage(const cam::CamPiece& piece, const engine::Machine& machine) {
  const auto text = [](const Name& name) { return std::string(name.view()); };
  cam::CamParams part;
  part.name = text(piece.name);
  part.x_unit = text(piece.x_unit);
  part.y_unit = text(piece.y_unit);
  part.cyclic = piece.cyclic;
  part.interpolation = piece.interpolation;
  part.points.assign(piece.points.all().begin(), piece.points.all().end());
  part.segments.assign(piece.segments.all().begin(), piece.segments.all().end());
  msgs::cam_piece m{};
  m.cycle = Signed(piece.cycle);
  m.time_ns = TimeNs(piece.cycle, machine);
  m.name = part.name;
  m.number = Signed(piece.number);
  m.total = static_cast<std::int32_t>(piece.total);
  m.first = static_cast<std::int32_t>(piece.first);
  m.count = static_cast<std::int32_t>(part.points.size() + part.segments.size());
  m.text = ToJson(TypeOf<cam::CamParams>(), &part).dump();
  return m;
}

void Add(const engine::TrackPlaces& places, const engine::Machine& machine, msgs::track_shape& m) {
  m.cycle = Signed(places.cycle);
  m.time_ns = TimeNs(places.cycle, machine);
  m.name = machine.tracks[places.track].name;
  m.part = places.part;
  m.length = places.length;
  m.closed = places.closed;
  for (std::size_t i = 0; i < places.count; ++i) {
    const engine::TrackPlaces::At& at = places.places[i];
    m.position.push_back(at.position);
    m.x.push_back(at.x);
    m.y.push_back(at.y);
    m.direction.push_back(at.direction / kDegree);
  }
  m.count = static_cast<std::int32_t>(m.x.size());
}

msgs::pose_state ToMessage(const engine::PoseSnapshot& snapshot, const engine::Machine& machine) {
  const conveyor::PoseOutputs& o = snapshot.outputs;
  msgs::pose_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.poses[snapshot.index].name;
  m.pose = ToMessage(o.pose);
  m.velocity = o.velocity;
  m.turning = o.turning;
  m.age_s = o.age_s;
  m.fresh = o.fresh;
  return m;
}

msgs::track_state ToMessage(const engine::TrackSnapshot& snapshot, const engine::Machine& machine) {
  const track::Outputs& o = snapshot.outputs;
  msgs::track_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.tracks[snapshot.index].name;
  m.state = static_cast<std::int8_t>(o.state);
  m.operation_mode = static_cast<std::int8_t>(o.operation_mode);
  m.error = static_cast<std::int32_t>(o.error);
  m.length = o.length;
  m.closed_loop = o.closed_loop;
  m.element_count = o.element_count;
  m.mover_count = o.mover_count;
  m.previous_tracks = o.previous_tracks;
  m.subsequent_tracks = o.subsequent_tracks;
  m.group = o.group;
  return m;
}

msgs::planar_group_state ToMessage(const engine::PlanarGroupSnapshot& snapshot, const engine::Machine& machine) {
  const planargroup::Outputs& o = snapshot.outputs;
  msgs::planar_group_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.planar_groups[snapshot.index].name;
  m.state = static_cast<std::int8_t>(o.state);
  m.error = static_cast<std::int32_t>(o.error);
  m.mover_count = o.mover_count;
  m.track_count = o.track_count;
  m.environment = o.environment;
  return m;
}

msgs::environment_state ToMessage(const engine::EnvironmentSnapshot& snapshot, const engine::Machine& machine) {
  const environment::Outputs& o = snapshot.outputs;
  msgs::environment_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.environments[snapshot.index].name;
  m.stator_count = o.stator_count;
  m.border_count = o.border_count;
  m.group = o.group;
  return m;
}

msgs::part_state ToMessage(const engine::PartSnapshot& snapshot, const engine::Machine& machine) {
  const part::Outputs& o = snapshot.outputs;
  msgs::part_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.parts[snapshot.index].name;
  m.state = static_cast<std::int8_t>(o.state);
  m.error = static_cast<std::int32_t>(o.error);
  m.disable_forced = o.disable_forced;
  m.position_index = o.position_index;
  m.commanded_index = o.commanded_index;
  m.coordinate_system = o.coordinate_system;
  m.x = o.x;
  m.y = o.y;
  m.mover_count = o.mover_count;
  return m;
}

msgs::pick_place_state ToMessage(const engine::PickPlaceSnapshot& snapshot, const engine::Machine& machine) {
  const pickplace::Outputs& o = snapshot.outputs;
  msgs::pick_place_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.pick_and_place[snapshot.index].name;
  m.state = static_cast<std::int8_t>(o.state);
  m.error = static_cast<std::int32_t>(o.error);
  m.warning = static_cast<std::int32_t>(o.warning);
  m.error_axes = o.error_axes;
  m.set_path_velocity = o.set_path_velocity;
  m.path_preparation_time = o.path_preparation_time;
  m.precalculated_profile_time = o.precalculated_profile_time;
  m.position = ToMessage(o.position);
  m.velocity = ToMessage(o.velocity);
  m.profile_point_passed = o.profile_point_passed;
  m.target = o.target;
  m.workpiece = o.workpiece;
  m.profiles = o.profiles;
  m.picked = o.picked;
  m.placed = o.placed;
  m.missed = o.missed;
  m.missed_too_late = o.missed_too_late;
  m.missed_interrupted = o.missed_interrupted;
  m.missed_refused = o.missed_refused;
  m.warning_belt = o.warning_belt;
  m.held = o.held;
  m.held_kind = o.held_kind;
  m.held_colour = o.held_colour;
  m.held_quality = o.held_quality;
  m.picks_per_minute = o.picks_per_minute;
  m.internal_control_active = o.internal_control_active;
  m.axes_enabled = o.axes_enabled;
  m.axes_group_enabled = o.axes_group_enabled;
  m.done = o.done;
  m.busy = o.busy;
  m.axes_group_homed = o.axes_group_homed;
  m.in_position = o.in_position;
  m.hw_limit_switch_active = o.hw_limit_switch_active;
  m.sw_limit_switch_active = o.sw_limit_switch_active;
  m.hw_limit_switches_positive = o.hw_limit_switches_positive;
  m.hw_limit_switches_negative = o.hw_limit_switches_negative;
  m.sw_limits_enabled = o.sw_limits_enabled;
  m.sw_limit_switches = o.sw_limit_switches;
  m.path_hold = o.path_hold;
  m.off_path = o.off_path;
  m.gripper_control_active = o.gripper_control_active;
  m.pulse_gripper = o.pulse_gripper;
  m.profile_in_preparation = o.profile_in_preparation;
  m.acc_dec_sync = o.acc_dec_sync;
  m.synchronised = o.synchronised;
  m.in_target = o.in_target;
  m.in_park_position = o.in_park_position;
  return m;
}

msgs::mover_state ToMessage(const engine::MoverSnapshot& snapshot, const engine::Machine& machine) {
  const mover::Outputs& o = snapshot.outputs;
  msgs::mover_state m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.movers[snapshot.index].name;
  m.state = static_cast<std::int8_t>(o.state);
  m.command_mode = static_cast<std::int8_t>(o.command_mode);
  m.error = static_cast<std::int32_t>(o.error);
  m.limited_by = static_cast<std::int8_t>(o.limited_by);
  m.x = o.x;
  m.y = o.y;
  m.z = o.z;
  m.a = o.a;
  m.b = o.b;
  m.c = o.c;
  m.velocity_x = o.velocity_x;
  m.velocity_y = o.velocity_y;
  m.velocity_z = o.velocity_z;
  m.velocity_a = o.velocity_a;
  m.velocity_b = o.velocity_b;
  m.velocity_c = o.velocity_c;
  m.acceleration_x = o.acceleration_x;
  m.acceleration_y = o.acceleration_y;
  m.acceleration_z = o.acceleration_z;
  m.acceleration_a = o.acceleration_a;
  m.acceleration_b = o.acceleration_b;
  m.acceleration_c = o.acceleration_c;
  m.actual_x = o.actual_x;
  m.actual_y = o.actual_y;
  m.actual_z = o.actual_z;
  m.actual_a = o.actual_a;
  m.actual_b = o.actual_b;
  m.actual_c = o.actual_c;
  m.busy_xyc = o.busy_xyc;
  m.busy_z = o.busy_z;
  m.busy_a = o.busy_a;
  m.busy_b = o.busy_b;
  m.busy_c = o.busy_c;
  m.external = static_cast<std::int8_t>(o.external);
  m.track = o.track;
  m.track_position = o.track_position;
  m.track_velocity = o.track_velocity;
  m.track_acceleration = o.track_acceleration;
  m.gap = o.gap;
  m.target_x = o.target_x;
  m.target_y = o.target_y;
  m.target_c = o.target_c;
  m.target_track = o.target_track;
  m.target_position = o.target_position;
  m.reserved_lower_x = o.reserved_lower_x;
  m.reserved_lower_y = o.reserved_lower_y;
  m.reserved_upper_x = o.reserved_upper_x;
  m.reserved_upper_y = o.reserved_upper_y;
  m.in_sync = o.in_sync;
  m.sync_error = o.sync_error;
  m.waits_for = o.waits_for;
  m.deadlocked = o.deadlocked;
  m.delay = static_cast<std::int8_t>(o.delay);
  m.delay_since = Signed(o.delay_since);
  m.blocker_kind = static_cast<std::int8_t>(o.blocker_kind);
  m.blocker = o.blocker;
  m.buffered = o.buffered;
  m.group = o.group;
  m.coordinate_system = o.coordinate_system;
  m.part = o.part;
  m.formation = o.formation;
  m.commands = Signed(o.commands);
  m.on_route = o.on_route;
  m.route_granted = Signed(o.route_granted);
  m.route_visit = Signed(o.route_visit);
  return m;
}

msgs::mover_trail ToMessage(const engine::TrailSnapshot& snapshot, const engine::Machine& machine) {
  msgs::mover_trail m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.movers[snapshot.index].name;
  for (const std::uint32_t track : snapshot.trail.all()) m.tracks.push_back(std::int64_t{track} + 1);
  m.count = static_cast<std::int32_t>(m.tracks.size());
  return m;
}

msgs::mover_route ToMessage(const engine::RouteSnapshot& snapshot, const engine::Machine& machine) {
  msgs::mover_route m{};
  m.cycle = Signed(snapshot.cycle);
  m.time_ns = TimeNs(snapshot.cycle, machine);
  m.name = machine.movers[snapshot.index].name;
  m.coordinate_system = snapshot.coordinate_system;
  m.first = Signed(snapshot.first);
  for (const planar::Place& place : snapshot.all()) {
    m.x.push_back(place.x);
    m.y.push_back(place.y);
  }
  m.count = static_cast<std::int32_t>(m.x.size());
  return m;
}

msgs::histogram ToMessage(const engine::Histogram& histogram) {
  msgs::histogram m{};
  std::transform(histogram.buckets.begin(), histogram.buckets.end(), m.buckets, Signed);
  m.count = Signed(histogram.count);
  m.max = Signed(histogram.max);
  return m;
}

msgs::engine_state ToMessage(const engine::EngineFigures& figures, const engine::Machine& machine) {
  msgs::engine_state m{};
  m.cycle = Signed(figures.cycle);
  m.time_ns = TimeNs(figures.cycle, machine);
  m.period_s = machine.cycle.period_s;
  m.overruns = Signed(figures.overruns);
  m.cycles_skipped = Signed(figures.cycles_skipped);
  m.commands_applied = Signed(figures.commands_applied);
  m.commands_refused = Signed(figures.commands_refused);
  m.snapshots_dropped = Signed(figures.snapshots_dropped);
  m.feedback_dropped = Signed(figures.feedback_dropped);
  m.journal_dropped = Signed(figures.journal_dropped);
  m.set_points_dropped = Signed(figures.set_points_dropped);
  m.samples_refused = Signed(figures.samples_refused);
  m.planner_second_scale = Signed(figures.planner_second_scale);
  m.planner_failures = Signed(figures.planner_failures);
  m.state_hash = Signed(figures.state_hash);
  m.execution = ToMessage(figures.execution);
  m.latency = ToMessage(figures.latency);
  return m;
}

msgs::feedback ToMessage(const FeedbackEvent& event) {
  msgs::feedback m{};
  m.ticket = Signed(event.ticket);
  m.cycle = Signed(event.cycle);
  m.state = static_cast<std::int8_t>(event.state);
  m.reached = event.reached;
  m.error_id = static_cast<std::int32_t>(event.error);
  m.value = event.value;
  m.sentence = engine::Sentence(event);
  m.object_kind = static_cast<std::int8_t>(event.object.kind);
  m.object_number = event.object.number;
  return m;
}

msgs::journal_command ToMessage(const engine::JournalEntry& entry, const engine::Machine& machine) {
  engine::CommandText text = engine::ToText(machine, entry.command);
  msgs::journal_command m{};
  m.cycle = Signed(entry.cycle);
  m.ticket = Signed(entry.command.ticket);
  m.lease_s = entry.command.lease_s;
  m.target = std::move(text.target);
  m.verb = std::move(text.verb);
  m.arguments = std::move(text.arguments);
  return m;
}

msgs::drive_setpoint ToMessage(const engine::DriveSetPoint& set_point, const engine::Machine& machine) {
  const ServoOutputs& o = set_point.outputs;
  msgs::drive_setpoint m{};
  m.cycle = set_point.cycle;
  m.axis = machine.axes[set_point.axis].name;
  m.period_s = machine.cycle.period_s;
  m.mode = static_cast<std::int8_t>(o.mode);
  m.enable = o.enable;
  m.release_brake = o.release_brake;
  m.position_counts = o.position_counts;
  m.velocity_counts_s = o.velocity_counts_s;
  m.voltage_v = o.voltage_v;
  m.torque_nm = o.torque_nm;
  m.torque_until_counts_s = o.torque_until_counts_s;
  m.torque_limit_nm = o.torque_limit_nm;
  m.digital_outputs = o.digital_outputs;
  return m;
}

msgs::drive_feedback ToMessage(const engine::DriveSample& sample, const engine::Machine& machine) {
  const ServoInputs& in = sample.inputs;
  msgs::drive_feedback m{};
  m.cycle = sample.cycle;
  m.axis = machine.axes[sample.axis].name;
  m.counts = in.counts;
  m.index_counts = in.index_counts;
  m.index_pulses = in.index_pulses;
  m.encoder_error = in.encoder_error;
  m.limit_positive = in.limit_positive;
  m.limit_negative = in.limit_negative;
  m.reference = in.reference;
  m.touch_probe = in.touch_probe;
  m.probe_rises = in.probe_rises;
  m.probe_falls = in.probe_falls;
  m.probe_rise_age_s = in.probe_rise_age_s;
  m.probe_fall_age_s = in.probe_fall_age_s;
  m.drive_ready = in.drive_ready;
  m.drive_fault = in.drive_fault;
  m.torque_nm = in.torque_nm;
  m.load_counts = in.load_counts;
  m.load_encoder_error = in.load_encoder_error;
  m.drive_error = in.drive_error;
  return m;
}

msgs::journal_drive ToMessage(const engine::DriveEntry& entry, const engine::Machine& machine) {
  msgs::journal_drive m{};
  m.cycle = Signed(entry.cycle);
  m.feedback = ToMessage(entry.sample, machine);
  return m;
}

engine::DriveSample ToSample(const msgs::drive_feedback& m, std::uint32_t axis) {
  engine::DriveSample sample;
  sample.cycle = m.cycle;
  sample.axis = axis;
  ServoInputs& in = sample.inputs;
  in.counts = static_cast<std::uint32_t>(m.counts);
  in.index_counts = static_cast<std::uint32_t>(m.index_counts);
  in.index_pulses = static_cast<std::uint32_t>(m.index_pulses);
  in.encoder_error = m.encoder_error != 0;
  in.limit_positive = m.limit_positive != 0;
  in.limit_negative = m.limit_negative != 0;
  in.reference = m.reference != 0;
  in.touch_probe = m.touch_probe != 0;
  in.probe_rises = static_cast<std::uint32_t>(m.probe_rises);
  in.probe_falls = static_cast<std::uint32_t>(m.probe_falls);
  in.probe_rise_age_s = m.probe_rise_age_s;
  in.probe_fall_age_s = m.probe_fall_age_s;
  in.drive_ready = m.drive_ready != 0;
  in.drive_fault = m.drive_fault != 0;
  in.torque_nm = m.torque_nm;
  in.load_counts = static_cast<std::uint32_t>(m.load_counts);
  in.load_encoder_error = m.load_encoder_error != 0;
  in.drive_error = static_cast<std::int32_t>(m.drive_error);
  sample.later_s = m.later_s;
  return sample;
}

std::optional<msgs::command> DecodeCommand(std::span<const std::uint8_t> bytes) {
  return Decode<msgs::command>(bytes, "iisiisss");
}

std::optional<msgs::heartbeat> DecodeHeartbeat(std::span<const std::uint8_t> bytes) {
  return Decode<msgs::heartbeat>(bytes, "iisi");
}

std::optional<msgs::machine_description> DecodeMachine(std::span<const std::uint8_t> bytes) {
  return Decode<msgs::machine_description>(bytes, "iiissis");
}

std::optional<msgs::drive_feedback> DecodeDriveFeedback(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kLayout = "iiiiisiiibbbbbiiiibbiibii";
  if (!IsFeedbackBefore(bytes)) return Decode<msgs::drive_feedback>(bytes, kLayout);
  std::vector<std::uint8_t> longer(bytes.begin(), bytes.end());
  const auto fingerprint = static_cast<std::uint64_t>(msgs::drive_feedback::getHash());
  for (std::size_t i = 0; i < kFingerprint; ++i) {
    longer[i] = static_cast<std::uint8_t>(fingerprint >> (8 * (kFingerprint - 1 - i)));
  }
  longer.resize(longer.size() + kFeedbackAdded);
  return Decode<msgs::drive_feedback>(longer, kLayout);
}

}  // namespace takt::lcm
