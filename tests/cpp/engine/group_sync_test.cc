// GR-20, GR-25: paths of the machine file, paths that follow a master, axes that follow the path of a group: on an
// engine, where masters step before their followers.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "line.h"

namespace takt::engine {
namespace {

using group::GroupState;

// A gantry of x and y; m leads, f and three more follow. Path "hook" is smooth from (0, 0): 100 mm along X, half a
// circle of 50 mm radius up to (100, 100), 60 mm back. "step" has corners. "fast" has its own speeds.
const char* kFollowers = R"(
name: followers
axes:
  - {name: x, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}, encoder: {increments_per_unit: 10000}}
  - {name: y, limits: {velocity: 1000, acceleration: 10000, jerk: 500000}, encoder: {increments_per_unit: 10000}}
  - {name: m, limits: {velocity: 300, acceleration: 3000, jerk: 60000, lower: -400, upper: 400}, encoder: {increments_per_unit: 10000}}
  - {name: f, limits: {velocity: 2000, acceleration: 40000, jerk: 2000000}, encoder: {increments_per_unit: 10000}}
  - {name: f2, limits: {velocity: 2000, acceleration: 40000, jerk: 2000000}, encoder: {increments_per_unit: 10000}}
  - {name: f3, limits: {velocity: 2000, acceleration: 40000, jerk: 2000000}, encoder: {increments_per_unit: 10000}}
  - {name: f4, limits: {velocity: 2000, acceleration: 40000, jerk: 2000000}, encoder: {increments_per_unit: 10000}}
  - {name: f5, limits: {velocity: 2000, acceleration: 40000, jerk: 2000000}, encoder: {increments_per_unit: 10000}}
groups:
  - name: bench
    axes: [x, y]
    kinematics: {gantry: {axes: [x, y]}}
    path: {velocity: 400, acceleration: 4000, jerk: 200000}
paths:
  - name: hook
    elements:
      - {shape: line, to: {x: 100, y: 0, z: 0}}
      - {shape: arc, via_x: 150, via_y: 50, via_z: 0, to: {x: 100, y: 100, z: 0}}
      - {shape: line, to: {x: 40, y: 100, z: 0}}
  - name: step
    elements:
      - {shape: line, to: {x: 50, y: 0, z: 0}}
      - {shape: line, to: {x: 50, y: 50, z: 0}}
      - {shape: line, to: {x: 100, y: 50, z: 0}}
  - name: fast
    elements:
      - {shape: line, to: {x: 100, y: 0, z: 0}, velocity: 250}
      - {shape: line, to: {x: 200, y: 0, z: 0}, velocity: 60}
      - {shape: line, to: {x: 300, y: 0, z: 0}}
      - {shape: spline, points: [{x: 330, y: 10, z: 0}, {x: 350, y: 50, z: 0}, {x: 330, y: 90, z: 0}, {x: 300, y: 100, z: 0}], velocity: 120}
)";
constexpr std::size_t kX = 0, kY = 1, kM = 2, kF = 3;
constexpr double kHook = 160 + 50 * std::numbers::pi;  // [mm] its length

struct PathPlace {
  double x = 0, y = 0;
};

// Returns the position on "hook" at an arc length.
PathPlace OnHook(double way) {
  constexpr double kTurned = 100 + 50 * std::numbers::pi;
  way = std::clamp(way, 0.0, kHook);
  if (way <= 100) return {way, 0};
  if (way >= kTurned) return {100 - (way - kTurned), 100};
  const double angle = (way - 100) / 50;
  return {100 + 50 * std::sin(angle), 50 - 50 * std::cos(angle)};
}
// Likewise on "step".
PathPlace OnStep(double way) {
  return {std::clamp(way, 0.0, 50.0) + std::clamp(way - 100, 0.0, 50.0), std::clamp(way - 50, 0.0, 50.0)};
}

// Returns the arc length on "hook" of the nearest position, and its distance.
struct Nearest {
  double way = 0, off = 1e99;
};
Nearest OnHookAt(double x, double y) {
  Nearest nearest;
  const auto look = [&](double way) {
    const PathPlace p = OnHook(way);
    const double off = std::hypot(p.x - x, p.y - y);
    if (off < nearest.off) nearest = {way, off};
  };
  look(x);
  look(100 + 50 * (std::numbers::pi / 2 + std::atan2(y - 50, x - 100)));
  look(100 + 50 * std::numbers::pi + 100 - x);
  return nearest;
}

