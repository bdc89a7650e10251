// One command in the middle of another: what is left of a strong motion must not break what a weak command cannot hold,
// and only as much is taken from the axis' own ramps as that needs.
#include <gtest/gtest.h>

#include <random>

#include "rig.h"

namespace takt::axis {
namespace {

AxisParams Fenced(double upper, double acceleration = 5000, double deceleration = 5000, double jerk = 100000) {
  AxisParams p = LinearParams();
  p.limits = {.velocity = 500,
              .acceleration = acceleration,
              .deceleration = deceleration,
              .jerk = jerk,
              .lower = -10,
              .upper = upper};
  return p;
}

// AX-12, AX-13: a motion without an end, blended into a move that ends at the SW limit, does not carry the axis over
// it.
TEST(Interrupt, ABlendedVelocityKeepsTheSoftLimit) {
  for (const double target : {1000.0, 990.0, 900.0}) {
    Rig rig(Fenced(1000));
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveAbsolute{.position = target});
    rig.Give(MoveVelocity{.velocity = 500, .buffer_mode = BufferMode::kBlendingPrevious});
    rig.Run(5);
    EXPECT_LE(Highest(rig), 1000 + 1e-6);
    EXPECT_GT(Highest(rig), target - 1);
  }
}

// AX-13, AX-14: turning back near a SW limit brakes with the whole deceleration, also where that is larger than the
// acceleration.
TEST(Interrupt, TurningBackBrakesWithAllTheDeceleration) {
  for (const double jerk : {0.0, 100000.0}) {
    Rig rig(Fenced(1000, 2000, 6000, jerk));
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveVelocity{.velocity = 500});
    while (rig.position() < 950) rig.Step();
    const std::size_t from = rig.trace.size();
    const Ticket back = rig.Give(MoveAbsolute{.position = 900});
    ASSERT_TRUE(rig.RunToEnd(back));
    EXPECT_LE(Highest(rig), 1000 + 1e-6);
    EXPECT_EQ(rig.position(), 900);
    EXPECT_LE(WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from).acceleration, 1 + 1e-9);
  }
}

// AX-13: a gentle jog or move towards the SW limit keeps its own ramp as long as it can.
TEST(Interrupt, AGentleMotionTowardsTheLimitStaysGentle) {
  for (const Command& gentle : {Command(Jog{.forward = true, .velocity = 500, .acceleration = 100}),
                                Command(MoveVelocity{.velocity = 500, .acceleration = 100})}) {
    Rig rig(Fenced(1000));
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(gentle);
    rig.Run(1);
    for (const Sample& s : rig.trace) ASSERT_LE(s.setpoint.acceleration, 100 + 1e-6);
    EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
  }
}

// AX-13: after the part that needed more, the command's own ramps hold again.
TEST(Interrupt, OnlyTheBeginningIsHarderThanAsked) {
  Rig rig(Fenced(100000));
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  while (rig.state.setpoint.velocity < 300) rig.Step();
  const Ticket weak = rig.Give(MoveAbsolute{.position = 5000, .acceleration = 200, .deceleration = 200, .jerk = 1000});
  rig.Run(0.1);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kVelocity);
  const std::size_t from = rig.trace.size();
  ASSERT_TRUE(rig.RunToEnd(weak, 60));
  EXPECT_EQ(rig.position(), 5000);
  const Worst worst = WorstOf(rig.trace, {500, 200, 200, 1000}, 0.001, from);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
}

// AX-13: the same on an axis without a jerk limit, interrupted by a command with one.
TEST(Interrupt, AJerkOfItsOwnOnAnAxisWithoutAJerkLimit) {
  for (const Command& weak :
       {Command(MoveVelocity{.velocity = 400, .jerk = 500}), Command(Jog{.backward = true, .jerk = 500}),
        Command(MoveAbsolute{.position = 3000, .acceleration = 800, .jerk = 500}), Command(Halt{.jerk = 500})}) {
    Rig rig(Fenced(100000, 5000, 15000, 0));
    rig.params.limits.lower = -100000;
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveVelocity{.velocity = 500});
    while (rig.state.setpoint.velocity < 300) rig.Step();
    rig.Give(weak);
    rig.Run(10);
    const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001);
    EXPECT_LE(worst.velocity, 1 + 1e-9);
    EXPECT_LE(worst.acceleration, 1 + 1e-9);
  }
}

