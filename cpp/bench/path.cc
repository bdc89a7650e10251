// GR-22, GR-30: what it costs to look up a place on a path, and to make a blend.

#include <benchmark/benchmark.h>

#include <vector>

#include "takt/path/blend.h"
#include "takt/path/make.h"
#include "takt/path/segment.h"
#include "takt/path/spline.h"

namespace takt::path {
namespace {

Point PointOf(double x, double y, double z, double turn) {
  return {Frame(KDL::Rotation::Rot({1, 2, 3}, turn), {x, y, z}), {turn, 2 * turn}};
}

Segment Line(const Point& from, const Point& to) {
  Segment out;
  MakeLine(from, to, out);
  return out;
}

Segment Arc(const Point& from, const Triple& border, const Point& to) {
  Segment out;
  MakeArc(from, {.mode = CircMode::kBorder, .auxiliary_point = border}, to, out);
  return out;
}

Segment StraightLine(double turn) {
  return Line(PointOf(0, 0, 0, 0), PointOf(100, 50, 20, turn));
}
Segment NextLine(double turn) {
  return Line(PointOf(100, 50, 20, turn), PointOf(80, 200, 0, 3 * turn));
}
Segment RoundArc(double turn) {
  return Arc(PointOf(0, 0, 0, 0), {50, 60, 10}, PointOf(100, 50, 20, turn));
}
Segment NextArc(double turn) {
  return Arc(PointOf(100, 50, 20, turn), {150, 60, 10}, PointOf(180, 50, 20, 2 * turn));
}
Segment Blended(double turn) {
  Segment out;
  const Segment first = StraightLine(turn), second = NextLine(turn);
  Blend(first, first.length - 20, second, 20, out);
  return out;
}
Segment SplinePiece(double turn) {
  std::vector<Segment> pieces;
  MakeSpline(std::vector{PointOf(0, 0, 0, 0), PointOf(100, 50, 20, turn), PointOf(80, 200, 0, 0)}, {}, pieces);
  return pieces[0];
}

void LookUp(benchmark::State& state, Segment (*make)(double), double turn) {
  const Segment segment = make(turn);
  double share = 0;
  for (auto _ : state) {
    share += 0.0123;
    if (share > 1) share -= 1;
    benchmark::DoNotOptimize(At(segment, share * segment.length));
  }
}

void Auxiliary(benchmark::State& state) {
  const Segment segment = Blended(1);
  double share = 0;
  for (auto _ : state) {
    share += 0.0123;
    if (share > 1) share -= 1;
    benchmark::DoNotOptimize(AuxiliariesAt(segment, share * segment.length));
  }
}

void Corners(benchmark::State& state, Segment (*make_first)(double), Segment (*make_second)(double), double turn) {
  const Segment first = make_first(turn), second = make_second(turn);
  for (auto _ : state) {
    const double d = CornerDistance(first, second, 1, HalfOf(first, second));
    Segment blend;
    benchmark::DoNotOptimize(Blend(first, first.length - d, second, d, blend));
    benchmark::DoNotOptimize(blend);
  }
}

// As the chords of a path need it: the curvature, and both blends with how far they are from the corners.
void RoundCorners(benchmark::State& state) {
  const Segment first = Line(PointOf(0, 0, 0, 0), PointOf(1, 0, 0, 0));
  const Segment second = Line(PointOf(1, 0, 0, 0), PointOf(2, 0.03, 0, 0));
  const Segment third = Line(PointOf(2, 0.03, 0, 0), PointOf(3, 0.09, 0, 0));
  for (auto _ : state) {
    const Triple bend = ChordCurvature(first, second, third).value_or(Triple{});
    Segment before, after;
    Blend(first, 0.5, second, 0.5, {{}, bend}, before);
    Blend(second, 0.5, third, 0.5, {bend, {}}, after);
    benchmark::DoNotOptimize(Deviation(first, second, before) + Deviation(second, third, after));
  }
}

BENCHMARK_CAPTURE(LookUp, line, StraightLine, 0)->Name("AtLine");
BENCHMARK_CAPTURE(LookUp, line_turning, StraightLine, 1)->Name("AtLineTurning");
BENCHMARK_CAPTURE(LookUp, arc, RoundArc, 0)->Name("AtArc");
BENCHMARK_CAPTURE(LookUp, arc_turning, RoundArc, 1)->Name("AtArcTurning");
BENCHMARK_CAPTURE(LookUp, blend, Blended, 0)->Name("AtBlend");
BENCHMARK_CAPTURE(LookUp, blend_turning, Blended, 1)->Name("AtBlendTurning");
BENCHMARK_CAPTURE(LookUp, spline, SplinePiece, 1)->Name("AtSplineTurning");
BENCHMARK(Auxiliary)->Name("AuxiliariesAtBlend");
BENCHMARK_CAPTURE(Corners, lines, StraightLine, NextLine, 0)->Name("BlendLines");
BENCHMARK_CAPTURE(Corners, lines_turning, StraightLine, NextLine, 1)->Name("BlendLinesTurning");
BENCHMARK_CAPTURE(Corners, line_arc, StraightLine, NextArc, 1)->Name("BlendLineArc");
BENCHMARK_CAPTURE(Corners, arcs, RoundArc, NextArc, 1)->Name("BlendArcs");
BENCHMARK(RoundCorners)->Name("BlendChords");
BENCHMARK_CAPTURE(Corners, spline, SplinePiece, NextLine, 1)->Name("BlendSplineLine");

}  // namespace
}  // namespace takt::path
