// PP-40 to PP-44: picking from belts and placing on them.
#include "cell.h"

namespace takt::pickplace {
namespace {

using M = PickPlaceState;

// Along X of its origin, from x = 0 on.
CellBelt BeltAt(const char* name, const Pose& origin, double speed) {
  CellBelt belt;
  belt.params.name = name;
  belt.params.axis = name;
  belt.params.origin = origin;
  belt.params.lower_limit = 100;
  belt.params.upper_limit = 700;
  belt.settings.park_x = origin.x + 300;
  belt.settings.park_y = origin.y;
  belt.settings.park_z = origin.z + 80;
  belt.settings.z_distance = 25;
  belt.settings.sync_time = 0.05;
  belt.travel = [speed](double t) { return KinematicState{speed * t, speed, 0}; };
  return belt;
}
Settings Quick() {
  Settings s = Fast();
  s.path_velocity = 1000;
  s.z_elliptical = 10;
  return s;
}
Configure Mode(TrackingMode mode) {
  Configure c;
  c.tracking_mode = mode;
  return c;
}

// Returns the distance of the tool from a workpiece after the last cycle stepped.
double OffWorkpiece(const Cell& cell, std::size_t belt, const conveyor::Object& object) {
  const conveyor::State& s = cell.belt_states[belt];
  const auto pose = conveyor::PoseOf(cell.belts[belt].params, s, object).GetFrame();
  return (cell.tool() - pose.p).Norm();
}

// PP-42, PP-41: from a static place onto a moving workpiece; it stays for the time set, lifts, and parks.
TEST(Belts, PickOne) {
  for (const double speed : {0.0, 50.0, 300.0, -100.0}) {
    SCOPED_TRACE(speed);
    Cell cell(Quick(), {BeltAt("belt", {0, 200, -50, 0, 0, 0}, speed)});
    cell.Start();
    const double x = speed < 0 ? 600 : 150;
    cell.Put(0, {x, 20, 10, 0, 0, 0});
    const conveyor::Object object = cell.belt_states[0].objects[0];
    const Ticket ticket = cell.Execute(1);
    ASSERT_TRUE(cell.RunUntil([&] { return cell.out().in_target && cell.out().synchronised; }, 5));
    int on = 0;
    while (!cell.rig.lives[ticket].ended()) {
      EXPECT_LT(OffWorkpiece(cell, 0, object), kOnWorkpiece);
      EXPECT_EQ(cell.out().target, 1u);
      EXPECT_EQ(cell.out().workpiece, object.number);
      cell.Step();
      ++on;
    }
    EXPECT_EQ(on, 50);
    EXPECT_TRUE(cell.rig.lives[ticket].done);
    EXPECT_EQ(cell.belt_states[0].count, 0u);
    EXPECT_EQ(cell.state.counters.picked, 1u);
    // It lifts along with the belt.
    for (int i = 0; i < 20; ++i) {
      cell.Step();
      const auto pose = conveyor::PoseOf(cell.belts[0].params, cell.belt_states[0], object).GetFrame();
      EXPECT_NEAR(cell.tool().x(), pose.p.x(), kOnWorkpiece) << i;
    }
    ASSERT_TRUE(cell.RunTo(M::kReady, 5));
    EXPECT_TRUE(cell.out().in_park_position);
    EXPECT_LT(cell.Off(300, 200, 30), 1e-9);
  }
}

// PP-41, PP-40: the numbers of the manual's chapters on belts and workpieces: the belt's origin at X 400, Y 500, Z 100,
// turned by C 180; its work range from 200 to 800 along it; the parking position at X -400, Y 500, Z 300; a workpiece
// detected at X 210, Y -50, Z 10 of the belt. That is X 400 - 210 = 190, Y 500 + 50 = 550, Z 110 in the MCS, and within
// the range; the belt runs towards -X.
TEST(Belts, ExampleOfTheManual) {
  CellBelt belt = BeltAt("belt", {400, 500, 100, 0, 0, 180}, 0);
  belt.params.lower_limit.reset();
  belt.params.upper_limit.reset();
  belt.settings.lower_limit = 200;
  belt.settings.upper_limit = 800;
  belt.settings.park_x = -400;
  belt.settings.park_y = 500;
  belt.settings.park_z = 300;
  Cell cell(Quick(), {belt});
  cell.Start({0, 0, 300, 0, 0, 0});
  cell.Put(0, {190, -50, 10, 0, 0, 0});  // before the range: it parks
  const Ticket ticket = cell.Execute(1);
  ASSERT_TRUE(cell.RunUntil([&] { return cell.out().in_park_position; }, 5));
  EXPECT_LT(cell.Off(-400, 500, 300), 1e-9);
  cell.Steps(200);
  EXPECT_FALSE(cell.rig.lives[ticket].ended());
  conveyor::Remove(1, cell.belt_states[0]);
  cell.Put(0, {210, -50, 10, 0, 0, 0});
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  EXPECT_LT(cell.Off(190, 550, 110), 1e-6);
}

// PP-42: nothing in range: it parks and waits; a workpiece that comes into range is picked.
TEST(Belts, ParksAndWaits) {
  Cell cell(Quick(), {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 100)});
  cell.Start();
  cell.Put(0, {-20, 0, 0, 0, 0, 0});  // 1.2 s before the range
  const Ticket ticket = cell.Execute(1);
  ASSERT_TRUE(cell.RunUntil([&] { return cell.out().in_park_position; }, 1.1));
  EXPECT_LT(cell.Off(300, 200, 30), 1e-6);
  EXPECT_EQ(cell.state.state, M::kMovePp);
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  EXPECT_GT(cell.belt_states[0].travel.position, 120);
}

// PP-44: a workpiece that cannot be reached before it leaves the range is not approached.
TEST(Belts, TooLateIsNotTried) {
  Cell cell(Quick(), {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 400)});
  cell.Start();
  cell.Put(0, {640, 0, 0, 0, 0, 0});
  cell.Put(0, {150, 0, 0, 0, 0, 0});
  const Ticket ticket = cell.Execute(1);
  ASSERT_TRUE(cell.RunUntil([&] { return cell.out().workpiece != 0; }, 5));
  EXPECT_EQ(cell.out().workpiece, 2u);
  ASSERT_TRUE(cell.RunToEnd(ticket, 5));
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  EXPECT_LT(cell.belt_states[0].travel.position + 150, 700);
}