// AX-39, AX-13: another speed with a weaker jerk, while a jog accelerates.
TEST(Interrupt, AJogWithLessJerkKeepsTheVelocity) {
  Rig rig(Fenced(100000));
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Jog{.forward = true, .velocity = 500});
  while (rig.state.setpoint.velocity < 300) rig.Step();
  rig.Give(Jog{.forward = true, .velocity = 490, .jerk = 1000});
  rig.Run(3);
  EXPECT_LE(WorstOf(rig.trace, rig.params.planner_limits(), 0.001).velocity, 1 + 1e-9);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
}

// AX-36, AX-37: a stop or halt with less jerk than the braking it finds never turns the axis round.
TEST(Interrupt, BrakingNeverTurnsRound) {
  for (const Command& weak :
       {Command(Stop{.jerk = 25000}), Command(Halt{.jerk = 5000}), Command(Halt{.deceleration = 100, .jerk = 500})}) {
    Rig rig(Fenced(100000));
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveVelocity{.velocity = 500});
    rig.Run(0.5);
    rig.Give(Halt{});
    while (rig.state.setpoint.velocity > 150) rig.Step();
    ASSERT_LT(rig.state.setpoint.acceleration, -4000);
    const Ticket braking = rig.Give(weak);
    const std::size_t from = rig.trace.size();
    ASSERT_TRUE(rig.RunToEnd(braking, 60));
    for (std::size_t i = from; i < rig.trace.size(); ++i) ASSERT_GE(rig.trace[i].setpoint.velocity, -1e-6);
    EXPECT_LE(WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from).jerk, 1 + 1e-6);
  }
}

// AX-12: blended moves shorter than a cycle follow one another within it.
TEST(Interrupt, BlendedMovesShorterThanACycle) {
  for (const double jerk : {0.0, 100000.0}) {
    AxisParams p = Fenced(100000, 5000, 5000, jerk);
    p.limits.lower.reset();
    Rig rig(p, 0.02);
    ASSERT_TRUE(rig.PowerOn());
    const std::size_t from = rig.trace.size();
    rig.Give(MoveRelative{.distance = 59});
    std::vector<Ticket> moves;
    for (int i = 0; i < 6; ++i)
      moves.push_back(rig.Give(MoveRelative{.distance = 0.5, .buffer_mode = BufferMode::kBlendingHigh}));
    ASSERT_TRUE(rig.RunToEnd(moves.back()));
    for (const Ticket t : moves) EXPECT_TRUE(rig.lives[t].done);
    EXPECT_NEAR(rig.position(), 62, 1e-9);
    EXPECT_LE(Highest(rig), 62 + 1e-6);
    const Worst worst = WorstOf(rig.trace, p.planner_limits(), 0.02, from);
    EXPECT_LE(worst.acceleration, 1 + 1e-9);
    EXPECT_LE(worst.position_step, 1 + 1e-6);
  }
}

// AX-12, AX-30: the current sense of a blended motion is the one of the move before it, not the one of an earlier
// motion.
TEST(Interrupt, TheCurrentSenseOfABlendIsThatOfTheMoveBefore) {
  Rig rig(Fenced(100000));
  rig.params.limits.lower = -1000;
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = -10})));
  const Ticket first = rig.Give(MoveAbsolute{.position = 100, .velocity = 200});
  rig.Give(
      MoveVelocity{.velocity = 200, .direction = Direction::kCurrent, .buffer_mode = BufferMode::kBlendingPrevious});
  ASSERT_TRUE(rig.RunToEnd(first));
  EXPECT_NEAR(rig.state.setpoint.velocity, 200, 1e-6);
}

