// The state machine, power, faults and resets.
#include <gtest/gtest.h>

#include <set>

#include "rig.h"
#include "takt/axis/sequence.h"

namespace takt::axis {
namespace {

// AX-10: the table holds exactly the transitions of the PLCopen diagram (its arrows, each once), every state can be
// left and entered.
TEST(StateTable, IsThePlcopenDiagram) {
  using S = PlcState;
  const std::set<std::pair<S, S>> diagram = {{S::kDisabled, S::kStandstill},
                                             {S::kDisabled, S::kErrorStop},
                                             {S::kStandstill, S::kDisabled},
                                             {S::kStandstill, S::kDiscreteMotion},
                                             {S::kStandstill, S::kContinuousMotion},
                                             {S::kStandstill, S::kSynchronizedMotion},
                                             {S::kStandstill, S::kHoming},
                                             {S::kStandstill, S::kStopping},
                                             {S::kStandstill, S::kErrorStop},
                                             {S::kDiscreteMotion, S::kStandstill},
                                             {S::kDiscreteMotion, S::kContinuousMotion},
                                             {S::kDiscreteMotion, S::kSynchronizedMotion},
                                             {S::kDiscreteMotion, S::kStopping},
                                             {S::kDiscreteMotion, S::kErrorStop},
                                             {S::kDiscreteMotion, S::kDisabled},
                                             {S::kContinuousMotion, S::kDiscreteMotion},
                                             {S::kContinuousMotion, S::kSynchronizedMotion},
                                             {S::kContinuousMotion, S::kStopping},
                                             {S::kContinuousMotion, S::kErrorStop},
                                             {S::kContinuousMotion, S::kDisabled},
                                             {S::kSynchronizedMotion, S::kDiscreteMotion},
                                             {S::kSynchronizedMotion, S::kContinuousMotion},
                                             {S::kSynchronizedMotion, S::kStopping},
                                             {S::kSynchronizedMotion, S::kErrorStop},
                                             {S::kSynchronizedMotion, S::kDisabled},
                                             {S::kHoming, S::kStandstill},
                                             {S::kHoming, S::kStopping},
                                             {S::kHoming, S::kErrorStop},
                                             {S::kHoming, S::kDisabled},
                                             {S::kStopping, S::kStandstill},
                                             {S::kStopping, S::kErrorStop},
                                             {S::kStopping, S::kDisabled},
                                             {S::kErrorStop, S::kStandstill},
                                             {S::kErrorStop, S::kDisabled}};
  std::set<std::pair<S, S>> table;
  for (const Transition& t : kTransitions) EXPECT_TRUE(table.insert({t.from, t.to}).second);
  EXPECT_EQ(table, diagram);
}

// AX-20: closes the loop and releases the brake once the drive is ready; AX-82: the brake relay is on exactly while the
// loop is closed.
TEST(Power, ClosesTheLoopWhenTheDriveIsReady) {
  Rig rig(LinearParams());
  rig.Run(0.01);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  EXPECT_FALSE(rig.commanded.enable);
  const Ticket on = rig.Give(Power{});
  rig.Step();
  EXPECT_TRUE(rig.commanded.enable);
  EXPECT_FALSE(rig.commanded.release_brake);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  ASSERT_TRUE(rig.RunToEnd(on, 1));
  EXPECT_TRUE(rig.lives[on].done);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_TRUE(rig.commanded.release_brake);
  const Ticket again = rig.Give(Power{});
  rig.Step();
  EXPECT_TRUE(rig.lives[again].done);
}

// AX-20: a moving axis stops along its ramp before its loop opens.
TEST(Power, OffInMotionBrakesFirst) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  const std::size_t from = rig.trace.size();
  const Ticket off = rig.Give(Power{.enable = false});
  rig.Step();
  EXPECT_TRUE(rig.lives[move].aborted);
  EXPECT_EQ(rig.out.state, PlcState::kStopping);
  ASSERT_TRUE(rig.RunToEnd(off));
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  EXPECT_FALSE(rig.commanded.enable);
  EXPECT_FALSE(rig.commanded.release_brake);
  EXPECT_LE(WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from).acceleration, 1 + 1e-9);
}

