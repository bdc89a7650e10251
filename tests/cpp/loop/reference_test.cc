// The reference of an axis: taken on the spot, in passing, needed and lost (AX-64 to AX-68, AX-71).
#include "homing_bench.h"

namespace takt::axis {
namespace {

// AX-64, AX-65, AX-71.
TEST(Reference, IsTakenOnTheSpotAndIsNeeded) {
  Bench bench(7);
  bench.params.requires_reference = true;
  bench.On();
  const Ticket early = bench.Give(MoveAbsolute{.position = 1});
  const Ticket relative = bench.Give(MoveRelative{.distance = 1});
  ASSERT_TRUE(bench.RunToEnd(relative));
  EXPECT_EQ(bench.last[early].error, ErrorId::kNoReference);
  EXPECT_EQ(bench.last[relative].state, FeedbackState::kDone);
  const Ticket absolute = bench.Give(StepAbsolute{});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[absolute].error, ErrorId::kState);  // no absolute encoder
  const Ticket direct = bench.Give(StepDirect{.set_position = 50});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[direct].state, FeedbackState::kDone);
  EXPECT_EQ(bench.seen.set_position, 50);
  EXPECT_TRUE(bench.seen.homed);
  ASSERT_TRUE(bench.RunToEnd(bench.Give(MoveAbsolute{.position = 48})));
  bench.Run(0.1);
  EXPECT_NEAR(bench.place(), 6, 0.001);
  bench.plant.faults.encoder_error = true;  // a lost signal loses the reference
  bench.Run(0.01);
  EXPECT_FALSE(bench.seen.homed);
}

TEST(Reference, IsLostWithAJumpOfTheEncoder) {  // AX-71
  Bench bench(7);
  bench.On();
  bench.Give(StepDirect{});
  bench.Run(0.01);
  ASSERT_TRUE(bench.seen.homed);
  bench.in.counts += 1000000;  // 100 mm in a cycle
  bench.Step();
  EXPECT_FALSE(bench.seen.homed);
  EXPECT_EQ(bench.seen.error, ErrorId::kEncoder);
}

TEST(Reference, ComesFromAnAbsoluteEncoder) {  // AX-65
  Bench bench(7);
  bench.params.encoder.type = EncoderType::kAbsoluteSsi;
  bench.params.requires_reference = true;
  bench.servo.encoder.type = plant::ServoEncoderType::kAbsolute;
  bench.On();
  EXPECT_TRUE(bench.seen.homed);
  EXPECT_NEAR(bench.seen.actual_position, 7, 0.001);
  bench.Give(SetPosition{.position = 100});
  const Ticket step = bench.Give(StepAbsolute{});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[step].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.seen.set_position, 7, 0.001);
}

