// Tables over time: AX-41.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rig.h"
#include "takt/cam/build.h"

namespace takt::axis {
namespace {

// The polynomial 3-4-5 over the share s of a second, and its integrals.
double Y(double s) {
  return s * s * s * (10 - 15 * s + 6 * s * s);
}
double Dy(double s) {
  return 30 * s * s * (1 - s) * (1 - s);
}
double Integral(double s) {
  return s * s * s * s * (2.5 - 3 * s + s * s);
}
double SecondIntegral(double s) {
  return s * s * s * s * s * (0.5 - 0.5 * s + s * s / 7);
}

cam::Table TableOf(const char* name, const std::vector<cam::CamPoint>& points) {
  cam::CamParams params;
  params.name = name;
  params.points = points;
  return cam::Build(params).table.value();
}

// From 0 to 1 within a second, from 0 to 1 and back within two, and one with a peak.
std::vector<cam::Table> Tables() {
  return {TableOf("rise", {{0, 0, 0.0, 0.0}, {1, 1, 0.0, 0.0}}),
          TableOf("bump", {{0, 0, 0.0, 0.0}, {1, 1, 0.0, 0.0}, {2, 0, 0.0, 0.0}}),
          TableOf("shifted", {{5, 10, 0.0, 0.0}, {6, 40, 0.0, 0.0}})};
}

struct TableRig : Rig {
  explicit TableRig(AxisParams p = LinearParams()) : Rig(std::move(p)) {
    cams = Tables();
    PowerOn();
    begin = trace.size();
  }
  void KeepsTheLimits() {
    const Worst worst = WorstOf(trace, params.planner_limits(), cycle.period_s, begin);
    EXPECT_LE(worst.velocity, 1 + 1e-9);
    EXPECT_LE(worst.acceleration, 1 + 1e-9);
    EXPECT_LE(worst.jerk, 1 + 1e-6);
    EXPECT_LE(worst.position_step, 1 + 1e-6);
  }
  std::size_t begin = 0;
};

// AX-41: position(t), scaled and shifted; done at rest at its end.
TEST(PositionProfile, IsTheTable) {
  TableRig rig;
  const Ticket ticket =
      rig.Give(PositionProfile{.profile = Name::Of("rise"), .time_scale = 0.8, .position_scale = 100});
  for (int i = 1; i < 800; ++i) {
    rig.Step();
    const double s = i / 800.0;
    ASSERT_EQ(rig.out.state, PlcState::kDiscreteMotion);
    ASSERT_NEAR(rig.position(), 100 * Y(s), 1e-9);
    ASSERT_NEAR(rig.state.setpoint.velocity, 125 * Dy(s), 1e-9);
    ASSERT_EQ(rig.out.limited_by, LimitedBy::kNothing);
  }
  EXPECT_FALSE(rig.Ended(ticket));
  rig.Step();
  EXPECT_TRUE(rig.lives[ticket].done);
  EXPECT_EQ(rig.position(), 100);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_EQ(rig.lives[ticket].events.front().value, 0.8);  // how long it takes
  rig.KeepsTheLimits();
}

// AX-41: an axis that is elsewhere catches up.
TEST(PositionProfile, IsCaughtUpWith) {
  TableRig rig;
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = -40}));
  const Ticket ticket = rig.Give(PositionProfile{.profile = Name::Of("shifted"), .position_scale = 2, .offset = -15});
  rig.Run(0.6);
  EXPECT_NEAR(rig.position(), 5 + 60 * Y(0.6), 1e-9);
  EXPECT_TRUE(rig.RunToEnd(ticket, 1));
  EXPECT_EQ(rig.position(), 65);
  rig.KeepsTheLimits();
}

// AX-41, AX-13: faster than the axis: as far as its limits go, and at the right place in the end.
TEST(PositionProfile, IsFollowedAsFarAsTheLimitsAllow) {
  AxisParams p = LinearParams();
  p.limits.velocity = 120;
  TableRig rig(p);
  const Ticket ticket = rig.Give(PositionProfile{.profile = Name::Of("rise"), .position_scale = 100});
  bool limited = false;
  for (int i = 0; i < 3000 && !rig.Ended(ticket); ++i) {
    rig.Step();
    limited |= rig.out.limited_by == LimitedBy::kVelocity;
  }
  EXPECT_TRUE(limited);
  EXPECT_TRUE(rig.lives[ticket].done);
  EXPECT_NEAR(rig.position(), 100, 1e-9);
  rig.KeepsTheLimits();
}

