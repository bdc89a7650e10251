// PP-62, PP-63, PP-66, PP-11: choice of workpieces, settings frozen at acceptance, and published attributes.
#include "cell.h"

namespace takt::pickplace {
namespace {

CellBelt Slow(const std::string& name, double y) {
  CellBelt belt;
  belt.params.name = belt.params.axis = name;
  belt.params.origin = {0, y, -50, 0, 0, 0};
  belt.params.lower_limit = 100;
  belt.params.upper_limit = 700;
  belt.settings = {.park_x = 300, .park_y = y, .park_z = 30, .z_distance = 25, .sync_time = 0.04};
  belt.travel = [](double t) { return KinematicState{80 * t, 80, 0}; };
  return belt;
}

// PP-62: grip offsets are the belt's at the time a profile was accepted: a gripper with two cups picks two, one after
// the other, and places them.
TEST(Choice, GripOffsetsOfTwoCups) {
  Cell cell(Fast(), {Slow("in", 200)});
  cell.Start();
  for (const double x : {260.0, 180.0}) cell.Put(0, {x, 0, 0, 0, 0, 0});
  const std::array objects = {cell.belt_states[0].objects[0], cell.belt_states[0].objects[1]};
  cell.Do(ConfigureBelt{.grip_x = -35});
  cell.Execute(1);
  cell.Step();
  cell.Do(ConfigureBelt{.z_distance = 60, .sync_time = 3, .grip_x = 35});
  cell.Do(ConfigureBelt{.z_distance = 25, .sync_time = 0.04});
  cell.Execute(1);
  cell.Step();
  cell.Do(ConfigureBelt{.grip_x = 0});
  cell.Execute(0);
  cell.Step();
  cell.Do(To(60, -50, 0));
  const Ticket last = cell.Execute(0);
  std::array<bool, 2> seen{};
  for (int i = 0; i < 8000 && !cell.rig.lives[last].ended(); ++i) {
    cell.Step();
    if (!cell.out().synchronised || cell.state.orders[0].phase != Phase::kStaying) continue;
    const std::size_t cup = cell.state.counters.picked;
    ASSERT_LT(cup, 2u);
    const auto place = conveyor::PoseOf(cell.belts[0].params, cell.belt_states[0], objects[cup]).GetFrame().p;
    EXPECT_NEAR(cell.tool().x() - place.x(), cup == 0 ? -35 : 35, kOnWorkpiece);
    seen[cup] = true;
  }
  EXPECT_TRUE(seen[0] && seen[1]);
  EXPECT_TRUE(cell.rig.lives[last].done);
  EXPECT_EQ(cell.state.counters.placed, 2u);
  EXPECT_LT(cell.Off(60, -50, 0), 1e-6);
}

// PP-66: only workpieces of the requested kind, colour and quality; the attributes follow to the place.
TEST(Choice, ByAttributes) {
  const auto chosen = [](const ConfigureBelt& wanted) {
    Cell cell(Fast(), {Slow("in", 200)});
    cell.Start();
    const conveyor::Attributes all[] = {{1, 5, 0.9}, {2, 5, 0.4}, {2, 6, 0.8}, {3, 6, 0.99}};
    for (std::uint32_t i = 0; i < 4; ++i) {
      cell.Put(0, {300 - 40.0 * i, 0, 0, 0, 0, 0});
      cell.belt_states[0].objects[i].attributes = all[i];
    }
    cell.Do(wanted);
    cell.Execute(1);
    cell.Steps(3);
    const std::uint32_t number = cell.out().workpiece;
    if (number == 0) return number;
    EXPECT_TRUE(cell.RunUntil([&] { return cell.state.counters.picked == 1; }, 5));
    cell.Step();
    EXPECT_EQ(cell.out().held, 1u);
    EXPECT_EQ(cell.out().held_kind, all[number - 1].kind);
    EXPECT_EQ(cell.out().held_colour, all[number - 1].colour);
    EXPECT_EQ(cell.out().held_quality, all[number - 1].quality);
    const Ticket place = cell.Execute(0);
    EXPECT_TRUE(cell.RunToEnd(place, 5));
    EXPECT_EQ(cell.out().held, 0u);
    return number;
  };
  EXPECT_EQ(chosen({}), 1u);
  EXPECT_EQ(chosen({.kind = 2}), 2u);
  EXPECT_EQ(chosen({.colour = 6}), 3u);
  EXPECT_EQ(chosen({.least_quality = 0.95}), 4u);
  EXPECT_EQ(chosen({.kind = 2, .least_quality = 0.5}), 3u);
  EXPECT_EQ(chosen({.kind = 7}), 0u);
}

// PP-66: a product that was detected twice is one, where both pictures show it; neighbours are not.
TEST(Choice, SeenTwice) {
  Cell cell(Fast(), {Slow("in", 200)});
  cell.Start();
  for (const double x : {250.0, 250.8, 246.0}) cell.Put(0, {x, 0.5, 0, 0, 0, 0});
  const Ticket ticket = cell.Execute(1);
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  ASSERT_EQ(cell.belt_states[0].count, 1u);
  EXPECT_EQ(cell.belt_states[0].objects[0].number, 3u);
}

// PP-63: a full belt is a warning of the module, with its belt; workpieces lost by other belts are not missed.
TEST(Choice, WarningsAndCountersOfBelts) {
  Settings s = Fast();
  s.tracking_mode = TrackingMode::kBelt2ToBelt1;
  Cell cell(s, {Slow("out", 200), Slow("in", 400), Slow("other", 600)});
  cell.Start();
  cell.Execute();
  cell.Steps(3);
  EXPECT_EQ(cell.out().warning, ErrorId::kNone);
  ++cell.belt_states[2].refused;
  cell.Step();
  EXPECT_EQ(cell.out().warning, ErrorId::kTooManyWorkpieces);
  EXPECT_EQ(cell.out().warning_belt, 3u);
  ++cell.belt_states[2].lost;
  cell.Step();
  EXPECT_EQ(cell.out().missed, 0u);
  ++cell.belt_states[1].lost;
  cell.Step();
  EXPECT_EQ(cell.out().missed, 1u);
  EXPECT_EQ(cell.out().missed_too_late, 1u);
}

// PP-11: an ellipse onto a tilted belt is refused when it is requested.
TEST(Choice, EllipsesOntoTiltedBelts) {
  for (const double a : {0.0, 12.0}) {
    Settings s = Fast();
    s.path_mode = PathMode::kElliptical;
    s.z_elliptical = 20;
    CellBelt belt = Slow("in", 200);
    belt.params.origin.a = a;
    Cell cell(s, {belt});
    cell.Start();
    cell.Put(0, {250, 0, 0, 0, 0, 0});
    const Ticket ticket = cell.Execute(1);
    cell.Steps(2);
    EXPECT_EQ(cell.rig.lives[ticket].error_id, a == 0 ? ErrorId::kNone : ErrorId::kTiltedEllipse);
    EXPECT_EQ(cell.out().warning, cell.rig.lives[ticket].error_id);
    EXPECT_EQ(cell.out().workpiece, a == 0 ? 1u : 0u);
  }
}

// PP-63: targets turned about A and B, as in the manual, are ignored by a mechanism that cannot tilt its tool.
TEST(Choice, TiltsThatTheMechanismDoesNotHave) {
  Settings s = Fast();
  s.keep_orientation = false;
  Cell cell(s, {}, group::DeltaRobot());
  cell.Start({0, 0, -880, 0, 0, 0});
  Configure to = To(40, 30, -890);
  to.a_target = 180;
  cell.Do(to);
  const Ticket ticket = cell.Execute();
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  EXPECT_LT(cell.Off(40, 30, -890), 1e-6);
}

}  // namespace
}  // namespace takt::pickplace