// PP-44: the rules.
TEST(Belts, Rules) {
  const auto chosen = [](WorkpieceRule rule) {
    Settings s = Quick();
    s.workpiece_rule = rule;
    Cell cell(s, {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 20)});
    cell.Start({350, 200, 0, 0, 0, 0});
    for (const double x : {300.0, 500.0, 120.0, 50.0, 690.0}) cell.Put(0, {x, 0, 0, 0, 0, 0});
    cell.Execute(1);
    cell.RunUntil([&] { return cell.out().workpiece != 0; }, 5);
    return cell.out().workpiece;
  };
  EXPECT_EQ(chosen(WorkpieceRule::kFirst), 2u);  // 690 leaves the range too soon
  EXPECT_EQ(chosen(WorkpieceRule::kNearest), 1u);
  EXPECT_EQ(chosen(WorkpieceRule::kLatest), 3u);
}

// PP-11, PP-42: half ellipses between workpieces of two belts.
TEST(Belts, EllipsesFromBeltToBelt) {
  Settings s = Quick();
  s.path_mode = PathMode::kElliptical;
  s.z_elliptical = 40;
  s.gripper_closing_time = 0.03;
  Cell cell(s, {BeltAt("in", {0, 200, -50, 0, 0, 0}, 100), BeltAt("out", {0, 400, -60, 0, 0, 0}, 60)});
  cell.Start();
  cell.Put(0, {120, 0, 0, 0, 0, 0});
  cell.Put(1, {150, 0, 0, 0, 0, 0});
  const conveyor::Object place = cell.belt_states[1].objects[0];
  const Ticket pick = cell.Execute(1);
  const Ticket put = cell.Execute(2);
  ASSERT_TRUE(cell.RunToEnd(pick, 5));
  ASSERT_TRUE(cell.rig.lives[pick].done) << static_cast<int>(cell.rig.lives[pick].error_id);
  cell.rig.trace.clear();
  ASSERT_TRUE(cell.RunToEnd(put, 5));
  ASSERT_TRUE(cell.rig.lives[put].done) << static_cast<int>(cell.rig.lives[put].error_id);
  EXPECT_LT(OffWorkpiece(cell, 1, place), kOnWorkpiece);
  double highest = -1000;
  for (const auto& sample : cell.rig.trace) highest = std::max(highest, sample.out.z);
  // Points at -50 + 25 and -60 + 25; 40 above the higher.
  EXPECT_NEAR(highest, -50 + 25 + 40, 0.5);
}

// PP-31: ack_gripper ends the time on the workpiece at once.
TEST(Belts, AckGripper) {
  CellBelt belt = BeltAt("belt", {0, 200, -50, 0, 0, 0}, 50);
  belt.settings.sync_time = 5;
  Cell cell(Quick(), {belt});
  cell.Start();
  cell.Put(0, {150, 0, 0, 0, 0, 0});
  const Ticket ticket = cell.Execute(1);
  ASSERT_TRUE(cell.RunUntil([&] { return cell.state.orders[0].phase == Phase::kStaying; }, 5));
  cell.Steps(20);
  EXPECT_FALSE(cell.rig.lives[ticket].ended());
  cell.Do(Control{.ack_gripper = true});
  EXPECT_TRUE(cell.rig.lives[ticket].done);
  const double z = cell.tool().z();
  cell.Steps(10);
  EXPECT_GT(cell.tool().z(), z + 0.01);
}