// AX-41: velocity(t); the last velocity stays.
TEST(VelocityProfile, IsTheTable) {
  TableRig rig;
  const Ticket ticket =
      rig.Give(VelocityProfile{.profile = Name::Of("rise"), .time_scale = 0.5, .velocity_scale = 200});
  for (int i = 1; i < 500; ++i) {
    rig.Step();
    const double s = i / 500.0;
    ASSERT_EQ(rig.out.state, PlcState::kContinuousMotion);
    ASSERT_NEAR(rig.state.setpoint.velocity, 200 * Y(s), 1e-9);
    ASSERT_NEAR(rig.state.setpoint.acceleration, 400 * Dy(s), 1e-9);
    ASSERT_NEAR(rig.position(), 100 * Integral(s), 1e-9);
  }
  rig.Step();
  EXPECT_TRUE(rig.lives[ticket].done);
  rig.Run(1);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  EXPECT_EQ(rig.state.setpoint.velocity, 200);
  EXPECT_NEAR(rig.position(), 50 + 200, 1e-9);
  rig.KeepsTheLimits();
}

// AX-41: acceleration(t), from the velocity there is.
TEST(AccelerationProfile, IsTheTable) {
  TableRig rig;
  rig.Give(MoveVelocity{.velocity = 50});
  rig.Run(0.5);
  const double from = rig.position();
  const Ticket ticket =
      rig.Give(AccelerationProfile{.profile = Name::Of("bump"), .time_scale = 0.25, .acceleration_scale = 800});
  for (int i = 1; i < 500; ++i) {
    rig.Step();
    const double s = i / 250.0;
    const double t = i / 1000.0;
    const double a = s < 1 ? Y(s) : Y(2 - s);
    const double v = s < 1 ? Integral(s) : 1 - Integral(2 - s);
    const double x = s < 1 ? SecondIntegral(s) : (s - 1) + SecondIntegral(2 - s);  // antisymmetric around s = 1
    ASSERT_NEAR(rig.state.setpoint.acceleration, 800 * a, 1e-9);
    ASSERT_NEAR(rig.state.setpoint.velocity, 50 + 200 * v, 1e-9);
    ASSERT_NEAR(rig.position(), from + 50 * t + 50 * x, 1e-9);
  }
  rig.Run(0.01);
  EXPECT_TRUE(rig.lives[ticket].done);
  EXPECT_NEAR(rig.state.setpoint.velocity, 250, 1e-9);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  rig.KeepsTheLimits();
}

// AX-41: what the limits do not allow is made up in velocity.
TEST(VelocityProfile, IsCaughtUpWith) {
  AxisParams p = LinearParams();
  p.limits.acceleration = 300;
  p.limits.deceleration = 250;
  TableRig rig(p);
  rig.Give(MoveVelocity{.velocity = 30, .direction = Direction::kNegative});
  rig.Run(1);
  const Ticket ticket = rig.Give(VelocityProfile{.profile = Name::Of("bump"), .velocity_scale = 180, .offset = 20});
  bool limited = false;
  for (int i = 0; i < 4000 && !rig.Ended(ticket); ++i) {
    rig.Step();
    limited |= rig.out.limited_by == LimitedBy::kAcceleration;
  }
  EXPECT_TRUE(limited);
  EXPECT_TRUE(rig.lives[ticket].done);
  EXPECT_NEAR(rig.state.setpoint.velocity, 20, 1e-9);
  rig.KeepsTheLimits();
}