class Followers : public Line, public testing::Test {
 public:
  Followers() : Line(Made()) {
    Tell(group::Enable{});
    Run(5);
  }
  static Machine Made() {
    LoadResult loaded = LoadMachine(kFollowers, "followers.yaml");
    if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
    return *loaded.machine;
  }

  Ticket Tell(const group::Command& body) { return engine.Submit(ToGroup(machine, body)); }
  const group::Outputs& bench() const { return engine.group_outputs(0); }
  double x() const { return At(kX).set_position; }
  double y() const { return At(kY).set_position; }
  // Returns the distance of the tool from the position that the master commands.
  double FromMaster(double begin, double ratio = 1) const {
    const PathPlace p = OnHook(ratio * (At(kM).set_position - begin));
    return std::hypot(p.x - x(), p.y - y());
  }
  // Each cycle: the tool stays on its path and never moves back.
  void Step() {
    Line::Step();
    ++cycle;
    const std::array<KinematicState, 4> now = {Of(kX), Of(kY), Of(kM), Of(kF)};
    for (std::size_t i = 0; i < 4; ++i) {
      const axis::AxisLimits& limits = machine.axes[i].limits;
      EXPECT_LE(std::abs(now[i].velocity), limits.velocity * (1 + 1e-9)) << i;
      EXPECT_LE(std::abs(now[i].acceleration), limits.acceleration * (1 + 1e-9)) << i;
      if (cycle > 1) {
        EXPECT_LE(std::abs(now[i].acceleration - before[i].acceleration), limits.jerk * 1e-3 * (1 + 1e-6)) << i;
        EXPECT_NEAR(now[i].position - before[i].position, 0.5e-3 * (now[i].velocity + before[i].velocity), 2e-4) << i;
      }
    }
    before = now;
    if (!on_hook) return;
    const Nearest nearest = OnHookAt(x(), y());
    // Where a line meets an arc without a blend its curvature has a step, which the axes' jerk rounds.
    EXPECT_LE(nearest.off, 2e-4) << "beside the path at " << x() << ", " << y();
    EXPECT_GE(nearest.way, way - 1e-6) << "back on the path";
    way = std::max(way, nearest.way);
  }
  void Run(int cycles) {
    for (int i = 0; i < cycles; ++i) Step();
  }
  bool RunToEnd(Ticket ticket, int cycles = 20000) {
    for (; cycles > 0 && !IsFinal(last[ticket].state); --cycles) Step();
    return IsFinal(last[ticket].state);
  }
  KinematicState Of(std::size_t axis) const {
    return {At(axis).set_position, At(axis).set_velocity, At(axis).set_acceleration};
  }
  // Starts a path that follows its master.
  Ticket Follow(double ratio = 1, const char* path = "hook") {
    const Ticket move = Tell(group::MovePathSynchronized{.path = Name::Of(path),
                                                         .master = Name::Of("m"),
                                                         .ratio = ratio,
                                                         .transition_mode = group::TransitionMode::kNone});
    Run(20);
    EXPECT_EQ(last[move].state, FeedbackState::kActive);
    return move;
  }

  int cycle = 0;
  std::array<KinematicState, 4> before{};
  bool on_hook = false;
  double way = 0;
};

// GR-20: lines, arcs and splines of a path: no element exceeds its own speed, and reaches it if it is long enough.
TEST_F(Followers, EveryElementHasItsSpeed) {
  const Ticket move = Tell(group::MovePath{.path = Name::Of("fast"), .velocity = 300});
  std::array<double, 4> fastest{};
  double slowest_inside = 1e99;
  while (!IsFinal(last[move].state)) {
    Step();
    const std::size_t element = x() >= 300 || y() > 0 ? 3 : static_cast<std::size_t>(x() / 100);
    fastest[element] = std::max(fastest[element], bench().velocity);
    if (element == 3 && y() > 20 && y() < 80) slowest_inside = std::min(slowest_inside, bench().velocity);
  }
  EXPECT_EQ(last[move].state, FeedbackState::kDone);
  EXPECT_NEAR(x(), 300, 1e-9);
  EXPECT_NEAR(y(), 100, 1e-9);
  const std::array<double, 4> most = {250, 60, 300, 120};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE(fastest[i], most[i] * (1 + 1e-6)) << i;
    EXPECT_GE(fastest[i], most[i] * 0.97) << i;
  }
  EXPECT_GE(slowest_inside, 0.9 * 120) << "the points of a spline are no stops";
}

