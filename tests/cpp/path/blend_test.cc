// GR-22: blends around corners: closed forms, and refusals.
#include "takt/path/blend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "../core/allocations.h"
#include "paths.h"
#include "takt/core/angle.h"

namespace takt::path {
namespace {

using testing::Length;
using testing::Line;
using testing::PeakCurvature;
using testing::StepBetween;

// Two lines of 100 mm that meet at the origin, where the path turns by an angle.
struct Lines {
  explicit Lines(double degrees, double turn_first = 0, double turn_second = 0)
      : first(Line({Frame(KDL::Rotation::RotZ(-turn_first * kDegree), {-100, 0, 0}), {-10}}, {})),
        second(Line({}, {Frame(KDL::Rotation::RotX(turn_second * kDegree),
                               {100 * std::cos(degrees * kDegree), 100 * std::sin(degrees * kDegree), 0}),
                         {30}})) {}
  Segment first;
  Segment second;
};

Segment BlendBetween(const Segment& first, double s_first, const Segment& second, double s_second) {
  Segment out;
  EXPECT_EQ(Blend(first, s_first, second, s_second, out), Problem::kNone);
  return out;
}

// GR-22: at a right angle the third control point is (1 - 0.4 * 1.7472) d before the corner, so that the middle of the
// curve is (16 - 5 * 1.7472) / 32 d from it along each leg; by hand from the rule: 0.3210 d in all.
TEST(Blend, RightAngleByHand) {
  const Lines lines(90);
  const Segment blend = BlendBetween(lines.first, 90, lines.second, 10);
  const double q = std::sqrt(0.5);
  const double c = q / (0.2067 + 0.28 * q);
  const double along = 10 * (16 - 5 * c) / 32;
  const KDL::Vector middle = At(blend, blend.length / 2).p.p;
  EXPECT_NEAR(middle.x(), -along, 1e-9);
  EXPECT_NEAR(middle.y(), along, 1e-9);
  EXPECT_NEAR(Deviation(lines.first, lines.second, blend), along * std::sqrt(2), 1e-9);
}

// The largest growth of the curvature vector along a blend, the third derivative of the position [1/mm²].
double PeakGrowth(const Segment& blend) {
  constexpr int kSteps = 4000;
  double most = 0;
  const double step = blend.length / kSteps;
  KDL::Vector before = At(blend, 0).p.dv;
  for (int i = 1; i <= kSteps; ++i) {
    const KDL::Vector now = At(blend, i * step).p.dv;
    most = std::max(most, Length(now - before) / step);
    before = now;
  }
  return most;
}

// GR-22: the largest curvature is at most 1.65 times that of the circle that begins and ends there, at any angle; up
// to a right angle it grows by 3.5 times that over the distance from the corner at most.
TEST(Blend, BendsLittleMoreThanACircle) {
  for (const double degrees : {0.1, 1.0, 10.0, 30.0, 60.0, 90.0, 120.0, 150.0, 170.0, 179.0}) {
    const Lines lines(degrees);
    const Segment blend = BlendBetween(lines.first, 90, lines.second, 10);
    const double circle = std::tan(degrees / 2 * kDegree) / 10;
    EXPECT_LT(PeakCurvature(blend, 4000) / circle, 1.65) << degrees;
    EXPECT_GT(PeakCurvature(blend, 4000) / circle, 1.0) << degrees;
    if (degrees <= 90) {
      EXPECT_LT(PeakGrowth(blend) / circle, 3.5 / 10)
          << degrees;  // with the least curvature it would be 6.3 to 6.9 / 10
    }
  }
}

// GR-22: with different distances on both sides, too, the curve bends at most 3 times as much as the circle on the
// shorter.
TEST(Blend, BendsLittleWithDifferentDistances) {
  for (const double degrees : {1.0, 30.0, 60.0, 90.0}) {
    for (const double behind : {10.0, 20.0, 50.0, 100.0}) {
      const Lines lines(degrees);
      const Segment blend = BlendBetween(lines.first, 95, lines.second, behind);
      EXPECT_LT(PeakCurvature(blend, 4000), 4 * std::tan(degrees / 2 * kDegree) / 5) << degrees << " " << behind;
    }
  }
}

// GR-22: the bound is reached, not only kept, where lines are long enough; else half of the shorter one is taken.
TEST(CornerDistances, UsesTheDeviation) {
  for (const double degrees : {0.1, 1.0, 10.0, 90.0, 170.0, 179.0}) {
    const Lines lines(degrees);
    for (const double deviation : {1e-4, 0.01, 1.0}) {
      const double d = CornerDistance(lines.first, lines.second, deviation, HalfOf(lines.first, lines.second));
      ASSERT_LE(d, 50);
      const Segment blend = BlendBetween(lines.first, 100 - d, lines.second, d);
      const double used = Deviation(lines.first, lines.second, blend) / deviation;
      EXPECT_LE(used, 1 + 1e-9);
      if (d < 50) {
        EXPECT_NEAR(used, 1, 1e-6) << degrees << " " << deviation;
      }
    }
  }
}

// GR-22: no more than the available length.
TEST(CornerDistances, KeepsToTheRoom) {
  const Lines lines(90);
  EXPECT_DOUBLE_EQ(CornerDistance(lines.first, lines.second, 10, {3, 40}), 3);
  EXPECT_DOUBLE_EQ(CornerDistance(lines.first, lines.second, 10, {40, 2}), 2);
  EXPECT_EQ(CornerDistance(lines.first, lines.second, 10, {40, 0}), 0);
  EXPECT_EQ(CornerDistance(lines.first, lines.second, 0, {40, 40}), 0);
  EXPECT_EQ(CornerDistance(lines.first, lines.second, -1, {40, 40}), 0);
  EXPECT_EQ(CornerDistance(lines.first, lines.second, std::nan(""), {40, 40}), 0);
}

// GR-22: a path that continues smoothly needs no blend; one that reverses has none.
TEST(CornerDistances, IsNothingWhereThereIsNothingToBlend) {
  const Segment a = Line(testing::At(0, 0), testing::At(100, 0));
  const Segment b = Line(testing::At(100, 0), testing::At(150, 0));
  const Segment back = Line(testing::At(100, 0), testing::At(50, 0));
  EXPECT_TRUE(Smooth(a, b));
  EXPECT_FALSE(Smooth(a, back));
  EXPECT_EQ(CornerDistance(a, b, 1, HalfOf(a, b)), 0);
  EXPECT_EQ(CornerDistance(a, back, 1, HalfOf(a, back)), 0);
}

// GR-21, GR-22: straight on, but turning about another axis from the middle on: the position stays on the line, the
// angular velocity is continuous.
TEST(Blend, EasesTurnsOnAStraightWay) {
  const Lines lines(0, 60, 90);
  EXPECT_FALSE(Smooth(lines.first, lines.second));
  EXPECT_DOUBLE_EQ(CornerDistance(lines.first, lines.second, 1e-3, HalfOf(lines.first, lines.second)), 50);
  const Segment blend = BlendBetween(lines.first, 80, lines.second, 20);
  EXPECT_NEAR(blend.length, 40, 1e-9);
  EXPECT_NEAR(Deviation(lines.first, lines.second, blend), 0, 1e-12);
  const KDL::Vector before(0, 0, 60 * kDegree / 100), behind(90 * kDegree / 100, 0, 0);
  EXPECT_LT(Length(At(blend, 0).M.w - before), 1e-15);
  EXPECT_LT(Length(At(blend, blend.length).M.w - behind), 1e-15);
  EXPECT_LT(Length(At(blend, 0).M.dw), 1e-15);
  EXPECT_LT(Length(At(blend, blend.length).M.dw), 1e-15);
  for (int i = 0; i <= 100; ++i) {
    const KDL::Vector w = At(blend, 0.4 * i).M.w;
    EXPECT_LE(Length(w), 1.05 * Length(behind));
  }
}

// GR-22: two turns on the spot and two moves of auxiliary axes, by hand: 3/16 of what a symmetric blend would cut.
TEST(Blend, JoinsTurnsAndAuxiliaries) {
  const Point start{Frame(KDL::Rotation::RotZ(-40 * kDegree)), {}}, end{Frame(KDL::Rotation::RotX(60 * kDegree)), {}};
  const Segment a = Line(start, {}), b = Line({}, end);
  ASSERT_EQ(a.measure, Measure::kTurn);
  const double d = CornerDistance(a, b, 2, HalfOf(a, b));
  EXPECT_NEAR(d, 2 / (std::sqrt(2) * 3 / 16), 1e-9);
  const Segment turn = BlendBetween(a, a.length - d, b, d);
  EXPECT_NEAR(Deviation(a, b, turn), 2, 1e-6);
  EXPECT_LT(StepBetween(a, a.length - d, turn, 0).turning, 1e-14);
  EXPECT_LT(StepBetween(turn, turn.length, b, d).turning, 1e-14);
  const Segment c = Line({Frame(), {-40}}, {}), e = Line({}, {Frame(), {-50}});
  ASSERT_EQ(c.measure, Measure::kAuxiliaries);
  const double f = CornerDistance(c, e, 1, HalfOf(c, e));
  EXPECT_NEAR(f, 1 / (2.0 * 3 / 16), 1e-9);
  const Segment moved = BlendBetween(c, c.length - f, e, f);
  EXPECT_NEAR(Deviation(c, e, moved), 1, 1e-6);
  EXPECT_LT(StepBetween(c, c.length - f, moved, 0).auxiliary_rate, 1e-14);
  EXPECT_LT(StepBetween(moved, moved.length, e, f).auxiliary_rate, 1e-14);
}

// GR-22: a half turn that is used up completely takes the sense of its segment.
TEST(Blend, KeepsTheWayOfAHalfTurn) {
  const Segment a = Line({Frame(KDL::Rotation::RotZ(std::numbers::pi), {-100, 0, 0}), {}}, {});
  const Segment b = Line({}, {Frame({0, 100, 0}), {}});
  const Segment blend = BlendBetween(a, 0, b, 100);
  const double way = At(a, 0).M.w.z();
  for (int i = 0; i < 100; ++i) EXPECT_GE(At(blend, blend.length * i / 100).M.w.z() * way, -1e-12) << i;
}

// GR-22: refusals leave the segment unchanged.
TEST(Blend, Refuses) {
  const Lines lines(90);
  Segment out;
  out.length = 7;
  const auto refuse = [&](const Segment& a, double s, const Segment& b, double t, Problem expected) {
    EXPECT_EQ(Blend(a, s, b, t, out), expected);
    EXPECT_EQ(out.length, 7);
  };
  const Segment &a = lines.first, &b = lines.second;
  refuse(a, -1, b, 10, Problem::kOutside);
  refuse(a, 100, b, 10, Problem::kOutside);
  refuse(a, std::nan(""), b, 10, Problem::kOutside);
  refuse(a, 90, b, 0, Problem::kOutside);
  refuse(a, 90, b, 101, Problem::kOutside);
  refuse(b, 90, a, 10, Problem::kApart);
  refuse(a, 90, Line({Frame(KDL::Rotation::RotX(1)), {}}, testing::At(0, 100)), 10, Problem::kApart);
  refuse(a, 90, Line({}, {Frame(), {1}}), 0.5, Problem::kMeasure);
  refuse(a, 90, Line({}, testing::At(-100, 0)), 10, Problem::kReversal);
  // Round the arc and back across the line.
  const Segment arc = testing::Arc({}, {.auxiliary_point = {-5, 5, 0}}, testing::At(-10, 0));
  refuse(a, 80, arc, arc.length, Problem::kTooSharp);
}

// GR-22, GR-30: for the cycle.
TEST(Blend, AllocatesNothing) {
  const Lines lines(70, 20, 50);
  const Segment arc =
      testing::Arc(PointAt(lines.second, 100), {.auxiliary_point = {30, 130, 10}}, testing::At(-20, 130, 40));
  const long before = AllocationsOfThisThread();
  Segment blend;
  double d = CornerDistance(lines.first, lines.second, 1, HalfOf(lines.first, lines.second));
  Problem problem = Blend(lines.first, 100 - d, lines.second, d, blend);
  const MovingFrame frame = At(blend, 1);
  const AuxiliaryMotion auxiliaries = AuxiliariesAt(blend, 1);
  d = CornerDistance(lines.second, arc, 0.1, HalfOf(lines.second, arc));
  problem = std::max(problem, Blend(lines.second, 100 - d, arc, d, blend));
  const double deviation = Deviation(lines.second, arc, blend);
  EXPECT_EQ(AllocationsOfThisThread() - before, 0);
  EXPECT_EQ(problem, Problem::kNone);
  EXPECT_TRUE(kinematics::Finite(frame));
  EXPECT_TRUE(std::isfinite(auxiliaries.position[0]) && deviation <= 0.1);
}

}  // namespace
}  // namespace takt::path
