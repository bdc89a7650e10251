// MC_SetOverride: AX-51.
#include <gtest/gtest.h>

#include "rig.h"

namespace takt::axis {
namespace {

SetOverride Factors(double velocity, double acceleration = 1, double jerk = 1) {
  return {.velocity_factor = velocity, .acceleration_factor = acceleration, .jerk_factor = jerk};
}

double SecondsOf(Rig& rig, Ticket move) {
  EXPECT_TRUE(rig.RunToEnd(move, 1000));
  EXPECT_TRUE(rig.lives[move].done);
  return static_cast<double>(rig.lives[move].final_cycle - rig.lives[move].active_cycle + 1) * rig.cycle.period_s;
}

double Fastest(const Rig& rig, std::size_t from = 0) {
  double fastest = 0;
  for (std::size_t i = from; i < rig.trace.size(); ++i) {
    fastest = std::max(fastest, std::abs(rig.trace[i].setpoint.velocity));
  }
  return fastest;
}

// AX-51: T = s / (f v) + f v / (g a), a trapezoid of velocity f v and ramps g a.
TEST(Override, ScalesAMoveFromRest) {
  const double way = 400, velocity = 200, ramp = 1000;
  for (const double f : {1.0, 0.5, 0.1}) {
    for (const double g : {1.0, 0.25}) {
      Rig rig(Trapezoid(5000));
      ASSERT_TRUE(rig.PowerOn());
      EXPECT_TRUE(rig.RunToEnd(rig.Give(Factors(f, g))));
      const Ticket move = rig.Give(
          MoveAbsolute{.position = way, .velocity = velocity, .acceleration = ramp, .deceleration = ramp, .jerk = 0});
      EXPECT_NEAR(SecondsOf(rig, move), way / (f * velocity) + f * velocity / (g * ramp), 0.0011) << f << " " << g;
      EXPECT_EQ(rig.out.override_factor, f);
      EXPECT_EQ(rig.position(), way);
    }
  }
}

// AX-51: a move that is nothing but jerk takes (1 / factor)^(1/3) of the time.
TEST(Override, ScalesTheJerk) {
  double before = 0;
  for (const double factor : {1.0, 1.0 / 8}) {
    Rig rig(LinearParams(), 0.0001);
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(Factors(1, 1, factor));
    const double took = SecondsOf(rig, rig.Give(MoveRelative{.distance = 0.1}));
    EXPECT_NEAR(took, std::cbrt(32 * 0.1 / (100000 * factor)), 0.00011);
    if (before > 0) {
      EXPECT_NEAR(took, 2 * before, 0.0003);
    }
    before = took;
  }
}

// AX-51: in motion, too, with steady position, velocity and acceleration.
TEST(Override, SlowsAndHastensAMoveInProgress) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 400, .velocity = 200});
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 200);
  rig.Give(Factors(0.25));
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 50);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  rig.Give(Factors(1));
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 200);
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_EQ(rig.position(), 400);
  ExpectWithinLimits(rig);
}

// AX-51: factor 0 stops the axis, which stays in its state, and goes on to the same target however long it stood.
TEST(Override, ZeroHoldsTheAxisInItsState) {
  for (const double after : {0.0, 0.01, 0.1, 0.6}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket move = rig.Give(MoveAbsolute{.position = 100, .velocity = 200});
    rig.Run(after);
    rig.Give(Factors(0));
    rig.Run(60);
    EXPECT_EQ(rig.out.set_velocity, 0);
    EXPECT_EQ(rig.out.override_factor, 0);
    if (after < 0.6) {
      EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
      EXPECT_EQ(rig.out.limited_by, LimitedBy::kOverride);
      EXPECT_FALSE(rig.Ended(move));
      EXPECT_FALSE(rig.out.in_position);
      EXPECT_LT(rig.position(), 99);
    }
    rig.Give(Factors(0.5));
    ASSERT_TRUE(rig.RunToEnd(move));
    EXPECT_TRUE(rig.lives[move].done);
    EXPECT_EQ(rig.position(), 100);
    EXPECT_EQ(Highest(rig), 100);
    ExpectWithinLimits(rig);
  }
}

// AX-51: what is given while the axis is held begins when it is released.
TEST(Override, CommandsWaitForTheirRelease) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(0));
  const Ticket first = rig.Give(MoveAbsolute{.position = 50});
  const Ticket second = rig.Give(MoveAbsolute{.position = 80, .buffer_mode = BufferMode::kBlendingHigh});
  const Ticket beyond = rig.Give(MoveAbsolute{.position = 2e12, .buffer_mode = BufferMode::kBuffered});
  rig.Run(1);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  EXPECT_EQ(rig.position(), 0);
  EXPECT_TRUE(rig.lives[first].active);
  EXPECT_TRUE(rig.lives[beyond].error);
  rig.Give(Factors(1));
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_TRUE(rig.lives[first].done);
  EXPECT_EQ(rig.position(), 80);
}

