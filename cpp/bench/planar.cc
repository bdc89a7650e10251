// PL-20, PL-24, PL-60: what it costs to look up a place on a track, to find the nearest one, and to make tracks.

#include <benchmark/benchmark.h>

#include "takt/planar/clearance.h"
#include "takt/planar/nearest.h"
#include "takt/planar/track.h"

namespace takt::planar {
namespace {

Element Line(const Place& start, const Place& end) {
  return {ElementShape::kLine, start, end};
}

// Round a rectangle, with an arc at one of its corners.
Layout Rectangle() {
  return {.elements = {Line({100, 0}, {900, 0}),
                       Line({1000, 100}, {1000, 900}),
                       {ElementShape::kArc, {960, 920}, {960, 1080}, {960, 1000}, false},
                       Line({900, 1080}, {100, 1080}),
                       Line({0, 980}, {0, 100})},
          .closed = true};
}
// A zigzag of so many lines.
Layout Zigzag(int lines) {
  Layout layout;
  for (int i = 0; i < lines; ++i) {
    const double x = 400.0 * i, y = i % 2 == 0 ? 0 : 200;
    layout.elements.push_back(Line({x, y}, {x + 200, y}));
  }
  return layout;
}

Track Make(const Layout& layout) {
  Track track;
  MakeTrack(layout, track);
  return track;
}

// All pieces, as they come.
void LookUp(benchmark::State& state, bool transitions) {
  const Track track = Make(Zigzag(static_cast<int>(state.range(0))));
  double share = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    share += 0.0123;
    if (share > 1) share -= 1;
    do i = (i + 7) % track.pieces.size();
    while (track.pieces[i].given == transitions);
    benchmark::DoNotOptimize(At(track, track.pieces[i].start + share * track.pieces[i].segment.length));
  }
}

void FindNearest(benchmark::State& state) {
  const Track track = Make(Zigzag(static_cast<int>(state.range(0))));
  double share = 0;
  for (auto _ : state) {
    share += 0.0123;
    if (share > 1) share -= 1;
    benchmark::DoNotOptimize(NearestTo(track, {share * 400 * static_cast<double>(state.range(0)), 150}));
  }
  state.counters["cells"] = static_cast<double>(track.cells.size());
}

void MakeOne(benchmark::State& state) {
  const Layout layout = Rectangle();
  for (auto _ : state) benchmark::DoNotOptimize(Make(layout));
}

void FindConflicts(benchmark::State& state) {
  const TrackPoint start{{0, 0}, 0};
  const Track left = Make({.elements = {Line({100, 100}, {100, 1000})}, .from = start});
  const Track right = Make({.elements = {Line({200, 0}, {1000, 0})}, .from = start});
  const Footprint mover{113, 113};
  for (auto _ : state) benchmark::DoNotOptimize(Conflicts(left, mover, right, mover, 1, 0.1));
}

BENCHMARK_CAPTURE(LookUp, given, false)->Name("AtGiven")->Arg(5)->Arg(100);
BENCHMARK_CAPTURE(LookUp, transitions, true)->Name("AtTransition")->Arg(5)->Arg(100);
BENCHMARK(FindNearest)->Name("NearestTo")->Arg(5)->Arg(20)->Arg(100);
BENCHMARK(MakeOne)->Name("MakeTrack")->Unit(benchmark::kMicrosecond);
BENCHMARK(FindConflicts)->Name("Conflicts")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace takt::planar
