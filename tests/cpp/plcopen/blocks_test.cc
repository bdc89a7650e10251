// The interface rules of table 8.3 (AX-11), as for the blocks of Python.
#include "takt/plcopen/blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "bench.h"

namespace takt::plcopen {
namespace {

using axis::BufferMode;

// AX-11, AX-30: Busy with the rising edge, Active in control, Done while Execute is true, cleared on the falling edge.
TEST_F(Blocks, AnAbsoluteMove) {
  MC_MoveAbsolute move(x);
  move();
  EXPECT_EQ(Shown(move), 0);
  move.position = 20;
  move.velocity = 100;
  move.Execute = true;
  move();
  EXPECT_TRUE(move.Busy() && move.Active());  // table 8.3: not buffered, Active is as Busy
  Step();
  move();
  EXPECT_TRUE(move.Active());
  ASSERT_TRUE(Until(move, [&] { return move.Done(); }));
  EXPECT_FALSE(move.Busy() || move.Active());
  EXPECT_DOUBLE_EQ(At(x).set_position, 20);
  Step(10);
  move();
  EXPECT_TRUE(move.Done());
  move.Execute = false;
  move();
  EXPECT_EQ(Shown(move), 0);
}

// AX-11: Execute falls before the end; the command goes on and its end is still seen, once.
TEST_F(Blocks, OutputsAreSeenInOneCallAtLeast) {
  MC_MoveRelative move(x);
  move.distance = 5;
  move.Execute = true;
  move();
  Step();
  move.Execute = false;
  move();
  EXPECT_TRUE(move.Busy());
  ASSERT_TRUE(Until(move, [&] { return move.Done(); }));
  EXPECT_DOUBLE_EQ(At(x).set_position, 5);
  move();
  EXPECT_EQ(Shown(move), 0);
}

// AX-11: a change of an input while Execute stays true does nothing; what is not set again keeps its value.
TEST_F(Blocks, InputsCountOnTheRisingEdge) {
  MC_MoveAbsolute move(x);
  move.velocity = 200;
  move.position = 10;
  move.Execute = true;
  move();
  Step(3);
  move.position = 50;
  ASSERT_TRUE(Until(move, [&] { return move.Done(); }));
  EXPECT_DOUBLE_EQ(At(x).set_position, 10);
  move.Execute = false;
  move();
  move.Execute = true;
  double fastest = 0;
  ASSERT_TRUE(Until(move, [&] {
    fastest = std::max(fastest, At(x).set_velocity);
    return move.Done();
  }));
  EXPECT_DOUBLE_EQ(At(x).set_position, 50);
  EXPECT_DOUBLE_EQ(fastest, 200);
}

// AX-11: of the first action of the instance nothing is heard any more.
TEST_F(Blocks, ANewRisingEdgeSupersedes) {
  MC_MoveAbsolute move(x);
  move.position = 300;
  move.Execute = true;
  move();
  Step(50);
  move.Execute = false;
  move();
  move.position = 5;
  move.Execute = true;
  ASSERT_TRUE(Until(move, [&] {
    EXPECT_FALSE(move.CommandAborted());
    EXPECT_EQ(Shown(move), 1);
    return move.Done();
  }));
  EXPECT_DOUBLE_EQ(At(x).set_position, 5);
}

// AX-11, AX-12: Active says that the command is in control.
TEST_F(Blocks, ABufferedMoveIsActiveWhenItsTurnComes) {
  MC_MoveRelative first(x), second(x);
  first.distance = 10;
  second.distance = 5;
  second.buffer_mode = BufferMode::kBuffered;
  first.Execute = second.Execute = true;
  first();
  second();
  EXPECT_TRUE(second.Busy() && !second.Active());
  ASSERT_TRUE(Until(first, [&] {
    second();
    EXPECT_NE(first.Active(), second.Active());
    return first.Done();
  }));
  ASSERT_TRUE(Until(second, [&] { return second.Done(); }));
  EXPECT_DOUBLE_EQ(At(x).set_position, 15);
}

// AX-11, AX-33, AX-36: CommandAborted excludes Done and InVelocity, and is cleared with Execute.
TEST_F(Blocks, AnotherBlockAborts) {
  MC_MoveVelocity ever(x);
  MC_Halt halt(x);
  ever.velocity = 80;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  EXPECT_TRUE(ever.Busy() && ever.Active());
  halt.Execute = true;
  halt();
  Step();
  ever();
  EXPECT_TRUE(ever.CommandAborted() && ever.Aborted());
  EXPECT_FALSE(ever.InVelocity() || ever.Busy() || ever.Active());
  ASSERT_TRUE(Until(halt, [&] { return halt.Done(); }));
  ever.Execute = false;
  ever();
  EXPECT_EQ(Shown(ever), 0);
}

// AX-11: the falling edge clears InVelocity and disturbs nothing.
TEST_F(Blocks, InVelocityIsClearedWithExecute) {
  MC_MoveVelocity ever(x);
  ever.velocity = 80;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  ever.Execute = false;
  ever();
  EXPECT_TRUE(!ever.InVelocity() && ever.Busy());
  Step(5);
  EXPECT_DOUBLE_EQ(At(x).set_velocity, 80);
}

// AX-11: and such an error does not by itself move the axis to ErrorStop.
TEST_F(Blocks, NegativeValuesAreErrors) {
  using Limit = std::optional<double> axis::MoveAbsolute::*;
  for (const Limit limit : {&axis::MoveAbsolute::velocity, &axis::MoveAbsolute::acceleration,
                            &axis::MoveAbsolute::deceleration, &axis::MoveAbsolute::jerk}) {
    MC_MoveAbsolute move(x);
    move.position = 1;
    move.*limit = -1;
    move.Execute = true;
    ASSERT_TRUE(Until(move, [&] { return move.Error(); }));
    EXPECT_EQ(move.ErrorID(), ErrorId::kParameter);
    EXPECT_EQ(Shown(move), 1);
    EXPECT_EQ(At(x).state, axis::PlcState::kStandstill);
    move.Execute = false;
    move();
    EXPECT_EQ(move.ErrorID(), ErrorId::kNone);
  }
  EXPECT_DOUBLE_EQ(At(x).set_position, 0);
}

// AX-11: the engine has no room for the command, which is said at once; the next rising edge tries again.
TEST_F(Blocks, AFullQueueIsAnError) {
  MC_MoveAbsolute move(x);
  engine::Command flood;
  flood.target = 2;
  flood.body = axis::Command(axis::MoveVelocity{});
  while (bench.engine.Submit(flood) != 0) {
  }
  move.Execute = true;
  move();
  EXPECT_EQ(move.ErrorID(), ErrorId::kQueueFull);
  EXPECT_EQ(Shown(move), 1);
  Step(100);
  move.Execute = false;
  move();
  move.Execute = true;
  EXPECT_TRUE(Until(move, [&] { return move.Done(); }));
}

// AX-50, AX-11: a block of Enable gives its command again as long as the engine has no room for it.
TEST_F(Blocks, ACamSwitchTriesAgainInAFullQueue) {
  MC_DigitalCamSwitch cams(x);
  cams.switches = Name::Of("none");
  engine::Command flood;
  flood.target = 2;
  flood.body = axis::Command(axis::MoveVelocity{});
  while (bench.engine.Submit(flood) != 0) {
  }
  cams.Enable = true;
  cams();
  EXPECT_EQ(cams.ErrorID(), ErrorId::kQueueFull);
  Step(100);
  EXPECT_TRUE(Until(cams, [&] { return cams.ErrorID() == ErrorId::kUnknownTarget; }));
}

// AX-37: Stopping lasts as long as Execute; another stop is refused meanwhile (figure 8.1, note 1).
TEST_F(Blocks, StopHolds) {
  MC_MoveVelocity ever(x);
  MC_Stop stop(x), second(x);
  MC_MoveRelative other(x);
  ever.velocity = 100;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  stop.Execute = true;
  ASSERT_TRUE(Until(stop, [&] { return stop.Done(); }));
  Step(500);
  EXPECT_EQ(At(x).state, axis::PlcState::kStopping);
  other.distance = 1;
  other.Execute = second.Execute = true;
  ASSERT_TRUE(Until(other, [&] { return other.Error(); }));
  ASSERT_TRUE(Until(second, [&] { return second.Done(); }));
  EXPECT_EQ(other.ErrorID(), ErrorId::kAxisStopping);
  second.Execute = false;
  second();
  Step(5);
  stop();
  EXPECT_TRUE(stop.Done());
  EXPECT_EQ(At(x).state, axis::PlcState::kStopping);
  stop.Execute = false;
  stop();
  Step(5);
  EXPECT_EQ(At(x).state, axis::PlcState::kStandstill);
  stop();
  EXPECT_EQ(Shown(stop), 0);
}

// AX-37: let go on the way, the ramp goes on to standstill; Done is seen once.
TEST_F(Blocks, StopReleasedOnTheWay) {
  MC_MoveVelocity ever(x);
  MC_Stop stop(x);
  ever.velocity = 150;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  stop.Execute = true;
  stop();
  Step(5);
  stop.Execute = false;
  ASSERT_TRUE(Until(stop, [&] { return stop.Done(); }));
  Step(3);
  EXPECT_EQ(At(x).state, axis::PlcState::kStandstill);
  stop();
  EXPECT_EQ(Shown(stop), 0);
}

// AX-21, AX-23, AX-83: running onto a SW limit, its number, reset.
TEST_F(Blocks, ErrorsAndReset) {
  MC_ReadAxisError read(x);
  MC_Reset reset(x), superseded(x);
  MC_MoveVelocity ever(x);
  ever.velocity = 190;
  ever.direction = axis::Direction::kNegative;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return At(x).state == axis::PlcState::kErrorStop; }));
  read.Enable = true;
  read();
  EXPECT_EQ(read.AxisErrorID(), ErrorId::kSoftLimitNegative);
  EXPECT_TRUE(read.Error() && read.Valid());
  superseded.Execute = reset.Execute = true;
  superseded();
  // A reset that another one supersedes is busy until the axis has left ErrorStop.
  ASSERT_TRUE(Until(reset, [&] {
    superseded();
    EXPECT_EQ(Shown(superseded), 1);
    EXPECT_EQ(Shown(reset), 1);
    EXPECT_EQ(superseded.Busy(), At(x).error != ErrorId::kNone);
    return reset.Done();
  }));
  EXPECT_TRUE(superseded.Done());
  EXPECT_EQ(At(x).state, axis::PlcState::kStandstill);
  read();
  EXPECT_TRUE(!read.Error() && read.Valid());
  ever.Execute = false;
  ever();
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return At(x).state == axis::PlcState::kErrorStop; }));
  superseded();
  EXPECT_TRUE(superseded.Done());  // of a fault that came later it says nothing
}

