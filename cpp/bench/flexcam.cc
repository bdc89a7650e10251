// CAM-60: what a cam module and its slave cost a cycle, with everything on: filter of a measured master, ramps of
// scaling and offset, a sequence of cams, extreme values. The floor is a polynomial of the third degree
// (CamFloor/cubic_polynomial of bench_cam). The largest times are those of single cycles; they hold the machine's own
// interruptions, too, so the 99.9th of a hundred is given beside them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

#include "takt/axis/axis.h"
#include "takt/cam/build.h"
#include "takt/flexcam/module.h"

namespace takt::flexcam {
namespace {

axis::AxisParams Params(const char* name) {
  axis::AxisParams p;
  p.name = name;
  p.kind = axis::AxisKind::kRotary;
  p.limits = {.velocity = 1e4, .acceleration = 1e6, .deceleration = {}, .jerk = 1e8, .lower = {}, .upper = {}};
  p.encoder.increments_per_unit = 1e4;
  return p;
}

cam::CamParams Hill(const char* name, double height, std::size_t points) {
  cam::CamParams p;
  p.name = name;
  p.cyclic = true;
  for (std::size_t i = 0; i <= points; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(points);
    p.points.push_back({360 * share, height * share * share * (1 - share) * (1 - share), {}, {}});
  }
  return p;
}

// A master (axis 0) that goes round, a slave (axis 1) and their module.
struct Bench {
  Bench(const Settings& settings, std::size_t points)
      : params{Params("web"), Params("knife")},
        states(2, axis::MakeState(params[0])),
        cams{cam::Build(Hill("a", 100, points)).table.value(), cam::Build(Hill("b", 50, points)).table.value(),
             cam::Build(Hill("c", 70, points)).table.value()},
        storage(64),
        sink(storage) {
    module.settings = settings;
    module.source = axis::MasterSource::kActualValue;
    around = {states, params, {}, cams};
    state = MakeState(module, {1, 2, 3, 0});
    axis::Apply(At(0), 0, 0, axis::Power{}, states[0]);
    Tell(Control{.regulator_on = true});
    Cycle();
    for (axis::State& s : states) s.drive_ready = true;
    Cycle();
    Tell(Control{.sync_cam = true});
    for (int i = 0; i < 3000; ++i) Cycle();
    if (!states[1].loop_closed || !outputs.cam_synchronised) std::abort();
  }
  axis::Context At(std::size_t i) { return {params[i], cycle, planner, sink, nullptr, around}; }
  Context Module() { return {module, At(1), 0u, {}}; }
  void Tell(const Command& command) { Apply(Module(), 0, 0, command, states[1], state); }
  void Begin() {
    ++cycle.count;
    axis::State& master = states[0];
    master.setpoint = {master.setpoint.position + 0.7, 700, 0};
    if (master.setpoint.position > 360) master.setpoint.position -= 360, master.origin += 360;
    for (axis::State& s : states) s.actual = s.setpoint;
    sink.Clear();
  }
  void Step() {
    flexcam::Step(Module(), states[1], state);
    axis::Move(At(1), states[1]);
    Publish(Module(), states[1], state, outputs);
  }
  void Cycle() {
    Begin();
    Step();
  }

  FlexCamParams module;
  std::vector<axis::AxisParams> params;
  std::vector<axis::State> states;
  std::vector<cam::Table> cams;
  axis::MachineView around;
  std::vector<FeedbackEvent> storage;
  FeedbackSink sink;
  trajectory::Planner planner;
  takt::Cycle cycle;
  State state;
  Outputs outputs;
};

Settings Everything() {
  Settings s;
  s.master_filter_s = 0.01;
  s.master_dead_time_s = 0.002;
  s.offset_mode_master = OffsetMode::kRampIn;
  s.offset_mode_slave = OffsetMode::kRampIn;
  s.scaling_mode_master = ScalingMode::kRampRelative;
  s.scaling_mode_slave = ScalingMode::kRampAbsolute;
  s.calculate_bounds = true;
  s.cam_sequence_mode = SequenceMode::kCam1Cam3;
  return s;
}

void Coupled(benchmark::State& state) {
  Bench b({}, static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) b.Cycle();
}

// Everything on, and something new asked for now and then, so that ramps never end.
void WithEverything(benchmark::State& state) {
  Bench b(Everything(), static_cast<std::size_t>(state.range(0)));
  std::vector<double> times;
  times.reserve(1 << 22);
  std::uint64_t n = 0;
  for (auto _ : state) {
    b.Begin();
    const auto begin = std::chrono::steady_clock::now();
    if (++n % 200 == 0) {
      const double way = n % 400 == 0 ? 10 : -10;
      b.Tell(Control{.cam_sequencer = n % 4000 < 2000,
                     .offset_master = way,
                     .offset_slave = -way,
                     .scaling_master = 1 + 0.01 * way,
                     .scaling_slave = 1 - 0.01 * way});
    }
    b.Step();
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    state.SetIterationTime(1e-9 * took.count());
    if (times.size() < times.capacity()) times.push_back(took.count());
  }
  std::sort(times.begin(), times.end());
  state.counters["p99.9_ns"] = times[times.size() * 999 / 1000];
  state.counters["max_ns"] = times.back();
}

BENCHMARK(Coupled)->Name("FlexCamCoupled")->Arg(10)->Arg(10000);
BENCHMARK(WithEverything)->Name("FlexCamWithEverything")->UseManualTime()->Arg(10)->Arg(10000);

}  // namespace
}  // namespace takt::flexcam
