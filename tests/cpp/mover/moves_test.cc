// PL-03, PL-11, PL-15: moves keep their limits, take no longer than necessary, and end at their targets.
#include <numbers>
#include <ruckig/ruckig.hpp>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "rig.h"

namespace takt::mover {
namespace {

double Optimum(double distance, const trajectory::Limits& l) {
  ruckig::Ruckig<1> solver;
  ruckig::InputParameter<1> input;
  input.current_position = {0};
  input.target_position = {distance};
  input.max_velocity = {l.velocity};
  input.max_acceleration = {l.acceleration};
  input.min_acceleration = std::array<double, 1>{-l.deceleration};
  input.max_jerk = {l.jerk};
  ruckig::Trajectory<1> trajectory;
  EXPECT_EQ(solver.calculate(input, trajectory), ruckig::Result::Working);
  return trajectory.get_duration();
}

// PL-15: as fast as a solver for the bare distance.
TEST(MoverMoves, StraightLinesAreTimeOptimal) {
  std::mt19937 random(3);
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    Rig rig({.initial = {.x = Uniform(random, -500, 500), .y = Uniform(random, -500, 500)}});
    rig.Enable();
    Watch watch(rig);
    const MoveToPosition move{.x = Uniform(random, -500, 500),
                              .y = Uniform(random, -500, 500),
                              .velocity = Uniform(random, 50, 2000),
                              .acceleration = Uniform(random, 500, 10000),
                              .deceleration = Uniform(random, 500, 10000),
                              .jerk = Uniform(random, 10000, 200000)};
    const double from_x = rig.out.x;
    const double from_y = rig.out.y;
    const double distance = std::hypot(move.x - from_x, move.y - from_y);
    const Ticket ticket = rig.Give(move);
    int cycles = 0;
    while (!IsFinal(rig.Of(ticket).state)) {
      rig.Step();
      watch.Look();
      ++cycles;
      const double off = (rig.out.x - from_x) * (move.y - from_y) - (rig.out.y - from_y) * (move.x - from_x);
      ASSERT_NEAR(off / distance, 0, 1e-9);  // on the line
    }
    ASSERT_EQ(rig.Of(ticket).state, FeedbackState::kDone);
    EXPECT_EQ(rig.out.x, move.x);
    EXPECT_EQ(rig.out.y, move.y);
    const double optimum = Optimum(distance, {*move.velocity, *move.acceleration, *move.deceleration, *move.jerk});
    worst = std::max(worst, rig.planned_s[ticket] / optimum);
    EXPECT_GE(rig.planned_s[ticket], optimum * (1 - 1e-6));
    EXPECT_EQ(cycles, static_cast<int>(std::ceil(rig.planned_s[ticket] / 0.001 - 1e-9)));
  }
  EXPECT_LE(worst, 1.01);
  RecordProperty("worst_ratio", std::to_string(worst));
}

// PL-03: dynamics above the maximum are reduced, and reported.
TEST(MoverMoves, TooMuchIsReducedNotRefused) {
  Rig rig({.xy = {.maximum = {500, 2000, {}, 20000}, .standard = Dynamics{100, 1000, {}, 10000}}});
  rig.Enable();
  Watch watch(rig);
  const auto run = [&](const MoveToPosition& move) {
    const Ticket ticket = rig.Give(move);
    double most = 0;
    while (!IsFinal(rig.Of(ticket).state)) {
      rig.Step();
      watch.Look();
      most = std::max(most, std::abs(rig.out.velocity_x));
    }
    EXPECT_EQ(rig.Of(ticket).state, FeedbackState::kDone);
    return most;
  };
  EXPECT_NEAR(run({.x = 500}), 100, 1e-6);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
  EXPECT_NEAR(run({.x = 0, .velocity = 5000.0}), 500, 1e-6);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kVelocity);
  run({.x = 500, .deceleration = 5000.0});
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kAcceleration);
  run({.x = 0, .jerk = 1e9});
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kJerk);
  run({.x = 500, .velocity = 200.0});
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
}