// AX-22, AX-24, AX-25, AX-26: valid while Enable is true.
TEST_F(Blocks, Reading) {
  MC_ReadStatus status(x);
  MC_ReadActualPosition position(x);
  MC_ReadActualVelocity velocity(x);
  MC_ReadMotionState motion(x);
  MC_ReadAxisInfo info(x);
  const auto read = [&](bool enable) {
    status.Enable = position.Enable = velocity.Enable = motion.Enable = info.Enable = enable;
    status(), position(), velocity(), motion(), info();
  };
  MC_MoveVelocity ever(x);
  ever.velocity = 50;
  ever.Execute = true;
  ever();
  Step(5);
  read(true);
  EXPECT_TRUE(motion.Accelerating() && motion.DirectionPositive() && !motion.ConstantVelocity());
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  Step(100);
  read(true);
  EXPECT_TRUE(status.ContinuousMotion() && !status.Standstill() && !status.Disabled());
  EXPECT_EQ(position.Position(), At(x).actual_position);
  EXPECT_GT(position.Position(), 0);
  EXPECT_NEAR(velocity.Velocity(), 50, 1);
  EXPECT_TRUE(motion.ConstantVelocity() && info.PowerOn() && info.ReadyForPowerOn());
  read(false);
  EXPECT_FALSE(status.Valid() || status.Disabled() || info.ReadyForPowerOn() || motion.ConstantVelocity());
  EXPECT_EQ(position.Position(), 0);
}