// AX-14, AX-06: the same target given again at any time of the move changes nothing of where it goes, also on the
// braking curve and with a deceleration larger than the acceleration.
TEST(Interrupt, TheSameTargetAgainChangesNothing) {
  for (const double jerk : {0.0, 250000.0}) {
    for (int after = 1; after < 140; ++after) {
      AxisParams p = Fenced(100000, 5000, 10000, jerk);
      Rig rig(p);
      ASSERT_TRUE(rig.PowerOn());
      rig.Give(MoveAbsolute{.position = 30.1, .velocity = 423});
      for (int i = 0; i < after; ++i) rig.Step();
      const Ticket again = rig.Give(MoveAbsolute{.position = 30.1, .velocity = 423});
      ASSERT_TRUE(rig.RunToEnd(again));
      ASSERT_LE(Highest(rig), 30.1 + 1e-6) << after;
    }
  }
}

// AX-14: a slower command that can still brake to its target does so in one go and neither overshoots nor turns round.
TEST(Interrupt, ASlowerCommandBrakesStraightToItsTarget) {
  for (const double ahead : {21.0, 21.68, 22.5, 30.0, 60.0}) {
    Rig rig(Fenced(100000, 2500, 5000, 125000));
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveVelocity{.velocity = 365});
    rig.Run(0.5);
    const double target = rig.position() + ahead;
    const Ticket slow = rig.Give(MoveAbsolute{.position = target, .velocity = 64});
    ASSERT_TRUE(rig.RunToEnd(slow));
    EXPECT_LE(Highest(rig), target + 1e-6) << ahead;
    EXPECT_EQ(rig.position(), target);
  }
}

// AX-30: the current sense is that of the last motion, also when that was shorter than a cycle.
TEST(Interrupt, TheCurrentSenseAfterAMoveShorterThanACycle) {
  AxisParams p = Fenced(100000, 500000, 500000, 0);
  p.limits.lower.reset();
  Rig rig(p, 0.02);
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = 50})));
  rig.Give(MoveRelative{.distance = -3});
  rig.Give(MoveVelocity{.velocity = 500, .direction = Direction::kCurrent, .buffer_mode = BufferMode::kBuffered});
  rig.Run(1);
  EXPECT_EQ(rig.out.set_velocity, -500);
}

// AX-20: power given again while the drive gets ready keeps what waits behind it.
TEST(Interrupt, PowerAgainKeepsTheBuffer) {
  Rig rig(LinearParams());
  const Ticket first = rig.Give(Power{});
  const Ticket move = rig.Give(MoveRelative{.distance = 5, .buffer_mode = BufferMode::kBuffered});
  rig.Step();
  const Ticket second = rig.Give(Power{});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_TRUE(rig.lives[second].done);
  EXPECT_TRUE(rig.lives[move].done);
}

// AX-20: power off while braking in ErrorStop, then a fault that opens the loop: off is done, and on works again after
// a reset.
TEST(Interrupt, AFaultDuringPowerOffEndsIt) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  rig.Run(0.5);
  rig.inputs.limit_positive = true;
  rig.Step();
  ASSERT_EQ(rig.out.state, PlcState::kErrorStop);
  const Ticket off = rig.Give(Power{.enable = false});
  rig.Run(0.01);
  ASSERT_FALSE(rig.Ended(off));
  rig.inputs.drive_fault = true;
  rig.Step();
  EXPECT_TRUE(rig.lives[off].done);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  rig.inputs.drive_fault = rig.inputs.limit_positive = false;
  ASSERT_TRUE(rig.RunToEnd(rig.Give(Reset{})));
  EXPECT_TRUE(rig.PowerOn());
}

// AX-37: a held stop may be released before its turn comes.
TEST(Interrupt, AReleasedStopInTheBufferDoesNotHold) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveRelative{.distance = 50});
  const Ticket stop = rig.Give(Stop{.hold = true, .buffer_mode = BufferMode::kBuffered});
  rig.Run(0.01);
  rig.Let(stop);
  rig.Run(2);
  EXPECT_TRUE(rig.lives[stop].done);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// AX-37, EN-32: a gentler one softens nothing; both are done when the axis stands.
