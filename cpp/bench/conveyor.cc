// CV-30: what belts full of objects cost a cycle, stepped and published, and with them a Delta in step with one.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "cpp/group/machines.h"
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

// Belts that go to and fro, and a Delta that stays on an object of the first one.
class InStep {
 public:
  explicit InStep(std::size_t count) : belts_(count) {
    params_.name = params_.axis = "belt";
    params_.origin = {0, 0, -880, 0, 0, 0};
    drive_.loop_closed = true;
    for (State& belt : belts_) {
      for (std::size_t i = 0; i < kObjects; ++i) Apply(Now(), 0, Detect{.x = 10.0 * static_cast<double>(i)}, belt);
    }
    rig_.carriers = {[](void*, std::string_view name) noexcept -> std::uint32_t { return name == "belt" ? 1 : 0; },
                     [](void* owner, std::uint32_t) noexcept {
                       const auto* self = static_cast<InStep*>(owner);
                       return CarrierOf(self->params_, self->belts_[0].travel);
                     },
                     [](void*, std::uint32_t, double position) noexcept { return position; }, this};
    rig_.StartAt({0, 0, -870, 0, 0, 0});
    rig_.Give(group::SetDynCoordTransform{.pcs = 1, .carrier = Name::Of("belt"), .recorded_position = 0.0});
    group::MoveLinearAbsolute onto{.x = 0, .y = 0, .z = 10};
    onto.coordinate_system = group::CoordinateSystem::kPcs;
    rig_.Give(onto);
    for (int i = 0; i < 4000; ++i) Cycle();
  }
  InStep(const InStep&) = delete;

  // ns of belts and group.
  double Cycle() {
    using Clock = std::chrono::steady_clock;
    constexpr double kReach = 100, kPace = 4;  // mm, rad/s
    double time = 0;
    rig_.trace.clear();
    rig_.Step([&](const auto& group) {
      const double angle = kPace * static_cast<double>(rig_.cycle.count) * rig_.cycle.period_s;
      drive_.setpoint = {kReach * std::sin(angle), kReach * kPace * std::cos(angle),
                         -kReach * kPace * kPace * std::sin(angle)};
      const auto from = Clock::now();
      for (State& belt : belts_) conveyor::Step(Now(), belt);
      group();
      for (const State& belt : belts_) {
        Publish(Now(), belt, out_);
        benchmark::DoNotOptimize(out_);
      }
      group::Publish(rig_.Now(), rig_.state, group_out_);
      benchmark::DoNotOptimize(group_out_);
      time = std::chrono::duration<double, std::nano>(Clock::now() - from).count();
    });
    return time;
  }
  bool rides() const { return rig_.out().in_sync && std::abs(rig_.out().x - belts_[0].travel.position) < 1e-6; }

 private:
  Context Now() { return {params_, drive_, drive_params_, rig_.cycle, feedback_}; }

  BeltParams params_;
  axis::State drive_;
  axis::AxisParams drive_params_;
  std::vector<FeedbackEvent> storage_ = std::vector<FeedbackEvent>(1024);
  FeedbackSink feedback_{storage_};
  std::vector<State> belts_;
  group::Rig rig_ = group::DeltaRobot();
  Outputs out_;
  group::Outputs group_out_;
};

void BeltsAndDelta(benchmark::State& bench) {
  InStep cell(static_cast<std::size_t>(bench.range(0)));
  std::vector<double> times;
  for (auto _ : bench) {
    times.push_back(cell.Cycle());
    bench.SetIterationTime(times.back() * 1e-9);
  }
  std::ranges::sort(times);
  bench.counters["median_ns"] = times[times.size() / 2];
  bench.counters["p98_ns"] = times[times.size() * 98 / 100];
  bench.counters["largest_ns"] = times.back();
  if (!cell.rides()) bench.SkipWithError("not in step");
}
BENCHMARK(BeltsAndDelta)->Arg(1)->Arg(16)->UseManualTime();

}  // namespace
}  // namespace takt::conveyor