// AX-28, AX-52: parameters are read as long as Enable is true; settings are done at once or refused.
TEST_F(Blocks, Parameters) {
  MC_WriteParameter write(x);
  MC_ReadParameter read(x);
  write.number = 2;
  write.value = 50;
  write.Execute = true;
  ASSERT_TRUE(Until(write, [&] { return write.Done(); }));
  read.Enable = true;
  read.ParameterNumber = 2;
  ASSERT_TRUE(Until(read, [&] { return read.Valid(); }));
  EXPECT_EQ(read.Value(), 50);
  read.ParameterNumber = 99;
  ASSERT_TRUE(Until(read, [&] { return read.Error(); }));
  EXPECT_EQ(read.ErrorID(), ErrorId::kParameter);
  EXPECT_FALSE(read.Valid());
  read.Enable = false;
  read();
  EXPECT_FALSE(read.Error() || read.Valid() || read.Busy());
  // An answer to what was asked before Enable fell is not taken for one of what is asked now.
  read.ParameterNumber = 2;
  read.Enable = true;
  ASSERT_TRUE(Until(read, [&] { return read.Valid(); }));
  read.Enable = false;
  read();
  read.ParameterNumber = 3;
  read.Enable = true;
  ASSERT_TRUE(Until(read, [&] { return read.Valid(); }));
  EXPECT_EQ(read.Value(), -10);
  MC_MoveAbsolute move(x);
  move.position = 51;
  move.Execute = true;
  ASSERT_TRUE(Until(move, [&] { return move.Error(); }));
  EXPECT_EQ(move.ErrorID(), ErrorId::kTargetBehindLimit);
}