// AX-20: the axis stands where it is when the loop closes, wherever it was moved by hand meanwhile.
TEST(Power, TakesOverThePositionItFinds) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = 50})));
  ASSERT_TRUE(rig.RunToEnd(rig.Give(Power{.enable = false})));
  rig.frozen = true;
  for (int i = 0; i < 100; ++i) {
    rig.inputs.counts += 1000;  // 0.1 mm by hand
    rig.Step();
  }
  ASSERT_TRUE(rig.RunToEnd(rig.Give(Power{})));
  EXPECT_NEAR(rig.position(), 50.1, 1e-6);
}

// AX-20, AX-82: a drive that does not get ready is a fault, and the drive is switched off again.
TEST(Power, FailsWhenTheDriveDoesNotGetReady) {
  Rig rig(LinearParams());
  rig.drive_delay = 1000;
  const Ticket on = rig.Give(Power{});
  ASSERT_TRUE(rig.RunToEnd(on, 1));
  EXPECT_EQ(rig.lives[on].error_id, ErrorId::kDrive);
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_FALSE(rig.commanded.enable);
}

// AX-20: on again while the drive gets ready takes the place of the first one, but gives the drive no more time.
TEST(Power, OnAgainGivesTheDriveNoMoreTime) {
  AxisParams p = LinearParams();
  p.drive.ready_timeout_s = 0.05;
  Rig rig(p);
  rig.drive_delay = 1000;
  const Ticket first = rig.Give(Power{});
  rig.Run(0.04);
  const Ticket second = rig.Give(Power{});
  rig.Run(0.02);
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_EQ(rig.lives[second].error_id, ErrorId::kDrive);
}

// AX-12, AX-20: on while it is on is done at once, or, buffered, behind the move.
TEST(Power, OnMayWaitBehindAMove) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 20});
  const Ticket on = rig.Give(Power{.buffer_mode = BufferMode::kBuffered});
  rig.Step();
  EXPECT_FALSE(rig.lives[on].active);
  ASSERT_TRUE(rig.RunToEnd(on));
  EXPECT_TRUE(rig.lives[on].done);
  EXPECT_EQ(rig.lives[on].final_cycle, rig.lives[move].final_cycle);
}

// AX-20: while it brakes for power off nothing else is accepted, but off once more, in whatever buffer mode.
TEST(Power, OffCannotBeTakenBack) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  const Ticket off = rig.Give(Power{.enable = false});
  rig.Run(0.01);
  for (const Command& c :
       {Command(Power{}), Command(Stop{.hold = true}), Command(Halt{}), Command(MoveAbsolute{.position = 1}),
        Command(MoveAbsolute{.position = 1, .buffer_mode = BufferMode::kBuffered}), Command(Jog{.forward = true})}) {
    const Ticket t = rig.Give(c);
    rig.Step();
    EXPECT_EQ(rig.lives[t].error_id, ErrorId::kAxisStopping) << c.index();
  }
  EXPECT_FALSE(rig.Ended(off));
  const Ticket again = rig.Give(Power{.enable = false, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(again));
  EXPECT_TRUE(rig.lives[off].aborted);
  EXPECT_TRUE(rig.lives[again].done);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
}

// AX-12: nothing can wait behind a power off that waits itself.
TEST(Power, OffCannotBeFollowed) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 100});
  const Ticket off = rig.Give(Power{.enable = false, .buffer_mode = BufferMode::kBuffered});
  const Ticket behind = rig.Give(MoveAbsolute{.position = 50, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(off));
  EXPECT_EQ(rig.lives[behind].error_id, ErrorId::kState);
  EXPECT_NEAR(rig.position(), 100, 1e-3);
}

// AX-20: also an axis that brakes because of a fault comes to rest before power off opens its loop.
TEST(Power, OffInErrorStopWaitsForTheBrake) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  const std::size_t from = rig.trace.size();
  rig.inputs.limit_positive = true;
  rig.Run(0.01);
  const Ticket off = rig.Give(Power{.enable = false});
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_TRUE(rig.out.loop_closed);
  ASSERT_TRUE(rig.RunToEnd(off));
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  rig.trace.pop_back();  // the loop is open: the axis is where it is measured
  const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
  EXPECT_LE(worst.position_step, 1 + 1e-6);
}

// Motion needs power (error 0010).
TEST(Commands, NeedPower) {
  Rig rig(LinearParams());
  for (const Command& c :
       {Command(MoveAbsolute{.position = 1}), Command(MoveRelative{.distance = 1}),
        Command(MoveVelocity{.velocity = 1}), Command(Halt{}), Command(Stop{}), Command(Jog{.forward = true})}) {
    const Ticket t = rig.Give(c);
    rig.Step();
    EXPECT_EQ(rig.lives[t].error_id, ErrorId::kPowerOff);
  }
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
}

