// PL-13: external set points.
#include <functional>
#include <numbers>

#include "rig.h"
#include "takt/mover/follow.h"

namespace takt::mover {
namespace {

using planar::ObjectState;

// A circle, entered with a smooth change of speed.
SetExternalSetpoint OnCircle(double t, double radius, double turns_s, double ramp_s) {
  const double w = 2 * std::numbers::pi * turns_s;
  const double r = std::min(t / ramp_s, 1.0);
  const double angle = t < ramp_s ? w * ramp_s * (r * r * r - 0.5 * r * r * r * r) : w * (0.5 * ramp_s + t - ramp_s);
  const double speed = w * (3 * r * r - 2 * r * r * r);
  const double change = t < ramp_s ? w * (6 * r - 6 * r * r) / ramp_s : 0;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {.x = radius * (1 - c),
          .y = radius * s,
          .velocity_x = radius * speed * s,
          .velocity_y = radius * speed * c,
          .acceleration_x = radius * (change * s + speed * speed * c),
          .acceleration_y = radius * (change * c - speed * speed * s)};
}

// The manual's program: jerk up to an acceleration and down again, then a stop from there.
TEST(MoverExternal, AProfileIsFollowedAndStopped) {
  Rig rig;
  rig.Enable();
  Watch watch(rig);
  const Ticket start = rig.Give(StartExternalSetpointGeneration{});
  SetExternalSetpoint p;
  rig.Give(p);
  rig.Step();
  EXPECT_EQ(rig.out.command_mode, CommandMode::kExternalSetpointGeneration);
  double jerk = 1000;
  const double t = rig.cycle.period_s;
  do {
    p.x += t * p.velocity_x + t * t / 2 * p.acceleration_x + t * t * t / 6 * jerk;
    p.velocity_x += t * p.acceleration_x + t * t / 2 * jerk;
    p.acceleration_x += t * jerk;
    if (p.acceleration_x >= 100) jerk = -1000;
    rig.Give(p);
    rig.Step();
    watch.Look(true);
    ASSERT_EQ(rig.out.x, p.x);
    ASSERT_EQ(rig.out.velocity_x, p.velocity_x);
  } while (p.acceleration_x > 0);
  ASSERT_GT(p.velocity_x, 9);
  EXPECT_EQ(rig.Of(start).state, FeedbackState::kActive);
  const Ticket stop = rig.Give(StopExternalSetpointGeneration{});
  EXPECT_EQ(rig.Of(start).state, FeedbackState::kDone);
  EXPECT_EQ(rig.out.command_mode, CommandMode::kExternalSetpointGeneration);
  const double rest = trajectory::StopPosition(rig.state.set_point[kX], rig.params.xy.maximum.limits());
  while (!IsFinal(rig.Of(stop).state)) {
    rig.Step();
    watch.Look();
  }
  EXPECT_EQ(rig.Of(stop).state, FeedbackState::kDone);
  EXPECT_NEAR(rig.out.x, rest, 1e-6);
  EXPECT_EQ(rig.out.command_mode, CommandMode::kFreeMovement);
}

// From any point of a circle, where velocity and acceleration differ in direction, the mover stops within its limits.
TEST(MoverExternal, StopsFromCurvesWithinItsLimits) {
  for (int cycles = 50; cycles < 1500; cycles += 37) {
    for (const int how : {0, 1, 2}) {
      Rig rig;
      rig.Enable();
      Watch watch(rig);
      const Ticket start = rig.Give(StartExternalSetpointGeneration{});
      for (int i = 1; i <= cycles; ++i) {
        rig.Give(OnCircle(i * 0.001, 100, 1.4, 0.5));
        rig.Step();
        watch.Look(true);
        ASSERT_EQ(rig.out.state, ObjectState::kEnabled) << i;
      }
      if (how == 0) rig.Give(StopExternalSetpointGeneration{});
      if (how == 1) rig.Give(Halt{});
      for (int i = 0; i < 1500; ++i) {
        rig.Step();
        watch.Look();
        if (testing::Test::HasFailure()) return;
      }
      EXPECT_TRUE(AtRest(rig.state));
      EXPECT_EQ(rig.out.state, how == 2 ? ObjectState::kError : ObjectState::kEnabled);
      EXPECT_EQ(rig.out.error, how == 2 ? ErrorId::kNoSetPoint : ErrorId::kNone);
      EXPECT_EQ(rig.Of(start).state, how == 2   ? FeedbackState::kError
                                     : how == 1 ? FeedbackState::kAborted
                                                : FeedbackState::kDone);
      EXPECT_EQ(rig.out.command_mode, CommandMode::kFreeMovement);
      EXPECT_LT(std::hypot(rig.out.x - 100, rig.out.y), 300);
    }
  }
}

// A set point that the mover cannot follow is an error, and the mover never jumps.
TEST(MoverExternal, WildSetPointsAreErrors) {
  using Change = std::function<void(SetExternalSetpoint&)>;
  const std::vector<Change> changes = {
      [](auto& p) { p.x += 0.1; },
      [](auto& p) { p.velocity_y += 30; },
      [](auto& p) {  // 9 mm/s more than follows from the acceleration
        const double more = 9 / std::hypot(p.acceleration_x, p.acceleration_y);
        p.velocity_x += more * p.acceleration_x;
        p.velocity_y += more * p.acceleration_y;
      },
      [](auto& p) { p.acceleration_x += 20000; },
      [](auto& p) { p.velocity_x = 2500; },
      [](auto& p) { p.z = -0.1; },
      [](auto& p) { p.z = 0.5; },
      [](auto& p) { p.b = 4; },
      [](auto& p) { p.velocity_c = 5; },
      [](auto& p) { p = {}; },
  };
  for (const Change& change : changes) {
    Rig rig;
    rig.Enable();
    Watch watch(rig);
    const Ticket start = rig.Give(StartExternalSetpointGeneration{});
    for (int i = 1; i <= 600; ++i) {
      rig.Give(OnCircle(i * 0.001, 100, 1.4, 0.5));
      rig.Step();
      watch.Look(true);
    }
    ASSERT_EQ(rig.out.state, ObjectState::kEnabled);
    SetExternalSetpoint wild = OnCircle(0.601, 100, 1.4, 0.5);
    change(wild);
    rig.Give(wild);
    rig.Step();
    watch.Look();
    EXPECT_EQ(rig.out.error, ErrorId::kWildSetPoint);
    EXPECT_EQ(rig.Of(start).error, ErrorId::kWildSetPoint);
    for (int i = 0; i < 1000; ++i) {
      rig.Step();
      watch.Look();
    }
    EXPECT_EQ(rig.out.state, ObjectState::kError);
  }
}

// A set point within all limits that leads beyond the maximum speed whatever the mover does then.
TEST(MoverExternal, SpeedsThatCannotBeHeldAreWild) {
  Rig rig;
  rig.Enable();
  rig.Give(StartExternalSetpointGeneration{});
  double x = 0;
  double v = 0;
  for (int i = 1; rig.out.error == ErrorId::kNone; ++i) {
    const double a = std::min(9000.0, 180.0 * i);  // as the jerk allows
    const double before = std::min(9000.0, 180.0 * (i - 1));
    x += 0.001 * v + 1e-6 * (before / 3 + a / 6);
    v += 0.0005 * (before + a);
    ASSERT_LT(v, 1900);
    rig.Give(SetExternalSetpoint{.x = x, .velocity_x = v, .acceleration_x = a});
    rig.Step();
  }
  EXPECT_EQ(rig.out.error, ErrorId::kWildSetPoint);
  // a² / 2j: the velocity gained while 9000 mm/s² are ramped down.
  EXPECT_NEAR(v, 2000 - 9000.0 * 9000 / (2 * 200000), 9.1);
  Watch watch(rig);
  for (int i = 0; i < 1000; ++i) {
    rig.Step();
    watch.Look();
  }
  // Nor may it be faster while it brakes.
  const auto can = [&](double from, double to) {
    SetPoint before{};
    SetPoint after{};
    before[kX] = {0, from, 0};
    after[kX] = {0.0005 * (from + to), to, -9000};
    return CanFollow(rig.context(), rig.state, before, after);
  };
  EXPECT_TRUE(can(1990, 1999));
  EXPECT_FALSE(can(1996, 2001));
}

// A set point is wild if a coordinate could no longer stop within its limits, or C within its window while X and Y
// move.
TEST(MoverExternal, WhatCannotStopWithinLimitsIsWild) {
  struct Case {
    SetpointMode mode;
    double SetExternalSetpoint::*position;
    double SetExternalSetpoint::*velocity;
    double SetExternalSetpoint::*acceleration;
    std::size_t coordinate;
    double acceleration_is, limit;
  };
  using P = SetExternalSetpoint;
  for (const Case& k : {Case{SetpointMode::kAbsolute, &P::z, &P::velocity_z, &P::acceleration_z, kZ, 500, 5},
                        Case{SetpointMode::kRelative, &P::z, &P::velocity_z, &P::acceleration_z, kZ, 500, 5},
                        Case{SetpointMode::kAbsolute, &P::b, &P::velocity_b, &P::acceleration_b, kB, -60, -5},
                        Case{SetpointMode::kRelative, &P::c, &P::velocity_c, &P::acceleration_c, kC, 1500, 15},
                        Case{SetpointMode::kAbsolute, &P::c, &P::velocity_c, &P::acceleration_c, kC, 1500, 15}}) {
    Rig rig;
    rig.Enable();
    std::optional<Watch> watch;
    if (k.mode == SetpointMode::kRelative) rig.Give(MoveToPosition{.x = 3000});
    rig.Give(StartExternalSetpointGeneration{.mode = k.mode});
    SetExternalSetpoint p;
    double most = 0;
    for (int i = 1; i <= 3000; ++i) {
      const double t = i * 0.001, s = k.acceleration_is;
      p.*k.position = 0.5 * s * t * t;
      p.*k.velocity = s * t;
      p.*k.acceleration = s;
      if (k.mode == SetpointMode::kAbsolute) {
        p.x = 100 * t * t;
        p.velocity_x = 200 * t;
        p.acceleration_x = 200;
      }
      if (rig.out.error == ErrorId::kNone) rig.Give(p);
      rig.Step();
      if (watch) watch->Look(rig.out.error == ErrorId::kNone);
      if (!watch) watch.emplace(rig);  // the motion begins with an acceleration
      most = std::max(most, std::abs(rig.state.set_point[k.coordinate].position));
    }
    EXPECT_EQ(rig.out.error, ErrorId::kWildSetPoint);
    EXPECT_TRUE(AtRest(rig.state));
    EXPECT_LE(most, std::abs(k.limit) + 1e-6) << k.coordinate;
    EXPECT_GT(most, 0.8 * std::abs(k.limit)) << k.coordinate;  // no sooner than necessary
  }
}

// Set points are due from the start on.
TEST(MoverExternal, NoneAtAllIsAnErrorToo) {
  for (const std::uint32_t missing : {1u, 4u}) {
    for (const SetpointMode mode : {SetpointMode::kAbsolute, SetpointMode::kRelative}) {
      Rig rig({.initial = {.x = 30, .c = 5}, .missing_setpoints = missing});
      rig.Enable();
      const Ticket start = rig.Give(StartExternalSetpointGeneration{.mode = mode});
      for (std::uint32_t i = 0; i < missing; ++i) {
        EXPECT_EQ(rig.Of(start).state, FeedbackState::kActive);
        rig.Step();
        EXPECT_EQ(rig.out.x, 30);
      }
      EXPECT_EQ(rig.Of(start).error, ErrorId::kNoSetPoint);
    }
  }
}

// As many may be missing as the machine file allows; meanwhile the motion is extrapolated.
TEST(MoverExternal, SomeMayBeMissing) {
  Rig rig({.missing_setpoints = 4});
  rig.Enable();
  Watch watch(rig);
  rig.Give(StartExternalSetpointGeneration{});
  const auto at = [](int i) {
    const double t = i * 0.001;
    return SetExternalSetpoint{.x = 50 * t * t, .velocity_x = 100 * t, .acceleration_x = 100};
  };
  for (int i = 1; i <= 300; ++i) {
    if (i % 4 == 1) rig.Give(at(i));
    rig.Step();
    watch.Look(true);
    ASSERT_EQ(rig.out.state, ObjectState::kEnabled);
    ASSERT_NEAR(rig.out.x, at(i).x, 1e-9);
  }
  rig.Run(1);
  EXPECT_EQ(rig.out.error, ErrorId::kNoSetPoint);
}

// PL-13: relative set points are added to a move, in its mode; their stop brings the mover to rest.
TEST(MoverExternal, RelativeSetPointsComeOnTop) {
  Rig rig, alone;
  for (Rig* r : {&rig, &alone}) {
    r->Enable();
    r->Give(MoveToPosition{.y = 400, .velocity = 300.0, .acceleration = 2000.0});
  }
  Watch watch(rig);
  rig.Give(StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
  for (int i = 1; i <= 700; ++i) {
    const SetExternalSetpoint offset = OnCircle(i * 0.001, 20, 1, 0.5);
    rig.Give(offset);
    rig.Step();
    alone.Step();
    watch.Look(true);
    ASSERT_EQ(rig.out.state, ObjectState::kEnabled) << i;
    ASSERT_EQ(rig.out.command_mode, CommandMode::kFreeMovement);
    ASSERT_EQ(rig.out.x, offset.x + alone.out.x);
    ASSERT_EQ(rig.out.y, offset.y + alone.out.y);
  }
  const Ticket stop = rig.Give(StopExternalSetpointGeneration{});
  while (!IsFinal(rig.Of(stop).state)) {
    rig.Step();
    watch.Look();
  }
  EXPECT_TRUE(AtRest(rig.state));
  EXPECT_EQ(rig.Of(stop).state, FeedbackState::kDone);
  EXPECT_EQ(rig.out.external, SetpointMode::kNone);
  EXPECT_EQ(rig.Become(rig.Give(MoveToPosition{})), FeedbackState::kDone);
}

// External set points may turn C anywhere; the mode follows from the final angle.
TEST(MoverExternal, ATurnFromOutsideMayEndOutsideTheWindows) {
  Rig rig;
  rig.Enable();
  rig.Give(StartExternalSetpointGeneration{});
  for (int i = 1; i <= 1000; ++i) {
    const double t = i * 0.001;
    rig.Give(SetExternalSetpoint{.c = 20 * t * t, .velocity_c = 40 * t, .acceleration_c = 40});
    rig.Step();
  }
  EXPECT_EQ(rig.Become(rig.Give(StopExternalSetpointGeneration{})), FeedbackState::kDone);
  EXPECT_GT(rig.out.c, 20);
  EXPECT_EQ(rig.out.command_mode, CommandMode::kCRotationFreeMovement);
}

// Turned out of its windows, X and Y stay locked for every source of motion.
TEST(MoverExternal, XAndYAreLockedOutsideTheWindows) {
  Rig rig({.initial = {.c = 40}});
  rig.Enable();
  rig.Give(StartExternalSetpointGeneration{.mode = SetpointMode::kRelative});
  rig.Give(SetExternalSetpoint{.z = 0});
  rig.Step();
  EXPECT_EQ(rig.out.state, ObjectState::kEnabled);
  rig.Give(SetExternalSetpoint{.x = 1e-4});
  rig.Step();
  EXPECT_EQ(rig.out.error, ErrorId::kWildSetPoint);
  EXPECT_EQ(rig.out.x, 0);
}

}  // namespace
}  // namespace takt::mover