// AX-43, AX-44: masters go by their names; in gear as long as the axis follows.
TEST_F(Blocks, Gears) {
  bench.PowerOn(bench.y);
  MC_MoveVelocity drive(x);
  MC_GearIn gear(bench.y);
  MC_GearOut out(bench.y);
  drive.velocity = 40;
  gear.master = Name::Of("x");
  gear.ratio_numerator = 2;
  drive.Execute = gear.Execute = true;
  drive();
  ASSERT_TRUE(Until(gear, [&] { return gear.InGear() && At(x).set_velocity == 40; }));
  EXPECT_DOUBLE_EQ(At(bench.y).set_velocity, 80);
  EXPECT_TRUE(gear.Busy() && gear.Active());
  MC_GearIn same(bench.y);
  same.master = Name::Of("x");
  same.ratio_numerator = 2;
  same.Execute = true;
  ASSERT_TRUE(Until(same, [&] { return same.InGear(); }));
  gear();
  EXPECT_TRUE(gear.CommandAborted() && !gear.InGear());
  out.Execute = true;
  ASSERT_TRUE(Until(out, [&] { return out.Done(); }));
  same();
  EXPECT_TRUE(same.CommandAborted() && !same.InGear());
}

// AX-28: a yes or no is no number.
TEST_F(Blocks, WriteBoolParameter) {
  MC_WriteBoolParameter write(x);
  write.number = 4;  // the SW limit at the positive end
  write.Execute = true;
  ASSERT_TRUE(Until(write, [&] { return write.Done(); }));
  MC_ReadParameter read(x);
  read.ParameterNumber = 4;
  read.Enable = true;
  ASSERT_TRUE(Until(read, [&] { return read.Valid(); }));
  EXPECT_EQ(read.Value(), 0);
  MC_WriteBoolParameter other(x);
  other.number = 2;
  other.on = other.Execute = true;
  ASSERT_TRUE(Until(other, [&] { return other.Error(); }));
  EXPECT_EQ(other.ErrorID(), ErrorId::kParameter);
}

