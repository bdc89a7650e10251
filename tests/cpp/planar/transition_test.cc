// PL-20: transitions have position, direction and curvature of both sides, and bend little.
#include "takt/planar/transition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../core/trials.h"
#include "takt/core/angle.h"
#include "takt/path/segment.h"
#include "tracks.h"

namespace takt::planar {
namespace {

using testing::Random;

using Segments = std::vector<path::Segment>;

struct PlanePoint {
  double x, y, cosine, sine, curvature;
};
PlanePoint PlanePointAt(const path::Segment& segment, double s) {
  const auto p = path::At(segment, s).p;
  return {p.p.x(), p.p.y(), p.v.x(), p.v.y(), p.v.x() * p.dv.y() - p.v.y() * p.dv.x()};
}

double Peak(const Segments& segments) {
  double peak = 0;
  for (const path::Segment& segment : segments) {
    for (int i = 0; i <= 1000; ++i) {
      peak = std::max(peak, std::abs(PlanePointAt(segment, segment.length * i / 1000).curvature));
    }
  }
  return peak;
}

double Length(const Segments& segments) {
  double length = 0;
  for (const path::Segment& segment : segments) length += segment.length;
  return length;
}

TrackPoint RandomPoint(Random& random) {
  return {{random.Between(-100, 100), random.Between(-100, 100)},
          random.Between(-3, 3),
          random.Coin() ? 0 : random.Between(-0.03, 0.03)};
}

// PL-20: in line with both sides a transition does not bend.
TEST(Transitions, AreStraightWhereTheyCan) {
  Segments transition;
  const double direction = std::atan2(3, 4);
  ASSERT_EQ(MakeTransition({{1, 2}, direction}, {{41, 32}, direction}, transition), Problem::kNone);
  ASSERT_EQ(transition.size(), 1u);
  EXPECT_EQ(transition[0].shape, path::Shape::kLine);
  EXPECT_NEAR(Length(transition), 50, 1e-12);
}

// PL-20: a corner of 90° whose sides end 50 mm before it. No curve with both directions in the square of 50 mm bends
// less than the circle of 50 mm; a clothoid into it and out again needs 1.4 times that or more.
TEST(Transitions, BendLittleAroundCorners) {
  Segments transition;
  ASSERT_EQ(MakeTransition({{0, 0}, 0}, {{50, 50}, 90 * kDegree}, transition), Problem::kNone);
  EXPECT_LT(Peak(transition), 1.19 / 50);
  // Between the corner cut off and the corner itself, near to the quarter circle.
  EXPECT_NEAR(Length(transition), 50 * std::numbers::pi / 2, 0.05 * 50);
}

// PL-20: half a turn between parallel lines.
TEST(Transitions, BendLittleAroundUTurns) {
  Segments transition;
  ASSERT_EQ(MakeTransition({{0, 0}, 0}, {{0, 100}, 180 * kDegree}, transition), Problem::kNone);
  EXPECT_LT(Peak(transition), 1.25 / 50);
  EXPECT_LT(Length(transition), 1.2 * 50 * std::numbers::pi);
}

// PL-20: over random gaps both ends match.
TEST(Transitions, GoOnFromBothSides) {
  Random random(1);
  int made = 0;
  for (int i = 0; i < Trials(2000); ++i) {
    const TrackPoint begin = RandomPoint(random), end = RandomPoint(random);
    Segments transition;
    const Problem problem = MakeTransition(begin, end, transition);
    if (problem != Problem::kNone) continue;
    ++made;
    const double peak = Peak(transition);
    for (const bool first : {true, false}) {
      const TrackPoint& side = first ? begin : end;
      const PlanePoint e =
          first ? PlanePointAt(transition.front(), 0) : PlanePointAt(transition.back(), transition.back().length);
      EXPECT_NEAR(e.x, side.place.x, 1e-9);
      EXPECT_NEAR(e.y, side.place.y, 1e-9);
      EXPECT_NEAR(e.cosine, std::cos(side.direction), 1e-11);
      EXPECT_NEAR(e.sine, std::sin(side.direction), 1e-11);
      EXPECT_NEAR(e.curvature, side.curvature, 1e-9 * peak);
    }
    EXPECT_LT(peak, 1.001 / kLeastRadius);
  }
  EXPECT_GT(made, Trials(2000) * 3 / 4);
}

// PL-20: two gaps that differ only by position, rotation, mirroring or direction have transitions of the same length.
TEST(Transitions, AreTheSameWhereverTheyLie) {
  Random random(2);
  for (int i = 0; i < Trials(300); ++i) {
    const double distance = random.Between(40, 300);
    const double angle = random.Between(-1.4, 1.4), other = random.Between(-1.4, 1.4);
    const double bend = random.Between(-1, 1) / distance, other_bend = random.Between(-1, 1) / distance;
    const auto gap = [&](const Place& from, double direction, double side, bool back) {
      const Place to = testing::Ahead(from, direction, distance);
      const TrackPoint a{from, direction + side * angle, side * bend};
      const TrackPoint b{to, direction + side * other, side * other_bend};
      const TrackPoint a_back{from, a.direction + std::numbers::pi, -a.curvature};
      const TrackPoint b_back{to, b.direction + std::numbers::pi, -b.curvature};
      Segments transition;
      EXPECT_EQ(back ? MakeTransition(b_back, a_back, transition) : MakeTransition(a, b, transition), Problem::kNone);
      return Length(transition);
    };
    const double here = gap({0, 0}, 0, 1, false);
    const double there = gap({random.Between(-999, 999), random.Between(-999, 999)}, random.Between(-3, 3), 1, false);
    EXPECT_NEAR(there, here, 1e-5);
    EXPECT_NEAR(gap({0, 0}, 0, -1, false), here, 1e-5);
    EXPECT_NEAR(gap({0, 0}, 0, 1, true), here, 1e-5);
  }
}

// PL-20: an impossible gap is refused, and nothing is made.
TEST(Transitions, AreRefused) {
  struct Case {
    TrackPoint begin, end;
    Problem problem;
  };
  for (const Case& c : {
           Case{{{0, 0}, 0}, {{-100, 0}, 0}, Problem::kReversal},
           Case{{{0, 0}, 0}, {{100, 0}, 180 * kDegree}, Problem::kReversal},
           Case{{{0, 0}, 0}, {{0.5, 0.5}, 90 * kDegree}, Problem::kTooSharp},
           Case{{{0, 0}, 0}, {{10, 0}, 150 * kDegree}, Problem::kTooSharp},
       }) {
    Segments transition;
    EXPECT_EQ(MakeTransition(c.begin, c.end, transition), c.problem);
    EXPECT_TRUE(transition.empty());
  }
}

}  // namespace
}  // namespace takt::planar