// PL-11: onto another line during a move: without a stop, and faster than with one.
TEST(MoverMoves, TurnsOntoAnotherLineWithoutAStop) {
  for (const double degrees : {5.0, 20.0, 40.0}) {
    Rig rig;
    rig.Enable();
    Watch watch(rig);
    rig.Give(MoveToPosition{.x = 2000});
    for (int i = 0; i < 500; ++i) {
      rig.Step();
      watch.Look();
    }
    ASSERT_NEAR(rig.out.velocity_x, 2000, 1e-6);
    const double angle = degrees * std::numbers::pi / 180;
    const double x = rig.out.x + 1500 * std::cos(angle);
    const double y = 1500 * std::sin(angle);
    const Ticket ticket = rig.Give(MoveToPosition{.x = x, .y = y});
    double least = 1e9;
    for (int i = 0; i < 400; ++i) {
      rig.Step();
      watch.Look();
      least = std::min(least, std::hypot(rig.out.velocity_x, rig.out.velocity_y));
    }
    EXPECT_GT(least, 2000 * std::cos(angle) * 0.8) << degrees;
    EXPECT_EQ(rig.Become(ticket), FeedbackState::kDone);
    EXPECT_EQ(rig.out.x, x);
    EXPECT_EQ(rig.out.y, y);
  }
}