// AX-48: on a cam that goes up by 10 every 40 of the master's.
TEST_F(Blocks, Cams) {
  bench.PowerOn(bench.y);
  MC_CamTableSelect select(bench.y);
  select.cam = Name::Of("lift");
  select.Execute = true;
  ASSERT_TRUE(Until(select, [&] { return select.Done(); }));
  MC_CamIn cam(bench.y);
  cam.master = Name::Of("x");
  cam.cam = select.cam;
  cam.Execute = true;
  ASSERT_TRUE(Until(cam, [&] { return cam.InSync(); }));
  MC_MoveVelocity drive(x);
  drive.velocity = 80;
  drive.Execute = true;
  drive();
  int ends = 0;
  ASSERT_TRUE(Until(cam, [&] { return (ends += cam.EndOfProfile()) == 3; }));
  EXPECT_NEAR(At(bench.y).set_position, 30, 1e-3);
  EXPECT_NEAR(At(x).set_position, 120, 0.1);
  MC_CamOut out(bench.y);
  out.Execute = true;
  ASSERT_TRUE(Until(out, [&] { return out.Done(); }));
  cam();
  EXPECT_TRUE(cam.CommandAborted() && !cam.InSync() && !cam.EndOfProfile());
}

// AX-48: EndOfProfile is that of the cam whose end was passed, also in the call in which the next one has taken over.
TEST_F(Blocks, CamsOneBehindTheOther) {
  bench.PowerOn(bench.y);
  MC_CamIn first(bench.y), second(bench.y);
  for (MC_CamIn* cam : {&first, &second}) {
    cam->master = Name::Of("x");
    cam->cam = Name::Of("lift");
    cam->start_mode = axis::CamStart::kRelative;
    cam->Execute = true;
  }
  second.buffer_mode = BufferMode::kBuffered;
  MC_MoveVelocity drive(x);
  drive.velocity = 80;
  drive.Execute = true;
  drive();
  ASSERT_TRUE(Until(first, [&] { return first.InSync(); }));
  second();
  std::vector<double> first_ends, second_ends;
  while (At(x).set_position < 130) {
    Step();
    first();
    second();
    if (first.EndOfProfile()) first_ends.push_back(At(x).set_position);
    if (second.EndOfProfile()) second_ends.push_back(At(x).set_position);
  }
  EXPECT_TRUE(first.CommandAborted());
  ASSERT_EQ(first_ends.size(), 1u);
  ASSERT_EQ(second_ends.size(), 2u);
  EXPECT_NEAR(second_ends[0] - first_ends[0], 40, 1);
}

// AX-48, AX-111: an end that is passed in the call of a change is not lost.
TEST_F(Blocks, EndsOfACamThatIsChanged) {
  bench.PowerOn(bench.y);
  MC_CamIn cam(bench.y);
  cam.master = Name::Of("x");
  cam.cam = Name::Of("lift");
  cam.ContinuousUpdate = cam.Execute = true;
  ASSERT_TRUE(Until(cam, [&] { return cam.InSync(); }));
  MC_MoveVelocity drive(x);
  drive.velocity = 80;
  drive.Execute = true;
  drive();
  int ends = 0;
  while (At(x).set_position < 130) {
    Step();
    cam.slave_scaling = 1 + 1e-6 * At(x).set_position;
    cam();
    ends += cam.EndOfProfile();
  }
  EXPECT_EQ(ends, 3);
}

// AX-49, AX-109: other probes of the axis do not change RecordedPosition.
TEST_F(Blocks, ATouchKeepsItsPosition) {
  GT_Touch touch(x);
  MC_TouchProbe other(x);
  touch.velocity = 50;
  other.edge = axis::ProbeEdge::kFalling;
  MC_MoveVelocity drive(x);
  drive.velocity = 500;
  touch.Execute = other.Execute = drive.Execute = true;
  drive();
  ASSERT_TRUE(Until(touch, [&] {
    other();
    return touch.Done();
  }));
  ASSERT_TRUE(other.Done());
  EXPECT_NEAR(other.RecordedPosition(), 70, 0.02);
  EXPECT_NEAR(touch.RecordedPosition(), 60, 0.02);
  EXPECT_NEAR(At(x).set_position, touch.RecordedPosition(), 1e-9);
}