// PP-41: a time of 0 means one cycle.
TEST(Belts, NoTimeIsOneCycle) {
  CellBelt belt = BeltAt("belt", {0, 200, -50, 0, 0, 0}, 50);
  belt.settings.sync_time = 0;
  Cell cell(Quick(), {belt});
  cell.Start();
  cell.Put(0, {150, 0, 0, 0, 0, 0});
  const Ticket ticket = cell.Execute(1);
  ASSERT_TRUE(cell.RunUntil([&] { return cell.state.orders[0].phase == Phase::kStaying; }, 5));
  cell.Step();
  EXPECT_TRUE(cell.rig.lives[ticket].done);
}

// PP-30: the pulse on a belt is as exact as elsewhere.
TEST(Belts, PulseToTheCycle) {
  for (const double time : {0.01, 0.06}) {
    Settings s = Quick();
    s.gripper_closing_time = time;
    Cell cell(s, {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 200)});
    cell.Start();
    cell.Put(0, {150, 20, 10, 0, 0, 0});
    const conveyor::Object object = cell.belt_states[0].objects[0];
    const Ticket ticket = cell.Execute(1);
    std::vector<bool> on;
    while (!cell.rig.lives[ticket].ended()) {
      cell.Step();
      on.push_back(OffWorkpiece(cell, 0, object) < kOnWorkpiece);
    }
    std::size_t end = on.size();
    while (end > 0 && on[end - 1]) --end;
    std::vector<std::size_t> pulses;
    for (std::size_t i = 0; i < on.size(); ++i) {
      if (cell.outs[i].pulse_gripper) pulses.push_back(i);
    }
    ASSERT_EQ(pulses.size(), 1u);
    EXPECT_EQ(end - pulses[0], static_cast<std::size_t>(std::llround(time / 0.001)));
  }
}

// PP-42: from one workpiece to the next on the same belt, without parking between them.
TEST(Belts, FromWorkpieceToWorkpiece) {
  Cell cell(Quick(), {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 60)});
  cell.Start();
  for (const double x : {300.0, 200.0, 130.0}) cell.Put(0, {x, 0, 0, 0, 0, 0});
  std::vector<Ticket> tickets;
  for (int i = 0; i < 3; ++i) tickets.push_back(cell.Execute(1));
  for (const Ticket ticket : tickets) {
    ASSERT_TRUE(cell.RunToEnd(ticket, 5));
    EXPECT_TRUE(cell.rig.lives[ticket].done);
    EXPECT_FALSE(cell.out().in_park_position);
  }
  EXPECT_EQ(cell.state.counters.picked, 3u);
  EXPECT_GT(cell.out().picks_per_minute, 30);
  ASSERT_TRUE(cell.RunTo(M::kReady, 5));
  EXPECT_TRUE(cell.out().in_park_position);
}

// PP-43: the modes, each for a while; the loop continues until it is aborted, and ends after the path in progress.
TEST(Modes, RoundAndRound) {
  for (const TrackingMode mode : {TrackingMode::kStaticToBelt1, TrackingMode::kBelt1ToStatic,
                                  TrackingMode::kBelt1ToBelt2, TrackingMode::kBelt2ToBelt1, TrackingMode::kFromTo}) {
    SCOPED_TRACE(static_cast<int>(mode));
    Settings s = Quick();
    s.gripper_closing_time = 0.02;
    s.gripper_open_time = 0.03;
    s.x_target = 250;
    s.y_target = -100;
    s.pick_belt = 2;
    Cell cell(s, {BeltAt("in", {0, 200, -50, 0, 0, 0}, 120), BeltAt("out", {0, 400, -60, 0, 0, 0}, 80)});
    cell.Start();
    cell.Do(Mode(mode));
    const Ticket loop = cell.Execute();
    for (int i = 0; i < 12000; ++i) {
      for (std::size_t belt = 0; belt < 2; ++belt) {
        if (i % 900 == 0) cell.Put(belt, {60, 10, 0, 0, 0, 0});
      }
      cell.Step();
      for (std::size_t belt = 0; belt < 2; ++belt) {  // as a belt's own cycle does
        for (const conveyor::Object& object : conveyor::ObjectsOf(cell.belt_states[belt])) {
          if (conveyor::PlaceOf(cell.belts[belt].params, cell.belt_states[belt], object) > 700 &&
              object.state == conveyor::ObjectState::kVisible) {
            conveyor::Remove(object.number, cell.belt_states[belt]);
            break;
          }
        }
      }
      ASSERT_NE(cell.state.state, M::kError) << static_cast<int>(cell.state.error) << " in " << i;
    }
    EXPECT_GE(cell.state.counters.picked, 5u);
    EXPECT_LE(cell.state.counters.picked - cell.state.counters.placed, 1u);
    EXPECT_FALSE(cell.rig.lives[loop].ended());
    cell.Do(Control{.abort = true});
    EXPECT_EQ(cell.state.state, M::kMovePp);
    cell.Put(0, {120, 10, 0, 0, 0, 0});
    cell.Put(1, {120, 10, 0, 0, 0, 0});
    ASSERT_TRUE(cell.RunToEnd(loop, 10));
    EXPECT_TRUE(cell.rig.lives[loop].done);
    EXPECT_TRUE(cell.RunTo(M::kReady, 5));
  }
}

