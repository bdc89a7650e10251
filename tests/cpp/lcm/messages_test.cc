#include "takt/lcm/messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "takt/core/columns.h"
#include "takt/core/describe.h"
#include "test_machine.h"

namespace takt::lcm {
namespace {

// Encoded and decoded, as by a receiver in any language.
template <typename Message>
Message ThroughBytes(const Message& message) {
  std::vector<std::uint8_t> bytes;
  Encode(message, bytes);
  Message decoded{};
  EXPECT_EQ(decoded.decode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  return decoded;
}

msgs::command GoodCommand() {
  return Command(2, "x", "move_absolute", "{position: 10}");
}

// EN-20
TEST(Messages, AxisStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.cycle.period_s = 0.00025;
  engine::AxisSnapshot s;
  s.cycle = 4'000'001;
  s.index = 1;
  axis::Outputs& o = s.outputs;
  o.set_position = 1.25;
  o.set_velocity = -2.5;
  o.set_acceleration = std::numeric_limits<double>::quiet_NaN();
  o.actual_position = 1.0 / 3;
  o.actual_velocity = -1e-300;
  o.following_error = 0.125;
  o.voltage_v = -9.75;
  o.torque_nm = 3.5;
  o.active_command = (Ticket{1} << 53) + 1;  // more than a double could hold
  o.error = ErrorId::kGroupDeviation;
  o.state = axis::PlcState::kErrorStop;
  o.limited_by = LimitedBy::kDistance;
  o.buffered_commands = 255;
  o.true_position = 1.5;
  o.loop_closed = o.limit_positive = o.reference = true;
  const msgs::axis_state m = ThroughBytes(ToMessage(s, machine));
  EXPECT_EQ(m.cycle, 4'000'001);
  EXPECT_EQ(m.time_ns, 1'000'000'250'000);
  EXPECT_EQ(m.name, "y");
  EXPECT_EQ(m.set_position, 1.25);
  EXPECT_EQ(m.set_velocity, -2.5);
  EXPECT_TRUE(std::isnan(m.set_acceleration));
  EXPECT_EQ(m.actual_position, 1.0 / 3);
  EXPECT_EQ(m.actual_velocity, -1e-300);
  EXPECT_EQ(m.following_error, 0.125);
  EXPECT_EQ(m.true_position, 1.5);
  EXPECT_EQ(m.voltage_v, -9.75);
  EXPECT_EQ(m.torque_nm, 3.5);
  EXPECT_EQ(m.active_command, 9007199254740993);
  EXPECT_EQ(m.error, 8001);
  EXPECT_EQ(m.state, msgs::axis_state::STATE_ERROR_STOP);
  EXPECT_EQ(m.limited_by, msgs::axis_state::LIMITED_BY_DISTANCE);
  EXPECT_EQ(m.buffered_commands, 255);
  EXPECT_EQ(m.loop_closed, 1);
  EXPECT_EQ(m.in_position, 0);
  EXPECT_EQ(m.limit_positive, 1);
  EXPECT_EQ(m.limit_negative, 0);
  EXPECT_EQ(m.reference, 1);
  EXPECT_EQ(m.touch_probe, 0);
}

// Stores a number in a type of any size.
void Put(const Type& type, std::int64_t value, void* at) {
  switch (type.kind) {
    case Kind::kReal:
      *static_cast<double*>(at) = static_cast<double>(value) + 0.25;
      return;
    case Kind::kBool:
      *static_cast<bool*>(at) = true;
      return;
    default:
      ASSERT_TRUE(type.kind == Kind::kInteger || type.kind == Kind::kEnum);
      std::memcpy(at, &value, type.size);  // little-endian, as on all supported platforms
  }
}

// The access of a test to one field of a message.
template <typename Message>
struct MessageField {
  std::string_view name;
  double (*in_message)(const Message&);
};
#define FIELD(message, field)                                                   \
  {                                                                             \
#field, [](const msgs::message& m) { return static_cast<double>(m.field); } \
  }
#define POSE(message, field)                                                                                          \
  FIELD_OF(message, field, x), FIELD_OF(message, field, y), FIELD_OF(message, field, z), FIELD_OF(message, field, a), \
      FIELD_OF(message, field, b), FIELD_OF(message, field, c)
#define FIELD_OF(message, field, part)                                    \
  {                                                                       \
#field "_" #part, [](const msgs::message& m) { return m.field.part; } \
  }

// Each output has its own field of the same name, and affects no other.
template <typename Message, typename Outputs>
void ExpectKeepsEveryNumber(const std::vector<MessageField<Message>>& fields, const engine::Machine& machine,
                            const std::string& name) {
  const std::vector<Column> outputs = ColumnsOf(TypeOf<Outputs>());
  ASSERT_EQ(fields.size(), outputs.size());
  engine::SnapshotOf<Outputs> plain;
  plain.cycle = 4'000'001;
  plain.index = 1;
  const Message before = ThroughBytes(ToMessage(plain, machine));
  EXPECT_EQ(before.cycle, 4'000'001);
  EXPECT_EQ(before.time_ns, 1'000'000'250'000);
  EXPECT_EQ(before.name, name);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Column& field = outputs[i];
    ASSERT_EQ(field.name, fields[i].name);
    const bool is_enum = field.type->kind == Kind::kEnum;
    const std::int64_t value =
        is_enum ? field.type->enumerators.back().value : 4'000'000'000 + static_cast<std::int64_t>(i);
    engine::SnapshotOf<Outputs> changed = plain;
    Put(*field.type, value, reinterpret_cast<std::byte*>(&changed.outputs) + field.offset);
    const Message after = ThroughBytes(ToMessage(changed, machine));
    double wanted = static_cast<double>(value);
    if (field.type->kind == Kind::kReal) wanted += 0.25;
    if (field.type->kind == Kind::kBool) wanted = 1;
    EXPECT_EQ(fields[i].in_message(after), wanted) << field.name;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      if (k == i) continue;
      EXPECT_EQ(fields[k].in_message(after), fields[k].in_message(before)) << field.name << " " << fields[k].name;
    }
  }
}

// EN-20, CAM-10
TEST(Messages, FlexCamStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.flex_cams.resize(2);
  machine.flex_cams[0].name = "other";
  machine.flex_cams[1].name = "cutter";
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::flex_cam_state, flexcam::Outputs>(
      {
          FIELD(flex_cam_state, set_offset_master),
          FIELD(flex_cam_state, set_offset_slave),
          FIELD(flex_cam_state, set_scaling_master),
          FIELD(flex_cam_state, set_scaling_slave),
          FIELD(flex_cam_state, set_x_position),
          FIELD(flex_cam_state, set_x_velocity),
          FIELD(flex_cam_state, set_x_acceleration),
          FIELD(flex_cam_state, set_y_position),
          FIELD(flex_cam_state, set_y_velocity),
          FIELD(flex_cam_state, set_y_acceleration),
          FIELD(flex_cam_state, actual_slave_position),
          FIELD(flex_cam_state, actual_slave_velocity),
          FIELD(flex_cam_state, slave_max_position),
          FIELD(flex_cam_state, slave_min_position),
          FIELD(flex_cam_state, slave_max_velocity),
          FIELD(flex_cam_state, slave_max_acceleration),
          FIELD(flex_cam_state, ip01_set_scaling_master),
          FIELD(flex_cam_state, ip02_scaling_mode_master),
          FIELD(flex_cam_state, ip03_set_offset_master),
          FIELD(flex_cam_state, ip04_set_offset_slave),
          FIELD(flex_cam_state, ip05_offset_mode_slave),
          FIELD(flex_cam_state, ip06_set_scaling_slave),
          FIELD(flex_cam_state, ip07_scaling_mode_slave),
          FIELD(flex_cam_state, ip08_cam_table1),
          FIELD(flex_cam_state, ip09_cam_table2),
          FIELD(flex_cam_state, ip10_cam_table3),
          FIELD(flex_cam_state, ip11_cam_table4),
          FIELD(flex_cam_state, mp01_set_master_position),
          FIELD(flex_cam_state, mp02_set_slave_position),
          FIELD(flex_cam_state, mp03_master_to_x_position),
          FIELD(flex_cam_state, mp04_cam_profiler_position_out),
          FIELD(flex_cam_state, mp05_set_y_position),
          FIELD(flex_cam_state, mp06_y_to_slave_position),
          FIELD(flex_cam_state, op01_set_x_position_out),
          FIELD(flex_cam_state, op02_set_y_position_out),
          FIELD(flex_cam_state, clutch_position),
          FIELD(flex_cam_state, clutch_distance),
          FIELD(flex_cam_state, clutch_master_velocity),
          FIELD(flex_cam_state, error),
          FIELD(flex_cam_state, warning),
          FIELD(flex_cam_state, state),
          FIELD(flex_cam_state, clutch),
          FIELD(flex_cam_state, clutch_waits),
          FIELD(flex_cam_state, cam_table),
          FIELD(flex_cam_state, cam_number),
          FIELD(flex_cam_state, next_cam_table),
          FIELD(flex_cam_state, pending_changes),
          FIELD(flex_cam_state, cam_ends),
          FIELD(flex_cam_state, internal_control_active),
          FIELD(flex_cam_state, axis_enabled),
          FIELD(flex_cam_state, done),
          FIELD(flex_cam_state, busy),
          FIELD(flex_cam_state, is_homed),
          FIELD(flex_cam_state, hw_limit_switch_positive),
          FIELD(flex_cam_state, hw_limit_switch_negative),
          FIELD(flex_cam_state, sw_limit_enabled),
          FIELD(flex_cam_state, sw_limit_switch_active),
          FIELD(flex_cam_state, cam_synchronised),
          FIELD(flex_cam_state, acc_dec_sync),
          FIELD(flex_cam_state, end_of_profile),
          FIELD(flex_cam_state, sequencer_active),
          FIELD(flex_cam_state, bounds_valid),
          FIELD(flex_cam_state, master_lost),
          FIELD(flex_cam_state, offset_master_busy),
          FIELD(flex_cam_state, offset_slave_busy),
          FIELD(flex_cam_state, scaling_master_busy),
          FIELD(flex_cam_state, scaling_slave_busy),
          FIELD(flex_cam_state, offset_master_done),
          FIELD(flex_cam_state, offset_slave_done),
          FIELD(flex_cam_state, scaling_master_done),
          FIELD(flex_cam_state, scaling_slave_done),
      },
      machine, "cutter");
  EXPECT_EQ(static_cast<int>(flexcam::ModuleState::kError), msgs::flex_cam_state::STATE_ERROR);
  EXPECT_EQ(static_cast<int>(flexcam::ModuleState::kSync), msgs::flex_cam_state::STATE_SYNC);
}

// EN-20, GR-02
TEST(Messages, GroupStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.groups.resize(2);
  machine.groups[0].name = "other";
  machine.groups[1].name = "robot";
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::group_state, group::Outputs>(
      {
          FIELD(group_state, state),
          FIELD(group_state, error),
          FIELD(group_state, x),
          FIELD(group_state, y),
          FIELD(group_state, z),
          FIELD(group_state, a),
          FIELD(group_state, b),
          FIELD(group_state, c),
          FIELD(group_state, actual_x),
          FIELD(group_state, actual_y),
          FIELD(group_state, actual_z),
          FIELD(group_state, actual_a),
          FIELD(group_state, actual_b),
          FIELD(group_state, actual_c),
          FIELD(group_state, velocity),
          FIELD(group_state, acceleration),
          FIELD(group_state, actual_velocity),
          FIELD(group_state, path_position),
          FIELD(group_state, path_velocity),
          FIELD(group_state, path_acceleration),
          FIELD(group_state, path_left),
          FIELD(group_state, time_left),
          FIELD(group_state, path_error),
          FIELD(group_state, override_factor),
          FIELD(group_state, command),
          FIELD(group_state, buffered),
          FIELD(group_state, axes),
          FIELD(group_state, member1),
          FIELD(group_state, member2),
          FIELD(group_state, member3),
          FIELD(group_state, member4),
          FIELD(group_state, member5),
          FIELD(group_state, member6),
          FIELD(group_state, member7),
          FIELD(group_state, member8),
          POSE(group_state, pcs1),
          POSE(group_state, pcs2),
          POSE(group_state, pcs3),
          POSE(group_state, pcs4),
          POSE(group_state, pcs5),
          POSE(group_state, pcs6),
          POSE(group_state, pcs7),
          POSE(group_state, pcs8),
          POSE(group_state, pcs9),
          POSE(group_state, pcs10),
          POSE(group_state, pcs11),
          POSE(group_state, pcs12),
          POSE(group_state, pcs13),
          POSE(group_state, pcs14),
          POSE(group_state, pcs15),
          POSE(group_state, pcs16),
          FIELD(group_state, track_state),
          FIELD(group_state, in_sync),
          FIELD(group_state, track_lag),
          FIELD(group_state, object_x),
          FIELD(group_state, object_y),
          FIELD(group_state, object_z),
          FIELD(group_state, object_a),
          FIELD(group_state, object_b),
          FIELD(group_state, object_c),
          FIELD(group_state, kinematics_on),
          FIELD(group_state, in_position),
          FIELD(group_state, interrupted),
          FIELD(group_state, synchronized),
          FIELD(group_state, reason),
          FIELD(group_state, problem),
          FIELD(group_state, blocked_at),
          FIELD(group_state, blocked_element),
          FIELD(group_state, trouble),
          FIELD(group_state, first_part),
          FIELD(group_state, second_part),
          FIELD(group_state, on_blend),
          FIELD(group_state, checking),
          FIELD(group_state, zones),
          FIELD(group_state, waits_for),
          FIELD(group_state, waits_zone),
          POSE(group_state, tool),
      },
      machine, "robot");
  EXPECT_EQ(static_cast<int>(group::GroupState::kErrorStop), msgs::group_state::STATE_GROUP_ERROR_STOP);
}
// EN-20, CV-01
TEST(Messages, BeltStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.belts.resize(2);
  machine.belts[0].name = "other";
  machine.belts[1].name = "infeed";
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::belt_state, conveyor::Outputs>(
      {
          FIELD(belt_state, position),
          FIELD(belt_state, velocity),
          FIELD(belt_state, acceleration),
          FIELD(belt_state, known),
          FIELD(belt_state, object_count),
          FIELD(belt_state, visible_count),
          FIELD(belt_state, taken_count),
          FIELD(belt_state, in_range_count),
          FIELD(belt_state, last_number),
          FIELD(belt_state, lost_count),
          FIELD(belt_state, refused_count),
          FIELD(belt_state, first_number),
          FIELD(belt_state, first_kind),
          FIELD(belt_state, first_colour),
          FIELD(belt_state, first_quality),
          FIELD(belt_state, first_place),
          POSE(belt_state, first_pose),
          FIELD(belt_state, first_time_left),
      },
      machine, "infeed");
}

// PL-86
TEST(Messages, MoverTrailNamesItsTracksByTheirNumbers) {
  engine::Machine machine = TestMachine();
  machine.movers = {{.name = "other"}, {.name = "shuttle"}};
  engine::TrailSnapshot snapshot{.cycle = 12, .index = 1};
  EXPECT_EQ(ToMessage(snapshot, machine).count, 0);
  snapshot.trail.count = 3;
  snapshot.trail.tracks = {4, 0, 7};
  const msgs::mover_trail message = ToMessage(snapshot, machine);
  EXPECT_EQ(message.name, "shuttle");
  EXPECT_EQ(message.cycle, 12);
  EXPECT_EQ(message.count, 3);
  EXPECT_EQ(message.tracks, (std::vector<std::int64_t>{5, 1, 8}));
}

// PL-72
TEST(Messages, MoverRouteHasItsPlaces) {
  engine::Machine machine = TestMachine();
  machine.movers = {{.name = "other"}, {.name = "shuttle"}};
  engine::RouteSnapshot snapshot{.cycle = 12, .index = 1, .coordinate_system = 2, .first = 7};
  EXPECT_EQ(ToMessage(snapshot, machine).count, 0);
  snapshot.count = 2;
  snapshot.places[0] = {120, 360};
  snapshot.places[1] = {240, 480};
  const msgs::mover_route message = ToMessage(snapshot, machine);
  EXPECT_EQ(message.name, "shuttle");
  EXPECT_EQ(message.cycle, 12);
  EXPECT_EQ(message.coordinate_system, 2);
  EXPECT_EQ(message.first, 7);
  EXPECT_EQ(message.count, 2);
  EXPECT_EQ(message.x, (std::vector<double>{120, 240}));
  EXPECT_EQ(message.y, (std::vector<double>{360, 480}));
}

// EN-20
TEST(Messages, TrackStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.tracks.resize(2);
  machine.tracks[1].name = "loop";
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::track_state, track::Outputs>(
      {
          FIELD(track_state, state),
          FIELD(track_state, operation_mode),
          FIELD(track_state, error),
          FIELD(track_state, length),
          FIELD(track_state, closed_loop),
          FIELD(track_state, element_count),
          FIELD(track_state, mover_count),
          FIELD(track_state, previous_tracks),
          FIELD(track_state, subsequent_tracks),
          FIELD(track_state, group),
      },
      machine, "loop");
}

// EN-20, PL-30
TEST(Messages, PlanarGroupStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.planar_groups.resize(2);
  machine.planar_groups[1].name = "cell";
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::planar_group_state, planargroup::Outputs>(
      {
          FIELD(planar_group_state, state),
          FIELD(planar_group_state, error),
          FIELD(planar_group_state, mover_count),
          FIELD(planar_group_state, track_count),
          FIELD(planar_group_state, environment),
      },
      machine, "cell");
}

// EN-20, PL-31
TEST(Messages, EnvironmentStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.environments.resize(2);
  machine.environments[1].name = "floor";
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::environment_state, environment::Outputs>(
      {
          FIELD(environment_state, stator_count),
          FIELD(environment_state, border_count),
          FIELD(environment_state, group),
      },
      machine, "floor");
}

// EN-20, PL-32
TEST(Messages, PartStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.parts.resize(2);
  machine.parts[1].name = "lift";
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::part_state, part::Outputs>(
      {
          FIELD(part_state, state),
          FIELD(part_state, error),
          FIELD(part_state, disable_forced),
          FIELD(part_state, position_index),
          FIELD(part_state, commanded_index),
          FIELD(part_state, coordinate_system),
          FIELD(part_state, x),
          FIELD(part_state, y),
          FIELD(part_state, mover_count),
      },
      machine, "lift");
}

// EN-20, CV-42
TEST(Messages, PoseStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.poses = {{.name = "other"}, {.name = "mover"}};
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::pose_state, conveyor::PoseOutputs>(
      {
          POSE(pose_state, pose),
          FIELD(pose_state, velocity),
          FIELD(pose_state, turning),
          FIELD(pose_state, age_s),
          FIELD(pose_state, fresh),
      },
      machine, "mover");
}

// EN-20, PL-01
TEST(Messages, MoverStateKeepsEveryNumber) {
  engine::Machine machine = TestMachine();
  machine.movers = {{.name = "other"}, {.name = "shuttle"}};
  machine.cycle.period_s = 0.00025;
  ExpectKeepsEveryNumber<msgs::mover_state, mover::Outputs>(
      {
          FIELD(mover_state, state),
          FIELD(mover_state, command_mode),
          FIELD(mover_state, error),
          FIELD(mover_state, limited_by),
          FIELD(mover_state, x),
          FIELD(mover_state, y),
          FIELD(mover_state, z),
          FIELD(mover_state, a),
          FIELD(mover_state, b),
          FIELD(mover_state, c),
          FIELD(mover_state, velocity_x),
          FIELD(mover_state, velocity_y),
          FIELD(mover_state, velocity_z),
          FIELD(mover_state, velocity_a),
          FIELD(mover_state, velocity_b),
          FIELD(mover_state, velocity_c),
          FIELD(mover_state, acceleration_x),
          FIELD(mover_state, acceleration_y),
          FIELD(mover_state, acceleration_z),
          FIELD(mover_state, acceleration_a),
          FIELD(mover_state, acceleration_b),
          FIELD(mover_state, acceleration_c),
          FIELD(mover_state, actual_x),
          FIELD(mover_state, actual_y),
          FIELD(mover_state, actual_z),
          FIELD(mover_state, actual_a),
          FIELD(mover_state, actual_b),
          FIELD(mover_state, actual_c),
          FIELD(mover_state, busy_xyc),
          FIELD(mover_state, busy_z),
          FIELD(mover_state, busy_a),
          FIELD(mover_state, busy_b),
          FIELD(mover_state, busy_c),
          FIELD(mover_state, external),
          FIELD(mover_state, track),
          FIELD(mover_state, track_position),
          FIELD(mover_state, track_velocity),
          FIELD(mover_state, track_acceleration),
          FIELD(mover_state, gap),
          FIELD(mover_state, target_x),
          FIELD(mover_state, target_y),
          FIELD(mover_state, target_c),
          FIELD(mover_state, target_track),
          FIELD(mover_state, target_position),
          FIELD(mover_state, reserved_lower_x),
          FIELD(mover_state, reserved_lower_y),
          FIELD(mover_state, reserved_upper_x),
          FIELD(mover_state, reserved_upper_y),
          FIELD(mover_state, in_sync),
          FIELD(mover_state, sync_error),
          FIELD(mover_state, waits_for),
          FIELD(mover_state, deadlocked),
          FIELD(mover_state, delay),
          FIELD(mover_state, delay_since),
          FIELD(mover_state, blocker_kind),
          FIELD(mover_state, blocker),
          FIELD(mover_state, buffered),
          FIELD(mover_state, group),
          FIELD(mover_state, coordinate_system),
          FIELD(mover_state, part),
          FIELD(mover_state, formation),
          FIELD(mover_state, commands),
          FIELD(mover_state, on_route),
          FIELD(mover_state, route_granted),
          FIELD(mover_state, route_visit),
      },
      machine, "shuttle");
  EXPECT_EQ(static_cast<int>(planar::ObjectState::kResetting), msgs::mover_state::STATE_RESETTING);
  EXPECT_EQ(static_cast<int>(mover::Delay::kPlace), msgs::mover_state::DELAY_PLACE);
  EXPECT_EQ(static_cast<int>(mover::CommandMode::kFormation), msgs::mover_state::MODE_FORMATION);
}
#undef FIELD
#undef FIELD_OF
#undef POSE

// EN-05, EN-20
TEST(Messages, EngineStateKeepsEveryNumber) {
  engine::EngineFigures f;
  f.cycle = 10;
  f.overruns = 1;
  f.commands_applied = 2;
  f.commands_refused = 3;
  f.snapshots_dropped = 4;
  f.feedback_dropped = 5;
  f.journal_dropped = 15;
  f.planner_second_scale = 6;
  f.planner_failures = 7;
  f.state_hash = 0xffff'ffff'ffff'fffe;
  f.execution.Add(1000);
  f.latency.Add(1u << 20);
  const msgs::engine_state m = ThroughBytes(ToMessage(f, TestMachine()));
  EXPECT_EQ(m.cycle, 10);
  EXPECT_EQ(m.time_ns, 10'000'000);
  EXPECT_EQ(m.period_s, 0.001);
  EXPECT_EQ(m.overruns, 1);
  EXPECT_EQ(m.commands_applied, 2);
  EXPECT_EQ(m.commands_refused, 3);
  EXPECT_EQ(m.snapshots_dropped, 4);
  EXPECT_EQ(m.feedback_dropped, 5);
  EXPECT_EQ(m.journal_dropped, 15);
  EXPECT_EQ(m.planner_second_scale, 6);
  EXPECT_EQ(m.planner_failures, 7);
  EXPECT_EQ(m.state_hash, -2);
  EXPECT_EQ(m.execution.buckets[9], 1);
  EXPECT_EQ(m.execution.max, 1000);
  EXPECT_EQ(m.latency.buckets[20], 1);
  EXPECT_EQ(m.latency.count, 1);
}

TEST(Messages, FeedbackSaysItsErrorInASentence) {
  const msgs::feedback error =
      ThroughBytes(ToMessage(FeedbackEvent{7, 8, FeedbackState::kError, false, ErrorId::kTargetBehindLimit, 0}));
  EXPECT_EQ(error.ticket, 7);
  EXPECT_EQ(error.cycle, 8);
  EXPECT_EQ(error.state, msgs::feedback::STATE_ERROR);
  EXPECT_EQ(error.error_id, 8);
  EXPECT_EQ(error.sentence, ErrorText(ErrorId::kTargetBehindLimit));
  const msgs::feedback blocked = ThroughBytes(ToMessage(
      FeedbackEvent{7, 8, FeedbackState::kError, false, ErrorId::kCollision, 0, {ObjectKind::kEnvironment, 3}}));
  EXPECT_EQ(blocked.object_kind, msgs::feedback::OBJECT_ENVIRONMENT);
  EXPECT_EQ(blocked.object_number, 3);
  const msgs::feedback reached =
      ThroughBytes(ToMessage(FeedbackEvent{7, 8, FeedbackState::kActive, true, ErrorId::kNone, 2.5}));
  EXPECT_EQ(reached.reached, 1);
  EXPECT_EQ(reached.sentence, "");
}

// EN-07
TEST(Messages, JournalCommandReadsBackAsTheSameCommand) {
  const engine::Machine machine = TestMachine();
  engine::ParsedCommand parsed =
      engine::ParseCommand(machine, "y", "move_absolute", "{position: 0.1, velocity: 33.3, buffer_mode: blending_low}");
  ASSERT_EQ(parsed.error, ErrorId::kNone) << parsed.sentence;
  parsed.command.ticket = 12;
  parsed.command.lease_s = 0.25;
  const msgs::journal_command m = ThroughBytes(ToMessage(engine::JournalEntry{99, parsed.command}, machine));
  EXPECT_EQ(m.cycle, 99);
  EXPECT_EQ(m.ticket, 12);
  EXPECT_EQ(m.lease_s, 0.25);
  const engine::ParsedCommand again = engine::ParseCommand(machine, m.target, m.verb, m.arguments);
  ASSERT_EQ(again.error, ErrorId::kNone) << again.sentence;
  EXPECT_EQ(again.command.target, parsed.command.target);
  const auto& before = std::get<axis::MoveAbsolute>(std::get<axis::Command>(parsed.command.body));
  const auto& after = std::get<axis::MoveAbsolute>(std::get<axis::Command>(again.command.body));
  EXPECT_EQ(after.position, before.position);
  EXPECT_EQ(after.velocity, before.velocity);
  EXPECT_EQ(after.acceleration, before.acceleration);
  EXPECT_EQ(after.buffer_mode, before.buffer_mode);
}

TEST(Messages, JournalHashesKeepTheirBits) {
  msgs::journal_hashes m{};
  m.first_cycle = 5;
  m.hashes = {-1, 0, std::numeric_limits<std::int64_t>::min()};
  m.count = 3;
  EXPECT_EQ(ThroughBytes(m).hashes, m.hashes);
}

TEST(Messages, CommandAndHeartbeatDecode) {
  std::vector<std::uint8_t> bytes;
  Encode(GoodCommand(), bytes);
  const auto command = DecodeCommand(bytes);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->run_id, 4711);
  EXPECT_EQ(command->client, "test");
  EXPECT_EQ(command->session, 1);
  EXPECT_EQ(command->id, 2);
  EXPECT_EQ(command->target, "x");
  EXPECT_EQ(command->verb, "move_absolute");
  EXPECT_EQ(command->arguments, "{position: 10}");
  EXPECT_FALSE(DecodeHeartbeat(bytes));

