// PP-17, PP-51: the effort of preparing a path, picks per minute compared with the least possible time, and the
// accuracy of placing on a belt that changes its speed.
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "../group/watch.h"
#include "cell.h"
#include "takt/conveyor/belt.h"

namespace takt::pickplace {
namespace {

using M = PickPlaceState;

// As far as the Delta of tests/cpp/group/machines.h goes; 25 mm up, 305 mm across, 25 mm down.
Settings StandardCycle() {
  Settings s = Fast();
  s.path_velocity = 4000;
  s.path_acceleration = s.path_deceleration = 60000;
  s.path_jerk = 3e6;
  s.z_start_distance = s.z_target_distance = 25;
  s.blending_radius = 12.5;
  s.z_target = -850;
  return s;
}
constexpr double kSide = 152.5;

struct Known {
  double length = 0;  // [mm]
  double least = 0;   // [s]
};

// This path in one direction, with the same limits; found off line by tests/tools/path_mechanisms.py.
Known OneWay() {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/data/path_optimum_joints.json");
  for (const nlohmann::json& path : nlohmann::json::parse(file)) {
    if (path["name"] != "delta standard cycle") continue;
    const Rig delta = group::DeltaRobot();
    EXPECT_EQ(path["joints"][0]["velocity"], delta.axes[0].limits.velocity);
    EXPECT_EQ(path["joints"][0]["acceleration"], delta.axes[0].limits.acceleration);
    EXPECT_EQ(path["joints"][0]["jerk"], delta.axes[0].limits.jerk);
    EXPECT_EQ(path["path"]["jerk"], StandardCycle().path_jerk);
    return {path["length"], path["optimum_s"]};
  }
  ADD_FAILURE() << "no such path";
  return {};
}

// PP-51, PP-65: there and back, repeatedly.
TEST(Figures, StandardCycle) {
  Cell cell(StandardCycle(), {}, group::DeltaRobot());
  cell.Start({0, -kSide, -850, 0, 0, 0});
  std::vector<Ticket> tickets;
  for (std::size_t i = 0; i < kOrders; ++i) {
    Configure to;
    to.y_target = i % 2 == 0 ? kSide : -kSide;
    cell.Give(to);
    tickets.push_back(cell.Execute());
  }
  ASSERT_TRUE(cell.RunToEnd(tickets.back(), 10));
  group::ExpectSmooth(cell.rig);
  // Without the first one and without the planning: from end to end.
  const double taken =
      static_cast<double>(cell.rig.lives[tickets.back()].final_cycle - cell.rig.lives[tickets.front()].final_cycle) *
      cell.rig.cycle.period_s / (kOrders - 1);
  double way = 0;
  for (std::size_t i = 1; i < cell.rig.trace.size(); ++i) {
    way += (group::ToolOf(cell.rig, cell.rig.trace[i]).p - group::ToolOf(cell.rig, cell.rig.trace[i - 1]).p).Norm();
  }
  const Known known = OneWay();
  // Of the quintic that passes a corner at one speed; the one of two ramps that overlap lies nearer to the corner.
  EXPECT_NEAR(way / kOrders, known.length, 0.01 * known.length);
  EXPECT_GE(way / kOrders, known.length);
  const double ratio = known.least / taken;
  std::cout << 60 / (2 * taken) << " picks/min, one way " << taken << " s, least " << known.least << " s, ratio "
            << ratio << "\n";
  EXPECT_LE(ratio, 1);
  EXPECT_GE(ratio, 0.95);  // a path bound by jerk nearly all the way
  EXPECT_GE(60 / (2 * taken), 111);
}

// PP-17: no cycle makes more than a few nodes of the path, each of which takes a few inverses; and the tool starts
// within a few cycles.
TEST(Figures, PreparationIsSpreadOverCycles) {
  constexpr std::uint64_t kMostNodes = 20;
  constexpr std::uint64_t kMostCycles = 2;
  for (const PathMode mode : {PathMode::kLinear, PathMode::kElliptical}) {
    for (const double radius : {0.0, 12.5}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(mode) << ", " << radius);
      Settings s = StandardCycle();
      s.path_mode = mode;
      s.z_elliptical = 15;
      s.blending_radius = radius;
      Cell cell(s, {}, group::DeltaRobot());
      cell.Start({0, -kSide, -850, 0, 0, 0});
      Configure to;
      to.y_target = kSide;
      cell.Give(to);
      const Ticket ticket = cell.Execute();
      std::uint64_t before = 0, most = 0, cycles = 0;
      bool moves = false;
      while (!cell.rig.lives[ticket].ended()) {
        cell.Step();
        const std::uint64_t nodes = cell.rig.state.planning.nodes;
        most = std::max(most, nodes - before);
        before = nodes;
        moves |= cell.rig.out().path_velocity > 0;
        if (!moves) ++cycles;
      }
      std::cout << "most nodes in a cycle " << most << ", cycles until it moves " << cycles << "\n";
      EXPECT_GT(before, kMostNodes / 4);
      EXPECT_LE(most, kMostNodes);
      EXPECT_LE(cycles, kMostCycles);
      EXPECT_LE(cell.out().path_preparation_time, kMostCycles * cell.rig.cycle.period_s + 1e-9);
    }
  }
}

// A belt whose speed changes by a tenth, and its encoder of 100 increments/mm, which reports it with a delay.
struct Measured {
  double speed = 1000, hertz = 1, dead_time_s = 0.002;
  conveyor::BeltParams params;
  axis::State axis;
  axis::AxisParams axis_params;
  Cycle cycle;
  std::vector<FeedbackEvent> storage = std::vector<FeedbackEvent>(64);
  FeedbackSink feedback{storage};
  conveyor::State state;

