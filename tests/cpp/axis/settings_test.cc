// Settings at run time: AX-27, AX-28, AX-29, AX-52, AX-53.
#include <gtest/gtest.h>

#include <memory>

#include "rig.h"

namespace takt::axis {
namespace {

double Read(Rig& rig, int number) {
  const Ticket ticket = rig.Give(ReadParameter{number});
  rig.Step();
  EXPECT_TRUE(rig.lives[ticket].done) << number;
  return rig.lives[ticket].events.back().value;
}

ErrorId ErrorOf(Rig& rig, const Command& command) {
  const Ticket ticket = rig.Give(command);
  rig.Step();
  EXPECT_TRUE(rig.Ended(ticket));
  return rig.lives[ticket].error_id;
}

// AX-27: no motion before the constants, where the machine asks for that.
TEST(Constants, AreAwaited) {
  AxisParams p = LinearParams();
  p.await_constants = true;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_EQ(ErrorOf(rig, MoveRelative{.distance = 1}), ErrorId::kNoConstants);
  EXPECT_EQ(ErrorOf(rig, Jog{.forward = true}), ErrorId::kNoConstants);
  EXPECT_EQ(
      ErrorOf(
          rig,
          SetConstants{
              .kp = 0.1, .ki = {}, .kd = 0.02, .kc = {}, .ff = {}, .velocity_at_10v = 800, .lower = -5, .upper = 50}),
      ErrorId::kNone);
  EXPECT_EQ(rig.params.loop.kp, 0.1);
  EXPECT_EQ(rig.params.loop.kd, 0.02);
  EXPECT_EQ(rig.params.loop.velocity_at_10v, 800);
  EXPECT_EQ(rig.params.loop.ff, 1);  // left out: as it was
  EXPECT_EQ(ErrorOf(rig, MoveAbsolute{.position = 51}), ErrorId::kTargetBehindLimit);
  EXPECT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = 50})));
}

// AX-28: PLCopen's numbers.
TEST(Parameters, AreReadAndWritten) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  p.supervision.deviation_moving = 5;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 10}));
  EXPECT_EQ(Read(rig, 1), 10);
  EXPECT_EQ(Read(rig, 2), 100);
  EXPECT_EQ(Read(rig, 4), 1);
  EXPECT_EQ(Read(rig, 5), 0);
  EXPECT_EQ(Read(rig, 7), 5);
  EXPECT_EQ(Read(rig, 9), 500);
  EXPECT_EQ(Read(rig, 13), 5000);
  EXPECT_EQ(Read(rig, 15), 4000);
  EXPECT_EQ(Read(rig, 17), 100000);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{2, 20}), ErrorId::kNone);
  EXPECT_EQ(Read(rig, 2), 20);
  EXPECT_EQ(ErrorOf(rig, MoveAbsolute{.position = 21}), ErrorId::kTargetBehindLimit);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{2, 9}), ErrorId::kTargetBehindLimit);  // the axis is beyond it
  EXPECT_EQ(ErrorOf(rig, WriteParameter{4, 0}), ErrorId::kNone);
  EXPECT_EQ(Read(rig, 4), 0);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{10, 1}), ErrorId::kParameter);  // cannot be written
  EXPECT_EQ(ErrorOf(rig, WriteParameter{18, 1}), ErrorId::kParameter);
  EXPECT_EQ(ErrorOf(rig, ReadParameter{0}), ErrorId::kParameter);
}

// AX-28: what PLCopen has no number for: the loop's constants, and supervision at rest.
TEST(Parameters, OfTaktsOwn) {
  AxisParams p = LinearParams();
  p.loop = {.kp = 0.1, .ki = 0.2, .kd = 0.3, .kc = 0.4, .ff = 0.5, .velocity_at_10v = 600};
  Rig rig(p);
  for (const int i : {1, 2, 3, 4, 5}) EXPECT_EQ(Read(rig, 1000 + i), i / 10.0);
  EXPECT_EQ(Read(rig, 1006), 600);
  EXPECT_EQ(Read(rig, 1007), HUGE_VAL);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{1007, 2}), ErrorId::kNone);
  EXPECT_EQ(Read(rig, 1007), 2);
  EXPECT_EQ(rig.params.supervision.deviation_standstill, 2);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{1007, 0}), ErrorId::kParameter);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{1001, 1}), ErrorId::kParameter);  // GT_SetConstant does that
  EXPECT_EQ(Read(rig, 1008), HUGE_VAL);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{1008, 3}), ErrorId::kNone);  // AX-105
  EXPECT_EQ(Read(rig, 1008), 3);
  for (const int number : {18, 1000, 1009}) EXPECT_EQ(ErrorOf(rig, ReadParameter{number}), ErrorId::kParameter);
}

