// Lowering a limit while moving: AX-97. Overrides at random: AX-51.
#include <gtest/gtest.h>

#include <random>

#include "../core/trials.h"
#include "rig.h"

namespace takt::axis {
namespace {

// What lowers the ramps at some time of a move to 100.
struct Lowering {
  const char* name;
  Command command;
  bool ends_there;  // at the same target
};
class Promise : public testing::TestWithParam<Lowering> {};

// AX-97: whenever it comes, the target is not overshot, and where the weaker ramps would not have been enough, it says
// that there was too little room for them.
TEST_P(Promise, IsKeptWhenLimitsAreLowered) {
  for (const double jerk : {100000.0, 0.0}) {
    int strengthened = 0;
    for (int after = 1; after < 600; after += 7) {
      AxisParams p = LinearParams();
      p.limits.jerk = jerk;
      Rig rig(p);
      ASSERT_TRUE(rig.PowerOn());
      rig.Give(MoveAbsolute{.position = 100, .velocity = 200, .deceleration = 3000});
      rig.Run(0.001 * after);
      const Ticket lowering = rig.Give(GetParam().command);
      rig.Step();
      strengthened += rig.out.limited_by == LimitedBy::kDistance ? 1 : 0;
      ASSERT_NE(rig.out.limited_by, LimitedBy::kOvershoot) << after;
      rig.Run(10);
      ASSERT_LE(Highest(rig), 100 + 1e-7) << after;
      EXPECT_TRUE(rig.lives[lowering].done) << after;
      if (GetParam().ends_there) {
        ASSERT_EQ(rig.position(), 100) << after;
      }
      ExpectWithinLimits(rig);
    }
    if (jerk > 0) {  // without a limit of it there is none to lower
      EXPECT_GT(strengthened, 3);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(
    Ways, Promise,
    testing::Values(Lowering{"override", SetOverride{1, 0.1, 0.1}, true},
                    Lowering{"override_jerk", SetOverride{0.5, 1, 0.01}, true},
                    Lowering{"same_target", MoveAbsolute{.position = 100, .velocity = 200, .deceleration = 300}, true},
                    Lowering{"slower", MoveAbsolute{.position = 100, .velocity = 20, .deceleration = 300}, true},
                    Lowering{"halt", Halt{.deceleration = 200}, false},
                    Lowering{"stop", Stop{.deceleration = 200}, false},
                    Lowering{"back", MoveAbsolute{.position = 0, .deceleration = 200}, false}),
    [](const auto& param) { return param.param.name; });

// AX-97: halting while the override already holds the axis does not take it further than promised.
TEST(Promise, HoldsWhileHeld) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 30, .velocity = 200});
  rig.Run(0.16);
  rig.Give(SetOverride{.velocity_factor = 0, .acceleration_factor = 0.01});
  rig.Run(0.02);
  rig.Give(Halt{.deceleration = 100});
  rig.Run(5);
  EXPECT_LE(Highest(rig), 30 + 1e-7);
}

// AX-97: a rotary axis with a fixed sense does not go on for another turn because its ramps were lowered.
TEST(Promise, TheSameTargetIsNotAnotherTurn) {
  for (const Direction direction : {Direction::kPositive, Direction::kCurrent, Direction::kShortest}) {
    Rig rig(RotaryParams());
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveAbsolute{.position = 100, .velocity = 300, .direction = Direction::kPositive});
    rig.Run(0.36);
    const Ticket again = rig.Give(MoveAbsolute{.position = 100, .deceleration = 100, .direction = direction});
    ASSERT_TRUE(rig.RunToEnd(again));
    EXPECT_NEAR(rig.position(), 100, 1e-9);
    EXPECT_LE(Highest(rig), 100 + 1e-7);
  }
}

// AX-97, AX-14: where a stop at the target is impossible it goes past it, and says so.
TEST(Promise, SaysWhenATargetIsOvershot) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  rig.Run(0.5);
  const double target = rig.position() + 1;
  const Ticket move = rig.Give(MoveAbsolute{.position = target});
  rig.Step();
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kOvershoot);
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_GT(Highest(rig), target + 10);
  EXPECT_EQ(rig.position(), target);
}