// AX-83: following error too large: ErrorStop 2001 and the loop opens; reset leads to Disabled (AX-21), power on works
// again.
TEST(Fault, DeviationOpensTheLoop) {
  AxisParams p = LinearParams();
  p.supervision.deviation_moving = 1;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 100});
  const Ticket next = rig.Give(MoveAbsolute{.position = 200, .buffer_mode = BufferMode::kBuffered});
  rig.Run(0.01);
  rig.frozen = true;
  rig.Run(0.2);
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.out.error, ErrorId::kDeviation);
  EXPECT_FALSE(rig.out.loop_closed);
  EXPECT_FALSE(rig.commanded.enable);
  EXPECT_EQ(rig.lives[move].error_id, ErrorId::kDeviation);
  EXPECT_TRUE(rig.lives[next].aborted);
  const Ticket refused = rig.Give(MoveAbsolute{.position = 0});
  const Ticket power = rig.Give(Power{});
  rig.Step();
  EXPECT_EQ(rig.lives[refused].error_id, ErrorId::kErrorStop);
  EXPECT_EQ(rig.lives[power].error_id, ErrorId::kErrorStop);
  const Ticket reset = rig.Give(Reset{});
  rig.Step();
  EXPECT_TRUE(rig.lives[reset].done);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  EXPECT_EQ(rig.out.error, ErrorId::kNone);
  rig.frozen = false;
  EXPECT_TRUE(rig.PowerOn());
}

// AX-05: at rest the narrower limit holds, once the axis had time to settle.
TEST(Fault, DeviationAtRestHasItsOwnLimit) {
  AxisParams p = LinearParams();
  p.supervision.deviation_moving = 5;
  p.supervision.deviation_standstill = 0.1;
  p.supervision.in_position_timeout_s = 0.05;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.Run(0.1);
  rig.frozen = true;
  rig.inputs.counts += 50000;  // 0.05 mm
  rig.Run(0.1);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  rig.inputs.counts += 100000;  // 0.15 mm
  rig.Run(0.1);
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.out.error, ErrorId::kDeviation);
}

// AX-83: onto a limit switch: brakes within limits, error, the loop stays closed; after reset only away from it.
TEST(Fault, LimitSwitch) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveVelocity{.velocity = 300});
  rig.Run(0.5);
  const std::size_t from = rig.trace.size();
  rig.inputs.limit_positive = true;
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.out.error, ErrorId::kLimitSwitchPositive);
  EXPECT_EQ(rig.lives[move].error_id, ErrorId::kLimitSwitchPositive);
  const Ticket early = rig.Give(Reset{});
  rig.Step();
  EXPECT_FALSE(rig.Ended(early));  // not before the axis stands (AX-21)
  rig.Run(0.5);
  EXPECT_TRUE(rig.lives[early].done);
  EXPECT_TRUE(rig.out.loop_closed);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_LE(WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from).acceleration, 1 + 1e-9);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  const Ticket further = rig.Give(MoveRelative{.distance = 1});
  const Ticket faster = rig.Give(MoveVelocity{.velocity = 1});
  const Ticket jog = rig.Give(Jog{.forward = true});
  rig.Run(0.01);
  EXPECT_EQ(rig.lives[further].error_id, ErrorId::kAwayFromLimitOnly);
  EXPECT_EQ(rig.lives[faster].error_id, ErrorId::kAwayFromLimitOnly);
  EXPECT_EQ(rig.lives[jog].error_id, ErrorId::kAwayFromLimitOnly);
  const Ticket back = rig.Give(MoveRelative{.distance = -10});
  ASSERT_TRUE(rig.RunToEnd(back));
  EXPECT_TRUE(rig.lives[back].done);
  rig.inputs.limit_positive = false;
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = 1})));
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// AX-03: a normally closed switch, and the other side.
TEST(Fault, InvertedLimitSwitch) {
  AxisParams p = LinearParams();
  p.inputs.invert_limit_negative = true;
  Rig rig(p);
  rig.inputs.limit_negative = true;
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 300, .direction = Direction::kNegative});
  rig.Run(0.3);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  rig.inputs.limit_negative = false;  // the wire broke
  rig.Step();
  EXPECT_EQ(rig.out.error, ErrorId::kLimitSwitchNegative);
  EXPECT_TRUE(rig.out.limit_negative);
}