TEST(Interrupt, ASecondStopJoinsTheFirst) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  const Ticket first = rig.Give(Stop{.hold = true});
  rig.Run(0.01);
  const Ticket second = rig.Give(Stop{.deceleration = 10});
  rig.Run(1);
  EXPECT_TRUE(rig.lives[second].done);
  EXPECT_TRUE(rig.lives[first].done);
  EXPECT_EQ(rig.out.state, PlcState::kStopping);
}

// AX-06: a jog that is refused leaves the motion in progress alone.
TEST(Interrupt, ARefusedJogDisturbsNothing) {
  Rig rig(LinearParams());
  rig.inputs.limit_positive = true;
  ASSERT_TRUE(rig.PowerOn());
  const Ticket away = rig.Give(MoveRelative{.distance = -50});
  rig.Run(0.05);
  const Ticket jog = rig.Give(Jog{.forward = true});
  ASSERT_TRUE(rig.RunToEnd(away));
  EXPECT_EQ(rig.lives[jog].error_id, ErrorId::kAwayFromLimitOnly);
  EXPECT_TRUE(rig.lives[away].done);
}

// AX-12: power off, buffered behind a power on that is still under way, waits for it.
TEST(Interrupt, ABufferedPowerOffWaitsForThePowerOn) {
  Rig rig(LinearParams());
  const Ticket on = rig.Give(Power{});
  const Ticket off = rig.Give(Power{.enable = false, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(off));
  EXPECT_TRUE(rig.lives[on].done);
  EXPECT_TRUE(rig.lives[off].done);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
}

// AX-04, AX-85: a slow axis with a noisy encoder has no encoder fault.
TEST(Interrupt, NoiseIsNoJump) {
  AxisParams p = LinearParams();
  p.limits = {.velocity = 1, .acceleration = 10, .deceleration = {}, .jerk = 100, .lower = {}, .upper = {}};
  p.encoder.increments_per_unit = 1000;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.frozen = true;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 2);
  for (int i = 0; i < 20000; ++i) {
    rig.inputs.counts = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(noise(random))));
    rig.Step();
  }
  EXPECT_EQ(rig.out.error, ErrorId::kNone);
}

// AX-20: off and on in one cycle: the loop is seen open.
TEST(Interrupt, OffAndOnInOneCycleOpensTheLoop) {
  Rig rig(LinearParams());
  rig.drive_delay = 0;
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Power{.enable = false});
  const Ticket on = rig.Give(Power{});
  rig.Step();
  EXPECT_FALSE(rig.out.loop_closed);
  ASSERT_TRUE(rig.RunToEnd(on));
  EXPECT_TRUE(rig.out.loop_closed);
}

// AX-03: each switch input may be active low.
TEST(Inputs, AreInvertedOneByOne) {
  for (int which = 0; which < 4; ++which) {
    AxisParams p = LinearParams();
    bool* const inverted[] = {&p.inputs.invert_limit_positive, &p.inputs.invert_limit_negative,
                              &p.inputs.invert_reference, &p.inputs.invert_touch_probe};
    *inverted[which] = true;
    Rig rig(p);
    rig.Step();
    const bool seen[] = {rig.out.limit_positive, rig.out.limit_negative, rig.out.reference, rig.out.touch_probe};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(seen[i], i == which);
    rig.inputs.limit_positive = rig.inputs.limit_negative = rig.inputs.reference = rig.inputs.touch_probe = true;
    rig.Step();
    const bool then[] = {rig.out.limit_positive, rig.out.limit_negative, rig.out.reference, rig.out.touch_probe};
    for (int i = 0; i < 4; ++i) EXPECT_EQ(then[i], i != which);
  }
}

