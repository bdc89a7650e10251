// Whole programs as one writes them: the example of takt/plcopen/program.h.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "../core/allocations.h"
#include "bench.h"
#include "takt/engine/scheduler.h"

namespace takt::plcopen {
namespace {

// Power on, move without homing, then a stop against a second move, which it holds at rest until the operator lets go.
struct Transfer {
  explicit Transfer(Program& p)
      : program(p), power(p.Axis("x")), there(p.Axis("x")), back(p.Axis("x")), stop(p.Axis("x")), read(p.Axis("x")) {
    power.Enable = true;
    read.Enable = true;
    there.position = 120;
    there.velocity = 300;
    back.distance = -100;
    back.velocity = 200;
    stop.deceleration = 3000;
  }

  void Scan() noexcept {
    program.Update();
    read();
    power();
    there.Execute = power.Status();
    there();
    back.Execute = there.Done();
    back();
    stop.Execute = operator_stops;
    stop();
  }

  Program& program;
  MC_Power power;
  MC_MoveAbsolute there;
  MC_MoveRelative back;
  MC_Stop stop;
  MC_ReadStatus read;
  bool operator_stops = false;
};

// AX-11, AX-20, AX-30, AX-31, AX-37.
TEST(Scenario, TransferStoppedOnTheWayBack) {
  engine::Engine engine(TheMachine());
  Program program(engine);
  Transfer transfer(program);
  const axis::Outputs& x = program.Axis("x").outputs();
  const auto cycles = [&](int n, const auto& until) {
    for (; n > 0; --n) {
      transfer.Scan();
      if (until()) return true;
      engine.RunCycle();
    }
    return false;
  };

  EXPECT_FALSE(transfer.power.Status());
  ASSERT_TRUE(cycles(500, [&] { return transfer.power.Status(); }));
  ASSERT_TRUE(cycles(2000, [&] { return transfer.there.Done(); }));
  EXPECT_DOUBLE_EQ(x.set_position, 120);
  EXPECT_TRUE(transfer.back.Busy());

  cycles(200, [] { return false; });
  EXPECT_DOUBLE_EQ(x.set_velocity, -200);
  transfer.operator_stops = true;
  const double where = x.set_position;
  ASSERT_TRUE(cycles(500, [&] { return transfer.stop.Done(); }));
  EXPECT_TRUE(transfer.back.CommandAborted());
  EXPECT_FALSE(transfer.back.Done());
  // v²/2a and half of what it takes to build up and ease out a with the jerk of 100 000: v/2 · a/j.
  EXPECT_NEAR(where - x.set_position, 200. * 200 / 2 / 3000 + 200. / 2 * 3000 / 100000, 0.3);

  cycles(100, [] { return false; });
  EXPECT_TRUE(transfer.read.Stopping());
  transfer.operator_stops = false;
  ASSERT_TRUE(cycles(10, [&] { return transfer.read.Standstill(); }));
  EXPECT_FALSE(transfer.stop.Done());
}

// Blocks belong to the cycle's thread.
TEST(Scenario, AllocatesNothing) {
  engine::Engine engine(TheMachine());
  Program program(engine);
  Transfer transfer(program);
  GT_Jog jog(program.Axis("y"));
  jog.Enable = true;
  const long before = AllocationsOfThisThread();
  for (int i = 0; i < 3000; ++i) {
    transfer.operator_stops = i > 1000;
    transfer.Scan();
    jog.JogPos = i / 100 % 2 == 1;
    jog();
    engine.RunCycle();
  }
  EXPECT_EQ(AllocationsOfThisThread(), before);
  EXPECT_TRUE(transfer.stop.Done());
}

// The same program in the cycle's own thread, as in real time.
TEST(Scenario, RunsWithTheScheduler) {
  engine::Engine engine(TheMachine());
  Program program(engine);
  Transfer transfer(program);
  const std::atomic<int> signals{0};
  engine::SchedulerOptions options;
  options.pace = engine::Pace::kFast;
  options.duration_s = 1.5;
  std::uint64_t calls = 0;
  options.program = [&] {
    ++calls;
    transfer.Scan();
  };
  const engine::RunResult result = engine::Run(engine, options, signals);
  EXPECT_EQ(result.end, engine::RunEnd::kStopped);
  EXPECT_EQ(calls, result.cycles);
  EXPECT_DOUBLE_EQ(program.Axis("x").outputs().set_position, 20);
  EXPECT_TRUE(engine.all_disabled());
}

TEST(Scenario, AxesGoByTheirNames) {
  engine::Engine engine(TheMachine());
  Program program(engine);
  EXPECT_EQ(program.Axis("r").target(), 2u);
  EXPECT_THROW(program.Axis("z"), std::invalid_argument);
}

}  // namespace
}  // namespace takt::plcopen
