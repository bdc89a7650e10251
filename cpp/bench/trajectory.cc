// What planning and evaluating a motion costs, beside Ruckig's own calculate and at_time in the same run.

#include <benchmark/benchmark.h>

#include <ruckig/ruckig.hpp>
#include <vector>

#include "takt/trajectory/planner.h"
#include "trajectory/problems.h"
#include "trajectory/reference_motions.h"

namespace takt::trajectory {
namespace {

using testing::Mix;
using testing::Problem;
using testing::Problems;

constexpr std::size_t kProblems = 4096;

// In metres, where Ruckig alone solves them all.
std::vector<Problem> MakeProblems(bool from_rest) {
  Problems problems(11, Mix{.unit = 0.001, .end_velocity_share = from_rest ? 0.0 : 0.3});
  std::vector<Problem> made(kProblems);
  for (Problem& p : made) {
    p = problems.Next();
    if (from_rest) p.from.velocity = p.from.acceleration = 0;
  }
  return made;
}

ruckig::InputParameter<1> ToInput(const Problem& p) {
  ruckig::InputParameter<1> input;
  input.current_position = {p.from.position};
  input.current_velocity = {p.from.velocity};
  input.current_acceleration = {p.from.acceleration};
  input.target_position = {p.position};
  input.target_velocity = {p.end_velocity};
  input.max_velocity = {p.limits.velocity};
  input.max_acceleration = {p.limits.acceleration};
  input.max_jerk = {p.limits.jerk};
  return input;
}

void PlanTakt(benchmark::State& state, bool from_rest) {
  const auto problems = MakeProblems(from_rest);
  Planner planner;
  Profile out;
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& p = problems[i++ % kProblems];
    benchmark::DoNotOptimize(planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, out));
  }
}

void PlanRuckig(benchmark::State& state, bool from_rest, bool to_velocity) {
  std::vector<ruckig::InputParameter<1>> inputs;
  for (const Problem& p : MakeProblems(from_rest)) inputs.push_back(ToInput(p));
  if (to_velocity) {
    for (auto& input : inputs) input.control_interface = ruckig::ControlInterface::Velocity;
  }
  ruckig::Ruckig<1> otg;
  ruckig::Trajectory<1> out;
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(otg.calculate(inputs[i++ % kProblems], out));
}

void ToVelocityTakt(benchmark::State& state) {
  const auto problems = MakeProblems(false);
  Planner planner;
  Profile out;
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& p = problems[i++ % kProblems];
    benchmark::DoNotOptimize(planner.ToVelocity(p.from, p.end_velocity, p.limits, out));
  }
}

// One motion followed at 1 kHz, as an axis does.
void AtTakt(benchmark::State& state) {
  const Problem p = MakeProblems(false)[0];
  Planner planner;
  Profile plan;
  (void)planner.ToPosition(p.from, p.position, p.end_velocity, p.limits, plan);
  double t = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(plan.At(t));
    t += 0.001;
    if (t > plan.duration()) t = 0;
  }
}

void AtRuckig(benchmark::State& state) {
  const Problem p = MakeProblems(false)[0];
  ruckig::Ruckig<1> otg;
  ruckig::Trajectory<1> plan;
  otg.calculate(ToInput(p), plan);
  double t = 0;
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
  for (auto _ : state) {
    plan.at_time(t, position, velocity, acceleration);
    benchmark::DoNotOptimize(position);
    benchmark::DoNotOptimize(velocity);
    benchmark::DoNotOptimize(acceleration);
    t += 0.001;
    if (t > plan.get_duration()) t = 0;
  }
}

void StopPositionTakt(benchmark::State& state) {
  const auto problems = MakeProblems(false);
  std::size_t i = 0;
  for (auto _ : state) {
    const Problem& p = problems[i++ % kProblems];
    benchmark::DoNotOptimize(StopPosition(p.from, p.limits));
  }
}

// A staircase with corners as overlaps, six coordinates: the whole plan, checks included, and each Newton step and
// interval of it.
void PlanAlongPath(benchmark::State& state) {
  const Limits limits{500, 5000, 5000, 100000};
  std::vector<testing::Point> points{{0, 0, 0}};
  for (int i = 0; i < 6; ++i) {
    testing::Point p = points.back();
    p[i % 2] += 25;
    points.push_back(p);
  }
  const testing::Polyline stairs(points, 0.05, limits, 0.0125);
  PathPlanner planner(500, 6);
  PathPlan plan(500);
  double steps = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(planner.Plan(stairs.Request(), plan));
    steps += planner.steps();
  }
  const double intervals = static_cast<double>(stairs.lengths.size());
  state.counters["intervals"] = intervals;
  state.counters["steps"] = planner.steps();
  state.counters["per_step_and_interval"] =
      benchmark::Counter(steps * intervals, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void PathPlanAt(benchmark::State& state) {
  const testing::Polyline line({{0, 0, 0}, {100, 0, 0}}, 0.05, {500, 5000, 5000, 100000}, 0.0125);
  PathPlanner planner(500, 6);
  PathPlan plan(500);
  (void)planner.Plan(line.Request(), plan);
  double t = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(plan.At(t));
    t += 0.001;
    if (t > plan.duration()) t = 0;
  }
}

BENCHMARK_CAPTURE(PlanTakt, from_any, false)->Name("PlanFromMotion/takt");
BENCHMARK_CAPTURE(PlanRuckig, from_any, false, false)->Name("PlanFromMotion/ruckig");
BENCHMARK_CAPTURE(PlanTakt, from_rest, true)->Name("PlanFromRest/takt");
BENCHMARK_CAPTURE(PlanRuckig, from_rest, true, false)->Name("PlanFromRest/ruckig");
BENCHMARK(ToVelocityTakt)->Name("PlanToVelocity/takt");
BENCHMARK_CAPTURE(PlanRuckig, velocity, false, true)->Name("PlanToVelocity/ruckig");
BENCHMARK(AtTakt)->Name("At/takt");
BENCHMARK(AtRuckig)->Name("At/ruckig");
BENCHMARK(StopPositionTakt)->Name("StopPosition");
BENCHMARK(PlanAlongPath);
BENCHMARK(PathPlanAt);

}  // namespace
}  // namespace takt::trajectory