// GR-25: in step with a master from its start to the end of the path.
TEST_F(Followers, APathGoesAsItsMaster) {
  on_hook = true;
  const Ticket move = Follow();
  EXPECT_EQ(way, 0);  // as the master is at rest
  const double begin = At(kM).set_position;
  Give(kM, axis::MoveVelocity{.velocity = 100});
  double worst = 0;
  while (At(kM).set_position - begin < kHook - 2) {  // before its end it brakes
    Step();
    worst = std::max(worst, FromMaster(begin));
  }
  EXPECT_EQ(bench().state, GroupState::kMoving);
  EXPECT_LE(worst, 0.003);
  EXPECT_TRUE(reached[move]);
  ASSERT_TRUE(RunToEnd(move, 200));
  EXPECT_EQ(last[move].state, FeedbackState::kDone);
  EXPECT_NEAR(x(), 40, 1e-9);
  EXPECT_EQ(bench().state, GroupState::kStandby);
  Run(100);  // the master continues alone
  EXPECT_NEAR(x(), 40, 1e-9);
}

// GR-25: a master that stops, continues, reverses, and stops at its end: the tool waits at its furthest position.
TEST_F(Followers, APathWaitsForItsMaster) {
  on_hook = true;
  const Ticket move = Follow(-1);
  const double begin = At(kM).set_position;
  const Ticket there = Give(kM, axis::MoveAbsolute{.position = begin - 150, .velocity = 120});
  ASSERT_TRUE(RunToEnd(there));
  Run(300);
  EXPECT_LE(FromMaster(begin, -1), 0.01);
  EXPECT_TRUE(bench().synchronized);
  EXPECT_EQ(bench().state, GroupState::kMoving);
  const double there_x = x(), there_y = y();
  ASSERT_TRUE(RunToEnd(Give(kM, axis::MoveAbsolute{.position = begin - 110, .velocity = 120})));
  EXPECT_NEAR(x(), there_x, 0.01);
  EXPECT_NEAR(y(), there_y, 0.01);
  EXPECT_FALSE(bench().synchronized);
  ASSERT_TRUE(RunToEnd(Give(kM, axis::MoveAbsolute{.position = begin - 200, .velocity = 120})));
  Run(300);
  EXPECT_LE(FromMaster(begin, -1), 0.01);
  EXPECT_TRUE(bench().synchronized);
  // Its SW limit is at -400: it stops there, but that is beyond the end of the path.
  Give(kM, axis::MoveVelocity{.velocity = 200, .direction = axis::Direction::kNegative});
  ASSERT_TRUE(RunToEnd(move));
  EXPECT_EQ(last[move].state, FeedbackState::kDone);
  EXPECT_NEAR(x(), 40, 1e-9);
}

// GR-25: a master that reaches its end first.
TEST_F(Followers, APathStopsWhereItsMasterDoes) {
  on_hook = true;
  const Ticket move = Follow(0.5);
  const double begin = At(kM).set_position;
  Give(kM, axis::MoveVelocity{.velocity = 250});
  Run(4000);
  EXPECT_NEAR(At(kM).set_position, 400, 1);
  EXPECT_LE(FromMaster(begin, 0.5), 0.01);
  EXPECT_EQ(bench().state, GroupState::kMoving);
  EXPECT_EQ(last[move].state, FeedbackState::kActive);
  const Ticket stop = Tell(group::Stop{});
  ASSERT_TRUE(RunToEnd(stop));
  EXPECT_EQ(last[move].state, FeedbackState::kAborted);
  EXPECT_EQ(bench().state, GroupState::kStandby);
}

// GR-25: a master faster than the path allows: the tool lags within the limits, and catches up.
TEST_F(Followers, APathMakesUpWhatItLost) {
  on_hook = true;
  Follow(3);
  const double begin = At(kM).set_position;
  const Ticket there = Give(kM, axis::MoveAbsolute{.position = begin + 80, .velocity = 250});
  double behind = 0;
  while (!IsFinal(last[there].state)) {
    Step();
    behind = std::max(behind, 3 * (At(kM).set_position - begin) - way);
  }
  EXPECT_GT(behind, 5);
  Run(1200);
  EXPECT_LE(FromMaster(begin, 3), 0.01);
  EXPECT_TRUE(bench().synchronized);
}

