// Blocks for groups (GR-02, GR-20, GR-25, CV-10, CV-11), as those of Python.
#include "takt/plcopen/group.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "bench.h"

namespace takt::plcopen {
namespace {

class GroupBlocks : public testing::Test {
 protected:
  void SetUp() override {
    GT_GroupPower power(pair);
    Finish(power);
    MC_GroupEnable enable(pair);
    Finish(enable);
  }
  // Calls the block until it is done.
  template <typename B>
  void Finish(B& block) {
    block.Execute = true;
    ASSERT_TRUE(bench.Until(block, [&] { return block.Done() || block.Error(); }));
    EXPECT_TRUE(block.Done()) << ErrorText(block.ErrorID());
    block.Execute = false;
    block();
  }
  const group::Outputs& now() const { return pair.outputs(); }

  Bench bench;
  GroupRef pair = bench.program.Group("pair");
};

TEST_F(GroupBlocks, AreMadeOfGroupsThatAreThere) {
  EXPECT_THROW(bench.program.Group("pear"), std::invalid_argument);
  EXPECT_EQ(pair.target(), bench.engine.machine().axes.size() + 1);
}

// GR-20: Busy, Active and Done by the rules of all blocks.
TEST_F(GroupBlocks, ALinearMove) {
  MC_MoveLinearAbsolute move(pair);
  MC_GroupReadStatus status(pair);
  status.Enable = true;
  status();
  EXPECT_TRUE(status.GroupStandby() && status.InPosition());
  move.x = 30;
  move.y = 40;
  move.Execute = true;
  move();
  EXPECT_TRUE(move.Busy());
  ASSERT_TRUE(bench.Until(move, [&] { return now().path_velocity > 50; }));
  status();
  EXPECT_TRUE(status.GroupMoving() && !status.InPosition());
  EXPECT_TRUE(move.Active());
  ASSERT_TRUE(bench.Until(move, [&] { return move.Done(); }));
  EXPECT_NEAR(now().x, 30, 1e-9);
  EXPECT_NEAR(now().y, 40, 1e-9);
  MC_GroupReadActualPosition position(pair);
  position();
  EXPECT_FALSE(position.Valid());
  position.Enable = true;
  position();
  EXPECT_NEAR(position.Position()[0], 30, 2e-3);
}

// GR-22: one behind the other, both aborted by a halt.
TEST_F(GroupBlocks, WaitForOneAnother) {
  MC_MoveLinearAbsolute first(pair), second(pair);
  first.x = 100;
  second.y = 50;
  second.buffer_mode = axis::BufferMode::kBuffered;
  first.Execute = second.Execute = true;
  first();
  bench.Step();
  second();
  ASSERT_TRUE(bench.Until(first, [&] { return first.Active() && now().path_velocity > 10; }));
  second();
  EXPECT_TRUE(second.Busy() && !second.Active());
  MC_GroupHalt halt(pair);
  Finish(halt);
  first();
  second();
  EXPECT_TRUE(first.CommandAborted() && second.CommandAborted());
}

TEST_F(GroupBlocks, AStopHoldsAsLongAsExecute) {
  MC_GroupStop stop(pair);
  stop.Execute = true;
  ASSERT_TRUE(bench.Until(stop, [&] { return stop.Done(); }));
  bench.Step(100);
  EXPECT_EQ(now().state, group::GroupState::kStopping);
  stop.Execute = false;
  stop();
  bench.Step(5);
  EXPECT_EQ(now().state, group::GroupState::kStandby);
}

// GR-25: InSync only while the slave is where the path has it.
TEST_F(GroupBlocks, AnAxisInStepWithThePath) {
  bench.PowerOn(bench.w);
  MC_SyncAxisToGroup sync(pair);
  sync.axis = Name::Of("w");
  sync.ratio_numerator = 5;
  sync.Execute = true;
  ASSERT_TRUE(bench.Until(sync, [&] { return sync.InSync(); }));
  sync.axis = Name::Of("x");  // without a rising edge
  MC_MoveLinearAbsolute move(pair);
  move.x = 20;
  move.velocity = 20;
  move.Execute = true;
  bool lagged = false;
  ASSERT_TRUE(bench.Until(move, [&] {
    sync();
    EXPECT_EQ(sync.InSync(), bench.w.outputs().in_step);
    lagged = lagged || !sync.InSync();
    return move.Done() && sync.InSync();
  }));
  EXPECT_TRUE(lagged);
  EXPECT_NEAR(bench.w.outputs().set_position, 100, 0.01);
}

TEST_F(GroupBlocks, APathInterruptedAndContinued) {
  MC_MovePath move(pair);
  move.path = Name::Of("hook");
  move.Execute = true;
  ASSERT_TRUE(bench.Until(move, [&] { return now().x > 10; }));
  MC_GroupInterrupt interrupt(pair);
  Finish(interrupt);
  EXPECT_TRUE(now().interrupted);
  MC_GroupContinue go_on(pair);
  Finish(go_on);
  ASSERT_TRUE(bench.Until(move, [&] { return move.Done(); }));
  EXPECT_NEAR(now().y, 20, 1e-9);
}

TEST_F(GroupBlocks, MembersComeAndGo) {
  MC_GroupDisable disable(pair);
  Finish(disable);
  MC_AddAxisToGroup add(pair);
  add.axis = Name::Of("w");
  add.ident = 3;
  Finish(add);
  MC_GroupReadConfiguration read(pair);
  read.Enable = true;
  read.IdentInGroup = 3;
  read();
  EXPECT_EQ(read.Axis(), bench.w.target());
  MC_RemoveAxisFromGroup remove(pair);
  remove.ident = 3;
  Finish(remove);
  read();
  EXPECT_EQ(read.Axis(), 0u);
  read.IdentInGroup = 9;
  EXPECT_EQ(read.Axis(), 0u);
}

// GR-10: product coordinate systems, seen from where one likes.
TEST_F(GroupBlocks, SayWhereCoordinateSystemsAre) {
  MC_SetCartesianTransform set(pair);
  set.pcs = 16;
  set.x = 100;
  set.c = 270;
  Finish(set);
  MC_SetCoordinateTransform on_it(pair);
  on_it.pcs = 2;
  on_it.x = 5;
  on_it.reference = group::CoordinateSystem::kPcs;
  on_it.reference_pcs = 16;
  Finish(on_it);
  MC_ReadCartesianTransform numbers(pair);
  numbers.Pcs = 16;
  numbers();
  EXPECT_FALSE(numbers.Valid() || numbers.Error());
  numbers.Enable = true;
  numbers();
  EXPECT_TRUE(numbers.Valid());
  EXPECT_EQ(numbers.TransX(), 100);
  EXPECT_EQ(numbers.RotAngle3(), 270);  // as given
  EXPECT_EQ(numbers.TransY() + numbers.TransZ() + numbers.RotAngle1() + numbers.RotAngle2(), 0);
  MC_ReadCoordinateTransform read(pair);
  read.Enable = true;
  read.Pcs = 2;
  read();
  EXPECT_NEAR(read.CoordTransform().x, 100, 1e-9);
  EXPECT_NEAR(read.CoordTransform().y, -5, 1e-9);
  read.Reference = group::CoordinateSystem::kPcs;
  read.ReferencePcs = 16;
  read();
  EXPECT_NEAR(read.CoordTransform().x, 5, 1e-9);
  EXPECT_NEAR(read.CoordTransform().c, 0, 1e-9);
  read.Reference = group::CoordinateSystem::kWcs;  // base: y 20, turned half around Z
  read();
  EXPECT_NEAR(read.CoordTransform().x, -100, 1e-9);
  EXPECT_NEAR(read.CoordTransform().y, 25, 1e-9);
  for (const std::uint32_t wrong : {0u, 17u}) {
    read.Pcs = wrong;
    read();
    EXPECT_EQ(read.ErrorID(), ErrorId::kParameter);
    EXPECT_FALSE(read.Valid());
  }
  read.Pcs = 2;
  read.Reference = group::CoordinateSystem::kAcs;
  read();
  EXPECT_TRUE(read.Error());
}

// GR-03: a member's fault is one of the group, until it is reset.
TEST_F(GroupBlocks, AFaultAndItsReset) {
  bench.engine.faults(bench.x.target() - 1).drive_fault = true;
  bench.Step(20);
  MC_GroupReadError error(pair);
  error.Enable = true;
  error();
  EXPECT_TRUE(error.Error());
  EXPECT_EQ(error.GroupErrorID(), ErrorId::kDrive);
  bench.engine.faults(bench.x.target() - 1).drive_fault = false;
  bench.Step(5);
  MC_GroupReset reset(pair);
  Finish(reset);
  error();
  EXPECT_FALSE(error.Error());
}

class TrackingBlocks : public GroupBlocks {
 protected:
  void SetUp() override {
    GroupBlocks::SetUp();
    bench.PowerOn(bench.w);
    drive.velocity = 100;
    drive.Execute = true;
    ASSERT_TRUE(bench.Until(drive, [&] { return drive.InVelocity(); }));
    status.Enable = true;
    track.belt = Name::Of("feed");
  }