// PP-43: a loop that waits for a workpiece ends at once.
TEST(Modes, AbortedWhileWaiting) {
  Cell cell(Quick(), {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 60)});
  cell.Start();
  cell.Do(Mode(TrackingMode::kBelt1ToStatic));
  const Ticket loop = cell.Execute();
  ASSERT_TRUE(cell.RunUntil([&] { return cell.out().in_park_position; }, 5));
  cell.Do(Control{.abort = true});
  cell.Steps(3);
  EXPECT_TRUE(cell.rig.lives[loop].done);
  EXPECT_TRUE(cell.RunTo(M::kReady, 0.1));
}

// PP-20: if another command stops the group there is no path any more; the module drops it.
TEST(Modes, StoppedBySomebodyElse) {
  Cell cell(Quick(), {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 60)});
  cell.Start();
  cell.Put(0, {150, 0, 0, 0, 0, 0});
  const Ticket ticket = cell.Execute(1);
  cell.Steps(200);
  cell.rig.Give(group::Stop{});
  ASSERT_TRUE(cell.RunToEnd(ticket, 1));
  EXPECT_TRUE(cell.rig.lives[ticket].aborted);
  EXPECT_TRUE(cell.RunUntil([&] { return IsFree(cell.Now(), cell.rig.state); }, 2));
  cell.Steps(2);
  EXPECT_EQ(cell.state.state, M::kReady);
  const Ticket again = cell.Execute(1);
  ASSERT_TRUE(cell.RunToEnd(again, 5));
  EXPECT_TRUE(cell.rig.lives[again].done);
}

// PP-43: another mode with an edge of execute; the same one again is refused.
TEST(Modes, Changed) {
  Settings s = Quick();
  s.x_target = 250;
  Cell cell(s, {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 60)});
  cell.Start();
  cell.Do(Mode(TrackingMode::kBelt1ToStatic));
  const Ticket first = cell.Execute();
  cell.Steps(100);
  const Ticket same = cell.Execute();
  cell.Step();
  EXPECT_EQ(cell.rig.lives[same].error_id, ErrorId::kState);
  cell.Do(Mode(TrackingMode::kStaticToBelt1));
  const Ticket second = cell.Execute();
  cell.Step();
  EXPECT_TRUE(cell.rig.lives[first].aborted);
  EXPECT_FALSE(cell.rig.lives[second].ended());
  cell.Do(Mode(TrackingMode::kBelt1ToBelt2));
  const Ticket none = cell.Execute();
  cell.Step();
  EXPECT_EQ(cell.rig.lives[none].error_id, ErrorId::kUnknownTarget);
}

// PP-20: stopped at every instant of a pick from a belt and continued: it picks, or the workpiece has left and it waits
// for the next one.
TEST(Belts, StoppedAtEveryInstantAndOn) {
  for (int instant = 0; instant < 700; instant += 23) {
    SCOPED_TRACE(instant);
    Cell cell(Quick(), {BeltAt("belt", {0, 200, -50, 0, 0, 0}, 80)});
    cell.Start();
    cell.Put(0, {150, 20, 10, 0, 0, 0});
    const Ticket ticket = cell.Execute(1);
    cell.Steps(instant);
    cell.Do(Control{.path_stop = true});
    ASSERT_TRUE(cell.RunUntil([&] { return Stands(cell.Now(), cell.rig.state); }, 2));
    cell.Steps(instant % 2 == 0 ? 50 : 1500);
    ASSERT_EQ(cell.state.state, M::kStop);
    cell.Do(Control{.path_stop = false});
    cell.Put(0, {120, 20, 10, 0, 0, 0});
    ASSERT_TRUE(cell.RunTo(M::kReady, 1));
    cell.Execute();
    if (cell.rig.lives[ticket].ended()) continue;
    ASSERT_TRUE(cell.RunToEnd(ticket, 10));
    EXPECT_TRUE(cell.rig.lives[ticket].done) << static_cast<int>(cell.rig.lives[ticket].error_id);
  }
}

}  // namespace
}  // namespace takt::pickplace