// AX-12, AX-41: buffered, and followed by what is buffered.
TEST(TimeTables, TakeTheirTurn) {
  TableRig rig;
  const Ticket move = rig.Give(MoveAbsolute{.position = 10});
  const Ticket profile = rig.Give(
      VelocityProfile{.profile = Name::Of("rise"), .velocity_scale = 40, .buffer_mode = BufferMode::kBuffered});
  const Ticket position = rig.Give(PositionProfile{
      .profile = Name::Of("bump"), .position_scale = 30, .offset = 40, .buffer_mode = BufferMode::kBuffered});
  const Ticket last = rig.Give(MoveRelative{.distance = 3, .buffer_mode = BufferMode::kBuffered});
  EXPECT_TRUE(rig.RunToEnd(last, 10));
  for (const Ticket ticket : {move, profile, position, last}) EXPECT_TRUE(rig.lives[ticket].done) << ticket;
  EXPECT_NEAR(rig.position(), 43, 1e-9);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  rig.KeepsTheLimits();
}

// AX-14, AX-41: aborted by a move on the way.
TEST(TimeTables, AreAbortedSmoothly) {
  TableRig rig;
  const Ticket profile = rig.Give(PositionProfile{.profile = Name::Of("rise"), .position_scale = 200});
  rig.Run(0.5);
  const Ticket move = rig.Give(MoveAbsolute{.position = 0});
  EXPECT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[profile].aborted);
  EXPECT_EQ(rig.position(), 0);
  rig.KeepsTheLimits();
}

// AX-41: a rotary axis takes the turn at hand.
TEST(PositionProfile, TakesTheNearestTurn) {
  TableRig rig(RotaryParams());
  rig.RunToEnd(rig.Give(MoveRelative{.distance = 1070}));
  const Ticket ticket = rig.Give(PositionProfile{.profile = Name::Of("rise"), .position_scale = 90});
  EXPECT_TRUE(rig.RunToEnd(ticket));
  EXPECT_NEAR(rig.position() + rig.state.origin, 1170, 1e-9);
  EXPECT_NEAR(rig.out.set_position, 90, 1e-9);
  rig.KeepsTheLimits();
}

// AX-06, AX-41, AX-71: what can be told at a glance is refused, and what moves goes on.
TEST(TimeTables, AreRefused) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  TableRig rig(p);
  const auto error = [&](const Command& command) {
    const Ticket ticket = rig.Give(command);
    rig.Run(0.002);
    return rig.lives[ticket].error_id;
  };
  const Ticket move = rig.Give(MoveVelocity{.velocity = 10});
  EXPECT_EQ(error(PositionProfile{.profile = Name::Of("none")}), ErrorId::kUnknownTarget);
  EXPECT_EQ(error(PositionProfile{}), ErrorId::kParameter);
  EXPECT_EQ(error(PositionProfile{.profile = Name::Of("rise"), .time_scale = 0}), ErrorId::kParameter);
  EXPECT_EQ(error(PositionProfile{.profile = Name::Of("bump"), .position_scale = 101}), ErrorId::kTargetBehindLimit);
  EXPECT_EQ(error(VelocityProfile{.profile = Name::Of("bump"), .velocity_scale = -501}), ErrorId::kParameter);
  EXPECT_EQ(error(AccelerationProfile{.profile = Name::Of("bump"), .acceleration_scale = 5001}), ErrorId::kParameter);
  EXPECT_FALSE(rig.Ended(move));
  EXPECT_EQ(error(PositionProfile{.profile = Name::Of("bump"), .position_scale = 99}), ErrorId::kNone);
  p.requires_reference = true;
  TableRig homeless(p);
  const Ticket ticket = homeless.Give(PositionProfile{.profile = Name::Of("rise")});
  homeless.Run(0.002);
  EXPECT_EQ(homeless.lives[ticket].error_id, ErrorId::kNoReference);
}

// AX-13, AX-41: a table of velocities that leads out of the SW limits stops inside them.
TEST(VelocityProfile, StaysInsideTheSoftLimits) {
  AxisParams p = LinearParams();
  p.limits.upper = 60;
  TableRig rig(p);
  const Ticket ticket = rig.Give(VelocityProfile{.profile = Name::Of("rise"), .velocity_scale = 200});
  rig.Run(2);
  EXPECT_EQ(rig.lives[ticket].error_id, ErrorId::kSoftLimitPositive);
  EXPECT_LE(rig.position(), 60 + 1e-9);
  EXPECT_GT(rig.position(), 55);
  rig.KeepsTheLimits();
}

}  // namespace
}  // namespace takt::axis