  msgs::heartbeat heartbeat{};
  heartbeat.run_id = 4711;
  heartbeat.client = "test";
  heartbeat.session = -3;
  Encode(heartbeat, bytes);
  ASSERT_TRUE(DecodeHeartbeat(bytes));
  EXPECT_EQ(DecodeHeartbeat(bytes)->session, -3);
  EXPECT_EQ(DecodeHeartbeat(bytes)->run_id, 4711);
  EXPECT_FALSE(DecodeCommand(bytes));
}

// EN-22: lengths for which the generated decoder alone would read beyond its bytes, or throw.
TEST(Messages, WrongLengthsAreRefused) {
  std::vector<std::uint8_t> good;
  Encode(GoodCommand(), good);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(DecodeCommand(std::span(good).first(size))) << size;
  }
  std::vector<std::uint8_t> longer = good;
  longer.push_back(0);
  EXPECT_FALSE(DecodeCommand(longer));
  constexpr std::size_t kClientLength = 24;  // after the fingerprint, utime and run_id
  for (const std::uint32_t length : {0u, 1u, 4u, 6u, 0x7fff'ffffu, 0x8000'0000u, 0x8000'0001u, 0xffff'ffffu}) {
    std::vector<std::uint8_t> bad = good;
    for (std::size_t i = 0; i < 4; ++i) bad[kClientLength + i] = static_cast<std::uint8_t>(length >> (24 - 8 * i));
    EXPECT_FALSE(DecodeCommand(bad)) << length;
  }
  std::vector<std::uint8_t> with_zero = good;
  with_zero[kClientLength + 4 + 1] = 0;
  EXPECT_FALSE(DecodeCommand(with_zero));
}

}  // namespace
}  // namespace takt::lcm