// AX-51, AX-11: InVelocity while the set point has the velocity that the override makes of the commanded one; not on
// the way there, nor while the axis is held.
TEST_F(Blocks, VelocitiesScaledByTheOverride) {
  MC_SetOverride factor(x);
  factor.Enable = true;
  MC_MoveVelocity move(x);
  move.velocity = 20;
  move.Execute = true;
  ASSERT_TRUE(Until(move, [&] { return move.InVelocity(); }));
  move.velocity = 30;  // without a rising edge
  for (const double velocity_factor : {0.5, 0.0, 1.0, 2.5, 50.0, 30.0, 0.2}) {
    factor.VelFactor = velocity_factor;
    factor();
    const double due = std::min(20 * velocity_factor, 500.0);
    for (int cycle = 0; cycle < 300; ++cycle) {
      Step();
      move();
      ASSERT_TRUE(!move.InVelocity() || std::abs(At(x).set_velocity - due) < 1e-6) << At(x).set_velocity;
    }
    EXPECT_EQ(move.InVelocity(), velocity_factor > 0) << velocity_factor;
  }
}

// AX-51, AX-28: an override above 1 counts as far as the largest velocity that was written.
TEST_F(Blocks, EndVelocityUpToTheLimitInForce) {
  MC_WriteParameter write(x);
  write.number = 9;
  write.value = 50;
  write.Execute = true;
  ASSERT_TRUE(Until(write, [&] { return write.Done(); }));
  MC_SetOverride factor(x);
  factor.Enable = true;
  factor.VelFactor = 2;
  ASSERT_TRUE(Until(factor, [&] { return factor.Enabled(); }));
  MC_MoveContinuousAbsolute move(x);
  move.position = 30;
  move.end_velocity = 40;
  move.velocity = 50;
  move.Execute = true;
  ASSERT_TRUE(Until(move, [&] { return move.InEndVelocity(); }));
  EXPECT_NEAR(At(x).set_velocity, 50, 1e-9);
  move.end_velocity = 20;  // without a rising edge
  factor.VelFactor = 0.5;
  ASSERT_TRUE(Until(factor, [&] {
    move();
    return At(x).set_velocity < 49;
  }));
  EXPECT_FALSE(move.InEndVelocity());
  ASSERT_TRUE(Until(move, [&] { return move.InEndVelocity(); }));
  EXPECT_NEAR(At(x).set_velocity, 20, 1e-6);
}

// AX-35: on top of a move, which is done where it would be done alone; halted, that goes on.
TEST_F(Blocks, MotionsOnTopOfOthers) {
  MC_MoveAbsolute move(x);
  move.position = 200;
  move.velocity = 100;
  MC_MoveSuperimposed top(x);
  top.distance = 30;
  top.velocity_difference = 50;
  move.Execute = top.Execute = true;
  move();
  ASSERT_TRUE(Until(top, [&] { return top.CoveredDistance() > 10; }));
  EXPECT_TRUE(top.Busy() && top.Active());
  EXPECT_EQ(Shown(top), 1);
  ASSERT_TRUE(Until(top, [&] { return top.Done(); }));
  EXPECT_NEAR(top.CoveredDistance(), 30, 1e-9);
  EXPECT_EQ(Shown(top), 1);
  move();
  EXPECT_TRUE(move.Busy());
  top.Execute = false;
  top();
  EXPECT_EQ(top.CoveredDistance(), 0);
  top.Execute = true;
  ASSERT_TRUE(Until(top, [&] { return top.CoveredDistance() > 5; }));
  MC_HaltSuperimposed halt(x);
  halt.Execute = true;
  ASSERT_TRUE(Until(halt, [&] { return halt.Done(); }));
  top();
  EXPECT_TRUE(top.CommandAborted());
  const double covered = top.CoveredDistance() + halt.ValueAtEnd();
  ASSERT_TRUE(Until(move, [&] { return move.Done(); }));
  EXPECT_NEAR(At(x).set_position, 200 + 30 + covered, 1e-9);
  top.distance = 2000;
  top.Execute = false;
  top();
  top.Execute = true;
  ASSERT_TRUE(Until(top, [&] { return top.Error(); }));
  EXPECT_EQ(top.ErrorID(), ErrorId::kTargetBehindLimit);
  EXPECT_EQ(top.CoveredDistance(), 0);
}