// AX-52: new limits hold at once; those that a motion could not keep are refused, and it goes on.
TEST(SoftLimits, ChangeAtRunTime) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 100});
  rig.Run(0.1);
  EXPECT_EQ(ErrorOf(rig, SetSoftLimits{.lower = {}, .upper = 99}), ErrorId::kTargetBehindLimit);
  EXPECT_EQ(ErrorOf(rig, SetSoftLimits{.lower = -10, .upper = 100}), ErrorId::kNone);
  EXPECT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_EQ(ErrorOf(rig, MoveRelative{.distance = 1}), ErrorId::kTargetBehindLimit);
  EXPECT_EQ(ErrorOf(rig, SetSoftLimits{.enable_lower = true, .enable_upper = false, .lower = {}, .upper = {}}),
            ErrorId::kNone);
  EXPECT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = 1})));
  EXPECT_EQ(ErrorOf(rig, SetSoftLimits{.lower = 200, .upper = 100}), ErrorId::kParameter);
  Rig rotary(RotaryParams());
  EXPECT_EQ(ErrorOf(rotary, SetSoftLimits{.lower = 0, .upper = 10}), ErrorId::kParameter);
}

// AX-52, AX-28: what was switched off comes back with its value; a yes or no is 0 or 1.
TEST(SoftLimits, AreSwitchedOffAndOnAgain) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  p.supervision.deviation_moving = 5;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_EQ(ErrorOf(rig, SetSoftLimits{.enable_upper = false, .lower = {}, .upper = {}}), ErrorId::kNone);
  EXPECT_EQ(Read(rig, 4), 0);
  EXPECT_EQ(ErrorOf(rig, SetSoftLimits{}), ErrorId::kNone);
  EXPECT_EQ(Read(rig, 2), 100);
  EXPECT_EQ(ErrorOf(rig, MoveAbsolute{.position = 101}), ErrorId::kTargetBehindLimit);
  for (const int number : {4, 6}) {
    EXPECT_EQ(ErrorOf(rig, WriteParameter{number, 0}), ErrorId::kNone);
    EXPECT_EQ(Read(rig, number), 0);
    EXPECT_EQ(Read(rig, 2), 100);
    EXPECT_EQ(Read(rig, 7), 5);
    EXPECT_EQ(ErrorOf(rig, WriteParameter{number, 7.5}), ErrorId::kParameter);
    EXPECT_EQ(ErrorOf(rig, WriteParameter{number, 1}), ErrorId::kNone);
    EXPECT_EQ(Read(rig, number), 1);
  }
  EXPECT_EQ(Read(rig, 2), 100);
  EXPECT_EQ(Read(rig, 7), 5);
  EXPECT_EQ(ErrorOf(rig, WriteParameter{5, 1}), ErrorId::kParameter);  // there never was a lower one
}

// A limit that comes into the way of an endless motion stops it before it.
TEST(SoftLimits, LeaveRoomWhereOneMovePassesItsVelocityOn) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 100, .velocity = 200});
  const Ticket next =
      rig.Give(MoveAbsolute{.position = 200, .velocity = 200, .buffer_mode = BufferMode::kBlendingHigh});
  rig.Run(0.2);
  const Ticket close = rig.Give(SetSoftLimits{.lower = -10, .upper = 103});
  rig.Step();
  EXPECT_EQ(rig.lives[close].error_id, ErrorId::kTargetBehindLimit);
  const Ticket further = rig.Give(SetSoftLimits{.lower = -10, .upper = 130});
  rig.RunToEnd(next);
  EXPECT_TRUE(rig.lives[further].done);
  EXPECT_EQ(rig.lives[next].error_id, ErrorId::kTargetBehindLimit);
  rig.Run(1);
  EXPECT_GT(rig.position(), 100);
  EXPECT_LT(rig.position(), 130);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// An axis that is turning round gets further before it comes back.
