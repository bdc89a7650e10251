// Forecasts of motions: AX-96.
#include "takt/axis/forecast.h"

#include <gtest/gtest.h>

#include <random>

#include "rig.h"
#include "takt/core/hash.h"

namespace takt::axis {
namespace {

// AX-96: s = 400, v = 200, a = 1000: 0.2 s of each ramp with 20 of the way, 1.8 s at speed.
TEST(Forecast, TellsTheTimesOfATrapezoid) {
  Rig rig(Trapezoid(1000));
  ASSERT_TRUE(rig.PowerOn());
  const Forecast f = Foresee(rig.Now(), MoveAbsolute{.position = 400, .velocity = 200}, rig.state);
  ASSERT_TRUE(f.known);
  EXPECT_NEAR(f.duration_s(), 2.2, 1e-9);
  EXPECT_NEAR(f.TimeTo(5), 0.1, 1e-9);
  EXPECT_NEAR(f.TimeTo(200), 1.1, 1e-9);
  EXPECT_NEAR(f.TimeTo(395), 2.1, 1e-9);
  EXPECT_NEAR(f.TimeTo(400), 2.2, 1e-7);  // there it is that slow
  EXPECT_TRUE(std::isnan(f.TimeTo(401)));
  EXPECT_TRUE(std::isnan(f.TimeTo(-1)));
  EXPECT_NEAR(f.At(0.1).position, 5, 1e-9);
  EXPECT_NEAR(f.At(1.1).position, 200, 1e-9);
  EXPECT_NEAR(f.At(1.1).velocity, 200, 1e-9);
  EXPECT_EQ(f.At(10).position, 400);
  EXPECT_EQ(rig.position(), 0);
}

// AX-96: the motion in progress, from where it is.
TEST(Forecast, FollowsTheMotionInProgress) {
  Rig rig(Trapezoid(1000));
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_EQ(Foresee(rig.Now(), rig.state).duration_s(), 0);
  const Ticket move = rig.Give(MoveAbsolute{.position = 400, .velocity = 200});
  rig.Run(1.1);
  Forecast f = Foresee(rig.Now(), rig.state);
  EXPECT_NEAR(f.duration_s(), 1.1, 1e-9);
  EXPECT_EQ(f.TimeTo(rig.position()), 0);
  EXPECT_NEAR(f.TimeTo(300), 0.5, 1e-9);
  EXPECT_TRUE(std::isnan(f.TimeTo(100)));  // it is past that
  rig.Give(SetOverride{.velocity_factor = 0.5});
  rig.Step();
  f = Foresee(rig.Now(), rig.state);
  const std::uint64_t now = rig.cycle.count;
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_NEAR(f.duration_s(), static_cast<double>(rig.lives[move].final_cycle + 1 - now) * 0.001, 0.001);
  EXPECT_GT(f.duration_s(), 1.9);
}

// AX-96, AX-51: held there is no end.
TEST(Forecast, OfAHeldMoveHasNoEnd) {
  Rig rig(Trapezoid(1000));
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(SetOverride{.velocity_factor = 0});
  rig.Step();
  const Forecast f = Foresee(rig.Now(), MoveAbsolute{.position = 400}, rig.state);
  EXPECT_TRUE(f.known && f.held);
  EXPECT_EQ(f.limited_by, LimitedBy::kOverride);
  EXPECT_TRUE(std::isinf(f.duration_s()));
  EXPECT_TRUE(std::isnan(f.TimeTo(400)));
}

// AX-96: a velocity goes on; a jog is foreseen, too.
TEST(Forecast, OfAVelocityGoesOn) {
  for (const Command& command :
       {Command(MoveVelocity{.velocity = 100}), Command(Jog{.forward = true, .velocity = 100})}) {
    Rig rig(Trapezoid(1000));
    ASSERT_TRUE(rig.PowerOn());
    const Forecast f = Foresee(rig.Now(), command, rig.state);
    EXPECT_NEAR(f.duration_s(), 0.1, 1e-9);
    EXPECT_NEAR(f.TimeTo(1005), 10.1, 1e-6);
    EXPECT_NEAR(f.At(10.1).position, 1005, 1e-6);
    EXPECT_TRUE(std::isnan(f.TimeTo(-5)));
  }
}

// AX-96: a SW limit ends it.
TEST(Forecast, OfAVelocityEndsAtALimit) {
  AxisParams p = Trapezoid(1000);
  p.limits.upper = 400;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const Forecast f = Foresee(rig.Now(), MoveVelocity{.velocity = 100}, rig.state);
  EXPECT_TRUE(f.known);
  EXPECT_NEAR(f.TimeTo(305), 3.1, 1e-6);
  EXPECT_TRUE(std::isnan(f.TimeTo(401)));
  EXPECT_EQ(f.At(60).position, 400);
  EXPECT_EQ(f.At(60).velocity, 0);
}

// AX-96, AX-14: rotary positions are those of the turn; the next one on the way counts.
TEST(Forecast, OfARotaryAxisKnowsTurns) {
  AxisParams p = Trapezoid(1000);
  p.kind = AxisKind::kRotary;
  p.modulus = 360;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const Forecast up = Foresee(rig.Now(), MoveVelocity{.velocity = 100}, rig.state);
  EXPECT_EQ(up.TimeTo(0), 0);
  EXPECT_NEAR(up.TimeTo(355), 3.6, 1e-9);
  EXPECT_NEAR(up.At(4).position, 35, 1e-9);
  const Forecast down = Foresee(rig.Now(), MoveVelocity{.velocity = 100, .direction = Direction::kNegative}, rig.state);
  EXPECT_NEAR(down.TimeTo(355), 0.1, 1e-9);
  EXPECT_NEAR(down.At(0.1).position, 355, 1e-9);
}

// AX-96: what is refused when it is given is refused in a dry run, with the same number.
TEST(Forecast, IsRefusedLikeTheCommand) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  for (const Command& command :
       {Command(MoveAbsolute{.position = 101}), Command(MoveAbsolute{.position = 1, .velocity = 1e9}),
        Command(MoveAbsolute{.position = 101, .buffer_mode = BufferMode::kBuffered}), Command(Halt{})}) {
    for (const bool on : {false, true}) {
      Rig rig(p);
      if (on) {
        ASSERT_TRUE(rig.PowerOn());
      }
      rig.Step();
      const Forecast f = Foresee(rig.Now(), command, rig.state);
      const Ticket given = rig.Give(command);
      rig.Run(0.1);
      EXPECT_EQ(f.error, rig.lives[given].error_id);
      EXPECT_EQ(f.known, f.error == ErrorId::kNone);
    }
  }
}

// AX-96: one that follows something has no plan.
TEST(Forecast, OfATorqueIsNotKnown) {
  AxisParams p = LinearParams();
  p.drive.mode = DriveMode::kCyclicPosition;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_FALSE(Foresee(rig.Now(), TorqueControl{.torque = 1}, rig.state).known);
}

Command RandomMove(std::mt19937_64& random, const AxisParams& p) {
  std::uniform_real_distribution<double> share(0.02, 1);
  const auto mode = static_cast<BufferMode>(random() % 6);
  const double velocity = share(random) * p.limits.velocity;
  const double acceleration = share(random) * p.limits.acceleration;
  const double jerk = share(random) * p.limits.jerk;
  const double position = p.rotary() ? share(random) * 360 : share(random) * 200 - 100;
  switch (random() % 4) {
    case 0:
      return MoveRelative{.distance = position, .velocity = velocity, .jerk = jerk, .buffer_mode = mode};
    case 1:
      return MoveAdditive{.distance = position, .acceleration = acceleration, .buffer_mode = mode};
    case 2:
      return MoveVelocity{.velocity = velocity, .jerk = jerk, .buffer_mode = mode};
    default:
      return MoveAbsolute{
          .position = position, .velocity = velocity, .acceleration = acceleration, .jerk = jerk, .buffer_mode = mode};
  }
}

class ForecastProperty : public testing::TestWithParam<int> {};

// AX-96: whatever the axis is doing, a dry run changes nothing of it, and what it foresaw is what happens: when the
// command begins, every set point, the travel time that is reported, and the time to each position on the way.
TEST_P(ForecastProperty, IsWhatHappens) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  std::uniform_real_distribution<double> share(0, 1);
  int waited = 0;
  for (int round = 0; round < 40; ++round) {
    Rig rig(random() % 2 ? LinearParams() : RotaryParams(), std::array{0.001, 0.004}[random() % 2]);
    const double period = rig.cycle.period_s;
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(SetOverride{.velocity_factor = 0.1 + share(random), .acceleration_factor = 0.1 + share(random)});
    for (auto n = random() % 3; n > 0; --n) {
      rig.Give(RandomMove(random, rig.params));
      rig.Run(0.3 * share(random));
    }
    rig.Step();
    const Command command = RandomMove(random, rig.params);
    const std::uint64_t before = HashOf(rig.state, 0);
    const Forecast f = Foresee(rig.Now(), command, rig.state);
    ASSERT_EQ(HashOf(rig.state, 0), before);
    const std::uint64_t now = rig.cycle.count;
    const Ticket given = rig.Give(command);
    const auto Passed = [&] { return static_cast<double>(rig.cycle.count - now) * period; };
    while (!rig.lives[given].active && !rig.Ended(given) && Passed() < 60) rig.Step();
    ASSERT_EQ(f.known, rig.lives[given].active) << round;
    if (!f.known) {
      ASSERT_EQ(f.error, rig.lives[given].error_id);
      continue;
    }
    waited += f.start_s > 0 ? 1 : 0;
    ASSERT_LE(Passed() - f.start_s, 1.001 * period);
    ASSERT_GE(Passed() - f.start_s, -1e-9);
    ASSERT_NEAR(rig.lives[given].events.back().value > 0 ? rig.lives[given].events.back().value : f.profile.duration(),
                f.profile.duration(), period);
    std::vector<std::pair<double, double>> passed;  // when, where
    for (int n = 0; n < 100 && Passed() < f.duration_s(); ++n) {
      const KinematicState foreseen = f.At(Passed());
      ASSERT_NEAR(rig.out.set_position, foreseen.position, 1e-6) << round;
      ASSERT_NEAR(rig.out.set_velocity, foreseen.velocity, 1e-6) << round;
      const double time = f.TimeTo(rig.out.set_position);
      ASSERT_LE(time, Passed() + 1e-6);  // it may have been there before
      ASSERT_NEAR(f.At(time).position, rig.out.set_position, 1e-6);
      rig.Run(0.01);
    }
  }
  EXPECT_GT(waited, 3);
}
INSTANTIATE_TEST_SUITE_P(Seeds, ForecastProperty, testing::Range(1, 9));

}  // namespace
}  // namespace takt::axis
