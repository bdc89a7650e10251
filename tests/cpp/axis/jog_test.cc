// Jogging and its dead man's lease.
#include <gtest/gtest.h>

#include "rig.h"

namespace takt::axis {
namespace {

// AX-39: moves while the key is held, stops when it is let go; done when the axis stands.
TEST(Jog, MovesWhileTheKeyIsHeld) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket jog =
      rig.Give(Jog{.backward = true, .velocity = 80, .acceleration = 800, .deceleration = 400, .jerk = 20000});
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, -80);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  const double here = rig.position();
  rig.Let(jog);
  rig.Run(0.01);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  ASSERT_TRUE(rig.RunToEnd(jog));
  EXPECT_TRUE(rig.lives[jog].done);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_NEAR(here - rig.position(), 80 * 0.5 * (80.0 / 400 + 400.0 / 20000), 0.1);  // the ramp asked for
}

// AX-39: the direction pressed first wins; the other key changes nothing while it is held; both must be let go before
// the next jog.
TEST(Jog, TheFirstKeyWinsAndBothMustBeLetGo) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Jog{.forward = true, .velocity = 50});
  rig.Run(0.2);
  rig.Give(Jog{.forward = true, .backward = true, .velocity = 50});
  rig.Run(0.2);
  EXPECT_EQ(rig.out.set_velocity, 50);
  const Ticket held = rig.Give(Jog{.backward = true, .velocity = 50});  // forward let go, backward still held
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_FALSE(rig.Ended(held));
  rig.Give(Jog{});
  rig.Step();
  const Ticket other = rig.Give(Jog{.backward = true, .velocity = 50});
  rig.Run(0.2);
  EXPECT_EQ(rig.out.set_velocity, -50);
  EXPECT_FALSE(rig.Ended(other));
}

// AX-39: both keys at once from standstill: no motion.
TEST(Jog, BothKeysAtOnceMoveNothing) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Jog{.forward = true, .backward = true});
  rig.Run(0.2);
  EXPECT_EQ(rig.position(), 0);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// AX-39: another speed while the key is held is taken at once and smoothly.
TEST(Jog, ChangesItsSpeed) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(Jog{.forward = true, .velocity = 50});
  rig.Run(0.3);
  const std::size_t from = rig.trace.size();
  rig.Give(Jog{.forward = true, .velocity = 200});
  rig.Run(0.5);
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_EQ(rig.out.set_velocity, 200);
  const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
}

// AX-39: the same downwards; its own ramps hold.
TEST(Jog, ChangesItsSpeedDownwardsWithItsOwnRamps) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Jog{.backward = true, .velocity = 50});
  rig.Run(0.3);
  const std::size_t from = rig.trace.size();
  rig.Give(Jog{.backward = true, .velocity = 200, .acceleration = 1000, .jerk = 20000});
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, -200);
  const Worst worst = WorstOf(rig.trace, {200, 1000, 4000, 20000}, 0.001, from);
  EXPECT_LE(worst.velocity, 1 + 1e-9);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
}

// AX-39: a jog without a key that takes over from a move brakes it along its own ramp.
TEST(Jog, BrakesWhatItTakesOverWithItsOwnRamp) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  const std::size_t from = rig.trace.size();
  const Ticket jog = rig.Give(Jog{.velocity = 100, .deceleration = 500, .jerk = 20000});
  ASSERT_TRUE(rig.RunToEnd(jog));
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  const Worst worst = WorstOf(rig.trace, {500, 5000, 500, 20000}, 0.001, from);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
}

// AX-39: other ramps for the same speed are taken at once too.
TEST(Jog, ChangesItsRamps) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Jog{.forward = true, .velocity = 400, .acceleration = 100});
  rig.Run(0.5);
  ASSERT_LT(rig.state.setpoint.velocity, 60);
  rig.Give(Jog{.forward = true, .velocity = 400, .acceleration = 4000});
  rig.Run(0.3);
  EXPECT_EQ(rig.out.set_velocity, 400);
}

// EN-23: a leased jog releases itself when its lease is not renewed, and says why.
TEST(Lease, ReleasesAJogThatIsNotRenewed) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket jog = rig.Give(Jog{.forward = true, .velocity = 100}, 0.1);
  for (int i = 0; i < 20; ++i) {
    rig.Run(0.05);
    rig.Hold(jog);
  }
  EXPECT_EQ(rig.out.set_velocity, 100);
  const std::uint64_t last = rig.cycle.count;
  ASSERT_TRUE(rig.RunToEnd(jog));
  EXPECT_TRUE(rig.lives[jog].aborted);
  EXPECT_EQ(rig.lives[jog].error_id, ErrorId::kLeaseExpired);
  EXPECT_NEAR(static_cast<double>(rig.cycle.count - last) * 0.001, 0.1, 0.003);
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// EN-23: a held stop is let go as well.
TEST(Lease, ReleasesAHeldStop) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket stop = rig.Give(Stop{.hold = true}, 0.1);
  rig.Run(0.09);
  EXPECT_EQ(rig.out.state, PlcState::kStopping);
  EXPECT_TRUE(rig.lives[stop].done);
  rig.Run(0.02);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// EN-23: the lease ends so many cycles after it was given as are not shorter than it; what is said of it is said once.
TEST(Lease, EndsInItsCycle) {
  for (const auto& [lease_s, cycles] : {std::pair{0.1, 100u}, std::pair{0.1005, 101u}}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket jog = rig.Give(Jog{.forward = true, .velocity = 100}, lease_s);
    rig.Run(1);
    EXPECT_EQ(rig.lives[jog].final_cycle - rig.lives[jog].active_cycle, cycles);
    EXPECT_EQ(rig.lives[jog].events.size(), 2u);  // Active, Aborted
    EXPECT_FALSE(rig.lives[jog].done);
  }
}

}  // namespace
}  // namespace takt::axis