  double TrueAt(double t) const {
    const double w = 2 * std::numbers::pi * hertz;
    return speed * t - 0.1 * speed / w * std::cos(w * t);
  }
  // In the cycle that begins then.
  KinematicState Step(double t) {
    const double period = cycle.period_s;
    const auto seen = [&](double when) { return std::round(100 * TrueAt(when - dead_time_s)) / 100; };
    axis.loop_closed = true;
    axis.actual = {seen(t), (seen(t) - seen(t - period)) / period, 0};
    conveyor::Step({params, axis, axis_params, cycle, feedback}, state);
    return state.travel;
  }
};

// PP-51: the commanded position of the tool on the belt at the end of a cycle, compared with the true one of the belt.
TEST(Figures, PlacingOnABeltThatChangesItsSpeed) {
  struct Case {
    double hertz, most;  // [mm]
  };
  // The error of the filter of 5 ms grows with acceleration; a shorter one lets more of the encoder's steps through.
  for (const auto& [hertz, most] : {Case{0.5, 0.06}, Case{1, 0.1}, Case{2, 0.15}}) {
    SCOPED_TRACE(hertz);
    kinematics::KinematicsParams gantry;
    gantry.gantry.emplace().axes = {kinematics::Coordinate::kX, kinematics::Coordinate::kY, kinematics::Coordinate::kZ};
    Rig machine = group::Machine(gantry, {"x", "y", "z"}, {4000, 40000, 2e6},
                                 {.velocity = 3000, .acceleration = 30000, .deceleration = {}, .jerk = 1.5e6});
    Settings s = StandardCycle();
    s.path_velocity = 3000;
    s.path_acceleration = s.path_deceleration = 30000;
    s.path_jerk = 1.5e6;
    s.z_target = 0;
    s.y_target = -100;
    s.tracking_mode = TrackingMode::kStaticToBelt1;
    Measured measured;
    measured.hertz = hertz;
    CellBelt belt;
    belt.params.name = belt.params.axis = "belt";
    belt.params.source = axis::MasterSource::kActualValue;
    belt.params.dead_time_s = measured.dead_time_s;
    belt.params.origin = {-600, 100, 0, 0, 0, 0};
    belt.settings = {.park_z = 60, .z_distance = 25, .sync_time = 0.05, .lower_limit = 0, .upper_limit = 1200};
    measured.params = belt.params;
    belt.travel = [&](double t) { return measured.Step(t); };
    Cell cell(s, {belt}, std::move(machine));
    cell.Start({0, 0, 60, 0, 0, 0});
    cell.Steps(100);  // the filter finds the speed
    cell.Execute();
    // Position of the belt when the axes are at the set points of the last cycle stepped.
    const auto truth = [&] { return measured.TrueAt(static_cast<double>(cell.rig.cycle.count) * 0.001); };
    double worst = 0;
    int on = 0;
    for (int i = 0; i < 20000; ++i) {
      if (i % 1000 == 0) {  // detected at its true position
        cell.Put(0, {0, 20, 0, 0, 0, 0});
        conveyor::State& state = cell.belt_states[0];
        state.objects[state.count - 1].latch = truth();
      }
      cell.Step();
      ASSERT_NE(cell.state.state, M::kError);
      conveyor::State& state = cell.belt_states[0];
      const Order& order = cell.state.orders[0];
      if (order.phase == Phase::kStaying) {
        const conveyor::Object& object = *conveyor::Find(state, order.workpiece);
        worst = std::max(worst, cell.Off(-600 + truth() - object.latch, 120, 0));
        ++on;
      }
      for (const conveyor::Object& object : conveyor::ObjectsOf(state)) {
        if (object.state != conveyor::ObjectState::kVisible) continue;
        if (conveyor::PlaceOf(cell.belts[0].params, state, object) <= 1200) continue;
        conveyor::Remove(object.number, state);
        break;
      }
    }
    std::cout << hertz << " Hz: " << cell.state.counters.placed << " placed, off by " << worst << " mm at most\n";
    EXPECT_GE(cell.state.counters.placed, 8u);
    EXPECT_GE(on, 400);
    EXPECT_LT(worst, most);
    EXPECT_GT(worst, 1e-4) << "a test that cannot fail";
  }
}

}  // namespace
}  // namespace takt::pickplace
