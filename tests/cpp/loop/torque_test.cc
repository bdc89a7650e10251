// AX-42 on the simulated drive.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "machine_rig.h"

namespace takt {
namespace {

using axis::TorqueControl;

MachineRig Machine(DriveMode mode = DriveMode::kCyclicPosition) {
  axis::AxisParams axis = StandardAxis();
  axis.drive.mode = mode;
  return {axis, StandardServo(axis)};
}

TEST(Torque, PressesAgainstAStop) {  // AX-42
  MachineRig rig = Machine();
  rig.servo_params.mechanics.upper_stop = 5;
  ASSERT_TRUE(rig.PowerOn());
  const Ticket press = rig.Give(TorqueControl{.torque = 4, .torque_ramp = 20, .velocity = 50});
  rig.Step();
  const auto start = rig.cycle.count;
  ASSERT_TRUE(rig.RunUntil([&] {
    EXPECT_LE(rig.servo.velocity, 50 * (1 + 1e-6));
    return rig.reached[press];
  }));
  EXPECT_NEAR(static_cast<double>(rig.cycle.count - start) * 0.001, 0.2, 0.0021) << "4 Nm at 20 Nm/s";
  ASSERT_TRUE(rig.RunUntil([&] { return rig.servo.load_position == 5; }));
  rig.Run(0.1);
  EXPECT_NEAR(rig.out.torque_nm, 4, 1e-9);
  EXPECT_EQ(rig.out.state, axis::PlcState::kContinuousMotion);
  EXPECT_FALSE(IsFinal(rig.ends[press].state));
}

TEST(Torque, AcceleratesAsTheTorqueSays) {  // AX-42
  MachineRig rig = Machine(DriveMode::kCyclicVelocity);
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(TorqueControl{.torque = -2});
  rig.Run(0.05);
  const double begin = rig.servo.velocity;
  rig.Run(0.05);
  // 2 Nm / 0.001 Nm s²/u, which is less than the axis' acceleration; before that its jerk limits it.
  EXPECT_NEAR(rig.servo.velocity - begin, -2000 * 0.05, 1e-6);
}

TEST(Torque, SpeedStaysBelowItsLimitWhateverPushes) {  // AX-42
  std::mt19937 random(42);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int run = 0; run < 100; ++run) {
    MachineRig rig = Machine(run % 2 == 0 ? DriveMode::kCyclicPosition : DriveMode::kCyclicVelocity);
    ASSERT_TRUE(rig.PowerOn());
    const double velocity = between(5, 500);
    rig.Give(TorqueControl{.torque = between(-9, 9), .velocity = velocity});
    double fastest = 0;
    for (int k = 0; k < 1000; ++k) {
      if (k % 200 == 50) rig.servo.faults.extra_load = between(-2, 2);
      if (k % 200 == 150) rig.Give(TorqueControl{.torque = between(-9, 9), .velocity = velocity});
      rig.Step();
      fastest = std::max(fastest, std::abs(rig.servo.velocity));
    }
    // A load of 2 Nm pushes the drive's velocity loop (1 ms) off by 2 / 0.001 * 0.001 = 2 u/s until it has learnt it;
    // one that turns round by twice that.
    EXPECT_LE(fastest, velocity + 4 + 1e-6) << run;
  }
}

TEST(Torque, SaysWhenTheSpeedHoldsTheTorqueBack) {  // AX-42
  MachineRig rig = Machine();
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(TorqueControl{.torque = 1, .velocity = 100});
  rig.Run(0.05);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
  rig.Run(1);
  EXPECT_NEAR(rig.servo.velocity, 100, 0.01);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kVelocity);
}

TEST(Torque, WhatComesNextStartsFromWhereTheAxisIs) {  // AX-42
  for (const DriveMode mode : {DriveMode::kCyclicPosition, DriveMode::kCyclicVelocity}) {
    for (const double seconds : {0.02, 0.1, 0.5}) {
      MachineRig rig = Machine(mode);
      ASSERT_TRUE(rig.PowerOn());
      const Ticket torque = rig.Give(TorqueControl{.torque = 2, .velocity = 200});
      rig.Run(seconds);
      const Ticket halt = rig.Give(axis::Halt{.deceleration = 2000});
      const KinematicState was{rig.servo.motor_position, rig.servo.velocity, 0};
      rig.Step();
      EXPECT_EQ(rig.ends[torque].state, FeedbackState::kAborted);
      // The set point is due one cycle later; what is measured is the mean of the cycle before, 2000 u/s² * 0.5 ms
      // less; and the drive's velocity loop (1 ms) lags behind the ramp.
      EXPECT_NEAR(rig.state.setpoint.position, was.position + was.velocity * 0.001, 0.009);
      EXPECT_NEAR(rig.state.setpoint.velocity, was.velocity, 2000 * 0.0017);
      KinematicState before = rig.state.setpoint;
      double last_velocity = rig.servo.velocity;
      ASSERT_TRUE(rig.RunUntil([&] {
        const KinematicState& now = rig.state.setpoint;
        EXPECT_LE(std::abs(now.acceleration - before.acceleration), 100 * (1 + 1e-6));
        EXPECT_GE(now.acceleration, -2000 * (1 + 1e-9));
        before = now;
        EXPECT_LT(std::abs(rig.servo.velocity - last_velocity), 6) << "no jerk in the metal";
        last_velocity = rig.servo.velocity;
        return IsFinal(rig.ends[halt].state);
      }));
      EXPECT_TRUE(rig.Done(halt));
    }
  }
}