// AX-13: what is left of hard braking must not become a start as hard where the axis accelerates less than it brakes:
// neither sense of travel, neither order of both limits.
TEST(Interrupt, ATurnKeepsTheLimitOfEachSide) {
  for (const auto& [acceleration, deceleration] : {std::pair{1000.0, 12000.0}, std::pair{12000.0, 1000.0}}) {
    for (const double sense : {1.0, -1.0}) {
      for (const double jerk : {2000.0, 20000.0}) {
        Rig rig(Fenced(100000, acceleration, deceleration));
        rig.params.limits.lower = -100000;
        ASSERT_TRUE(rig.PowerOn());
        const auto along = sense > 0 ? Direction::kPositive : Direction::kNegative;
        const auto against = sense > 0 ? Direction::kNegative : Direction::kPositive;
        rig.Give(MoveVelocity{.velocity = 500, .direction = along});
        if (deceleration > acceleration) {
          rig.Run(2);
          rig.Give(Halt{});
          while (sense * rig.state.setpoint.velocity > 100) rig.Step();
        } else {
          while (sense * rig.state.setpoint.velocity < 300) rig.Step();
        }
        const std::size_t from = rig.trace.size();
        rig.Give(MoveVelocity{.velocity = 200, .jerk = jerk, .direction = against});
        rig.Run(3);
        EXPECT_EQ(rig.out.set_velocity, -sense * 200);
        const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
        EXPECT_LE(worst.velocity, 1 + 1e-9);
        EXPECT_LE(worst.acceleration, 1 + 1e-9);
        EXPECT_LE(worst.jerk, 1 + 1e-6);
      }
    }
  }
}

// AX-36: nor does braking turn round downwards.
TEST(Interrupt, BrakingDownwardsNeverTurnsRound) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500, .direction = Direction::kNegative});
  rig.Run(0.5);
  rig.Give(Halt{});
  while (rig.state.setpoint.velocity < -150) rig.Step();
  const Ticket braking = rig.Give(Halt{.jerk = 25000});
  const std::size_t from = rig.trace.size();
  ASSERT_TRUE(rig.RunToEnd(braking, 60));
  for (std::size_t i = from; i < rig.trace.size(); ++i) ASSERT_LE(rig.trace[i].setpoint.velocity, 1e-6);
}

// AX-12: into a motion without an end near a SW limit: the first move is done, passed as fast as the axis (not the weak
// command behind it) can still brake.
TEST(Interrupt, ABlendedVelocityLetsTheFirstMoveEnd) {
  for (const auto& [target, speed] : {std::pair{1000.0, 0.0}, std::pair{900.0, 500.0}}) {
    Rig rig(Fenced(1000));
    ASSERT_TRUE(rig.PowerOn());
    const Ticket first = rig.Give(MoveAbsolute{.position = target});
    rig.Give(MoveVelocity{.velocity = 500, .deceleration = 300, .buffer_mode = BufferMode::kBlendingPrevious});
    ASSERT_TRUE(rig.RunToEnd(first));
    EXPECT_TRUE(rig.lives[first].done);
    EXPECT_NEAR(rig.state.setpoint.velocity, speed, 1e-6);
    rig.Run(2);
    EXPECT_LE(Highest(rig), 1000 + 1e-6);
  }
}

// What holds a jog back is told, at its start and when it is changed.
TEST(Interrupt, AJogSaysWhatHoldsItBack) {
  for (const Command& before : {Command(MoveVelocity{.velocity = 500}), Command(Jog{.forward = true})}) {
    Rig rig(Fenced(100000));
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(before);
    while (rig.state.setpoint.velocity < 300) rig.Step();
    rig.Give(Jog{.forward = true, .velocity = 490, .jerk = 1000});
    rig.Step();
    EXPECT_EQ(rig.out.limited_by, LimitedBy::kVelocity);
  }
}

// AX-39: without a key, or with both, there is nothing to plan and so nothing to refuse.
TEST(Interrupt, AJogWithoutASenseIsNotRefused) {
  for (const bool both : {false, true}) {
    Rig rig(LinearParams());
    rig.inputs.limit_positive = both;
    rig.inputs.limit_negative = !both;
    ASSERT_TRUE(rig.PowerOn());
    const Ticket jog = rig.Give(Jog{.forward = both, .backward = both});
    rig.Run(0.01);
    EXPECT_TRUE(rig.lives[jog].active);
    EXPECT_FALSE(rig.lives[jog].error);
  }
}