TEST(SoftLimits, LeaveRoomForTurningRound) {
  Rig rig(LinearParams());
  Rig twin(LinearParams());
  for (Rig* each : {&rig, &twin}) {
    ASSERT_TRUE(each->PowerOn());
    each->Give(MoveVelocity{.velocity = 100});
    each->Run(0.5);
    each->Give(MoveVelocity{.velocity = 100, .direction = Direction::kNegative});
    while (each->out.set_velocity > 20) each->Step();
  }
  const double here = rig.position();
  double furthest = here;
  for (int i = 0; i < 200; ++i) {
    twin.Step();
    furthest = std::max(furthest, twin.position());
  }
  ASSERT_GT(furthest, here + 0.01);
  const Ticket close = rig.Give(SetSoftLimits{.lower = -1000, .upper = 0.5 * (here + furthest)});
  rig.Step();
  EXPECT_EQ(rig.lives[close].error_id, ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
}

TEST(SoftLimits, StopAnEndlessMotion) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(0.5);
  const double limit = rig.position() + 20;
  EXPECT_EQ(ErrorOf(rig, SetSoftLimits{.lower = {}, .upper = limit}), ErrorId::kNone);
  rig.Run(1);
  EXPECT_EQ(rig.out.error, ErrorId::kSoftLimitPositive);
  EXPECT_LE(rig.position(), limit + 1e-9);
}

// AX-53, AX-82: it is gone with any fault, also one that finds the loop open, and with power off.
TEST(DirectOutput, DoesNotSurviveAFault) {
  AxisParams p = LinearParams();
  p.drive.mode = DriveMode::kAnalog;
  p.loop.velocity_at_10v = 1000;
  Rig rig(p);
  rig.Step();
  const auto put_out = [&] {
    EXPECT_EQ(ErrorOf(rig, DirectOutput{2}), ErrorId::kNone);
    EXPECT_NEAR(rig.commanded.voltage_v, 2, kVoltageStep / 2);
    EXPECT_EQ(std::remainder(rig.commanded.voltage_v, kVoltageStep), 0);  // of the converter
  };
  put_out();
  Fail(rig.Now(), ErrorId::kOverrun, false, rig.state);
  rig.Step();
  EXPECT_EQ(rig.commanded.voltage_v, 0);
  rig.RunToEnd(rig.Give(Reset{}));
  put_out();
  rig.Give(Power{.enable = false});
  rig.Step();
  EXPECT_EQ(rig.commanded.voltage_v, 0);
}

// AX-53: while the axis is Disabled only, on analogue drives only.
TEST(DirectOutput, IsForDisabledAnalogueAxes) {
  AxisParams p = LinearParams();
  Rig csp(p);
  EXPECT_EQ(ErrorOf(csp, DirectOutput{1}), ErrorId::kState);
  p.drive.mode = DriveMode::kAnalog;
  Rig rig(p);
  EXPECT_EQ(ErrorOf(rig, DirectOutput{2.5}), ErrorId::kNone);
  EXPECT_EQ(rig.commanded.voltage_v, 2.5);
  rig.Run(0.01);
  EXPECT_TRUE(rig.commanded.enable);
  EXPECT_TRUE(rig.commanded.release_brake);  // the drive is ready and holds the load
  EXPECT_EQ(ErrorOf(rig, DirectOutput{0}), ErrorId::kNone);
  EXPECT_FALSE(rig.commanded.enable);
  EXPECT_FALSE(rig.commanded.release_brake);
  EXPECT_EQ(ErrorOf(rig, DirectOutput{10.1}), ErrorId::kParameter);
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_NEAR(rig.commanded.voltage_v, 0, 0.01);
  EXPECT_EQ(ErrorOf(rig, DirectOutput{1}), ErrorId::kPowerOn);
  EXPECT_TRUE(rig.RunToEnd(rig.Give(Power{.enable = false})));
  rig.Run(0.01);
  EXPECT_EQ(rig.commanded.voltage_v, 0);  // not the old one again
}

// GT_Pulse: so many cycles, then 0 V.
TEST(PulseOutput, LastsAsLongAsItSays) {
  AxisParams p = LinearParams();
  p.drive.mode = DriveMode::kAnalog;
  Rig rig(p);
  rig.Step();
  const Ticket pulse = rig.Give(PulseOutput{.voltage = -2.5, .duration = 0.007});
  for (int i = 0; i < 7; ++i) {
    rig.Step();
    EXPECT_EQ(rig.commanded.voltage_v, -2.5) << i;
    EXPECT_FALSE(rig.Ended(pulse));
  }
  rig.Step();
  EXPECT_EQ(rig.commanded.voltage_v, 0);
  EXPECT_TRUE(rig.lives[pulse].done);
  const Ticket shortest = rig.Give(PulseOutput{.voltage = 1, .duration = 1e-9});
  rig.Step();
  EXPECT_EQ(std::round(rig.commanded.voltage_v), 1);
  rig.Step();
  EXPECT_EQ(rig.commanded.voltage_v, 0);
  EXPECT_TRUE(rig.lives[shortest].done);
}

