// Between motor and load (AX-115), distance-coded marks and digital outputs (AX-111), against the simulated servo.
#include "homing_bench.h"

namespace takt::axis {
namespace {

// AX-111: from anywhere, either way, on scales and encoders either way round, the axis knows where its load is.
TEST(DistanceCoded, TwoMarksTellThePosition) {
  for (const bool reversed : {false, true}) {
    for (const bool invert : {false, true}) {
      for (const double start : {-61.234, 0.0, 17.3}) {
        for (const HomingDirection direction : {HomingDirection::kPositive, HomingDirection::kNegative}) {
          Bench bench(start);
          const double origin = reversed ? 300 : -300;
          bench.servo.encoder.index_distance = 20;
          bench.servo.encoder.index_step = 0.02;
          bench.servo.encoder.index_offset = origin;
          bench.servo.encoder.index_reversed = reversed;
          bench.servo.encoder.inverted = bench.params.encoder.invert = invert;
          bench.params.encoder.coded_marks = {.distance = 20, .step = 0.02, .position = origin, .reversed = reversed};
          bench.On();
          const Ticket ticket = bench.Give(StepDistanceCoded{.direction = direction, .velocity = 50});
          ASSERT_TRUE(bench.RunToEnd(ticket));
          EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
          EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
          EXPECT_TRUE(bench.seen.homed);
          bench.Run(0.1);
          EXPECT_NEAR(bench.seen.actual_position, bench.place(), 3e-4) << start << reversed << invert;
          EXPECT_LT(std::abs(bench.place() - start), 40);
        }
      }
    }
  }
}

// AX-111: marks that are as far apart as no neighbours are end the search; so do its limits; an encoder has to have
// them.
TEST(DistanceCoded, WhatIsNoCodeIsNotBelieved) {
  Bench bench(0);
  bench.On();
  Ticket ticket = bench.Give(StepDistanceCoded{.velocity = 50});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[ticket].error, ErrorId::kNoCodedMarks);
  bench.params.encoder.coded_marks = {.distance = 20, .step = 0.02};  // the marks are 10 apart
  ticket = bench.Give(StepDistanceCoded{.velocity = 50});
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].error, ErrorId::kMarkDistance);
  EXPECT_FALSE(bench.seen.homed);
  bench.Run(0.5);
  EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
  ticket = bench.Give(StepDistanceCoded{.velocity = 5, .distance_limit = 1});
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].error, ErrorId::kDistanceLimit);
}

// AX-111: the code itself, for each pair and both ways round.
TEST(DistanceCoded, EachPairHasItsCode) {
  for (const bool reversed : {false, true}) {
    const CodedMarks marks{.distance = 20, .step = 0.5, .position = 7, .reversed = reversed};
    const double sense = reversed ? -1 : 1;
    double before = 1000;  // of an unknown origin
    double at = 7;
    for (int k = 0; k < 19; ++k) {
      for (const double way : {10 + (k + 1) * 0.5, 10 - (k + 1) * 0.5}) {
        const double mark = before + sense * way;
        at += sense * way;
        ASSERT_TRUE(MarkPosition(marks, before, mark));
        EXPECT_NEAR(*MarkPosition(marks, before, mark), at, 1e-9);
        EXPECT_NEAR(*MarkPosition(marks, mark, before), at - sense * way, 1e-9);
        before = mark;
      }
    }
    for (const double apart : {10.0, 20.0, 10.3, 25.0, 0.0, 9.74}) EXPECT_FALSE(MarkPosition(marks, 0, apart)) << apart;
  }
}

struct LoadBench : Bench {
  explicit LoadBench(DriveMode mode) : Bench(0) {
    params.drive.mode = mode;
    servo.switches = {};
  }
  // How far the load is from where it is to be, at places reached gently from below and from above.
  double WorstError(double most = 90) {
    double worst = 0;
    for (const double target : {0.5 * most, most, 0.3 * most, -0.2 * most, 0.1 * most, 0.0}) {
      const Ticket ticket = Give(
          MoveAbsolute{.position = target, .velocity = 150, .acceleration = 500, .deceleration = 500, .jerk = 5000});
      EXPECT_TRUE(RunToEnd(ticket));
      Run(0.4);
      worst = std::max(worst, std::abs(place() - target));
    }
    return worst;
  }
};

// AX-115: without, the load is half of it behind either way; with, where it shall be.
TEST(Compensation, OfBacklash) {
  for (const DriveMode mode : {DriveMode::kCyclicPosition, DriveMode::kCyclicVelocity}) {
    for (const double made_up : {0.0, 0.5}) {
      LoadBench bench(mode);
      bench.servo.mechanics.backlash = 0.5;
      bench.params.compensation.backlash = made_up;
      bench.On();
      EXPECT_NEAR(bench.WorstError(), made_up > 0 ? 0 : 0.25, 0.006);
    }
  }
}

