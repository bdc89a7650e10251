// PP-44, PP-40: belts with unexpected motions, and workpieces that vanish, at every instant of a pick. The tool is low
// over a belt only within the work range and straight over its workpiece, also on the way up from a pick that was given
// up; and it continues with the next one.
#include <algorithm>

#include "../core/trials.h"
#include "../group/watch.h"
#include "cell.h"

namespace takt::pickplace {
namespace {

using M = PickPlaceState;

constexpr double kBeltY = 200, kBeltZ = -50;
constexpr double kDistance = 25, kRadius = 10;  // [mm] of the way down and its rounding

// A change of speed that begins at a time and takes a duration: with no jerk that axes could not follow.
std::function<KinematicState(double)> Changing(double before, double after, double from_s, double takes_s) {
  return [=](double t) -> KinematicState {
    const double change = after - before;
    const double x = std::clamp((t - from_s) / takes_s, 0.0, 1.0);
    const double rest = std::max(0.0, t - from_s - takes_s);
    const double place = before * t + change * (takes_s * x * x * x * (1 - 0.5 * x) + rest);
    return {place, before + change * x * x * (3 - 2 * x), change / takes_s * 6 * x * (1 - x)};
  };
}

CellBelt Infeed(const std::function<KinematicState(double)>& travel) {
  CellBelt belt;
  belt.params.name = belt.params.axis = "belt";
  belt.params.origin = {0, kBeltY, kBeltZ, 0, 0, 0};
  belt.params.lower_limit = 100;
  belt.params.upper_limit = 500;
  belt.settings = {.park_x = 300, .park_y = kBeltY, .park_z = 30, .z_distance = kDistance, .sync_time = 0.1};
  belt.travel = travel;
  return belt;
}

Settings Rounded() {
  Settings s = Fast();
  s.blending_radius = kRadius;
  s.z_start_distance = 0;
  return s;
}

class Watched {
 public:
  explicit Watched(const CellBelt& belt, const Pose& tool = {}) : cell(Rounded(), {belt}) { cell.Start(tool); }

  void Put(double x) {
    cell.Put(0, {x, 20, 0, 0, 0, 0});
    objects_.push_back(belt().objects[belt().count - 1]);
  }
  void Step() {
    cell.Step();
    ASSERT_NE(cell.state.state, M::kError) << static_cast<int>(cell.state.error);
    const KDL::Vector tool = cell.tool();
    if (std::abs(tool.y() - kBeltY) > kHalfWidth || tool.z() > kBeltZ + kDistance - kRadius - 1e-3) return;
    ++low;
    double beside = 1e9, along = 0;
    for (const conveyor::Object& object : objects_) {
      const KDL::Vector place = conveyor::PoseOf(cell.belts[0].params, belt(), object).GetFrame().p;
      const double off = std::hypot(tool.x() - place.x(), tool.y() - place.y());
      if (off > beside) continue;
      beside = off;
      along = conveyor::PlaceOf(cell.belts[0].params, belt(), object);
    }
    ASSERT_LT(beside, kBeside) << "z " << tool.z();
    ASSERT_GE(along, 100);
    ASSERT_LE(along, 500);
  }
  void Steps(int n) {
    while (n-- > 0 && !testing::Test::HasFatalFailure()) Step();
  }
  // Steps until the condition is true; returns false if it never was.
  template <typename Until>
  bool RunUntil(const Until& until, double seconds = 10) {
    for (int i = 0; i < seconds * 1000 && !testing::Test::HasFatalFailure(); ++i) {
      Step();
      if (until()) return true;
    }
    return false;
  }
  bool IsUp() const { return cell.tool().z() >= kBeltZ + kDistance - kRadius; }
  conveyor::State& belt() { return cell.belt_states[0]; }
  const Counters& counters() const { return cell.state.counters; }

  Cell cell;
  int low = 0;  // cycles