// AX-51: refused as without an override, so that a release never meets what would have been refused.
TEST(Override, ZeroDoesNotHideWhatIsForbidden) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(0));
  rig.Step();
  const Ticket outside = rig.Give(MoveAbsolute{.position = 101});
  rig.Step();
  EXPECT_EQ(rig.lives[outside].error_id, ErrorId::kTargetBehindLimit);
  const Ticket inside = rig.Give(MoveAbsolute{.position = 99});
  rig.Step();
  EXPECT_TRUE(rig.lives[inside].active);
  const Ticket closer = rig.Give(SetSoftLimits{.upper = 50});
  rig.Step();
  EXPECT_EQ(rig.lives[closer].error_id, ErrorId::kTargetBehindLimit);
  rig.inputs.limit_positive = true;  // it stands on the switch: only away from it
  rig.Step();
  rig.Give(Reset{});
  rig.Run(0.01);
  ASSERT_EQ(rig.out.state, PlcState::kStandstill);
  const Ticket onto = rig.Give(MoveVelocity{.velocity = 10});
  rig.Step();
  EXPECT_EQ(rig.lives[onto].error_id, ErrorId::kAwayFromLimitOnly);
}

// AX-51: factors above 1 count up to the axis' own limits, and it says so.
TEST(Override, AboveOneEndsAtTheLimitsOfTheAxis) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(2));
  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(1);
  EXPECT_EQ(rig.out.set_velocity, 200);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
  rig.Give(Factors(100));
  rig.Run(1);
  EXPECT_EQ(rig.out.set_velocity, 500);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kVelocity);
  rig.Give(Factors(1, 2));
  rig.Step();
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kAcceleration);
  rig.Give(Factors(1, 1, 1.5));
  rig.Step();
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kJerk);
  rig.Run(1);
  ExpectWithinLimits(rig);
}

// AX-51: AccFactor and JerkFactor 0 are errors, and so is whatever is no factor; the ones before stay.
TEST(Override, RefusesWhatIsNoFactor) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(0.5, 0.6, 0.7));
  for (const SetOverride& bad : {Factors(1, 0), Factors(1, 1, 0), Factors(-0.1), Factors(1, -1), Factors(1, 1, -1),
                                 Factors(NAN), Factors(HUGE_VAL), Factors(1, NAN), Factors(101), Factors(1e-7)}) {
    const Ticket ticket = rig.Give(bad);
    rig.Step();
    EXPECT_EQ(rig.lives[ticket].error_id, ErrorId::kParameter);
    EXPECT_NE(Diagnose(bad, rig.params), "");
  }
  EXPECT_EQ(rig.state.override_factors, (Override{0.5, 0.6, 0.7}));
}

// AX-51: MC_MoveVelocity and jog follow; held, a velocity is not reached.
TEST(Override, VelocitiesFollow) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(0));
  const Ticket move = rig.Give(MoveVelocity{.velocity = 100, .direction = Direction::kNegative});
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  EXPECT_FALSE(rig.lives[move].reached);
  rig.Give(Factors(0.3));
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, -30);
  EXPECT_TRUE(rig.lives[move].reached);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(Halt{})));
  const Ticket jog = rig.Give(Jog{.forward = true, .velocity = 50});
  rig.Run(0.5);
  EXPECT_NEAR(rig.out.set_velocity, 15, 1e-12);
  rig.Give(Factors(0));
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  rig.Give(Factors(1));
  rig.Run(0.5);
  EXPECT_NEAR(rig.out.set_velocity, 50, 1e-12);
  rig.Let(jog);
  ASSERT_TRUE(rig.RunToEnd(jog));
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  ExpectWithinLimits(rig);
}

// AX-51: what brings the axis to rest is not overridden.
TEST(Override, DoesNotLengthenAStop) {
  for (const bool stop : {false, true}) {
    double way[2] = {};
    for (const int weak : {0, 1}) {
      Rig rig(LinearParams());
      ASSERT_TRUE(rig.PowerOn());
      rig.Give(MoveVelocity{.velocity = 200});
      rig.Run(0.5);
      if (weak) rig.Give(Factors(1, 0.1, 0.1));
      rig.Step();
      const double from = rig.position();
      const Ticket end = stop ? rig.Give(Stop{}) : rig.Give(Halt{});
      ASSERT_TRUE(rig.RunToEnd(end));
      way[weak] = rig.position() - from;
    }
    EXPECT_NEAR(way[1], way[0], 1e-9);
  }
}

// AX-51: homing keeps its own speeds.
TEST(Override, DoesNotActOnHoming) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(0));
  rig.Give(StepRefPulse{.direction = HomingDirection::kPositive, .velocity = 20});
  rig.Run(0.5);
  EXPECT_EQ(rig.out.set_velocity, 20);
  ++rig.inputs.index_pulses;
  rig.inputs.index_counts = rig.inputs.counts;
  rig.Run(0.5);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// AX-51, AX-12: blending velocities are scaled, too.
