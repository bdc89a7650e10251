// Belts and other carriers in a machine: sections of its file, their order in a cycle, and what groups see of them.
#include <gmock/gmock.h>

#include "rig.h"
#include "takt/engine/carriers.h"
#include "takt/engine/cycle.h"

namespace takt::conveyor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kCell = R"(
name: cell
axes:
  - {name: x, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
  - {name: y, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
  - {name: u, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
  - {name: v, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
  - {name: drive, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
  - {name: disc, unit: deg, kind: rotary, limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}}
groups:
  - {name: left, axes: [x, y], kinematics: {gantry: {axes: [x, y]}}, base: {x: 1000, c: 90}, tool: {x: 10},
     path: {velocity: 500, acceleration: 5000, jerk: 500000}}
  - {name: right, axes: [u, v], kinematics: {gantry: {axes: [x, y]}}, path: {velocity: 500, acceleration: 5000, jerk: 500000}}
belts:
  - {name: infeed, axis: drive, origin: {y: 300}, lower_limit: 0, upper_limit: 500}
  - {name: table, kind: turning, axis: disc, source: actual_value}
)";
const std::string kPoses = "poses: [{name: mover, goes_on_s: 0.1}]\n";

std::vector<std::string> Problems(const std::string& more) {
  return engine::LoadMachine(kCell + more, "cell.yaml").problems;
}

// CV-01
TEST(Cell, BeltsOfTheMachineFile) {
  EXPECT_THAT(Problems(""), IsEmpty());
  EXPECT_THAT(Problems("  - {name: second, axis: drive}\n" + kPoses), IsEmpty());
  EXPECT_THAT(Problems("  - {name: b, axis: driv}\n"),
              ElementsAre(HasSubstr("belts[2].axis: expected the name of an axis, found 'driv'; did you mean drive?")));
  EXPECT_THAT(Problems("  - {name: left, axis: drive}\n"),
              ElementsAre(HasSubstr("belts[2].name: expected a name that")));
  EXPECT_THAT(Problems("  - {name: infeed, axis: drive}\n"), ElementsAre(HasSubstr("expected each name once")));
  EXPECT_THAT(Problems("poses: [{name: infeed}, {name: machine}]\n"),
              ElementsAre(HasSubstr("poses[0].name"), HasSubstr("poses[1].name")));
  EXPECT_THAT(Problems("  - {name: b, axis: drive, ratio: 0}\n"), ElementsAre(HasSubstr("ratio: must not be 0")));
  EXPECT_THAT(Problems("  - {name: b, axis: drive, lower_limit: 5, upper_limit: 5}\n"),
              ElementsAre(HasSubstr("upper_limit: must lie above lower_limit")));
}

// CV-02, PP-40: by the text form of commands; the value of the feedback is the number.
TEST(Cell, ObjectsByCommand) {
  Cell cell(kCell);
  EXPECT_EQ(cell.Ask("infeed", "locate", "{x: 5}").error, ErrorId::kNoWorkpiece);
  EXPECT_EQ(cell.Ask("infeed", "detect").value, 1);
  EXPECT_EQ(cell.Ask("infeed", "locate", "{x: 5, kind: 2}").state, FeedbackState::kDone);
  EXPECT_EQ(cell.Belt().first_number, 1u);
  EXPECT_NEAR(cell.Belt().first_pose.y, 300, 1e-9);
  for (int i = 2; i <= 30; ++i) EXPECT_EQ(cell.Ask("infeed", "detect", "{x: 0}").value, i);
  const double before = cell.Belt(1).position;
  EXPECT_EQ(cell.Ask("infeed", "detect").error, ErrorId::kTooManyWorkpieces);
  EXPECT_EQ(cell.Belt().object_count, 30u);
  EXPECT_EQ(cell.Belt(1).position, before);
  EXPECT_EQ(cell.Ask("table", "detect", "{x: 1}").value, 1);
}

// CV-01, CV-03: "now" is the position of the belt when the command is applied, at any speed.
TEST(Cell, DetectsWhereTheBeltIs) {
  Cell cell(kCell);
  cell.Give("drive", "power");
  cell.Give("disc", "power");
  cell.Run(200);
  cell.Give("drive", "move_velocity", "{velocity: 800}");
  cell.Run(300);
  const double at = cell.Belt().position;
  cell.Ask("infeed", "detect", "{x: 10}");
  EXPECT_NEAR(cell.Belt().first_place, 10 + cell.Belt().position - at, 1e-9);
  EXPECT_NEAR(cell.Belt().first_place, 10.8, 1e-9);
}

// The machine in a single cycle, to inspect the views of its groups.
struct OneWorld {
  explicit OneWorld(const std::string& text = kCell + kPoses)
      : machine(Cell::Load(text)), world(machine), left(engine::CarriersFor(world.riders[0])) {}

  void Give(const std::string& target, const std::string& verb, const std::string& arguments = "") {
    const engine::ParsedCommand parsed = engine::ParseCommand(machine, target, verb, arguments);
    EXPECT_EQ(parsed.error, ErrorId::kNone) << parsed.sentence;
    engine::Apply(world, parsed.command);
  }
  void Run(int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      Sense(world);
      Begin();
      Finish();
    }
  }
  void Begin() { Move(world); }
  void Finish() {
    Control(world);
    Actuate(world);
    world.feedback.Clear();
    ++world.cycle.count;
  }

  engine::Machine machine;
  engine::World world;
  group::Carriers left;
};

// CV-42
TEST(Cell, GroupsFindWhatCarries) {
  OneWorld w;
  const group::Carriers right = engine::CarriersFor(w.world.riders[1]);
  const std::uint32_t infeed = w.left.Find("infeed"), table = w.left.Find("table"), mover = w.left.Find("mover");
  EXPECT_NE(infeed, 0u);
  EXPECT_NE(table, 0u);
  EXPECT_NE(mover, 0u);
  EXPECT_EQ(w.left.Find("left"), 0u) << "it does not carry itself";
  EXPECT_NE(w.left.Find("right"), 0u);
  EXPECT_NE(right.Find("left"), 0u);
  EXPECT_EQ(right.Find("infeed"), infeed);
  EXPECT_EQ(w.left.Find("drive"), 0u);
  EXPECT_EQ(w.left.At(infeed).kind, kinematics::CarrierKind::kStraight);
  EXPECT_EQ(w.left.At(table).kind, kinematics::CarrierKind::kTurning);
  EXPECT_EQ(w.left.At(mover).kind, kinematics::CarrierKind::kNone) << "nobody has said where it is";
  EXPECT_EQ(w.left.At(99).kind, kinematics::CarrierKind::kNone);
}

// CV-03: tables are in radians, like their carriers.
TEST(Cell, CarriersAreWhereTheirAxesAre) {
  OneWorld w;
  for (const char* axis : {"drive", "disc"}) w.Give(axis, "power");
  w.Run(200);
  w.Give("drive", "move_relative", "{distance: 70}");
  w.Give("disc", "move_relative", "{distance: 450}");
  w.Run(3000);
  const kinematics::Carrier belt = w.left.At(w.left.Find("infeed"));
  EXPECT_NEAR(belt.travel.position, 70, 1e-9);
  EXPECT_NEAR(belt.origin.p.y(), 300, 1e-12);
  const double turn = 2 * std::numbers::pi;
  EXPECT_NEAR(w.left.At(w.left.Find("table")).travel.position, 1.25 * turn, 1e-4);
  EXPECT_NEAR(w.left.TravelAt(w.left.Find("infeed"), 50), 50, 1e-9);
  EXPECT_NEAR(w.left.TravelAt(w.left.Find("table"), 45), 1.125 * turn, 1e-4);
  EXPECT_NEAR(w.left.TravelAt(w.left.Find("table"), 180), 0.5 * turn, 1e-4) << "the turn before";
}

// CV-42: the tool of another group, in the world, with its velocity.
TEST(Cell, AToolCarries) {
  OneWorld w;
  const group::Carriers right = engine::CarriersFor(w.world.riders[1]);
  w.Give("left", "power");
  w.Run(200);
  w.Give("left", "enable");
  w.Run();
  w.Give("left", "move_linear_absolute", "{x: 110, y: 20}");
  w.Run(60);
  const std::uint32_t tool = right.Find("left");
  double x = w.world.group_outputs[0].x, y = w.world.group_outputs[0].y;
  kinematics::Carrier at = right.At(tool);
  EXPECT_EQ(at.kind, kinematics::CarrierKind::kFree);
  EXPECT_NEAR(at.pose.p.p.x(), 1000 - y, 1e-9);  // rotated by 90 degrees
  EXPECT_NEAR(at.pose.p.p.y(), x, 1e-9);
  EXPECT_GT(at.pose.p.v.Norm(), 10);
  const KDL::Vector before = at.pose.p.p, speed = at.pose.p.v;
  w.Run();
  at = right.At(tool);
  const KDL::Vector mean = (at.pose.p.v + speed) / 2;
  EXPECT_NEAR((at.pose.p.p - before - 0.001 * mean).Norm(), 0, 1e-4);
}

// CV-01: belts by set position have stepped before the groups, in any order of the file.
TEST(Cell, GroupsStepBehindBelts) {
  OneWorld w;
  const auto order = w.world.axis_order.sequence();
  const auto place = [&](std::uint32_t axis) { return std::ranges::find(order, axis) - order.begin(); };
  for (const std::uint32_t member : {0u, 1u, 2u, 3u}) EXPECT_LT(place(4), place(member));
}

// EN-03: unless the belt's axis follows a group.
TEST(Cell, GroupsLeadBeltsThatFollowThem) {
  OneWorld w;
  for (const char* target : {"left", "drive"}) w.Give(target, "power");
  w.Run(200);
  w.Give("left", "enable");
  w.Run();
  w.Give("left", "sync_axis", "{axis: drive}");
  w.Run(10);
  const auto order = w.world.axis_order.sequence();
  const auto place = [&](std::uint32_t axis) { return std::ranges::find(order, axis) - order.begin(); };
  EXPECT_LT(place(0), place(4));
  w.Give("left", "move_linear_absolute", "{x: 50}");
  w.Run(1000);
  EXPECT_NEAR(w.world.belt_outputs[0].position, 40, 1e-6);  // the tool is 10 mm from the flange
}

// CV-20, CV-21: through the whole engine the tool is on the object in every cycle, to the last bits; on a measured
// belt, too, relative to the true position of its drive.
TEST(Cell, AToolRidesWithoutLag) {
  for (const char* source : {"set_value", "actual_value"}) {
    Cell cell(R"(
name: cell
axes:
  - {name: x, limits: {velocity: 2000, acceleration: 20000, jerk: 1000000}}
  - {name: y, limits: {velocity: 2000, acceleration: 20000, jerk: 1000000}}
  - name: drive
    limits: {velocity: 1000, acceleration: 10000, jerk: 1000000}
    encoder: {increments_per_unit: 10000000}
groups:
  - {name: robot, axes: [x, y], kinematics: {gantry: {axes: [x, y]}},
     path: {velocity: 500, acceleration: 5000, jerk: 500000}}
belts:
  - {name: infeed, axis: drive, filter_s: 0.01, origin: {x: 5, y: -20}, source: )" +
              std::string(source) + "}\n");
    for (const char* target : {"robot", "drive"}) cell.Give(target, "power");
    cell.Run(200);
    cell.Give("robot", "enable");
    cell.Give("drive", "move_velocity", "{velocity: 200}");
    cell.Run(500);
    cell.Give("robot", "set_dyn_coord_transform", "{pcs: 3, carrier: infeed, x: 10}");
    cell.Run(1);
    const Ticket move = cell.Give("robot", "move_linear_absolute", "{coordinate_system: pcs, pcs: 3, x: 30, y: 20}");
    cell.Run(1000);
    EXPECT_EQ(cell.last[move].state, FeedbackState::kDone);
    const double offset = cell.engine.group_outputs(0).x - cell.Belt().position;
    double worst = 0, against_axis = 0;
    const double true_offset = cell.engine.group_outputs(0).x - cell.engine.outputs(2).set_position;
    cell.each = [&] {
      const double x = cell.engine.group_outputs(0).x;
      worst = std::max(worst, std::abs(x - cell.Belt().position - offset));
      against_axis = std::max(against_axis, std::abs(x - cell.engine.outputs(2).set_position - true_offset));
    };
    cell.Run(500);
    EXPECT_LT(worst, 1e-9) << source;
    EXPECT_LT(against_axis, source == std::string("set_value") ? 1e-9 : 1e-5);
    EXPECT_NEAR(cell.engine.group_outputs(0).velocity, 200, 1e-3);
  }
}

// CV-42, EN-03: a group that rides on the tool of another group steps after it; two groups cannot ride on each other.
TEST(Cell, GroupsRideOnOneAnotherOneWayOnly) {
  OneWorld w;
  w.Give("left", "set_dyn_coord_transform", "{pcs: 1, carrier: right}");
  auto order = w.world.axis_order.sequence();
  const auto place = [&](std::uint32_t axis) { return std::ranges::find(order, axis) - order.begin(); };
  for (const std::uint32_t member : {0u, 1u}) {
    EXPECT_GT(place(member), place(2));
    EXPECT_GT(place(member), place(3));
  }
  const engine::ParsedCommand back =
      engine::ParseCommand(w.machine, "right", "set_dyn_coord_transform", "{pcs: 1, carrier: left}");
  engine::Command numbered = back.command;
  numbered.ticket = 7;
  w.world.feedback.Clear();
  engine::Apply(w.world, numbered);
  ASSERT_EQ(w.world.feedback.events().size(), 1u);
  EXPECT_EQ(w.world.feedback.events()[0].error, ErrorId::kCouplingLoop);
  w.Give("left", "set_cartesian_transform", "{pcs: 1}");
  engine::Apply(w.world, numbered);
  EXPECT_EQ(w.world.feedback.events().back().error, ErrorId::kNone);
  order = w.world.axis_order.sequence();
  EXPECT_GT(place(2), place(0));
}

// CV-42: a given pose continues at its velocity, to the instant of the set points, and is at rest when it is old.
TEST(Cell, APoseGoesOnBetweenMessages) {
  OneWorld w;
  const std::uint32_t mover = w.left.Find("mover");
  w.Run();
  EXPECT_TRUE(std::isnan(w.world.pose_outputs[0].pose.x));
  w.Give("mover", "set", "{x: 100, y: 50, c: 10, vx: 200, wz: 90, age_s: 0.005}");
  w.Begin();
  kinematics::Carrier at = w.left.At(mover);
  EXPECT_EQ(at.kind, kinematics::CarrierKind::kFree);
  EXPECT_NEAR(at.pose.p.p.x(), 100 + 200 * 0.006, 1e-9);
  EXPECT_NEAR(kinematics::ToPose(at.pose.GetFrame()).c, 10 + 90 * 0.006, 1e-9);
  EXPECT_NEAR(at.pose.p.v.x(), 200, 1e-12);
  EXPECT_NEAR(at.pose.M.w.z(), std::numbers::pi / 2, 1e-12);
  w.Finish();
  EXPECT_TRUE(w.world.pose_outputs[0].fresh);
  EXPECT_NEAR(w.world.pose_outputs[0].turning, 90, 1e-9);
  w.Run(50);
  EXPECT_NEAR(w.world.pose_outputs[0].pose.x, 100 + 200 * 0.056, 1e-9);
  w.Run(500);
  EXPECT_FALSE(w.world.pose_outputs[0].fresh);
  EXPECT_NEAR(w.world.pose_outputs[0].pose.x, 100 + 200 * 0.1, 1e-9);
  EXPECT_EQ(w.world.pose_outputs[0].velocity, 0);
  at = w.left.At(mover);
  EXPECT_EQ(at.pose.p.v.Norm(), 0);
}

}  // namespace
}  // namespace takt::conveyor