// AX-04: the encoder's error line, or a jump: a fault that opens the loop; reset works only when the line is well
// again.
TEST(Fault, Encoder) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(0.1);
  rig.inputs.encoder_error = true;
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.out.error, ErrorId::kEncoder);
  EXPECT_FALSE(rig.out.loop_closed);
  const Ticket reset = rig.Give(Reset{});
  rig.Step();
  EXPECT_EQ(rig.lives[reset].error_id, ErrorId::kAxisFault);
  rig.inputs.encoder_error = false;
  const Ticket again = rig.Give(Reset{});
  rig.Step();
  EXPECT_TRUE(rig.lives[again].done);
  ASSERT_TRUE(rig.PowerOn());
  rig.frozen = true;
  rig.inputs.counts += 50'000'000;  // 50 mm in a cycle
  rig.Step();
  EXPECT_EQ(rig.out.error, ErrorId::kEncoder);
}

// AX-04: after a jump reset believes the encoder again, wherever it is.
TEST(Fault, ResetBelievesTheEncoderAfterAJump) {
  for (const bool powered : {true, false}) {
    Rig rig(LinearParams());
    rig.Step();
    if (powered) rig.PowerOn();
    rig.frozen = true;
    rig.inputs.counts += 50'000'000;
    rig.Step();
    ASSERT_EQ(rig.out.error, ErrorId::kEncoder);
    ASSERT_TRUE(rig.RunToEnd(rig.Give(Reset{})));
    rig.Step();
    EXPECT_EQ(rig.out.error, ErrorId::kNone);
    EXPECT_TRUE(rig.PowerOn());
  }
}

// AX-04: a jump is what is more than four times the largest velocity (and the noise).
TEST(Fault, FastIsNoJump) {
  for (const std::uint32_t step : {1'999'000u, 2'001'000u}) {  // 500 mm/s are 500,000 counts a cycle
    AxisParams p = LinearParams();
    p.supervision.encoder_noise_counts = 4;
    Rig rig(p);
    rig.frozen = true;
    rig.Step();
    rig.inputs.counts += step;
    rig.Step();
    EXPECT_EQ(rig.out.error, step < 2'000'004 ? ErrorId::kNone : ErrorId::kEncoder) << step;
  }
}

// A drive that is no longer ready, without saying why.
TEST(Fault, DriveThatDropsOutSilently) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.drive_delay = 1'000'000;
  rig.Run(0.002);
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.out.error, ErrorId::kDrive);
  EXPECT_FALSE(rig.out.loop_closed);
}

// AX-21: no reset while the drive still reports its fault.
TEST(Fault, ResetWantsAWellDrive) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.inputs.drive_fault = true;
  rig.Step();
  const Ticket early = rig.Give(Reset{});
  rig.Step();
  EXPECT_EQ(rig.lives[early].error_id, ErrorId::kAxisFault);
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.out.error, ErrorId::kDrive);
  rig.inputs.drive_fault = false;
  const Ticket reset = rig.Give(Reset{});
  rig.Step();
  EXPECT_TRUE(rig.lives[reset].done);
}

// The first fault is the one that is told; a worse one still opens the loop.
TEST(Fault, TheFirstOneIsTold) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 300});
  rig.Run(0.5);
  rig.inputs.limit_positive = true;
  rig.Run(0.01);
  EXPECT_TRUE(rig.out.loop_closed);
  rig.inputs.drive_fault = true;
  rig.Step();
  EXPECT_EQ(rig.out.error, ErrorId::kLimitSwitchPositive);
  EXPECT_FALSE(rig.out.loop_closed);
}

// AX-05: the narrower limit at rest holds a while after power on only, as after a move.
TEST(Fault, DeviationAtRestWaitsAfterPowerOn) {
  AxisParams p = LinearParams();
  p.supervision.deviation_moving = 5;
  p.supervision.deviation_standstill = 0.1;
  p.supervision.in_position_timeout_s = 0.05;
  Rig rig(p);
  rig.Run(0.2);
  ASSERT_TRUE(rig.PowerOn());
  rig.frozen = true;
  rig.inputs.counts += 200'000;
  rig.Run(0.04);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  rig.Run(0.03);
  EXPECT_EQ(rig.out.error, ErrorId::kDeviation);
}