// ... and is cut off by another output, a fault, power on.
TEST(PulseOutput, IsCutOff) {
  AxisParams p = LinearParams();
  EXPECT_EQ(ErrorOf(*std::make_unique<Rig>(p), PulseOutput{.voltage = 1, .duration = 1}), ErrorId::kState);
  p.drive.mode = DriveMode::kAnalog;
  Rig rig(p);
  rig.Step();
  const auto is_cut_off_by = [&](const auto& what) {
    const Ticket pulse = rig.Give(PulseOutput{.voltage = 5, .duration = 1});
    rig.Run(0.1);
    EXPECT_EQ(rig.commanded.voltage_v, 5);
    what();
    rig.Run(0.002);
    return rig.lives[pulse].aborted;
  };
  EXPECT_TRUE(is_cut_off_by([&] { rig.Give(DirectOutput{.voltage = 5}); }));
  EXPECT_EQ(rig.commanded.voltage_v, 5);
  rig.Run(2);
  EXPECT_EQ(rig.commanded.voltage_v, 5);
  EXPECT_TRUE(is_cut_off_by([&] { rig.Give(PulseOutput{.voltage = 0, .duration = 0.01}); }));
  EXPECT_EQ(rig.commanded.voltage_v, 0);
  EXPECT_TRUE(is_cut_off_by([&] { Fail(rig.Now(), ErrorId::kOverrun, false, rig.state); }));
  EXPECT_EQ(rig.commanded.voltage_v, 0);
  EXPECT_TRUE(rig.RunToEnd(rig.Give(Reset{})));
  EXPECT_TRUE(is_cut_off_by([&] { rig.Give(Power{}); }));
  rig.Run(0.1);
  EXPECT_EQ(ErrorOf(rig, PulseOutput{.voltage = 1, .duration = 1}), ErrorId::kPowerOn);
}

// AX-29: only the numbers change.
TEST(SetPosition, MovesNothing) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 10}));
  const double counts = rig.commanded.position_counts;
  EXPECT_EQ(ErrorOf(rig, SetPosition{.position = 100}), ErrorId::kNone);
  EXPECT_EQ(rig.out.set_position, 100);
  EXPECT_NEAR(rig.out.actual_position, 100, 1e-5);
  EXPECT_NEAR(rig.out.following_error, 0, 1e-5);
  EXPECT_EQ(rig.commanded.position_counts, counts);
  EXPECT_EQ(ErrorOf(rig, SetPosition{.position = -1, .relative = true}), ErrorId::kNone);
  EXPECT_EQ(rig.out.set_position, 99);
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 0}));
  EXPECT_NEAR(rig.commanded.position_counts, counts - 99e6, 1);
}

// In motion: on to where it went, by its new name; without a step.
TEST(SetPosition, LeavesAMotionAsItIs) {
  Rig rig(LinearParams());
  Rig twin(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(twin.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 100});
  twin.Give(MoveAbsolute{.position = 100});
  rig.Run(0.1);
  twin.Run(0.1);
  rig.Give(SetPosition{.position = 1000, .relative = true});
  while (!rig.Ended(move)) {
    rig.Step();
    twin.Step();
    ASSERT_NEAR(rig.position(), twin.position() + 1000, 1e-9);
    ASSERT_EQ(rig.out.set_velocity, twin.out.set_velocity);
  }
  EXPECT_EQ(rig.position(), 1100);
}

TEST(SetPosition, KeepsTheSoftLimits) {
  AxisParams p = LinearParams();
  p.limits.upper = 100;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_EQ(ErrorOf(rig, SetPosition{.position = 101}), ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.position(), 0);
  const Ticket move = rig.Give(MoveAbsolute{.position = 90});
  rig.Run(0.05);
  EXPECT_EQ(ErrorOf(rig, SetPosition{.position = 11, .relative = true}), ErrorId::kTargetBehindLimit);
  EXPECT_TRUE(rig.RunToEnd(move));
  EXPECT_EQ(rig.position(), 90);
  rig.Give(Stop{.hold = true});
  rig.Step();
  EXPECT_EQ(ErrorOf(rig, SetPosition{.position = 0}), ErrorId::kState);
}

// On a rotary axis positions stay within a turn.
TEST(SetPosition, KnowsTurns) {
  Rig rig(RotaryParams());
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_EQ(ErrorOf(rig, SetPosition{.position = 350}), ErrorId::kNone);
  EXPECT_EQ(ErrorOf(rig, SetPosition{.position = 361}), ErrorId::kParameter);
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 10}));
  EXPECT_NEAR(rig.out.set_position, 10, 1e-9);
  EXPECT_NEAR(rig.commanded.position_counts, 20e6, 1);
}

}  // namespace
}  // namespace takt::axis