// AX-66: moves off, and ends homing; not without a step before.
TEST(FinishHoming, MovesOff) {
  Bench bench(0);
  bench.On();
  const Ticket early = bench.Give(FinishHoming{});
  bench.Run(0.01);
  EXPECT_EQ(bench.last[early].error, ErrorId::kState);
  StepAbsSwitch step;
  step.direction = HomingDirection::kPositive;
  step.velocity = 50;
  step.set_position = 0;
  bench.Give(step);
  FinishHoming finish;
  finish.distance = -5;
  finish.velocity = 10;
  finish.buffer_mode = BufferMode::kBuffered;
  const Ticket ticket = bench.Give(finish);
  const Ticket move = bench.Give(MoveAbsolute{.position = 1, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_NEAR(bench.seen.set_position, -5, 1e-6);
  EXPECT_NEAR(bench.place(), 5, 0.1);
  ASSERT_TRUE(bench.RunToEnd(move));
  EXPECT_EQ(bench.last[move].state, FeedbackState::kDone);
}

// AX-67, AX-13: a reference taken in passing may show that a move leads out of the SW limits; then it does not go
// there.
TEST(Flying, DoesNotLeadOutOfTheLimits) {
  Bench bench(-50);
  bench.params.limits.upper = 200;
  bench.On();
  const Ticket move = bench.Give(MoveRelative{.distance = 110, .velocity = 100});  // to 110: inside, as far as is known
  const Ticket reference = bench.Give(StepRefFlyingSwitch{.set_position = 160});  // where REF begins, 50 before the end
  ASSERT_TRUE(bench.RunToEnd(move));
  bench.Run(0.5);
  EXPECT_EQ(bench.last[reference].state, FeedbackState::kDone);
  EXPECT_EQ(bench.last[move].error, ErrorId::kSoftLimitPositive);
  EXPECT_EQ(bench.state.plc, PlcState::kErrorStop);
  EXPECT_LT(bench.seen.set_position, 200);
}

// AX-67, AX-68: in passing; the motion goes on to where it went.
TEST(Flying, TakesTheReferenceInPassing) {
  for (const bool pulse : {false, true}) {
    Bench bench(-5);
    bench.On();
    const Ticket move = bench.Give(MoveRelative{.distance = 60, .velocity = 100});
    StepRefFlyingSwitch by_switch;
    by_switch.set_position = 200;
    StepRefFlyingRefPulse by_pulse;
    by_pulse.set_position = 200;
    const Ticket reference = pulse ? bench.Give(by_pulse) : bench.Give(by_switch);
    ASSERT_TRUE(bench.RunToEnd(move));
    EXPECT_EQ(bench.last[move].state, FeedbackState::kDone);
    EXPECT_EQ(bench.last[reference].state, FeedbackState::kDone);
    EXPECT_TRUE(bench.seen.homed);
    bench.Run(0.1);
    EXPECT_NEAR(bench.place(), 55, 0.001);
    EXPECT_NEAR(bench.seen.actual_position - 200, bench.place() - (pulse ? 3 : 10), pulse ? 0.0003 : 0.11);
  }
}

// AX-106: it does not stay armed: a newer reference ends it, a halt or a stop where that was asked for, and the command
// that is for it. What passes the switch later keeps its numbers.
TEST(Flying, EndsWithANewerReferenceAHaltOrWhenToldTo) {
  struct Case {
    const char* name;
    Command ends;
    bool until_halt, aborted;
  };
  const Case cases[] = {
      {"a reference on the spot", StepDirect{.set_position = 5}, false, true},
      {"a halt", Halt{}, false, false},
      {"a halt that ends it", Halt{}, true, true},
      {"a stop that ends it", Stop{}, true, true},
      {"the command", AbortPassiveHoming{}, false, true},
      {"another number", SetPosition{.position = 5}, false, false},
  };
  for (const bool pulse : {false, true}) {
    for (const Case& c : cases) {
      SCOPED_TRACE(c.name);
      Bench bench(-5);
      bench.On();
      const Command by_pulse = StepRefFlyingRefPulse{.set_position = 300, .until_halt = c.until_halt};
      const Command by_switch = StepRefFlyingSwitch{.set_position = 300, .until_halt = c.until_halt};
      const Ticket flying = bench.Give(pulse ? by_pulse : by_switch);
      bench.Run(0.01);
      const Ticket ends = bench.Give(c.ends);
      bench.Run(0.05);
      EXPECT_EQ(bench.last[ends].state, FeedbackState::kDone);
      EXPECT_EQ(bench.last[flying].state, c.aborted ? FeedbackState::kAborted : FeedbackState::kActive);
      const double begin = bench.seen.set_position;
      ASSERT_TRUE(bench.RunToEnd(bench.Give(MoveRelative{.distance = 60, .velocity = 100})));
      if (c.aborted) {
        EXPECT_NEAR(bench.seen.set_position, begin + 60, 1e-6);
      } else {
        EXPECT_EQ(bench.last[flying].state, FeedbackState::kDone);
        EXPECT_GT(bench.seen.set_position, 300);
      }
    }
  }
}

// AX-64: a rotary axis that brings back its turns between a switch and the way back to it returns to the switch.
TEST(Reference, IsReturnedToWhereTurnsAreBroughtBack) {
  Bench bench(0);
  bench.params.kind = AxisKind::kRotary;
  bench.params.modulus = 0.0201;  // brought back beyond 20.1 mm
  bench.servo.switches.reference.from = 19.9;
  bench.On();
  StepAbsSwitch step;
  step.direction = HomingDirection::kPositive;
  step.switch_mode = SwitchMode::kEdgeOn;
  step.velocity = 50;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_LT(bench.state.setpoint.position, 1) << "its turns have been brought back";
  bench.Run(0.1);
  EXPECT_NEAR(bench.place(), 19.9, 0.1);
}

// AX-49, AX-67: a reference in passing and GT_Touch at one edge: it goes back to where the edge was.
TEST(Flying, TakesItsNumbersWhereATouchGoesBackTo) {
  Bench bench(-5);
  bench.servo.switches.touch_probe.from = 10;
  bench.On();
  bench.Give(MoveVelocity{.velocity = 100});
  bench.Run(0.05);
  const Ticket flying = bench.Give(StepRefFlyingSwitch{.set_position = 200});
  const Ticket touch = bench.Give(Touch{});
  ASSERT_TRUE(bench.RunToEnd(touch, 5));
  EXPECT_EQ(bench.last[flying].state, FeedbackState::kDone);
  EXPECT_EQ(bench.last[touch].state, FeedbackState::kDone);
  bench.Run(0.1);
  EXPECT_NEAR(bench.place(), 10, 0.11);
  EXPECT_NEAR(bench.seen.set_position, 200, 0.11);
}

// AX-100: one rule for a place beyond a SW limit, whoever would call it so.
TEST(Reference, NoPlaceIsBeyondALimit) {
  StepAbsSwitch by_switch;
  by_switch.velocity = 50;
  by_switch.set_position = 201;
  StepRefPulse by_pulse;
  by_pulse.velocity = 50;
  by_pulse.set_position = 201;
  for (const Command& names : {Command(SetPosition{.position = 201}), Command(StepDirect{.set_position = 201}),
                               Command(by_switch), Command(by_pulse), Command(StepRefFlyingSwitch{.set_position = 201}),
                               Command(StepRefFlyingRefPulse{.set_position = 201}), Command(Home{.position = 201})}) {
    Bench bench(-5);
    bench.params.homing = {.method = HomingMethod::kSwitch, .velocity = 50};
    bench.params.homing.pulse_velocity = 5;
    bench.params.limits.upper = 200;
    bench.On();
    const double before = bench.seen.set_position;
    const Ticket ticket = bench.Give(names);
    bench.Run(0.05);
    EXPECT_EQ(bench.last[ticket].error, ErrorId::kTargetBehindLimit) << names.index();
    EXPECT_EQ(bench.seen.set_position, before);
    EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
  }
}

TEST(Flying, GivesUp) {
  Bench bench(40);
  bench.On();
  bench.Give(MoveRelative{.distance = 50, .velocity = 50});
  StepRefFlyingSwitch step;
  step.distance_limit = 20;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].error, ErrorId::kDistanceLimit);
  EXPECT_EQ(bench.state.plc, PlcState::kDiscreteMotion);
}

}  // namespace
}  // namespace takt::axis