// GR-25, GR-20: interrupted, the path rests; continued, it catches up.
TEST_F(Followers, AnInterruptedPathComesBackIntoStep) {
  on_hook = true;
  const Ticket move = Follow();
  const double begin = At(kM).set_position;
  Give(kM, axis::MoveVelocity{.velocity = 60});
  Run(800);
  ASSERT_TRUE(RunToEnd(Tell(group::Interrupt{}), 500));
  const double there = way;
  Run(300);
  EXPECT_EQ(way, there);
  Tell(group::Continue{});
  Run(1000);
  EXPECT_LE(FromMaster(begin), 0.02);
  ASSERT_TRUE(RunToEnd(move));
  EXPECT_EQ(last[move].state, FeedbackState::kDone);
}

// GR-25: also a path with corners, at which the tool stops: after them it is in step again.
TEST_F(Followers, APathWithCornersIsInStepBehindThem) {
  const Ticket move = Follow(1, "step");
  const double begin = At(kM).set_position;
  for (const double to : {25.0, 75.0, 125.0}) {
    ASSERT_TRUE(RunToEnd(Give(kM, axis::MoveAbsolute{.position = begin + to, .velocity = 50})));
    Run(500);
    EXPECT_NEAR(x(), OnStep(to).x, 0.01) << to;
    EXPECT_NEAR(y(), OnStep(to).y, 0.01) << to;
  }
  Give(kM, axis::MoveAbsolute{.position = begin + 151, .velocity = 50});
  ASSERT_TRUE(RunToEnd(move, 2000));
  EXPECT_NEAR(x(), 100, 1e-9);
}

// GR-25: moves after a path that follows a master are timed by the clock.
TEST_F(Followers, WhatComesBehindDoesNotFollow) {
  for (const auto mode : {axis::BufferMode::kBuffered, axis::BufferMode::kBlendingNext}) {
    ASSERT_TRUE(RunToEnd(Tell(group::MoveDirectAbsolute{.a1 = 0, .a2 = 0})));
    ASSERT_TRUE(RunToEnd(Give(kM, axis::MoveAbsolute{.position = 0, .velocity = 300})));
    const Ticket path = Follow(1, "step");
    const Ticket behind = Tell(group::MoveLinearRelative{.x = -30,
                                                         .y = 100,
                                                         .buffer_mode = mode,
                                                         .transition_mode = group::TransitionMode::kCornerDistance,
                                                         .transition_parameter = 5});
    ASSERT_TRUE(RunToEnd(Give(kM, axis::MoveAbsolute{.position = 151, .velocity = 80})));
    ASSERT_TRUE(RunToEnd(behind, 3000)) << "still follows: " << static_cast<int>(mode);
    EXPECT_EQ(last[path].state, FeedbackState::kDone);
    EXPECT_EQ(last[behind].state, FeedbackState::kDone);
    EXPECT_NEAR(x(), 70, 1e-9);
    EXPECT_NEAR(y(), 150, 1e-9);
  }
}

// GR-25: an axis follows the arc length along all motions of the group: two consecutive moves, a whole circle, a move
// of axes, an interrupt, a halt, a stop.
TEST_F(Followers, AnAxisFollowsTheWay) {
  const Ticket sync = Tell(group::SyncAxis{.axis = Name::Of("f"), .ratio_numerator = -3, .ratio_denominator = 2});
  Run(5);
  EXPECT_EQ(last[sync].state, FeedbackState::kActive);
  EXPECT_TRUE(reached[sync]);
  double gone = 0, bx = x(), by = y();
  const auto watch = [&] {
    Step();
    gone += std::hypot(x() - bx, y() - by);
    bx = x();
    by = y();
    EXPECT_NEAR(At(kF).set_position, -1.5 * gone, 2e-3);
  };
  const auto run = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) watch();
  };
  const auto to_end = [&](Ticket ticket) {
    for (int i = 0; i < 10000 && !IsFinal(last[ticket].state); ++i) watch();
  };
  Tell(group::MoveLinearAbsolute{.x = 60, .y = 80});
  to_end(Tell(group::MoveLinearAbsolute{.x = 0, .y = 80, .buffer_mode = axis::BufferMode::kBuffered}));
  EXPECT_NEAR(At(kF).set_position, -1.5 * 160, 1e-6);
  group::MoveCircularRelative circle{.circ_mode = path::CircMode::kCenter, .velocity = 100};
  circle.aux_x = 20;
  circle.normal_z = 1;
  to_end(Tell(circle));
  EXPECT_NEAR(At(kF).set_position, -1.5 * (160 + 40 * std::numbers::pi), 1e-6);
  Tell(group::MoveLinearAbsolute{.x = 200, .y = 80});
  run(150);
  to_end(Tell(group::Interrupt{}));
  run(50);
  Tell(group::Continue{});
  run(100);
  to_end(Tell(group::Halt{}));
  const Ticket aborted = Tell(group::MoveLinearAbsolute{.x = 0, .y = 0});
  run(100);
  to_end(Tell(group::MoveLinearAbsolute{.y = 300}));
  EXPECT_EQ(last[aborted].state, FeedbackState::kAborted);
  Tell(group::MoveLinearAbsolute{.x = 0, .y = 0});
  run(150);
  to_end(Tell(group::Stop{.deceleration = 1000}));
  EXPECT_EQ(last[sync].state, FeedbackState::kActive);
  EXPECT_EQ(At(kF).state, axis::PlcState::kSynchronizedMotion);
  Tell(group::Disable{});
  Run(10);
  EXPECT_EQ(last[sync].state, FeedbackState::kDone);
  EXPECT_EQ(At(kF).state, axis::PlcState::kStandstill);
}

