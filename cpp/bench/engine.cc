// AX-91 and AX-01: whole cycles of a machine, with position loop and simulated servo, by number of axes; and the
// cycle's own overhead.
#include "takt/engine/engine.h"

#include <benchmark/benchmark.h>

namespace takt::engine {
namespace {

Machine MachineOf(std::int64_t axes, DriveMode mode) {
  Machine machine;
  machine.name = "bench";
  for (std::int64_t i = 0; i < axes; ++i) {
    axis::AxisParams axis;
    axis.name = "a" + std::to_string(i);
    axis.limits = {
        .velocity = 500, .acceleration = 5000, .deceleration = {}, .jerk = 100000, .lower = -1e9, .upper = 1e9};
    axis.supervision.deviation_moving = 100;
    axis.drive.mode = mode;
    machine.axes.push_back(axis);
  }
  return machine;
}

void GiveAll(Engine& engine, std::int64_t axes, const axis::Command& body) {
  for (std::int64_t i = 0; i < axes; ++i) {
    Command command;
    command.target = static_cast<std::uint32_t>(i + 1);
    command.body = body;
    while (engine.Submit(command) == 0) engine.RunCycle();
  }
}

void RunCycles(benchmark::State& state, DriveMode mode, bool moving) {
  const std::int64_t axes = state.range(0);
  Engine engine(MachineOf(axes, mode));
  GiveAll(engine, axes, axis::Power{});
  for (int i = 0; i < 500; ++i) engine.RunCycle();
  if (moving) GiveAll(engine, axes, axis::MoveVelocity{.velocity = 400});
  for (int i = 0; i < 500; ++i) engine.RunCycle();
  FeedbackEvent event;
  for (auto _ : state) {
    engine.RunCycle();
    while (engine.feedback().TryPop(event)) {
    }
  }
  state.counters["per_axis"] = benchmark::Counter(
      static_cast<double>(axes), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// A cycle without anything powered: what the engine itself costs.
void RunIdle(benchmark::State& state) {
  Engine engine(MachineOf(state.range(0), DriveMode::kCyclicPosition));
  for (auto _ : state) engine.RunCycle();
}

BENCHMARK(RunIdle)->Name("CycleIdle")->Arg(1)->Arg(6);
BENCHMARK_CAPTURE(RunCycles, csp, DriveMode::kCyclicPosition, false)
    ->Name("CycleStandstillCsp")
    ->Arg(6)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(RunCycles, csp_moving, DriveMode::kCyclicPosition, true)
    ->Name("CycleMovingCsp")
    ->Arg(6)
    ->Arg(100)
    ->Arg(1000);
BENCHMARK_CAPTURE(RunCycles, loop, DriveMode::kAnalog, true)
    ->Name("CycleMovingLoop")
    ->Arg(1)
    ->Arg(6)
    ->Arg(64)
    ->Arg(100)
    ->Arg(1000);

}  // namespace
}  // namespace takt::engine