// EN-23: who renews a command that waits does not renew the one in control; nobody has ticket 0.
TEST(Interrupt, RenewalsAreForTheirOwnCommand) {
  Rig rig(LinearParams());
  EXPECT_FALSE(Release(rig.Now(), 0, rig.state));
  EXPECT_FALSE(Renew(rig.Now(), 0, rig.state));
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(Stop{.hold = true}, 0.1);
  const Ticket second = rig.Give(Stop{.hold = true, .buffer_mode = BufferMode::kBuffered}, 0.1);
  for (int i = 0; i < 4; ++i) {
    rig.Run(0.04);
    rig.Hold(second);
  }
  EXPECT_TRUE(rig.lives[first].done);
  EXPECT_TRUE(rig.lives[second].active);
  EXPECT_EQ(rig.lives[second].active_cycle - rig.lives[first].active_cycle, 100u);
}

// AX-83: on the negative limit switch only up, and what is refused while the axis still brakes does not harden its
// brake.
TEST(Interrupt, OnlyAwayFromTheNegativeSwitch) {
  Rig rig(LinearParams());
  rig.inputs.limit_negative = true;
  ASSERT_TRUE(rig.PowerOn());
  for (const Command& c : {Command(MoveRelative{.distance = -1}), Command(MoveAbsolute{.position = -1}),
                           Command(MoveVelocity{.velocity = 1, .direction = Direction::kNegative})}) {
    const Ticket t = rig.Give(c);
    rig.Step();
    EXPECT_EQ(rig.lives[t].error_id, ErrorId::kAwayFromLimitOnly);
  }
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = 1})));
  EXPECT_EQ(rig.position(), 1);
  const Jog up{.forward = true, .velocity = 400, .deceleration = 500};
  rig.Give(up);
  rig.Run(0.5);
  const std::size_t from = rig.trace.size();
  rig.Give(Jog{.velocity = 400, .deceleration = 500});
  rig.Run(0.1);
  const Ticket down = rig.Give(Jog{.backward = true, .velocity = 400, .deceleration = 500});
  rig.Run(2);
  EXPECT_EQ(rig.lives[down].error_id, ErrorId::kAwayFromLimitOnly);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_LE(WorstOf(rig.trace, {500, 5000, 500, 100000}, 0.001, from).acceleration, 1 + 1e-9);
}

// AX-12, AX-13: nor does a blended motion that goes on faster than the move before it, wherever that ends.
TEST(Interrupt, ABlendedVelocityThatAcceleratesKeepsTheSoftLimit) {
  for (int i = 0; i <= 400; ++i) {
    Rig rig(Fenced(20));
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveAbsolute{.position = 15 + 0.0125 * i, .velocity = 100});
    rig.Give(MoveVelocity{.velocity = 500, .buffer_mode = BufferMode::kBlendingLow});
    rig.Run(0.4);
    ASSERT_LE(Highest(rig), 20 + 1e-6) << i;
  }
}

// AX-11, AX-12: a move whose end is reached is done, also where the motion blended into it then has to be braked.
TEST(Interrupt, AMoveInFrontOfTheLimitIsDone) {
  for (const double target : {980.0, 990.0, 995.0}) {
    Rig rig(Fenced(1000));
    ASSERT_TRUE(rig.PowerOn());
    const Ticket first = rig.Give(MoveAbsolute{.position = target});
    const Ticket second = rig.Give(MoveVelocity{.velocity = 500, .buffer_mode = BufferMode::kBlendingPrevious});
    ASSERT_TRUE(rig.RunToEnd(second));
    EXPECT_TRUE(rig.lives[first].done) << target;
    EXPECT_EQ(rig.lives[second].error_id, ErrorId::kSoftLimitPositive) << target;
  }
}

}  // namespace
}  // namespace takt::axis
