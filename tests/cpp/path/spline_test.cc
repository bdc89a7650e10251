// GR-20: splines through points for MovePath.
#include "takt/path/spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../core/trials.h"
#include "paths.h"
#include "takt/path/blend.h"

namespace takt::path {
namespace {

using testing::Length;
using testing::PeakCurvature;
using testing::Random;
using testing::StepBetween;

std::vector<Segment> Spline(const std::vector<Point>& points, const SplineOptions& options = {}) {
  std::vector<Segment> pieces;
  EXPECT_EQ(MakeSpline(points, options, pieces), Problem::kNone);
  EXPECT_EQ(pieces.size() + 1, points.size());
  return pieces;
}

// GR-20: through two points it is a line with constant rates.
TEST(Splines, LineThroughTwoPoints) {
  const Point from{Frame(KDL::Rotation::RotX(0.1), {1, 2, 3}), {5}},
      to{Frame(KDL::Rotation::RotX(1.1), {4, 6, 15}), {6}};
  for (const Spacing spacing : {Spacing::kCentripetal, Spacing::kChord}) {
    const Segment piece = Spline({from, to}, {.spacing = spacing})[0];
    EXPECT_NEAR(piece.length, 13, 1e-12);
    const MovingFrame f = At(piece, 3.25);
    EXPECT_LT(Length(f.p.p - KDL::Vector(1.75, 3, 6)), 1e-12);
    EXPECT_LT(Length(f.p.dv), 1e-12);
    EXPECT_LT(Length(f.M.w - KDL::Vector(1 / 13.0, 0, 0)), 1e-14);
    EXPECT_TRUE(KDL::Equal(f.M.R, KDL::Rotation::RotX(0.35), 1e-14));
    EXPECT_NEAR(AuxiliariesAt(piece, 3.25).position[0], 5.25, 1e-14);
  }
}

// GR-20: by hand: the natural cubic spline through (0, 0), (1, 1), (2, 0) with equal steps has slopes 1.5, 0, -1.5;
// with steps of 1 the first piece is y = (3 u - u³) / 2.
TEST(Splines, NaturalCubicByHand) {
  const auto pieces = Spline({testing::At(0, 0), testing::At(1, 1), testing::At(2, 0)});
  EXPECT_NEAR(pieces[0].place[1][1], 1.5, 1e-14);
  EXPECT_NEAR(pieces[0].place[2][1], 0, 1e-14);
  EXPECT_NEAR(pieces[0].place[3][1], -0.5, 1e-14);
  EXPECT_NEAR(pieces[1].place[1][1], 0, 1e-14);
  EXPECT_NEAR(At(pieces[1], pieces[1].length).p.p.x(), 2, 1e-14);
}

// GR-20: with the directions of a circle at its ends a spline through 33 points of it is the circle to 1e-4 mm of 100.
TEST(Splines, FollowsACircle) {
  std::vector<Point> points;
  for (int i = 0; i <= 32; ++i) points.push_back(testing::At(100 * std::cos(i / 10.0), 100 * std::sin(i / 10.0)));
  const Triple end{-std::sin(3.2), std::cos(3.2), 0};
  double sum = 0;
  for (const Segment& piece : Spline(points, {.start_direction = Triple{0, 5, 0}, .end_direction = end})) {
    sum += piece.length;
    for (int i = 0; i <= 10; ++i) {
      const MovingFrame f = At(piece, piece.length * i / 10);
      EXPECT_NEAR(Length(f.p.p), 100, 1e-4);
      EXPECT_NEAR(Length(f.p.dv), 0.01, 1e-4);
    }
  }
  EXPECT_NEAR(sum, 320, 1e-3);
}

// GR-20, GR-21, GR-22: it meets its points, and nothing jumps from piece to piece: they need no blend.
TEST(Splines, PropertyGoOnSmoothly) {
  Random random(51);
  for (int trial = 0; trial < Trials(50); ++trial) {
    const double size = random.Size(1e-2, 1e3);
    std::vector<Point> points;
    for (int i = 0; i < 8; ++i) {
      points.push_back(
          {Frame(random.Orientation(), random.Direction() * (size * random.Size(0.1, 3))), random.SomeAuxiliaries()});
    }
    SplineOptions options{random.Coin() ? Spacing::kChord : Spacing::kCentripetal, {}, {}};
    const KDL::Vector direction = random.Direction();
    if (random.Coin()) options.start_direction = Triple{direction.x(), direction.y(), direction.z()};
    const auto pieces = Spline(points, options);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Point end = PointAt(pieces[i], pieces[i].length);
      ASSERT_LT(Length(end.frame.p - points[i + 1].frame.p), 1e-11 * (1 + size));
      ASSERT_TRUE(KDL::Equal(end.frame.M, points[i + 1].frame.M, 1e-12));
      ASSERT_NEAR(end.auxiliaries[0], points[i + 1].auxiliaries[0], 1e-11);
      if (i == 0) continue;
      const auto step = StepBetween(pieces[i - 1], pieces[i - 1].length, pieces[i], 0);
      const double peak = std::max(PeakCurvature(pieces[i - 1]), PeakCurvature(pieces[i]));
      ASSERT_LT(step.tangent, 1e-11);
      ASSERT_LT(step.curvature, 1e-9 * peak);
      ASSERT_LT(step.turning * pieces[i].length, 1e-10);
      ASSERT_LT(step.auxiliary_rate * pieces[i].length, 1e-9);
      ASSERT_TRUE(Smooth(pieces[i - 1], pieces[i])) << trial << " " << i;
    }
    if (options.start_direction) {
      ASSERT_LT(Length(At(pieces[0], 0).p.v - direction), 1e-12);
    } else {
      ASSERT_LT(Length(At(pieces[0], 0).p.dv), 1e-9 * PeakCurvature(pieces[0]));
    }
  }
}

// GR-20: bad input has its reason and leaves the output unchanged.
TEST(Splines, Refuse) {
  std::vector<Segment> out(3);
  const auto refuse = [&](const std::vector<Point>& points, const SplineOptions& options, Problem expected) {
    EXPECT_EQ(MakeSpline(points, options, out), expected);
    EXPECT_EQ(out.size(), 3u);
  };
  const Point a = testing::At(0, 0), b = testing::At(1, 0);
  refuse({}, {}, Problem::kTooFew);
  refuse({a}, {}, Problem::kTooFew);
  refuse({a, b, b}, {}, Problem::kCoincide);
  refuse({a, testing::At(5e-7, 0)}, {}, Problem::kCoincide);
  refuse({a, testing::At(std::nan(""), 0)}, {}, Problem::kNotFinite);
  refuse({a, b}, {.start_direction = Triple{}}, Problem::kLengthZero);
  refuse({a, b}, {.end_direction = Triple{0, INFINITY, 0}}, Problem::kNotFinite);
}

}  // namespace
}  // namespace takt::path