// AX-111: a direction that is not enabled is refused, and told to the axis while it is powered, whenever it changes.
TEST_F(Blocks, PowerEnablesDirections) {
  MC_Power power(x);
  power.Enable = true;
  power.EnablePositive = false;
  power();
  Step(3);
  power();
  EXPECT_TRUE(power.Status() && !power.Error());
  MC_MoveAbsolute move(x);
  move.position = At(x).set_position + 20;
  move.velocity = 50;
  move.Execute = true;
  ASSERT_TRUE(Until(move, [&] { return move.Error(); }));
  EXPECT_EQ(move.ErrorID(), ErrorId::kDirection);
  EXPECT_EQ(bench.State(x), axis::PlcState::kStandstill);
  move.Execute = false;
  move();
  power.EnablePositive = true;
  power();
  Step(3);
  move.Execute = true;
  ASSERT_TRUE(Until(move, [&] { return At(x).set_velocity > 10; }));
  power.EnablePositive = false;
  power();
  ASSERT_TRUE(Until(move, [&] { return move.Error(); }));
  EXPECT_EQ(move.ErrorID(), ErrorId::kDirection);
  EXPECT_EQ(bench.State(x), axis::PlcState::kErrorStop);
}

// AX-38: every axis of the machine.
TEST_F(Blocks, EmergencyStop) {
  MC_MoveVelocity ever(x);
  GT_EStop stop(bench.y);
  ever.velocity = 100;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  stop.Execute = true;
  ASSERT_TRUE(Until(stop, [&] { return stop.Done(); }));
  EXPECT_EQ(At(x).state, axis::PlcState::kDisabled);
  EXPECT_FALSE(At(x).loop_closed);
}

// Commands without a block of their own have one all the same: everything an axis understands can be given.
template <typename C>
bool IsTaken(AxisRef axis) {
  Block<C> block(axis);
  block.Execute = true;
  block();
  return block.Busy();
}
template <typename... C>
int CountTaken(const std::variant<C...>&, AxisRef axis) {
  return (0 + ... + IsTaken<C>(axis));
}
TEST_F(Blocks, ThereIsOneForEveryCommand) {
  EXPECT_EQ(CountTaken(axis::Command(), x), std::variant_size_v<axis::Command>);
  Step(10);  // what was given by blocks that are gone by now is nobody's news
}

// AX-111: with ContinuousUpdate at the rising edge each change of an input is commanded, and only then.
TEST_F(Blocks, ContinuousUpdateOfAMove) {
  for (const bool updates : {true, false}) {
    MC_MoveAbsolute move(x);
    move.position = updates ? 100 : 150;
    move.velocity = 100;
    move.ContinuousUpdate = updates;
    move.Execute = true;
    move();
    Step(50);
    move();
    move.position = updates ? 60 : 20;
    move.velocity = 200;
    ASSERT_TRUE(Until(move, [&] { return move.Done() || move.Error(); }));
    EXPECT_TRUE(move.Done());
    EXPECT_EQ(Shown(move), 1);
    EXPECT_DOUBLE_EQ(At(x).set_position, updates ? 60 : 150);
  }
}

