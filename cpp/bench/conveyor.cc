// CV-30, belt side: what belts full of objects cost a cycle, stepped and published.
#include <benchmark/benchmark.h>

#include <vector>

#include "takt/conveyor/belt.h"

namespace takt::conveyor {
namespace {

void Belts(benchmark::State& bench, BeltKind kind, axis::MasterSource source) {
  BeltParams params;
  params.kind = kind;
  params.source = source;
  params.upper_limit = 1e9;
  axis::AxisParams axis_params;
  axis::State axis;
  axis.loop_closed = true;
  Cycle cycle;
  std::vector<FeedbackEvent> storage(64);
  FeedbackSink feedback(storage);
  const Context context{params, axis, axis_params, cycle, feedback};
  std::vector<State> belts(static_cast<std::size_t>(bench.range(0)));
  for (State& belt : belts) {
    for (std::size_t i = 0; i < kObjects; ++i) Apply(context, 0, Detect{.x = 10.0 * static_cast<double>(i)}, belt);
  }
  Outputs out;
  for (auto _ : bench) {
    axis.setpoint = {axis.setpoint.position + 0.5, 500, 0};
    axis.actual = axis.setpoint;
    for (State& belt : belts) {
      Step(context, belt);
      Publish(context, belt, out);
      benchmark::DoNotOptimize(out);
    }
  }
}
BENCHMARK_CAPTURE(Belts, set_value, BeltKind::kStraight, axis::MasterSource::kSetValue)->Arg(1)->Arg(16);
BENCHMARK_CAPTURE(Belts, actual_value, BeltKind::kStraight, axis::MasterSource::kActualValue)->Arg(1)->Arg(16);
BENCHMARK_CAPTURE(Belts, tables, BeltKind::kTurning, axis::MasterSource::kActualValue)->Arg(1)->Arg(16);

}  // namespace
}  // namespace takt::conveyor