TEST(Override, ScalesBlendingVelocities) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(0.5));
  rig.Give(MoveAbsolute{.position = 100, .velocity = 200});
  const Ticket last =
      rig.Give(MoveAbsolute{.position = 200, .velocity = 300, .buffer_mode = BufferMode::kBlendingHigh});
  ASSERT_TRUE(rig.RunToEnd(last));
  for (std::size_t i = 1; i < rig.trace.size(); ++i) {
    if (rig.trace[i - 1].setpoint.position < 100 && rig.trace[i].setpoint.position >= 100) {
      EXPECT_NEAR(rig.trace[i].setpoint.velocity, 150, 3);
    }
  }
  EXPECT_NEAR(Fastest(rig), 150, 1e-9);
}

// AX-51, AX-12: slowed down just before it is left, the first move is passed while the axis still brakes; nobody turns
// back, and the last target is kept.
TEST(Override, ABlendIsPassedBrakingAndGoesOn) {
  for (const double factor : {0.0, 0.02, 0.3}) {
    for (int late = 1; late < 60; late += 3) {
      Rig rig(LinearParams());
      ASSERT_TRUE(rig.PowerOn());
      const Ticket first = rig.Give(MoveAbsolute{.position = 100, .velocity = 300});
      const Ticket second =
          rig.Give(MoveAbsolute{.position = 130, .velocity = 300, .buffer_mode = BufferMode::kBlendingHigh});
      while (rig.position() < 100 - 0.3 * late) rig.Step();
      rig.Give(Factors(factor, 0.4, 0.5));
      rig.Run(1);
      const double held = rig.position();
      EXPECT_GT(held, 100 - 0.3 * late);
      if (factor == 0) {
        // Where a stop takes all the way there is nothing left to wait for.
        EXPECT_EQ(rig.out.state, held == 130 ? PlcState::kStandstill : PlcState::kDiscreteMotion);
        EXPECT_EQ(rig.out.set_velocity, 0);
      }
      rig.Give(Factors(1));
      ASSERT_TRUE(rig.RunToEnd(second));
      EXPECT_TRUE(rig.lives[first].done);
      EXPECT_TRUE(rig.lives[second].done);
      EXPECT_EQ(rig.position(), 130);
      for (const Sample& s : rig.trace) {
        ASSERT_GE(s.setpoint.velocity, -1e-9);
        ASSERT_LE(s.setpoint.position, 130 + 1e-9);
      }
      ExpectWithinLimits(rig);
    }
  }
}

// AX-51, AX-34: the end velocity of a continuous move follows, before its position and behind it.
TEST(Override, ContinuousMovesFollow) {
  for (int late = 0; late < 60; late += 5) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket move = rig.Give(MoveContinuousAbsolute{.position = 80, .end_velocity = 150, .velocity = 200});
    while (rig.position() < 80 - 0.5 * late) rig.Step();
    rig.Give(Factors(0.2));
    rig.Run(2);
    EXPECT_TRUE(rig.lives[move].reached);
    EXPECT_NEAR(rig.out.set_velocity, 30, 1e-9);
    rig.Give(Factors(0));
    rig.Run(1);
    EXPECT_EQ(rig.out.set_velocity, 0);
    EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
    rig.Give(Factors(1));
    rig.Run(1);
    EXPECT_NEAR(rig.out.set_velocity, 150, 1e-9);
    ExpectWithinLimits(rig);
  }
}

// AX-51, AX-32: held, the commanded end position is what an additive move adds to.
TEST(Override, AHeldMoveKeepsWhatIsAddedTo) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 100, .velocity = 200});
  rig.Run(0.2);
  rig.Give(Factors(0));
  rig.Run(0.5);
  const Ticket more = rig.Give(MoveAdditive{.distance = 20});
  rig.Give(Factors(1));
  ASSERT_TRUE(rig.RunToEnd(more));
  EXPECT_EQ(rig.position(), 120);
}

// AX-51: very small factors end, too.
TEST(Override, TheSmallestFactorsEnd) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(1e-6, 1e-6, 1e-6));
  const Ticket move = rig.Give(MoveRelative{.distance = 1e-4});
  ASSERT_TRUE(rig.RunToEnd(move, 100));
  EXPECT_EQ(rig.position(), 1e-4);
  rig.Give(Factors(1));
  rig.Give(MoveRelative{.distance = 100});
  rig.Run(0.15);
  rig.Give(Factors(1e-6, 1e-6, 1e-6));
  rig.Run(1);
  rig.Give(Factors(1));
  rig.Run(2);
  EXPECT_NEAR(rig.position(), 100 + 1e-4, 1e-9);
  EXPECT_LE(Highest(rig), 100 + 1e-4 + 1e-9);
}

// AX-51: power off, a fault and an emergency stop end a held move; the factors stay.
TEST(Override, AHeldMoveCanBeEnded) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Factors(0));
  const Ticket first = rig.Give(MoveRelative{.distance = 10});
  rig.Run(0.1);
  const Ticket halt = rig.Give(Halt{});
  ASSERT_TRUE(rig.RunToEnd(halt, 1));
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  const Ticket second = rig.Give(MoveRelative{.distance = 10});
  rig.Run(0.1);
  const Ticket off = rig.Give(Power{.enable = false});
  ASSERT_TRUE(rig.RunToEnd(off, 1));
  EXPECT_TRUE(rig.lives[second].aborted);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_EQ(rig.out.override_factor, 0);
}

}  // namespace
}  // namespace takt::axis
