// Whatever is pressed and let go on two instances of each block, and through all faults (AX-11).
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <random>
#include <utility>

#include "../core/trials.h"
#include "bench.h"

namespace takt::plcopen {
namespace {

// The interface rules of one block with Execute, looked at after every call.
template <typename B>
class Watched {
 public:
  explicit Watched(AxisRef axis) : block(axis) {}

  void Call() {
    const bool was_executed = executed_;
    block();
    const int ends = block.Done() + block.Error() + block.CommandAborted();
    EXPECT_LE(ends + block.Busy(), 1);
    EXPECT_LE(ends + block.Active(), 1);
    EXPECT_TRUE(block.Busy() || !(block.Active() || block.Reached()));
    EXPECT_EQ(block.Error(), block.ErrorID() != ErrorId::kNone);
    if (block.Execute || end_due_) {
      EXPECT_EQ(ends + block.Busy(), 1);  // let go of while busy: its end is shown in one call
    } else if (!was_executed) {
      EXPECT_EQ(ends, 0);
    }
    end_due_ = !block.Execute && block.Busy();
    executed_ = block.Execute;
    ended = ended || ends > 0;
  }

  B block;
  bool ended = false;

 private:
  bool executed_ = false;
  bool end_due_ = false;
};

struct Instances {
  explicit Instances(AxisRef x) : move(x), ever(x), halt(x), stop(x), reset(x), power(x), jog(x) {}

  void Call() {
    move.Call();
    ever.Call();
    halt.Call();
    stop.Call();
    reset.Call();
    jog();
    power();
    EXPECT_LE(power.Busy() + power.Error() + power.CommandAborted(), 1);
    EXPECT_TRUE(power.Busy() || !power.Active());
    EXPECT_FALSE(power.Valid() && power.Error());
  }

  Watched<MC_MoveAbsolute> move;
  Watched<MC_MoveVelocity> ever;
  Watched<MC_Halt> halt;
  Watched<MC_Stop> stop;
  Watched<MC_Reset> reset;
  MC_Power power;
  GT_Jog jog;
};

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : random_(seed) {}
  bool Coin() { return Below(2) == 1; }
  int Below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  axis::BufferMode Mode(int of) { return static_cast<axis::BufferMode>(Below(of)); }
  double Velocity() { return std::array{100.0, 400.0, -1.0}[static_cast<std::size_t>(Below(3))]; }

 private:
  std::mt19937 random_;
};

void Press(Dice& dice, Instances& on) {
  switch (dice.Below(7)) {
    case 0:
      on.move.block.velocity = dice.Velocity();
      on.move.block.position = 100;
      on.move.block.buffer_mode = dice.Mode(6);
      on.move.block.Execute = dice.Coin();
      break;
    case 1:  // also too fast: the loop opens
      on.ever.block.velocity = dice.Velocity();
      on.ever.block.direction = dice.Coin() ? axis::Direction::kPositive : axis::Direction::kNegative;
      on.ever.block.buffer_mode = dice.Mode(6);
      on.ever.block.Execute = dice.Coin();
      break;
    case 2:
      on.halt.block.buffer_mode = dice.Mode(2);
      on.halt.block.Execute = dice.Coin();
      break;
    case 3:
      on.stop.block.buffer_mode = dice.Mode(2);
      on.stop.block.Execute = dice.Coin();
      break;
    case 4:
      on.reset.block.Execute = dice.Coin();
      break;
    case 5:
      on.power.buffer_mode = dice.Mode(2);
      on.power.Enable = dice.Coin();
      break;
    default:
      on.jog.Enable = dice.Coin();
      on.jog.JogPos = dice.Coin();
      on.jog.JogNeg = dice.Coin();
  }
}

// AX-11: exactly one of Busy, Done, Error, CommandAborted while Execute is true, and each end is seen once. At last,
// with all keys let go, a reset brings back an axis whose MC_Power is still enabled (AX-20), and nothing holds it any
// more.
TEST(Properties, OutputsExcludeOneAnother) {
  int ended = 0;
  for (std::uint32_t seed = 0; seed < static_cast<std::uint32_t>(Trials(1000, 1)) && !testing::Test::HasFailure();
       ++seed) {
    SCOPED_TRACE(seed);
    Dice dice(seed);
    Bench bench;
    std::array<Instances, 2> both{Instances(bench.w), Instances(bench.w)};
    const auto run = [&](int cycles) {
      for (; cycles > 0; --cycles) {
        for (Instances& each : both) each.Call();
        bench.Step();
      }
    };
    for (Instances& each : both) {
      each.power.Enable = true;
      each.jog.velocity = 100;
    }
    run(150);
    for (int presses = 0; presses < 16; ++presses) {
      Instances& on = both[static_cast<std::size_t>(dice.Below(2))];
      Press(dice, on);
      on.Call();  // perhaps more than once in a cycle
      run(dice.Below(60));
    }
    for (Instances& on : both) {
      on.move.block.Execute = on.ever.block.Execute = on.halt.block.Execute = on.stop.block.Execute = false;
      on.reset.block.Execute = on.jog.JogPos = on.jog.JogNeg = false;
      on.power.Enable = true;
    }
    run(150);  // perhaps the drive is still getting ready
    auto& [first, second] = both;
    first.halt.block.buffer_mode = axis::BufferMode::kAborting;
    first.halt.block.Execute = true;
    run(200);
    first.halt.block.Execute = false;
    run(1);
    first.reset.block.Execute = true;
    run(300);
    EXPECT_TRUE(first.reset.block.Done());
    EXPECT_TRUE(first.power.Status() && second.power.Status() && !first.power.Busy() && !second.power.Busy());
    first.halt.block.Execute = true;
    run(20);
    EXPECT_TRUE(first.halt.block.Done());
    EXPECT_EQ(bench.State(bench.w), axis::PlcState::kStandstill);
    for (const Instances& on : both) ended += on.move.ended + on.ever.ended + on.stop.ended;
  }
  EXPECT_GT(ended, Trials(1000, 1));
}

}  // namespace
}  // namespace takt::plcopen
