// MC_Power: a level, not an edge (AX-20).
#include <gtest/gtest.h>

#include "bench.h"

namespace takt::plcopen {
namespace {

class Power : public testing::Test {
 protected:
  template <typename B, typename F>
  bool Until(B& block, F condition) {
    return bench.Until(block, condition);
  }
  Bench bench;
};

// AX-20: the level of Enable closes and opens the loop; Status says that it is closed.
TEST_F(Power, FollowsTheLevel) {
  MC_Power power(bench.x);
  power();
  EXPECT_FALSE(power.Status() || power.Busy() || power.Error());
  power.Enable = true;
  power();
  EXPECT_TRUE(power.Busy() && power.Active() && power.Valid() && !power.Status());
  ASSERT_TRUE(Until(power, [&] { return power.Status(); }));
  EXPECT_TRUE(power.Valid() && !power.Error());
  EXPECT_EQ(bench.State(bench.x), axis::PlcState::kStandstill);
  power.Enable = false;
  ASSERT_TRUE(Until(power, [&] { return !power.Status(); }));
  EXPECT_EQ(bench.State(bench.x), axis::PlcState::kDisabled);
}

// AX-20, AX-11: Error shows the fault that opened the loop as long as it is there; after a reset it is closed again.
TEST_F(Power, ClosesTheLoopAgainAfterAReset) {
  MC_Power power(bench.w);
  MC_MoveVelocity fast(bench.w);
  MC_Reset reset(bench.w);
  power.Enable = true;
  ASSERT_TRUE(Until(power, [&] { return power.Status(); }));
  fast.velocity = 400;
  fast.Execute = true;
  ASSERT_TRUE(Until(fast, [&] { return !fast.Busy(); }));
  power();
  EXPECT_EQ(power.ErrorID(), ErrorId::kDeviation);
  EXPECT_FALSE(power.Status() || power.Valid() || power.Busy());
  bench.Step(50);
  power();
  EXPECT_TRUE(power.Error());
  reset.Execute = true;
  ASSERT_TRUE(Until(reset, [&] { return reset.Done(); }));
  power();
  EXPECT_TRUE(!power.Error() && power.Busy() && power.Active());
  ASSERT_TRUE(Until(power, [&] { return power.Status(); }));
  EXPECT_FALSE(power.Busy());
}

// AX-20: a drive that does not get ready is an error that stays until it is reset, and is tried again then.
TEST_F(Power, TriesAgainADriveThatWasNotReady) {
  MC_Power power(bench.r);
  MC_Reset reset(bench.r);
  power.Enable = true;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(Until(power, [&] { return power.Error(); }));
    EXPECT_EQ(power.ErrorID(), ErrorId::kDrive);
    EXPECT_EQ(bench.State(bench.r), axis::PlcState::kErrorStop);
    reset.Execute = true;
    ASSERT_TRUE(Until(reset, [&] { return reset.Done(); }));
    reset.Execute = false;
    reset();
    power();
    EXPECT_TRUE(!power.Error() && power.Busy());
  }
  ASSERT_TRUE(Until(power, [&] { return power.Error(); }));
  power.Enable = false;
  ASSERT_TRUE(Until(power, [&] { return bench.State(bench.r) == axis::PlcState::kDisabled; }));
  EXPECT_FALSE(power.Error());
}

// AX-20: Enable comes back while the axis brakes.
TEST_F(Power, ChangesItsMind) {
  MC_Power power(bench.x);
  MC_MoveVelocity ever(bench.x);
  power.Enable = true;
  ASSERT_TRUE(Until(power, [&] { return power.Status(); }));
  ever.velocity = 100;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  power.Enable = false;
  power();
  bench.Step(5);
  power.Enable = true;
  power();
  EXPECT_TRUE(power.Status() && power.Busy());
  ASSERT_TRUE(Until(power, [&] { return !power.Status(); }));
  ASSERT_TRUE(Until(power, [&] { return power.Status(); }));
  EXPECT_FALSE(power.Busy());
}

// AX-12: switching off waits for the move; a buffer mode that there is not is an error, and not tried for ever.
TEST_F(Power, BufferedAndRefused) {
  bench.PowerOn(bench.x);
  MC_Power power(bench.x);
  MC_MoveRelative move(bench.x);
  power.Enable = true;
  power();
  move.distance = 20;
  move.Execute = true;
  move();
  bench.Step(5);
  power.Enable = false;
  power.buffer_mode = axis::BufferMode::kBuffered;
  power();
  bench.Step();
  power();
  EXPECT_TRUE(power.Busy() && !power.Active() && power.Status());
  ASSERT_TRUE(Until(power, [&] { return !power.Status(); }));
  move();
  EXPECT_TRUE(move.Done());

  power.Enable = true;
  power.buffer_mode = axis::BufferMode::kAborting;
  ASSERT_TRUE(Until(power, [&] { return power.Status(); }));
  power.Enable = false;
  power.buffer_mode = axis::BufferMode::kBlendingLow;
  ASSERT_TRUE(Until(power, [&] { return power.Error(); }));
  const std::uint64_t applied = bench.engine.figures().commands_applied;
  for (int i = 0; i < 5; ++i) {
    bench.Step();
    power();
    EXPECT_EQ(power.ErrorID(), ErrorId::kParameter);
    EXPECT_TRUE(power.Status());
  }
  EXPECT_EQ(bench.engine.figures().commands_applied, applied);
  power.Enable = true;
  power();
  EXPECT_FALSE(power.Error());

  // Once the axis is in another state it is given again.
  power.Enable = false;
  ASSERT_TRUE(Until(power, [&] { return power.Error(); }));
  power.buffer_mode = axis::BufferMode::kAborting;
  bench.Step(5);
  power();
  EXPECT_TRUE(power.Error());
  move.Execute = false;
  move();
  move.Execute = true;
  move();
  ASSERT_TRUE(Until(power, [&] { return !power.Status(); }));
  EXPECT_FALSE(power.Error());
}

// The same when switching on.
TEST_F(Power, RefusedWhenSwitchingOn) {
  MC_Power power(bench.x);
  power.Enable = true;
  power.buffer_mode = axis::BufferMode::kBlendingLow;
  ASSERT_TRUE(Until(power, [&] { return power.Error(); }));
  bench.Step(20);
  power();
  EXPECT_EQ(power.ErrorID(), ErrorId::kParameter);
  EXPECT_EQ(bench.engine.figures().commands_applied, 1u);
}

// AX-11: both wait for the same drive; the one that was superseded says so once and follows the axis.
TEST_F(Power, TwoInstances) {
  MC_Power first(bench.x), second(bench.x);
  first.Enable = second.Enable = true;
  first();
  second();
  bench.Step();
  first();
  EXPECT_TRUE(first.CommandAborted() && first.Aborted() && !first.Busy());
  ASSERT_TRUE(Until(first, [&] {
    second();
    EXPECT_FALSE(second.CommandAborted() || second.Error());
    return first.Status() && second.Status();
  }));
  // Both switch off an axis that moves: each gives one command, instead of aborting the other's for ever.
  MC_MoveVelocity ever(bench.x);
  ever.velocity = 300;
  ever.Execute = true;
  ASSERT_TRUE(Until(ever, [&] { return ever.InVelocity(); }));
  const std::uint64_t applied = bench.engine.figures().commands_applied;
  first.Enable = second.Enable = false;
  ASSERT_TRUE(Until(first, [&] {
    second();
    return !first.Status() && !second.Status();
  }));
  EXPECT_EQ(bench.engine.figures().commands_applied, applied + 2);
}

}  // namespace
}  // namespace takt::plcopen