// AX-111: a distance counts from where the move began.
TEST_F(Blocks, ContinuousUpdateOfADistance) {
  MC_MoveRelative move(x);
  move.distance = 30;
  move.velocity = 100;
  move.ContinuousUpdate = true;
  move.Execute = true;
  move();
  Step(50);
  move();
  move.distance = 50;
  move();
  Step(50);
  move();
  EXPECT_TRUE(move.Busy() && move.Active());
  move.distance = 40;
  ASSERT_TRUE(Until(move, [&] { return move.Done(); }));
  EXPECT_NEAR(At(x).set_position, 40, 1e-9);
  MC_MoveContinuousRelative onwards(x);
  onwards.distance = 30;
  onwards.velocity = 100;
  onwards.end_velocity = 20;
  onwards.ContinuousUpdate = true;
  onwards.Execute = true;
  onwards();
  Step(50);
  onwards();
  onwards.distance = 60;
  ASSERT_TRUE(Until(onwards, [&] { return onwards.InEndVelocity(); }));
  EXPECT_NEAR(At(x).set_position, 100, 0.1);
}

// AX-111: couplings and velocities, too; a change that is refused is an error of the block, and the motion goes on.
TEST_F(Blocks, ContinuousUpdateOfWhatNeverEnds) {
  bench.PowerOn(bench.y);
  MC_MoveVelocity move(x);
  move.velocity = 50;
  move.ContinuousUpdate = true;
  move.Execute = true;
  ASSERT_TRUE(Until(move, [&] { return move.InVelocity(); }));
  MC_GearIn gear(bench.y);
  gear.master = Name::Of("x");
  gear.ContinuousUpdate = true;
  gear.Execute = true;
  ASSERT_TRUE(Until(gear, [&] { return gear.InGear(); }));
  gear.ratio_numerator = 2;
  ASSERT_TRUE(Until(gear, [&] { return gear.InGear() && std::abs(At(bench.y).set_velocity - 100) < 1e-6; }));
  move.velocity = 80;
  ASSERT_TRUE(Until(move, [&] { return move.InVelocity() && At(x).set_velocity == 80; }));
  move.velocity = -1;
  ASSERT_TRUE(Until(move, [&] { return move.Error(); }));
  EXPECT_NE(move.ErrorID(), ErrorId::kNone);
  Step(100);
  EXPECT_DOUBLE_EQ(At(x).set_velocity, 80);
}

// AX-111: a move that waits changes once it is in control.
TEST_F(Blocks, ContinuousUpdateOfWhatWaits) {
  MC_MoveAbsolute first(x), second(x);
  first.position = 20;
  first.velocity = second.velocity = 100;
  first.Execute = second.Execute = second.ContinuousUpdate = true;
  second.position = 50;
  second.buffer_mode = BufferMode::kBuffered;
  first();
  second();
  Step(20);
  second();
  second.position = 70;
  bool met = false;
  ASSERT_TRUE(bench.Until([&] {
    first();
    second();
    met |= At(x).set_position == 20;
    return second.Done() || second.Error();
  }));
  EXPECT_TRUE(second.Done() && met);
  EXPECT_DOUBLE_EQ(At(x).set_position, 70);
}

// AX-111: outputs are written at the edge; what there is not is an error.
TEST_F(Blocks, DigitalOutputsAndInputs) {
  MC_WriteDigitalOutput write(x);
  MC_ReadDigitalOutput read(x);
  MC_ReadDigitalInput input(x);
  write.number = read.OutputNumber = 7;
  write.value = read.Enable = input.Enable = true;
  read();
  input();
  EXPECT_TRUE(read.Valid() && !read.Value() && input.Valid() && !input.Value());
  write.Execute = true;
  ASSERT_TRUE(Until(write, [&] { return write.Done(); }));
  read();
  EXPECT_TRUE(read.Value());
  for (const int number : {0, 33}) {
    read.OutputNumber = number;
    read();
    EXPECT_TRUE(read.Error() && !read.Valid() && !read.Value());
  }
  input.InputNumber = 5;
  input();
  EXPECT_TRUE(input.Error() && !input.Value());
  write.Execute = false;
  write();
  write.number = 33;
  write.Execute = true;
  ASSERT_TRUE(Until(write, [&] { return write.Error(); }));
}

}  // namespace
}  // namespace takt::plcopen
