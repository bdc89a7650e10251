// AX-90: what the move stage of one axis costs (set point, state machine, feedback), by state and number of axes,
// beside Ruckig's own at_time for as many trajectories in the same run.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <ruckig/ruckig.hpp>
#include <vector>

#include "takt/axis/axis.h"

namespace takt::axis {
namespace {

AxisParams Params(bool limits) {
  AxisParams p;
  p.name = "x";
  p.limits = {.velocity = 500, .acceleration = 5000, .deceleration = 5000, .jerk = 100000, .lower = {}, .upper = {}};
  if (limits) p.limits.lower = -1e9, p.limits.upper = 1e9;
  p.encoder.increments_per_unit = 1e6;
  return p;
}

// Many powered axes, each given the same command.
struct Axes {
  Axes(std::size_t n, const AxisParams& p) : params(n, p), states(n, MakeState(p)), storage(16 * n), sink(storage) {
    machine.states = states, machine.params = params;
    for (std::size_t i = 0; i < n; ++i) Apply(At(i), 1, 0, Power{}, states[i]);
    ++cycle.count;  // the loop closes in a later cycle
    for (std::size_t i = 0; i < n; ++i) {
      states[i].drive_ready = true;
      Move(At(i), states[i]);
      if (!states[i].loop_closed) std::abort();
    }
  }
  Context At(std::size_t i) { return {params[i], cycle, planner, sink, nullptr, machine}; }
  void Give(const Command& command) {
    for (std::size_t i = 0; i < states.size(); ++i) Apply(At(i), 2, 0, command, states[i]);
  }
  void MoveAll() {
    ++cycle.count;
    for (std::size_t i = 0; i < states.size(); ++i) {
      states[i].actual = states[i].setpoint;
      Move(At(i), states[i]);
    }
    sink.Clear();
  }

  std::vector<AxisParams> params;
  std::vector<State> states;
  MachineView machine;
  std::vector<FeedbackEvent> storage;
  FeedbackSink sink;
  trajectory::Planner planner;
  Cycle cycle;
};

void Report(benchmark::State& state) {
  state.counters["per_axis"] = benchmark::Counter(
      static_cast<double>(state.range(0)), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void MoveStandstill(benchmark::State& state) {
  Axes axes(static_cast<std::size_t>(state.range(0)), Params(false));
  for (auto _ : state) axes.MoveAll();
  Report(state);
}

// A move that never ends within the run: its time is set back before the end.
void MoveMoving(benchmark::State& state) {
  Axes axes(static_cast<std::size_t>(state.range(0)), Params(false));
  axes.Give(MoveAbsolute{.position = 500});
  const std::uint64_t start = axes.cycle.count;
  for (auto _ : state) {
    axes.MoveAll();
    if (axes.cycle.count == start + 1000) axes.cycle.count = start;
  }
  Report(state);
}

// On and on, with SW limits: every set point is proven to be one that can still stop in front of them.
void MoveContinuous(benchmark::State& state) {
  Axes axes(static_cast<std::size_t>(state.range(0)), Params(true));
  axes.Give(MoveVelocity{.velocity = 400});
  for (auto _ : state) axes.MoveAll();
  Report(state);
}

// All in gear with one master on its way, in step with it.
void MoveGeared(benchmark::State& state) {
  Axes axes(static_cast<std::size_t>(state.range(0)) + 1, Params(false));
  Apply(axes.At(0), 2, 0, MoveVelocity{.velocity = 200}, axes.states[0]);
  GearIn gear;
  axes.params[0].name = "master";
  gear.master = Name::Of("master");
  for (std::size_t i = 1; i < axes.states.size(); ++i) Apply(axes.At(i), 2, 0, gear, axes.states[i]);
  for (int i = 0; i < 2000; ++i) axes.MoveAll();
  if (!axes.states.back().coupling.in_step) std::abort();
  for (auto _ : state) axes.MoveAll();
  Report(state);
}

// As many trajectories of the same move, evaluated at the same instants.
void AtTimeRuckig(benchmark::State& state) {
  ruckig::InputParameter<1> input;
  input.current_position = {0};
  input.current_velocity = {0};
  input.current_acceleration = {0};
  input.target_position = {500};
  input.max_velocity = {500};
  input.max_acceleration = {5000};
  input.max_jerk = {100000};
  ruckig::Ruckig<1> otg;
  ruckig::Trajectory<1> trajectory;
  otg.calculate(input, trajectory);
  std::vector<ruckig::Trajectory<1>> all(static_cast<std::size_t>(state.range(0)), trajectory);
  double t = 0;
  std::array<double, 1> p{}, v{}, a{};
  for (auto _ : state) {
    t = t < 1 ? t + 0.001 : 0;
    for (auto& one : all) {
      one.at_time(t, p, v, a);
      benchmark::DoNotOptimize(p);
    }
  }
  Report(state);
}

BENCHMARK(MoveStandstill)->Name("MoveStandstill/takt")->Arg(1)->Arg(100)->Arg(1000);
BENCHMARK(MoveMoving)->Name("MoveMoving/takt")->Arg(1)->Arg(100)->Arg(1000);
BENCHMARK(MoveContinuous)->Name("MoveContinuous/takt")->Arg(1)->Arg(100)->Arg(1000);
BENCHMARK(MoveGeared)->Name("MoveGeared/takt")->Arg(1)->Arg(100)->Arg(1000);
BENCHMARK(AtTimeRuckig)->Name("MoveMoving/ruckig")->Arg(1)->Arg(100)->Arg(1000);

}  // namespace
}  // namespace takt::axis