// AX-05: nor does it hold in motion, however long that is.
TEST(Fault, DeviationAtRestDoesNotHoldInMotion) {
  AxisParams p = LinearParams();
  p.supervision.deviation_moving = 5;
  p.supervision.deviation_standstill = 0.1;
  p.supervision.in_position_timeout_s = 0.05;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 10});
  rig.Run(0.3);
  rig.frozen = true;
  rig.Run(0.1);  // 1 mm behind
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  EXPECT_GT(rig.out.following_error, 0.9);
}

// A drive that drops out while the loop is closed.
TEST(Fault, Drive) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.inputs.drive_fault = true;
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.out.error, ErrorId::kDrive);
  EXPECT_FALSE(rig.commanded.enable);
}

// The seed's note 2: power on with an error leads to ErrorStop, not to motion; power off leaves ErrorStop and keeps the
// error.
TEST(Fault, StaysUntilReset) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.inputs.limit_positive = true;
  rig.Run(0.01);
  ASSERT_EQ(rig.out.state, PlcState::kErrorStop);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(Power{.enable = false})));
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  EXPECT_EQ(rig.out.error, ErrorId::kLimitSwitchPositive);
  const Ticket on = rig.Give(Power{});
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.lives[on].error_id, ErrorId::kErrorStop);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(Reset{})));
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
  EXPECT_TRUE(rig.PowerOn());
}

// AX-82: a set point that is not a number never reaches the drive: outputs 0, loop open.
TEST(Fault, InternalOpensTheLoopWithZeroOutputs) {
  AxisParams p = LinearParams();
  p.drive.mode = DriveMode::kAnalog;
  Rig rig(p);
  rig.drive_delay = 0;
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(0.01);
  rig.state.motion.profile.pieces[0].velocity = NAN;
  rig.state.motion.profile.pieces[1].velocity = NAN;
  rig.state.motion.profile.pieces[2].velocity = NAN;
  rig.Step();
  EXPECT_EQ(rig.out.error, ErrorId::kInternal);
  EXPECT_EQ(rig.commanded.voltage_v, 0);
  EXPECT_FALSE(rig.commanded.enable);
  EXPECT_FALSE(rig.commanded.release_brake);
  EXPECT_TRUE(std::isfinite(rig.commanded.position_counts));
}

// AX-10: a transition outside the table would be seen.
TEST(StateTable, IllegalTransitionsAreCounted) {
  State state;
  Enter(state, PlcState::kStandstill);
  EXPECT_EQ(state.illegal_transitions, 0u);
  Enter(state, PlcState::kDisabled);
  Enter(state, PlcState::kHoming);
  EXPECT_EQ(state.illegal_transitions, 1u);
}

// AX-11: Busy while it waits, Active, Done; a command that need not wait is Active at once. InVelocity is told once.
TEST(Feedback, IsBusyActiveDone) {
  using S = FeedbackState;
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(MoveAbsolute{.position = 10});
  const Ticket second = rig.Give(MoveAbsolute{.position = 20, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(second));
  const Ticket endless = rig.Give(MoveVelocity{.velocity = 10});
  rig.Run(0.5);
  const Ticket halt = rig.Give(Halt{.buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(halt));
  const auto states = [&](Ticket t) {
    std::vector<S> all;
    for (const FeedbackEvent& e : rig.lives[t].events) all.push_back(e.state);
    return all;
  };
  EXPECT_EQ(states(first), (std::vector<S>{S::kActive, S::kDone}));
  EXPECT_EQ(states(second), (std::vector<S>{S::kBusy, S::kActive, S::kDone}));
  EXPECT_EQ(states(endless), (std::vector<S>{S::kActive, S::kActive, S::kAborted}));
  EXPECT_FALSE(rig.lives[endless].events[0].reached);
  EXPECT_TRUE(rig.lives[endless].events[1].reached);
  EXPECT_TRUE(rig.lives[endless].events[2].reached);
}

// A fault from outside while the drive gets ready: there is nothing to brake yet, it is switched off.
TEST(Fault, WhileTheDriveGetsReadySwitchesItOff) {
  Rig rig(LinearParams());
  const Ticket on = rig.Give(Power{});
  rig.Step();
  ASSERT_TRUE(rig.commanded.enable);
  Fail(rig.Now(), ErrorId::kOverrun, false, rig.state);
  rig.Step();
  EXPECT_EQ(rig.lives[on].error_id, ErrorId::kOverrun);
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_FALSE(rig.commanded.enable);
}

}  // namespace
}  // namespace takt::axis