// AX-97: a nearer target may be overshot, but not beyond the one promised before.
TEST(Promise, ANearerTargetKeepsTheOneBefore) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 100, .velocity = 300});
  while (rig.position() < 85) rig.Step();
  const Ticket nearer = rig.Give(MoveAbsolute{.position = 86, .deceleration = 400});
  ASSERT_TRUE(rig.RunToEnd(nearer));
  EXPECT_EQ(rig.position(), 86);
  EXPECT_GT(Highest(rig), 86);
  EXPECT_LE(Highest(rig), 100 + 1e-7);
  ExpectWithinLimits(rig);
}

SetOverride RandomFactors(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0, 1);
  const auto factor = [&] { return random() % 8 == 0 ? 1 + share(random) : std::pow(10, -2 * share(random)); };
  const double velocity = random() % 5 == 0 ? 0 : random() % 9 == 0 ? 1e-4 : factor();
  return {.velocity_factor = velocity, .acceleration_factor = factor(), .jerk_factor = factor()};
}

class OverrideProperty : public testing::TestWithParam<int> {};

// AX-51, AX-97: moves one after the other in one sense, blended or not, under factors that change every few cycles: all
// limits hold, nothing steps, the axis never runs backwards nor beyond a target at which it is to stop, and it ends
// where it was to end.
TEST_P(OverrideProperty, ChangesNothingOfWhereMovesEnd) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  std::uniform_real_distribution<double> share(0, 1);
  for (int walk = 0; walk < 40; ++walk) {
    AxisParams p = LinearParams();
    p.limits.deceleration = std::array{4000.0, 5000.0, 9000.0}[random() % 3];
    p.limits.jerk = std::array{100000.0, 1000000.0, 20000.0, 0.0}[random() % 4];
    Rig rig(p, std::array{0.001, 0.004, 0.00025}[random() % 3]);
    ASSERT_TRUE(rig.PowerOn());
    const double sense = random() % 2 ? 1 : -1;
    double target = 0;
    std::vector<Ticket> moves;
    std::vector<double> stops;  // where a move is to come to rest, for what follows it does not blend
    for (auto n = 1 + random() % 4; n > 0; --n) {
      const auto mode = static_cast<BufferMode>(moves.empty() ? 0 : 1 + random() % 5);
      const double distance = std::pow(10, -1 + 3 * share(random));
      if (!moves.empty() && mode == BufferMode::kBuffered) stops.push_back(target);
      target += sense * distance;
      moves.push_back(rig.Give(MoveAbsolute{.position = target,
                                            .velocity = 500 * std::max(0.01, share(random)),
                                            .acceleration = 5000 * std::max(0.05, share(random)),
                                            .deceleration = *p.limits.deceleration * std::max(0.05, share(random)),
                                            .jerk = p.limits.jerk * std::max(0.05, share(random)),
                                            .buffer_mode = mode}));
    }
    stops.push_back(target);
    std::size_t next_stop = 0;
    const auto step = [&] {
      rig.Step();
      const KinematicState& now = rig.state.setpoint;
      ASSERT_GE(sense * now.velocity, -1e-6) << walk;
      ASSERT_LE(sense * (now.position - stops[next_stop]), 1e-7) << walk;
      if (now.position == stops[next_stop] && now.velocity == 0 && next_stop + 1 < stops.size()) ++next_stop;
      ASSERT_NE(rig.out.limited_by, LimitedBy::kOvershoot) << walk;
    };
    for (auto changes = random() % 60; changes > 0 && !rig.Ended(moves.back()); --changes) {
      rig.Give(RandomFactors(random));
      for (auto n = 1 + random() % (random() % 4 ? 20 : 400); n > 0; --n) ASSERT_NO_FATAL_FAILURE(step());
    }
    rig.Give(SetOverride{});
    for (int n = 0; n < 400000 && !rig.Ended(moves.back()); ++n) ASSERT_NO_FATAL_FAILURE(step());
    for (const Ticket move : moves) ASSERT_TRUE(rig.lives[move].done) << walk;
    ASSERT_EQ(rig.position(), target) << walk;
    ExpectWithinLimits(rig);
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, OverrideProperty, testing::Range(1, 1 + Trials(12, 80)));

}  // namespace
}  // namespace takt::axis