  MC_MoveVelocity drive{bench.w};
  MC_GroupReadStatus status{pair};
  MC_TrackConveyorBelt track{pair};
};

// CV-10, CV-11: in step, with a move on top, until the object has left.
TEST_F(TrackingBlocks, GoAlongWithABelt) {
  track.start_distance = 10;
  track.end_distance = 150;
  track.Execute = true;
  track();
  EXPECT_TRUE(track.Busy() && track.Active() && !track.InSync());
  bench.Step(20);
  status();
  EXPECT_TRUE(status.GroupStandby() && !status.SynchronizedMotion() && !status.DiscreteMotion());
  ASSERT_TRUE(bench.Until(track, [&] { return track.InSync(); }));
  EXPECT_EQ(now().track_state, group::TrackState::kInSync);
  status();
  EXPECT_TRUE(status.GroupMoving() && status.SynchronizedMotion() && !status.DiscreteMotion());
  MC_MoveLinearAbsolute across(pair);
  across.y = 10;
  across.coordinate_system = group::CoordinateSystem::kPcs;
  across.Execute = true;
  ASSERT_TRUE(bench.Until(across, [&] { return across.Active(); }));
  bench.Step(20);
  status();
  EXPECT_TRUE(status.SynchronizedMotion() && status.DiscreteMotion());
  ASSERT_TRUE(bench.Until(across, [&] { return across.Done(); }));
  EXPECT_NEAR(now().object_y, 10, 1e-9);
  ASSERT_TRUE(bench.Until(track, [&] { return track.Done(); }));
  EXPECT_FALSE(track.InSync() || track.Busy());
  track.Execute = false;
  track();
  EXPECT_FALSE(track.Done());
}

// CV-10, CV-11: behind a move; a group that only moves. CV-13: the same numbers as in Python.
TEST_F(TrackingBlocks, WaitForMoves) {
  MC_MoveLinearAbsolute move(pair);
  move.y = 20;
  move.Execute = true;
  ASSERT_TRUE(bench.Until(move, [&] { return move.Active() && now().path_velocity > 10; }));
  track.execution_mode = group::ExecutionMode::kQueued;
  track.Execute = true;
  while (!move.Done()) {
    track();
    status();
    ASSERT_TRUE(track.Busy() && !track.Active());
    ASSERT_TRUE(status.DiscreteMotion() && !status.SynchronizedMotion());
    bench.Step();
    move();
  }
  ASSERT_TRUE(bench.Until(track, [&] { return track.InSync(); }));
  MC_GroupStop stop(pair);
  Finish(stop);
  track();
  EXPECT_TRUE(track.CommandAborted());
  track.Execute = false;
  track();
  track.end_distance = -1;
  track.Execute = true;
  ASSERT_TRUE(bench.Until(track, [&] { return track.Error(); }));
  EXPECT_EQ(track.ErrorID(), ErrorId::kTrackOrder);
}

// CV-03: a coordinate system that goes along.
TEST_F(TrackingBlocks, ShowCoordinateSystemsThatMove) {
  MC_SetDynCoordTransform set(pair);
  set.carrier = Name::Of("feed");
  set.pcs = 4;
  set.y = 7;
  Finish(set);
  MC_ReadCartesianTransform read(pair);
  read.Pcs = 4;
  read.Enable = true;
  read();
  const double before = read.TransX();
  bench.Step(100);
  read();
  EXPECT_NEAR(read.TransX() - before, 10, 1e-9);
}

TEST_F(GroupBlocks, AnOverrideHoldsTheGroup) {
  MC_GroupSetOverride override_block(pair);
  override_block.VelFactor = 0;
  override_block.Enable = true;
  ASSERT_TRUE(bench.Until(override_block, [&] { return override_block.Enabled(); }));
  MC_MoveLinearAbsolute move(pair);
  move.x = 20;
  move.Execute = true;
  move();
  bench.Step(500);
  EXPECT_EQ(now().path_velocity, 0);
  override_block.VelFactor = 1;
  override_block();
  ASSERT_TRUE(bench.Until(move, [&] { return move.Done(); }));
}

}  // namespace
}  // namespace takt::plcopen
