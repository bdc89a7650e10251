// GR-22, GR-24: blends of lines that are chords of a curve, which meet in the middle between two corners.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../core/trials.h"
#include "paths.h"
#include "takt/core/angle.h"
#include "takt/path/blend.h"

namespace takt::path {
namespace {

using testing::Length;
using testing::Line;
using testing::PeakCurvature;
using testing::Random;
using testing::StepBetween;

// From its middle to the middle of the next one.
Segment Round(const Segment& first, const Segment& second, const Bends& bends) {
  Segment out;
  EXPECT_EQ(Blend(first, first.length / 2, second, second.length / 2, bends, out), Problem::kNone);
  return out;
}

Triple Bend(const Segment& before, const Segment& chord, const Segment& after) {
  const auto bend = ChordCurvature(before, chord, after);
  EXPECT_TRUE(bend.has_value());
  return bend.value_or(Triple{});
}

// GR-24: for the sides of a regular polygon it is the circle that touches them, whose radius is L / (2 tan(angle/2)).
TEST(Chords, OfARegularPolygonGiveACircle) {
  for (const double degrees : {0.1, 1.0, 5.0, 20.0, 45.0, 72.0, 90.0}) {
    std::vector<Segment> sides;
    KDL::Vector at(0, 0, 0);
    for (int i = 0; i < 4; ++i) {
      const KDL::Vector to = at + KDL::Rotation::RotZ(i * degrees * kDegree) * KDL::Vector(0, 7, 0);
      sides.push_back(Line({Frame(at), {}}, {Frame(to), {}}));
      at = to;
    }
    const double radius = 3.5 / std::tan(degrees / 2 * kDegree);
    const KDL::Vector centre(-radius, 3.5, 0);
    const Triple first = Bend(sides[0], sides[1], sides[2]), second = Bend(sides[1], sides[2], sides[3]);
    const Segment blend = Round(sides[1], sides[2], {first, second});
    for (int n = 0; n <= 100; ++n) {
      const MovingFrame frame = At(blend, blend.length * n / 100);
      EXPECT_NEAR(Length(frame.p.p - centre) / radius, 1, degrees < 30 ? 1e-7 : 4e-4) << degrees;
      EXPECT_NEAR(Length(frame.p.dv) * radius, 1, 5e-3) << degrees;
    }
  }
}

// No curve bends where the next chord continues straight, or to the other side; a sharp corner belongs to no curve.
TEST(Chords, BendOnlyWhereTheCurveDoes) {
  const auto line = [](double x0, double y0, double x1, double y1) {
    return Line(testing::At(x0, y0), testing::At(x1, y1));
  };
  const Segment before = line(-1, -0.1, 0, 0), chord = line(0, 0, 1, 0);
  EXPECT_EQ(Bend(before, chord, line(1, 0, 2, 0)), Triple{});
  EXPECT_EQ(Bend(before, chord, line(1, 0, 2, 0.1)), Triple{});
  EXPECT_LT(Bend(before, chord, line(1, 0, 2, -0.1))[1], -0.05);
  EXPECT_FALSE(ChordCurvature(before, chord, line(1, 0, 0.9, -1)).has_value());
  EXPECT_FALSE(ChordCurvature(line(0.1, -1, 0, 0), chord, line(1, 0, 2, -0.1)).has_value());
  const Segment arc = testing::Arc(testing::At(1, 0), {.auxiliary_point = {2, -0.1, 0}}, testing::At(3, -0.5));
  EXPECT_FALSE(ChordCurvature(before, chord, arc).has_value());
}

// GR-22: whatever the chords: from one blend to the next neither tangent nor curvature jumps, nor the rate of the
// orientation; none makes a loop; and none bends much more than a blend that begins and ends without a curvature.
TEST(Chords, PropertyOfAnyPolyline) {
  Random random(31);
  double worst_peak = 0;
  for (int trial = 0; trial < Trials(200); ++trial) {
    const double mean = random.Size(1e-2, 100), most = random.Size(0.01, 80), spread = random.Between(1, 2.5);
    const double turn = random.Coin() ? random.Between(0, 0.2) : 0;
    std::vector<Segment> lines;
    KDL::Vector at = 100 * random.Direction(), way = random.Direction();
    KDL::Rotation tool = random.Orientation();
    for (int i = 0; i < 8; ++i) {
      const KDL::Vector to = at + way * mean * random.Between(1, spread);
      const KDL::Rotation next = tool * KDL::Rotation::Rot(random.Direction(), turn);
      lines.push_back(Line({Frame(tool, at), {at.x()}}, {Frame(next, to), {to.x()}}));
      at = to;
      tool = next;
      way = KDL::Rotation::Rot(random.Across(way), random.Between(0, most) * kDegree) * way;
    }
    std::vector<Triple> bends{Triple{}};
    for (std::size_t i = 2; i < lines.size(); ++i) bends.push_back(Bend(lines[i - 2], lines[i - 1], lines[i]));
    bends.push_back({});
    Segment last;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const Segment blend = Round(lines[i - 1], lines[i], {bends[i - 1], bends[i]});
      const double peak = PeakCurvature(blend, 200);
      if (i > 1) {
        const auto step = StepBetween(last, last.length, blend, 0);
        ASSERT_LT(step.place, 1e-10) << trial;
        ASSERT_LT(step.tangent, 1e-10) << trial;
        ASSERT_LT(step.curvature, 1e-6 * peak) << trial;
        ASSERT_LT(step.turning, 1e-9 / blend.length) << trial;
        ASSERT_LT(step.auxiliary_rate, 1e-9) << trial;
      }
      last = blend;
      const KDL::Vector on = At(lines[i - 1], 0).p.v + At(lines[i], 0).p.v;
      for (int n = 0; n <= 100; ++n) ASSERT_GT(KDL::dot(At(blend, blend.length * n / 100).p.v, on), 0) << trial;
      // Without: with the same distance before and behind the corner, no longer than the shorter half.
      const double d = std::min(lines[i - 1].length, lines[i].length) / 2;
      Segment plain;
      ASSERT_EQ(Blend(lines[i - 1], lines[i - 1].length - d, lines[i], d, plain), Problem::kNone);
      // It may be bent at its ends as its neighbours are.
      const double ends = std::max(Length(At(blend, 0).p.dv), Length(At(blend, blend.length).p.dv));
      worst_peak = std::max(worst_peak, peak / std::max(PeakCurvature(plain, 200), ends));
    }
  }
  EXPECT_LT(worst_peak, 1.35);
  std::cout << "largest curvature beside that of plain blends: " << worst_peak << "\n";
}

}  // namespace
}  // namespace takt::path
