// CAM-04, CAM-60: what a look-up costs by the number of points, beside a cubic polynomial as the floor.
//
// Walk: the master goes round in 1,000 cycles, as in a machine. Anywhere: every x is a new one, so that large tables
// come from far memory. Crowded: half of the points lie in a millionth of the length.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "takt/cam/build.h"

namespace takt::cam {
namespace {

constexpr std::size_t kCycles = 1000;

Table TableOf(std::size_t n, Interpolation interpolation, bool crowded = false) {
  CamParams params;
  params.interpolation = interpolation;
  for (std::size_t i = 0; i < n; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(n - 1);
    const double x = crowded ? (share < 0.5 ? 1e-6 * share : share) : share;
    params.points.push_back({360 * x, std::sin(6.28 * x)});
  }
  return Build(params).table.value();
}

std::vector<double> Places(bool anywhere) {
  std::vector<double> xs(anywhere ? 1 << 16 : kCycles);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < xs.size(); ++i) {
    xs[i] =
        anywhere ? std::uniform_real_distribution(0.0, 360.0)(random) : 360 * static_cast<double>(i) / kCycles + 0.1;
  }
  return xs;
}

// Each x depends on the result before, as in a cycle, where one look-up follows another.
template <typename F>
void LookUp(benchmark::State& state, bool anywhere, F at) {
  const std::vector<double> xs = Places(anywhere);
  std::size_t i = 0;
  double tiny = 0;
  for (auto _ : state) {
    const Value value = at(xs[i] + tiny);
    tiny = 1e-300 * value.y;
    benchmark::DoNotOptimize(value);
    if (++i == xs.size()) i = 0;
  }
}

void Walk(benchmark::State& state) {
  const Table table = TableOf(static_cast<std::size_t>(state.range(0)), Interpolation::kQuintic);
  LookUp(state, false, [&](double x) { return table.At(x); });
}

void WalkLinear(benchmark::State& state) {
  const Table table = TableOf(static_cast<std::size_t>(state.range(0)), Interpolation::kLinear);
  LookUp(state, false, [&](double x) { return table.At(x); });
}

void Anywhere(benchmark::State& state) {
  const Table table = TableOf(static_cast<std::size_t>(state.range(0)), Interpolation::kQuintic);
  LookUp(state, true, [&](double x) { return table.At(x); });
}

void Crowded(benchmark::State& state) {
  const Table table = TableOf(static_cast<std::size_t>(state.range(0)), Interpolation::kLinear, true);
  LookUp(state, true, [&](double x) { return table.At(x < 180 ? 1e-6 * x : x); });
}

void WalkSine(benchmark::State& state) {
  CamParams params;
  CamSegment segment;
  segment.to = {360, 100};
  segment.law = Law::kModifiedSine;
  params.segments = {segment};
  const Table table = Build(params).table.value();
  LookUp(state, false, [&](double x) { return table.At(x); });
}

// The floor: a cubic polynomial with its derivatives, at hand.
void CubicPolynomial(benchmark::State& state) {
  double c[4] = {0.1, 0.2, 0.3, 0.4};
  benchmark::DoNotOptimize(c);
  LookUp(state, false, [&](double x) {
    return Value{c[0] + x * (c[1] + x * (c[2] + x * c[3])), c[1] + x * (2 * c[2] + x * 3 * c[3]),
                 2 * c[2] + x * 6 * c[3], 6 * c[3]};
  });
}

BENCHMARK(CubicPolynomial)->Name("CamFloor/cubic_polynomial");
BENCHMARK(Walk)->Name("CamWalk/quintic")->Arg(10)->Arg(100)->Arg(1000)->Arg(100000);
BENCHMARK(WalkLinear)->Name("CamWalk/linear")->Arg(10)->Arg(100)->Arg(1000)->Arg(100000);
BENCHMARK(WalkSine)->Name("CamWalk/modified_sine");
BENCHMARK(Anywhere)->Name("CamAnywhere/quintic")->Arg(10)->Arg(100)->Arg(1000)->Arg(100000);
BENCHMARK(Crowded)->Name("CamCrowded/linear")->Arg(10)->Arg(100)->Arg(1000)->Arg(100000);

}  // namespace
}  // namespace takt::cam