// GR-25: started during a path, it synchronises, and recovers the displacement lost until then.
TEST_F(Followers, AnAxisGetsIntoStepOnTheWay) {
  Tell(group::MoveLinearAbsolute{.x = 300, .y = 400, .velocity = 200});
  Run(400);
  const double x0 = x(), f0 = At(kF).set_position;
  const Ticket sync = Tell(group::SyncAxis{.axis = Name::Of("f")});
  for (int i = 0; i < 1000 && !reached[sync]; ++i) Step();
  ASSERT_TRUE(reached[sync]);
  EXPECT_TRUE(bench().state == GroupState::kMoving);
  Step();
  // As of the cycle before the command, or the one after it.
  EXPECT_NEAR(At(kF).set_position - f0, (x() - x0) / 0.6, 0.3);
  EXPECT_NEAR(At(kF).set_velocity, bench().velocity, 1e-6);
}

// GR-25: four at the same time, each once; a command or a fault of the axis ends that.
TEST_F(Followers, AxesComeAndGo) {
  const auto sync = [&](const char* name) { return Tell(group::SyncAxis{.axis = Name::Of(name)}); };
  const std::array<Ticket, 5> tickets = {sync("f"), sync("f2"), sync("f3"), sync("f4"), sync("f5")};
  Run(5);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(last[tickets[i]].state, FeedbackState::kActive) << i;
  EXPECT_EQ(last[tickets[4]].error, ErrorId::kBufferFull);
  const Ticket again = sync("f4");
  const Ticket member = sync("x");
  Run(5);
  EXPECT_EQ(last[tickets[3]].state, FeedbackState::kAborted);
  EXPECT_EQ(last[again].state, FeedbackState::kActive);
  EXPECT_EQ(last[member].state, FeedbackState::kError);
  const Ticket move = Tell(group::MoveLinearAbsolute{.x = 300});
  Run(200);
  EXPECT_GT(At(4).set_velocity, 100);
  const Ticket own = Give(kF, axis::Halt{});
  engine.faults(5).drive_fault = true;  // f3
  Run(100);
  EXPECT_EQ(last[tickets[0]].state, FeedbackState::kAborted);
  EXPECT_EQ(last[own].state, FeedbackState::kDone);
  EXPECT_EQ(last[tickets[2]].state, FeedbackState::kError);
  EXPECT_EQ(bench().state, GroupState::kMoving) << "no member";
  ASSERT_TRUE(RunToEnd(move));
  EXPECT_EQ(last[move].state, FeedbackState::kDone);
  EXPECT_NEAR(At(4).set_position, 300, 1e-9);
}

// GR-25, GR-03: along the path also while a fault stops the group.
TEST_F(Followers, AnAxisFollowsIntoAFault) {
  const Ticket sync = Tell(group::SyncAxis{.axis = Name::Of("f"), .ratio_numerator = 2});
  Tell(group::MoveLinearAbsolute{.x = 300});
  Run(300);
  ASSERT_GT(x(), 20);
  engine.faults(kY).drive_fault = true;  // y stops
  for (int i = 0; i < 400; ++i) {
    Step();
    EXPECT_NEAR(At(kF).set_position, 2 * x(), 1e-6);
  }
  EXPECT_EQ(bench().state, GroupState::kErrorStop);
  EXPECT_EQ(At(kX).set_velocity, 0);
  EXPECT_EQ(last[sync].state, FeedbackState::kActive);
}

}  // namespace
}  // namespace takt::engine