// AX-115: the motor goes through it with the velocity of the compensation and the acceleration of the axis, no further,
// whatever it is.
TEST(Compensation, KeepsItsVelocityAndAcceleration) {
  for (const double velocity : {0.7, 10.0, 13.0, 37.3, 400.0}) {
    for (const double play : {0.001, 0.0123, 0.5}) {
      LoadBench bench(DriveMode::kCyclicPosition);
      bench.params.compensation = {.backlash = play, .screw = {}, .velocity = velocity};
      bench.On();
      ASSERT_TRUE(bench.RunToEnd(bench.Give(MoveAbsolute{.position = 200, .velocity = 100})));
      EXPECT_NEAR(bench.seen.encoder_correction, play / 2, 1e-9);
      const Ticket back = bench.Give(MoveAbsolute{.position = 0, .velocity = 100});
      double before = bench.seen.encoder_correction, rate_before = 0;
      for (int i = 0; i < 5000 && !IsFinal(bench.last[back].state); ++i) {
        bench.Step();
        const double rate = (bench.seen.encoder_correction - before) / bench.cycle.period_s;
        ASSERT_LE(std::abs(rate), velocity + 1e-6);
        ASSERT_LE(std::abs(rate - rate_before), 5 + 1e-6);
        ASSERT_GE(bench.seen.encoder_correction, -play / 2 - 1e-9);
        before = bench.seen.encoder_correction;
        rate_before = rate;
      }
      EXPECT_NEAR(before, -play / 2, 1e-9);
    }
  }
}

// AX-115: errors of the screw count from the reference on.
TEST(Compensation, OfTheScrew) {
  LoadBench bench(DriveMode::kCyclicPosition);
  bench.servo.mechanics.backlash = 0.2;
  bench.servo.mechanics.screw = {{-50, 0.02}, {0, 0}, {40, 0.08}, {100, -0.05}};
  bench.params.compensation.backlash = 0.2;
  bench.params.compensation.screw = {{-50, 0.02}, {0, 0}, {40, 0.08}, {100, -0.05}};
  bench.On();
  EXPECT_GT(bench.WorstError(), 0.03);
  ASSERT_TRUE(bench.RunToEnd(bench.Give(StepDirect{.set_position = 0})));
  bench.Run(0.1);
  EXPECT_LT(bench.WorstError(), 0.003);
  EXPECT_LT(std::abs(bench.seen.following_error), 0.001);
}

// AX-115: an encoder on the load is where the axis is, whatever lies between.
TEST(LoadEncoder, ClosesTheLoop) {
  LoadBench bench(DriveMode::kCyclicVelocity);
  bench.servo.mechanics.backlash = 0.1;
  bench.servo.mechanics.screw = {{-50, 0.02}, {0, 0}, {40, 0.08}, {100, -0.05}};
  bench.params.load_encoder = Encoder{.increments_per_unit = 20000, .invert = true};
  bench.servo.load_encoder = plant::ServoEncoder{.increments_per_unit = 20000, .inverted = true};
  bench.On();
  EXPECT_LT(bench.WorstError(), 0.02);
  EXPECT_NEAR(bench.seen.actual_position, bench.place(), 1e-4);
}

// AX-115: a coupling that slips opens the loop, an error of either encoder too; reset takes both as they are then.
TEST(LoadEncoder, IsWatched) {
  LoadBench bench(DriveMode::kCyclicVelocity);
  bench.servo.mechanics.backlash = 1;
  bench.params.load_encoder = Encoder{.increments_per_unit = 20000};
  bench.servo.load_encoder = plant::ServoEncoder{.increments_per_unit = 20000};
  bench.params.supervision.encoders_apart = 0.3;
  bench.On();
  Ticket move = bench.Give(MoveAbsolute{.position = 50});
  ASSERT_TRUE(bench.RunToEnd(move));
  EXPECT_EQ(bench.last[move].error, ErrorId::kEncodersApart);
  EXPECT_FALSE(bench.seen.loop_closed);
  bench.Run(0.2);
  ASSERT_TRUE(bench.RunToEnd(bench.Give(Reset{})));
  ASSERT_TRUE(bench.RunToEnd(bench.Give(Power{})));
  move = bench.Give(MoveAbsolute{.position = 50});
  ASSERT_TRUE(bench.RunToEnd(move));
  EXPECT_EQ(bench.last[move].state, FeedbackState::kDone);
  bench.in.load_encoder_error = true;
  bench.Step();
  EXPECT_EQ(bench.seen.error, ErrorId::kEncoder);
  EXPECT_FALSE(bench.seen.loop_closed);
}

// AX-111: each output by itself; what there is not is refused.
TEST(Outputs, AreWrittenAndStay) {
  Bench bench(0);
  bench.On();
  ASSERT_TRUE(bench.RunToEnd(bench.Give(WriteOutput{32, true})));
  ASSERT_TRUE(bench.RunToEnd(bench.Give(WriteOutput{2, true})));
  EXPECT_EQ(bench.seen.digital_outputs, 0x80000002U);
  EXPECT_EQ(bench.out.digital_outputs, 0x80000002U);
  ASSERT_TRUE(bench.RunToEnd(bench.Give(WriteOutput{2, false})));
  EXPECT_EQ(bench.seen.digital_outputs, 0x80000000U);
  for (const int number : {0, 33, -1}) {
    const Ticket ticket = bench.Give(WriteOutput{number, true});
    ASSERT_TRUE(bench.RunToEnd(ticket));
    EXPECT_EQ(bench.last[ticket].state, FeedbackState::kError);
  }
  EXPECT_EQ(bench.seen.digital_outputs, 0x80000000U);
}

}  // namespace
}  // namespace takt::axis