TEST(Torque, StopsInsideTheSoftLimits) {  // AX-42
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int run = 0; run < 60; ++run) {
    MachineRig rig = Machine(run % 2 == 0 ? DriveMode::kCyclicPosition : DriveMode::kCyclicVelocity);
    rig.params.limits.upper = 80;
    rig.params.limits.lower = -80;
    ASSERT_TRUE(rig.PowerOn());
    const double torque = between(0.2, 9.5) * (run % 3 == 0 ? -1 : 1);  // up to twice the axis' own acceleration
    const Ticket command = rig.Give(TorqueControl{.torque = torque, .velocity = between(20, 500)});
    ASSERT_TRUE(rig.RunUntil([&] {
      EXPECT_LE(std::abs(rig.state.setpoint.position), 80 + 1e-6);
      EXPECT_LE(std::abs(rig.servo.motor_position), 80.05);
      return rig.out.state == axis::PlcState::kErrorStop && rig.state.setpoint.velocity == 0;
    }));
    EXPECT_EQ(rig.out.error, torque > 0 ? ErrorId::kSoftLimitPositive : ErrorId::kSoftLimitNegative);
    EXPECT_EQ(rig.ends[command].state, FeedbackState::kError);
    EXPECT_GT(std::abs(rig.state.setpoint.position), 70) << "not too early: " << torque;
  }
}

TEST(Torque, BufferedCommandTakesOverWhenTheTorqueIsReached) {  // AX-42
  MachineRig rig = Machine();
  ASSERT_TRUE(rig.PowerOn());
  const Ticket torque = rig.Give(TorqueControl{.torque = 2, .torque_ramp = 10, .velocity = 20});
  rig.Step();
  const Ticket move = rig.Give(axis::MoveAbsolute{.position = 30, .buffer_mode = axis::BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunUntil([&] { return rig.ends[torque].state == FeedbackState::kAborted; }));
  rig.Step();
  EXPECT_NEAR(rig.out.following_error, 0, 0.002) << "a lost cycle would be 20 u/s * 1 ms";
  KinematicState before = rig.state.setpoint;
  rig.Step();
  ASSERT_TRUE(rig.RunUntil([&] {
    const KinematicState& now = rig.state.setpoint;
    EXPECT_NEAR(now.position - before.position, (before.velocity + now.velocity) / 2 * 0.001, 0.001);
    before = now;
    return IsFinal(rig.ends[move].state);
  }));
  EXPECT_TRUE(rig.Done(move));
  EXPECT_TRUE(rig.reached[torque]);
  EXPECT_EQ(rig.ends[torque].state, FeedbackState::kAborted);
  EXPECT_NEAR(rig.servo.motor_position, 30, 0.01);
}

TEST(Torque, FaultsEndIt) {  // AX-42
  MachineRig rig = Machine();
  ASSERT_TRUE(rig.PowerOn());
  const Ticket torque = rig.Give(TorqueControl{.torque = 2, .velocity = 20});
  rig.Run(0.1);
  rig.wires_in.limit_positive = true;
  rig.Step();
  EXPECT_EQ(rig.out.error, ErrorId::kLimitSwitchPositive);
  EXPECT_EQ(rig.ends[torque].error, ErrorId::kLimitSwitchPositive);
  EXPECT_EQ(rig.wires_out.mode, DriveMode::kCyclicPosition);
  EXPECT_EQ(rig.wires_out.torque_nm, 0);
}

TEST(Torque, InvertedDriveIsToldTheOppositeTorque) {  // AX-42, AX-03
  axis::AxisParams axis = StandardAxis();
  axis.drive.invert = true;
  plant::ServoParams servo = StandardServo(axis);
  servo.drive.inverted = true;
  MachineRig rig(axis, servo);
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(TorqueControl{.torque = 2, .velocity = 20});
  rig.Run(0.5);
  EXPECT_LT(rig.wires_out.torque_nm, 0);
  EXPECT_NEAR(rig.servo.velocity, 20, 0.1);
}

TEST(Torque, RefusedWhereItCannotBe) {  // AX-42
  MachineRig analogue = Machine(DriveMode::kAnalog);
  ASSERT_TRUE(analogue.PowerOn());
  const Ticket no_input = analogue.Give(TorqueControl{.torque = 1});
  analogue.Step();
  EXPECT_EQ(analogue.ends[no_input].error, ErrorId::kState);
  MachineRig rig = Machine();
  ASSERT_TRUE(rig.PowerOn());
  const Ticket too_fast = rig.Give(TorqueControl{.torque = 1, .velocity = 501});
  rig.Step();
  EXPECT_EQ(rig.ends[too_fast].error, ErrorId::kParameter);
}

}  // namespace
}  // namespace takt