 private:
  std::vector<conveyor::Object> objects_;
};

constexpr double kPick_s = 1.4;  // duration of one pick, and some time more

// The belt stops for good at every instant of a pick: the workpiece is picked where it is.
TEST(GiveUp, BeltStopsForEver) {
  for (double stop = 0; stop < kPick_s; stop += Stride(0.017)) {
    SCOPED_TRACE(stop);
    Watched run(Infeed(Changing(150, 0, stop, 0.1)));
    run.Put(150);
    const Ticket ticket = run.cell.Execute(1);
    ASSERT_TRUE(run.RunUntil([&] { return run.cell.rig.lives[ticket].ended(); }));
    EXPECT_TRUE(run.cell.rig.lives[ticket].done);
    EXPECT_EQ(run.counters().picked, 1u);
    EXPECT_GE(run.low, 100);
    ASSERT_TRUE(run.RunUntil([&] { return run.cell.state.state == M::kReady; }));
    EXPECT_TRUE(run.cell.out().in_park_position);
  }
}

// PP-61: the tool waits straight over its workpiece, or nearly, and the belt starts at every instant of the way down.
// The tool is in step before it is low.
TEST(GiveUp, BeltSetsOutBelowTheTool) {
  for (const double beside : {0.0, 1e-7, 1e-4, 0.02, 0.5, 3.0}) {
    for (const double above : {0.0, 4.0}) {
      for (double starts = 0; starts < 0.3; starts += Stride(0.011)) {
        SCOPED_TRACE(testing::Message() << beside << " mm beside, " << above << " mm above, at " << starts);
        const Pose over = {150 + beside, kBeltY + 20, kBeltZ + kDistance + above, 0, 0, 0};
        Watched run(Infeed(Changing(0, 150, starts, 0.15)), over);
        run.Put(150);
        const Ticket ticket = run.cell.Execute(1);
        ASSERT_TRUE(run.RunUntil([&] { return run.cell.rig.lives[ticket].ended(); }));
        EXPECT_TRUE(run.cell.rig.lives[ticket].done);
        EXPECT_GE(run.low, 20);
      }
    }
  }
}

// PP-60: a halt at every instant of a pick, on which the tool rises where it is low; a jog requested in every cycle
// starts as soon as the tool is at rest. Then a stop, or the end of enable, ends the jog as any other.
TEST(GiveUp, JogBehindARiseIsStopped) {
  int jogged = 0, rose = 0;
  for (const bool disable : {false, true}) {
    for (double at = 0; at < kPick_s; at += Stride(0.023)) {
      SCOPED_TRACE(testing::Message() << "at " << at << (disable ? ", enable false" : ", path_stop"));
      Cell cell(Rounded(), {Infeed(Changing(100, 0, at, 0.1))});
      cell.Start();
      cell.Put(0, {150, 20, 0, 0, 0, 0});
      cell.Execute(1);
      cell.Steps(static_cast<int>(at / 0.001));
      cell.Give(Control{.path_halt = true});
      cell.Give(Control{.select_axis = SelectAxis::kZ});
      for (int i = 0; i < 1000 && cell.state.state != M::kJogNeg; ++i) {
        cell.Give(Jog{.negative = true});
        cell.Step();
        rose += cell.state.lifting ? 1 : 0;
      }
      if (cell.state.state != M::kJogNeg) continue;
      ++jogged;
      for (int i = 0; i < 1000 && !(std::abs(cell.rig.states[2].setpoint.velocity) > 1); ++i) cell.Step();
      cell.Give(disable ? Control{.enable = false} : Control{.path_stop = true});
      cell.Steps(300);
      for (const axis::State& axis : cell.rig.states) EXPECT_EQ(axis.setpoint.velocity, 0);
    }
  }
  EXPECT_GT(jogged, Trials(35, 1));
  EXPECT_GT(rose, Trials(500, 1));
}

// The belt turns back at every instant: near the beginning of the range that is too early for some.
TEST(GiveUp, BeltTurnsBack) {
  int given_up = 0;
  for (double turn = 0; turn < kPick_s; turn += Stride(0.013)) {
    SCOPED_TRACE(turn);
    Watched run(Infeed(Changing(100, -200, turn, 0.2)));
    run.Put(120);
    run.cell.Execute(1);
    run.Steps(1500);
    given_up += run.counters().picked == 0 ? 1 : 0;
    run.Put(450);
    ASSERT_TRUE(run.RunUntil([&] { return run.counters().picked > 0; }));
  }
  EXPECT_GT(given_up, Trials(10, 1));
  EXPECT_LT(given_up, Trials(100, 1));
}

// The belt becomes much faster at every instant, beyond its stated range: in the end it is too late for some. Those
// workpieces continue along the belt, to other modules that may reach them.
TEST(GiveUp, BeltBecomesMuchFaster) {
  int given_up = 0, low = 0;
  for (double change = 0; change < kPick_s + 0.5; change += Stride(0.009)) {
    SCOPED_TRACE(change);
    CellBelt belt = Infeed(Changing(100, 600, change, 0.3));
    belt.settings.sync_time = 0.6;
    Watched run(belt);
    run.Put(240);
    run.cell.Execute(1);
    bool lowers = false, was_low = false;
    ASSERT_TRUE(run.RunUntil([&] {
      const bool lost = lowers && run.cell.state.orders[0].workpiece == 0 && run.counters().picked == 0;
      if (lost && !run.IsUp()) was_low = true;
      lowers = run.cell.state.orders[0].workpiece != 0;
      return lost || run.counters().picked > 0;
    }));
    low += was_low ? 1 : 0;
    if (run.counters().picked == 0) {
      ++given_up;
      ASSERT_TRUE(run.RunUntil([&] { return run.cell.out().in_park_position; }, 2));
    }
  }
  EXPECT_GT(given_up, Trials(10, 1));
  EXPECT_LT(given_up, Trials(190, 1));
  EXPECT_GE(low, Trials(4, 1)) << "a test that cannot fail";
}

// The camera or the program removes the workpiece while the tool approaches it: the tool goes up, straight and in step,
// and parks; the next workpiece is picked. On the workpiece it stays as long as it should.
TEST(GiveUp, WorkpieceIsRemoved) {
  int low = 0;
  for (int instant = 1; instant < 1400; instant += Stride(11)) {
    SCOPED_TRACE(instant);
    Watched run(Infeed(Changing(150, 150, 0, 1)));
    run.Put(150);
    run.cell.Execute(1);
    run.Steps(instant);
    const Order& order = run.cell.state.orders[0];
    const bool goes = order.phase == Phase::kGoing && run.counters().picked == 0;
    conveyor::Remove(1, run.belt());
    if (!goes) continue;
    const bool was_low = run.low > 0 && !run.IsUp();
    low += was_low ? 1 : 0;
    ASSERT_TRUE(run.RunUntil([&] { return was_low ? run.IsUp() : true; }, 0.25));
    ASSERT_TRUE(run.RunUntil([&] { return run.cell.out().in_park_position; }));
    EXPECT_EQ(run.counters().missed, 0u);
    EXPECT_FALSE(run.cell.out().in_target);
    run.Put(130);
    ASSERT_TRUE(run.RunUntil([&] { return run.counters().picked == 1; }));
  }
  EXPECT_GE(low, Trials(6, 1)) << "a test that cannot fail";
}

// The stated range of the belt's speed counts from the choice of a workpiece on: how fast it may become, and how slow,
// or whether it may turn back.
TEST(GiveUp, ReckonsWithWhatTheBeltMayDo) {
  struct Case {
    double lowest, highest, x;
    bool picks;
  };
  // From 100 to 500; the way there takes some 0.8 s, with the stay and the way up some 1.1 s.
  for (const Case& one : {Case{0, 0, 300, true}, Case{0, 150, 300, true}, Case{0, 250, 300, false},
                          Case{0, 250, 110, true}, Case{-100, 0, 110, false}, Case{-100, 0, 300, true}}) {
    SCOPED_TRACE(testing::Message() << one.lowest << " to " << one.highest << " from " << one.x);
    CellBelt belt = Infeed(Changing(100, 100, 0, 1));
    belt.settings.lowest_speed = one.lowest;
    belt.settings.highest_speed = one.highest;
    Watched run(belt);
    run.Put(one.x);
    run.cell.Execute(1);
    run.Step();
    EXPECT_EQ(run.cell.out().workpiece != 0, one.picks);
  }
}

// PP-20: stopped at every instant, by any stop, until the workpiece has left the range. If the tool is low over the
// belt it goes straight up from there before anything else.
TEST(GiveUp, StoppedUntilItHasLeft) {
  int low = 0;
  for (int instant = 1; instant < 1400; instant += Stride(17)) {
    SCOPED_TRACE(instant);
    Watched run(Infeed(Changing(150, 150, 0, 1)));
    run.Put(150);
    run.cell.Execute(1);
    run.Steps(instant);
    if (run.counters().picked > 0) break;
    const bool all = instant % 2 == 0;
    run.cell.Do(Control{.path_stop = !all, .stop_all = all});
    const bool was_on_it = run.counters().picked > 0;  // a stop on the path ends the time on the workpiece
    run.cell.Steps(3000);
    // PP-61: after a stop on the path it has risen in step with the belt.
    const bool over_belt = std::abs(run.cell.tool().y() - kBeltY) < kHalfWidth;
    if (!all && over_belt) {
      ASSERT_GE(run.cell.tool().z(), kBeltZ + kDistance - kRadius - 0.5);
    }
    const KDL::Vector rest = run.cell.tool();
    const bool was_low = std::abs(rest.y() - kBeltY) < kHalfWidth && !run.IsUp();
    low += was_low ? 1 : 0;
    run.cell.Do(Control{.path_stop = false, .stop_all = false});
    run.Put(150);
    run.cell.Steps(2);
    run.cell.Execute();
    for (int i = 0; i < 400 && was_low && !run.IsUp(); ++i) {
      run.cell.Step();
      ASSERT_LT(std::hypot(run.cell.tool().x() - rest.x(), run.cell.tool().y() - rest.y()), kBeside) << i;
    }
    ASSERT_TRUE(run.RunUntil([&] { return run.counters().picked == 1; }));
    EXPECT_EQ(run.counters().interrupted, was_on_it ? 0u : 1u);
  }
  EXPECT_GE(low, Trials(6, 1)) << "a test that cannot fail";
}

// From belt to belt: the place on the second one vanishes while the tool lifts from the first one. It continues
// lifting, over its picked workpiece.
TEST(GiveUp, PlaceIsRemovedWhileTheToolLifts) {
  int low = 0;
  for (int instant = 1; instant < 140; instant += 3) {
    SCOPED_TRACE(instant);
    Settings s = Rounded();
    s.tracking_mode = TrackingMode::kBelt1ToBelt2;
    CellBelt out = Infeed(Changing(100, 100, 0, 1));
    out.params.name = out.params.axis = "out";
    out.params.origin.y = out.settings.park_y = 400;
    Cell cell(s, {Infeed(Changing(150, 150, 0, 1)), out});
    cell.Start();
    cell.Put(0, {150, 0, 0, 0, 0, 0});
    const conveyor::Object picked = cell.belt_states[0].objects[0];
    cell.Execute();
    ASSERT_TRUE(cell.RunUntil([&] { return cell.state.orders[0].phase == Phase::kStaying; }));
    cell.Put(1, {120, 0, 0, 0, 0, 0});
    ASSERT_TRUE(cell.RunUntil([&] { return cell.state.counters.picked == 1; }));
    cell.Steps(instant);
    const auto is_low = [&] { return cell.tool().z() < kBeltZ + kDistance - kRadius; };
    low += is_low() ? 1 : 0;
    conveyor::Remove(1, cell.belt_states[1]);
    const bool another = instant % 2 == 0;
    if (another) cell.Put(1, {130, 10, 0, 0, 0, 0});
    for (int i = 0; i < 300 && is_low(); ++i) {
      cell.Step();
      const auto place = conveyor::PoseOf(cell.belts[0].params, cell.belt_states[0], picked).GetFrame().p;
      ASSERT_LT(std::hypot(cell.tool().x() - place.x(), cell.tool().y() - place.y()), kBeside) << i;
    }
    if (!another) {
      ASSERT_TRUE(cell.RunUntil([&] { return cell.out().in_park_position; }));
      cell.Put(1, {120, 0, 0, 0, 0, 0});
    }
    ASSERT_TRUE(cell.RunUntil([&] { return cell.state.counters.placed == 1; }));
    group::ExpectSmooth(cell.rig);
    EXPECT_EQ(cell.state.counters.missed, 0u);
  }
  EXPECT_GT(low, 10) << "a test that cannot fail";
}

}  // namespace
}  // namespace takt::pickplace