// PL-11, PL-15: random moves, halts, turns and others at random times; every limit holds in every cycle.
TEST(MoverMoves, RandomCommandsKeepAllLimits) {
  std::mt19937 random(11);
  int done = 0;
  for (int run = 0; run < Trials(150, 1); ++run) {
    MoverParams params;
    params.xy.maximum = {Uniform(random, 200, 3000), Uniform(random, 1000, 20000), Uniform(random, 1000, 20000),
                         Uniform(random, 20000, 500000)};
    params.c.maximum = {Uniform(random, 30, 720), Uniform(random, 300, 7200), {}, Uniform(random, 3000, 100000)};
    Rig rig(params, Whole(random, 0, 1) ? 0.001 : 0.00025);
    rig.Enable();
    Watch watch(rig);
    std::vector<Ticket> moves;
    const auto maybe = [&](double from, double to) {
      return Whole(random, 0, 1) ? std::optional(Uniform(random, from, to)) : std::nullopt;
    };
    for (int i = 0; i < 30; ++i) {
      const double v = params.xy.maximum.velocity;
      const double a = params.xy.maximum.acceleration;
      const double j = params.xy.maximum.jerk;
      switch (Whole(random, 0, 9)) {
        case 0:
          rig.Give(Halt{.deceleration = maybe(0.05 * a, 2 * a), .jerk = maybe(0.05 * j, 2 * j)});
          break;
        case 1:
          rig.Give(MoveC{.position = Uniform(random, -14, 14),
                         .velocity = maybe(1, 900),
                         .acceleration = maybe(30, 9000),
                         .jerk = maybe(300, 100000)});
          break;
        case 2:
          rig.Give(MoveC{.position = Uniform(random, -300, 300)});
          break;
        case 3:
          rig.Give(MoveC{.position = 0, .direction = TurnDirection::kShortestWay});
          rig.Run(Whole(random, 0, 1) ? 3000 : 0);
          break;
        case 4:
          rig.Give(MoveZ{.position = Uniform(random, 0, 5), .velocity = maybe(1, 200), .jerk = maybe(500, 40000)});
          rig.Give(MoveA{.position = Uniform(random, -5, 5), .deceleration = maybe(10, 300)});
          break;
        default:
          moves.push_back(rig.Give(MoveToPosition{.x = Uniform(random, -800, 800),
                                                  .y = Uniform(random, -800, 800),
                                                  .c = Uniform(random, -14, 14),
                                                  .use_orientation = Whole(random, 0, 3) == 0,
                                                  .velocity = maybe(0.05 * v, 2 * v),
                                                  .acceleration = maybe(0.05 * a, 2 * a),
                                                  .deceleration = maybe(0.05 * a, 2 * a),
                                                  .jerk = maybe(0.05 * j, 2 * j)}));
      }
      watch = Watch(rig);
      const int cycles = Whole(random, 0, 400);
      for (int k = 0; k < cycles; ++k) {
        rig.Step();
        watch.Look();
        if (testing::Test::HasFailure()) return;
      }
    }
    rig.Run(60'000);
    EXPECT_TRUE(AtRest(rig.state));
    for (const Ticket move : moves) {
      EXPECT_TRUE(IsFinal(rig.Of(move).state));
      done += rig.Of(move).state == FeedbackState::kDone ? 1 : 0;
    }
  }
  EXPECT_GT(done, Trials(200, 1));
}

// PL-11: with its orientation the mover arrives in all three coordinates at the same time, from rest.
TEST(MoverMoves, HasOrientationTarget) {
  for (const double velocity : {2000.0, 20.0}) {
    Rig rig;
    rig.Enable();
    Watch watch(rig);
    const Ticket ticket =
        rig.Give(MoveToPosition{.x = 100, .y = 50, .c = 12, .use_orientation = true, .velocity = velocity});
    bool moved = false;
    while (!IsFinal(rig.Of(ticket).state)) {
      rig.Step();
      watch.Look();
      // Both or none.
      if (rig.out.busy_xyc && moved) {
        EXPECT_EQ(rig.out.velocity_x != 0, rig.out.velocity_c != 0);
      }
      moved = true;
    }
    EXPECT_EQ(rig.Of(ticket).state, FeedbackState::kDone);
    EXPECT_EQ(rig.out.x, 100);
    EXPECT_EQ(rig.out.y, 50);
    EXPECT_EQ(rig.out.c, 12);
  }
  Rig rig;
  rig.Enable();
  rig.Finish(rig.Give(MoveToPosition{.x = 100, .c = 12, .use_orientation = false}));
  EXPECT_EQ(rig.out.c, 0);
  EXPECT_EQ(rig.Of(rig.Give(MoveToPosition{.x = 0, .c = 16, .use_orientation = true})).error, ErrorId::kOutsideWindow);
}

// PL-11: a given angle applies; without one, or if it is not to be used, C stays.
TEST(MoverMoves, TurnsWhereAnAngleIsGiven) {
  Rig rig;
  rig.Enable();
  rig.Finish(rig.Give(MoveToPosition{.x = 100, .c = 10}));
  EXPECT_EQ(rig.out.c, 10);
  rig.Finish(rig.Give(MoveToPosition{.x = 0}));
  EXPECT_EQ(rig.out.c, 10);
  rig.Finish(rig.Give(MoveToPosition{.x = 100, .c = 5, .use_orientation = false}));
  EXPECT_EQ(rig.out.c, 10);
}

// PL-11: Z, A and B move independently, within their limits.
TEST(MoverMoves, AuxiliaryCoordinatesHaveLimits) {
  Rig rig;
  rig.Enable();
  const Ticket z = rig.Give(MoveZ{.position = 5});
  const Ticket a = rig.Give(MoveA{.position = 1});
  const Ticket b = rig.Give(MoveB{.position = -1});
  const Ticket c = rig.Give(MoveC{.position = 3});
  rig.Step();
  EXPECT_TRUE(rig.out.busy_z && rig.out.busy_a && rig.out.busy_b && rig.out.busy_c && !rig.out.busy_xyc);
  for (const Ticket ticket : {z, a, b, c}) EXPECT_EQ(rig.Become(ticket), FeedbackState::kDone);
  EXPECT_EQ(rig.out.z, 5);
  EXPECT_EQ(rig.out.a, 1);
  EXPECT_EQ(rig.out.b, -1);
  EXPECT_EQ(rig.out.c, 3);
  EXPECT_EQ(rig.Of(rig.Give(MoveZ{.position = 5.1})).error, ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.Of(rig.Give(MoveZ{.position = -0.1})).error, ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.Of(rig.Give(MoveA{.position = -6})).error, ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.Of(rig.Give(MoveB{.position = 6})).error, ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.Of(rig.Give(MoveB{.position = std::nan("")})).error, ErrorId::kParameter);
}

TEST(MoverMoves, ACycleTakesNoMemory) {
  Rig rig;
  TypeOf<State>();
  rig.Enable();
  for (int i = 0; i < 5; ++i) {
    const long before = AllocationsOfThisThread();
    Apply(rig.context(), 0, MoveToPosition{.x = 100.0 * i, .y = 70, .c = 5, .use_orientation = i % 2 == 0}, rig.state);
    for (int k = 0; k < 30; ++k) {
      mover::Step(rig.context(), rig.inputs, rig.state);
      Publish(rig.context(), rig.inputs, rig.state, rig.out);
      ++rig.cycle.count;
    }
    EXPECT_EQ(AllocationsOfThisThread(), before);
  }
}

}  // namespace
}  // namespace takt::mover
