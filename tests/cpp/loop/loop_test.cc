// AX-80 and AX-85 together: encoder, position loop and simulated servo, wired as an axis wires them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "takt/axis/control_loop.h"
#include "takt/axis/encoder.h"
#include "takt/plant/servo.h"

namespace takt {
namespace {

struct Axis {
  axis::Encoder encoder;
  axis::ControlLoop loop;
  plant::ServoParams plant;
  DriveMode mode = DriveMode::kAnalog;

  Cycle cycle;
  axis::EncoderState encoder_state;
  axis::EncoderOutputs measured;
  axis::ControlLoopState loop_state;
  plant::ServoState servo;
  ServoInputs wires_in;
  bool invert = false;

  void Start() { servo = plant::MakeServoState(plant); }

  void Step(double position, double velocity) {
    axis::Step(encoder, {.counts = wires_in.counts, .error = wires_in.encoder_error}, cycle, encoder_state, measured);
    axis::ControlLoopOutputs out;
    axis::Step(loop,
               {.mode = mode,
                .closed = wires_in.drive_ready,
                .invert = invert,
                .model_position = position,
                .model_velocity = velocity,
                .feedback = measured.position},
               cycle, loop_state, out);
    const ServoOutputs wires_out{.position_counts = (invert ? -1 : 1) * axis::CountsAt(encoder, position),
                                 .velocity_counts_s = axis::CountRateAt(encoder, out.velocity),
                                 .voltage_v = out.voltage_v,
                                 .mode = mode,
                                 .enable = true,
                                 .release_brake = wires_in.drive_ready};
    plant::Step(plant, wires_out, cycle.period_s, servo, wires_in);
    ++cycle.count;
  }
  void Stand(double position, double seconds) {
    for (double t = 0; t < seconds; t += cycle.period_s) Step(position, 0);
  }
};

// A drive without load compensation of its own, as an analogue one with a proportional velocity loop.
plant::ServoParams PlainDrive() {
  plant::ServoParams p;
  p.drive.velocity_time_constant_s = 0.002;
  p.drive.load_compensation_s = 0;
  return p;
}

TEST(Loop, LoadLeavesAnErrorThatOnlyKiTakesAway) {  // AX-80, AX-85
  Axis axis;
  axis.plant = PlainDrive();
  axis.plant.mechanics.load_torque = 2;  // 2 Nm * 2 ms / 0.0001 = 40 u/s of droop
  axis.Start();
  axis.Stand(5, 3);
  EXPECT_NEAR(axis.servo.motor_position, 5 - 40 * 0.001 / axis.loop.kp, 0.01) << "40 u/s over a gain of 50 1/s";
  axis.loop.ki = 0.001;
  axis.Stand(5, 3);
  // The converter's step is 0.24 u/s: with it the axis cannot stand still to better than a few counts.
  EXPECT_NEAR(axis.servo.motor_position, 5, 0.005);
}

TEST(Loop, StepIsReachedWithoutOvershootOnBothKindsOfSpeedDrive) {  // AX-81
  for (const DriveMode mode : {DriveMode::kAnalog, DriveMode::kCyclicVelocity}) {
    Axis axis;
    axis.plant = PlainDrive();
    axis.mode = mode;
    axis.Start();
    axis.Stand(0, 0.2);
    double highest = 0;
    for (int k = 0; k < 1000; ++k) {
      axis.Step(1, 0);
      highest = std::max(highest, axis.servo.motor_position);
    }
    EXPECT_LT(highest, 1.002);
    EXPECT_NEAR(axis.servo.motor_position, 1, 0.002);
  }
}

TEST(Loop, InvertedWiringIsPutRightByInvertedSenses) {  // AX-03, AX-81
  for (const DriveMode mode : {DriveMode::kAnalog, DriveMode::kCyclicVelocity, DriveMode::kCyclicPosition}) {
    for (const bool encoder : {false, true}) {
      for (const bool drive : {false, true}) {
        Axis axis;
        axis.mode = mode;
        axis.plant = PlainDrive();
        axis.plant.encoder.inverted = axis.encoder.invert = encoder;
        axis.plant.drive.inverted = axis.invert = drive;
        axis.Start();
        axis.Stand(3, 2);
        EXPECT_NEAR(axis.servo.motor_position, 3, 0.002) << static_cast<int>(mode) << encoder << drive;
      }
    }
  }
}

TEST(Loop, OffsetAndDeadBandOfTheDriveAreMadeUpFor) {  // AX-80
  const auto error = [](bool compensated) {
    Axis axis;
    axis.plant = PlainDrive();
    axis.plant.drive.offset_mv = 60;
    axis.plant.drive.dead_band_plus_mv = 100;
    axis.plant.drive.dead_band_minus_mv = 100;
    if (compensated) {
      axis.loop.offset_mv = -60;
      axis.loop.dead_band_plus_mv = axis.loop.dead_band_minus_mv = 98;
    }
    axis.Start();
    axis.Stand(2, 3);
    return std::abs(axis.servo.motor_position - 2);
  };
  EXPECT_GT(error(false), 0.05);
  EXPECT_LT(error(true), 0.01);
}

TEST(Loop, FeedForwardTakesTheLagAway) {  // AX-80
  for (const double ff : {0.0, 1.0}) {
    Axis axis;
    axis.plant = PlainDrive();
    axis.loop.ff = ff;
    axis.Start();
    axis.Stand(0, 0.5);
    for (int k = 1; k <= 1000; ++k) axis.Step(0.1 * k, 100);
    // v / Kv = 2 u without it.
    EXPECT_NEAR(axis.loop_state.error, ff > 0 ? 0 : 2, 0.02) << ff;
  }
}

TEST(Loop, AbsoluteGrayEncoderClosesTheLoopOverItsWrap) {  // AX-04
  Axis axis;
  axis.plant = PlainDrive();
  axis.encoder = {.type = axis::EncoderType::kAbsoluteSsi, .ssi_bits = 12, .coding = axis::SsiCoding::kGray};
  axis.plant.encoder.type = plant::ServoEncoderType::kAbsolute;
  axis.plant.encoder.coding = plant::ServoEncoderCoding::kGray;
  axis.plant.encoder.ssi_bits = 12;
  axis.Start();
  axis.Stand(0, 0.5);
  for (int k = 1; k <= 2000; ++k) axis.Step(0.01 * k, 10);  // 20 u: nearly five turns of 4.096 u
  axis.Stand(20, 1);
  EXPECT_NEAR(axis.servo.motor_position, 20, 0.002);
}

}  // namespace
}  // namespace takt
