// GR-20: circular arcs and helices, in the three ways of MC_MoveCircular.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "paths.h"
#include "takt/path/make.h"

namespace takt::path {
namespace {

using testing::Arc;
using testing::Length;
using testing::Random;

constexpr double kPi = std::numbers::pi;

Circle Border(const Triple& border, double turns = 0) {
  return {.mode = CircMode::kBorder, .auxiliary_point = border, .turns = turns};
}
Circle Center(const Triple& center, PathChoice choice, const Triple& normal = {}, double turns = 0) {
  return {CircMode::kCenter, center, choice, normal, turns};
}
Circle Radius(const Triple& normal, PathChoice choice, double turns = 0) {
  return {CircMode::kRadius, normal, choice, {}, turns};
}
constexpr PathChoice kCcw = PathChoice::kCounterclockwise, kCw = PathChoice::kClockwise, kShort = PathChoice::kShort,
                     kLong = PathChoice::kLong;

void ExpectAt(const Segment& arc, double share, double x, double y, double z, double tolerance = 1e-12) {
  const KDL::Vector p = At(arc, share * arc.length).p.p;
  EXPECT_NEAR(p.x(), x, tolerance);
  EXPECT_NEAR(p.y(), y, tolerance);
  EXPECT_NEAR(p.z(), z, tolerance);
}

const double kDiagonal = 10 * std::sqrt(0.5);

// GR-20: a quarter of a circle of 10 mm about (10, 0), by hand; its curvature points at the centre.
TEST(Arcs, QuarterCircle) {
  const Segment arc = Arc({}, Border({10 - kDiagonal, kDiagonal, 0}), testing::At(10, 10));
  EXPECT_NEAR(arc.length, 5 * kPi, 1e-12);
  ExpectAt(arc, 0.5, 10 - kDiagonal, kDiagonal, 0);
  ExpectAt(arc, 1, 10, 10, 0);
  EXPECT_LT(Length(At(arc, 0).p.v - KDL::Vector(0, 1, 0)), 1e-14);
  EXPECT_LT(Length(At(arc, 0).p.dv - KDL::Vector(0.1, 0, 0)), 1e-14);
  EXPECT_LT(Length(At(arc, arc.length).p.v - KDL::Vector(1, 0, 0)), 1e-14);
  EXPECT_LT(Length(At(arc, arc.length).p.dv - KDL::Vector(0, -0.1, 0)), 1e-14);
}

// GR-20: the border point determines the sense: on the other side the arc is three quarters.
TEST(Arcs, BorderSaysWhichWay) {
  const Segment arc = Arc({}, Border({20, 0, 0}), testing::At(10, 10));
  EXPECT_NEAR(arc.length, 15 * kPi, 1e-12);
  ExpectAt(arc, 2.0 / 3, 20, 0, 0);
  const Segment more = Arc({}, Border({20, 0, 0}, 2), testing::At(10, 10));
  EXPECT_NEAR(more.length, 55 * kPi, 1e-12);
  ExpectAt(more, 1, 10, 10, 0);
}

// GR-20: the arc passes exactly through its border point and ends at its end, anywhere in space, of any size.
TEST(Arcs, PropertyBorderIsMet) {
  Random random(41);
  for (int i = 0; i < Trials(1000); ++i) {
    const double size = random.Size(1e-3, 1e4);
    const KDL::Vector from = random.Direction() * random.Between(0, 1000);
    const KDL::Vector border = from + random.Direction() * size, to = from + random.Direction() * size;
    if (Length((border - from) * (to - from)) < 1e-4 * size * size) continue;
    const Segment arc = Arc({Frame(from), {}}, Border({border.x(), border.y(), border.z()}), {Frame(to), {}});
    double least = INFINITY, best = 0;
    const auto distance = [&](double s) { return Length(At(arc, s).p.p - border); };
    for (int n = 0; n <= 200; ++n) {
      if (distance(arc.length * n / 200) < least) least = distance(best = arc.length * n / 200);
    }
    for (int n = 0; n < 6; ++n) {
      const MovingFrame f = At(arc, best);
      best += KDL::dot(border - f.p.p, f.p.v) / (1 - KDL::dot(border - f.p.p, f.p.dv));
    }
    const double allowed = 1e-12 * (1000 + arc.length);
    ASSERT_LT(distance(best), allowed) << "trial " << i;
    ASSERT_LT(Length(At(arc, arc.length).p.p - to), allowed) << "trial " << i;
    ASSERT_GT(best, 0);
    ASSERT_LT(best, arc.length);
  }
}

// GR-20: center mode: the choice counts about the normal; without one its Z points up.
TEST(Arcs, CenterGoesEitherWay) {
  const Point from = testing::At(10, 0), to = testing::At(0, 10);
  const Segment left = Arc(from, Center({0, 0, 0}, kCcw), to);
  EXPECT_NEAR(left.length, 5 * kPi, 1e-12);
  ExpectAt(left, 0.5, kDiagonal, kDiagonal, 0);
  const Segment right = Arc(from, Center({0, 0, 0}, kCw), to);
  EXPECT_NEAR(right.length, 15 * kPi, 1e-12);
  ExpectAt(right, 1.0 / 3, 0, -10, 0);
  const Segment seen_from_below = Arc(from, Center({0, 0, 0}, kCcw, {0, 0, -3}), to);
  EXPECT_NEAR(seen_from_below.length, 15 * kPi, 1e-12);
  // In the plane of Z and X the normal is Y, in that of Y and Z it is X.
  EXPECT_NEAR(Arc(testing::At(0, 0, 10), Center({0, 0, 0}, kCcw), testing::At(10, 0, 0)).length, 5 * kPi, 1e-12);
  EXPECT_NEAR(Arc(testing::At(0, 10, 0), Center({0, 0, 0}, kCcw), testing::At(0, 0, 10)).length, 5 * kPi, 1e-12);
}

// GR-20: start, centre and end on a line: half a circle and a whole one lie level if possible.
TEST(Arcs, CenterOnALine) {
  const Segment half = Arc(testing::At(10, 0, 5), Center({0, 0, 5}, kCw), testing::At(-10, 0, 5));
  EXPECT_NEAR(half.length, 10 * kPi, 1e-12);
  ExpectAt(half, 0.5, 0, -10, 5);
  const Segment whole = Arc(testing::At(10, 0, 5), Center({0, 0, 5}, kCcw), testing::At(10, 0, 5));
  EXPECT_NEAR(whole.length, 20 * kPi, 1e-12);
  ExpectAt(whole, 0.25, 0, 10, 5);
  const Segment upright = Arc(testing::At(10, 0, 0), Center({0, 0, 0}, kCcw, {0, 1, 0}), testing::At(10, 0, 0));
  ExpectAt(upright, 0.25, 0, 0, -10);
}

// GR-20: radius mode: counterclockwise about the vector, short or long, by hand.
TEST(Arcs, RadiusHasFourArcs) {
  const Point from = testing::At(10, 0), to = testing::At(0, 10);
  const Segment a = Arc(from, Radius({0, 0, 10}, kShort), to);
  EXPECT_NEAR(a.length, 5 * kPi, 1e-12);
  ExpectAt(a, 0.5, kDiagonal, kDiagonal, 0);
  const Segment b = Arc(from, Radius({0, 0, 10}, kLong), to);  // about (10, 10)
  EXPECT_NEAR(b.length, 15 * kPi, 1e-12);
  ExpectAt(b, 1.0 / 3, 20, 10, 0);
  const Segment c = Arc(from, Radius({0, 0, -10}, kShort), to);
  EXPECT_NEAR(c.length, 5 * kPi, 1e-12);
  ExpectAt(c, 0.5, 10 - kDiagonal, 10 - kDiagonal, 0);
  const Segment d = Arc(from, Radius({0, 0, -10}, kLong), to);
  EXPECT_NEAR(d.length, 15 * kPi, 1e-12);
  ExpectAt(d, 1.0 / 3, 0, -10, 0);
}

// GR-20: the length of a helix of n turns, radius r and rise h is the hypotenuse of 2 pi n r and h.
TEST(Arcs, HelixLength) {
  const double angle = 2 * kPi * 3.25, length = std::hypot(angle * 10, 40);
  for (const Segment& helix :
       {Arc(testing::At(10, 0, 1), Center({0, 0, 77}, kCcw, {0, 0, 2}, 3), testing::At(0, 10, 41)),
        Arc(testing::At(10, 0, 1), Radius({0, 0, 10}, kShort, 3), testing::At(0, 10, 41))}) {
    EXPECT_NEAR(helix.length, length, 1e-10);
    EXPECT_LT(Length(At(helix, 5).p.v) - 1, 1e-14);
    EXPECT_NEAR(Length(At(helix, 5).p.dv), 10 * angle * angle / (length * length), 1e-14);
    ExpectAt(helix, 2.0 / 3.25, 10, 0, 1 + 40 * 2.0 / 3.25, 1e-11);
    ExpectAt(helix, 1, 0, 10, 41, 1e-11);
  }
  // Straight above the start: one whole turn, and those on top.
  const Segment screw = Arc(testing::At(10, 0), Center({0, 0, 0}, kCw, {0, 0, 1}, 1), testing::At(10, 0, 6));
  EXPECT_NEAR(screw.length, std::hypot(40 * kPi, 6), 1e-12);
  ExpectAt(screw, 0.125, 0, -10, 0.75);
}

// GR-20: nearly a line: a radius of 10 km is as accurate as one of 10 mm.
TEST(Arcs, NearlyStraight) {
  const Segment arc = Arc({}, Border({50, 1.25e-4, 0}), testing::At(100, 0));
  EXPECT_NEAR(arc.length, 100 + 8.0 / 3 * 1.25e-4 * 1.25e-4 / 100, 1e-12);
  ExpectAt(arc, 0.5, 50, 1.25e-4, 0, 1e-11);
  ExpectAt(arc, 1, 100, 0, 0, 1e-11);
}

// GR-20: small errors of the centre are compensated by moving it, those of the radius by growing; both ends are met.
TEST(Arcs, TakesSmallErrors) {
  const Point from = testing::At(10, 0), to = testing::At(0, 10);
  const Segment center = Arc(from, Center({0.006, 0, 0}, kCcw), to);
  EXPECT_NEAR(center.length, 5 * kPi, 0.02);
  ExpectAt(center, 0, 10, 0, 0);
  ExpectAt(center, 1, 0, 10, 0);
  const Segment radius = Arc(testing::At(-10, 0), Radius({0, 0, 9.995}, kShort), testing::At(10, 0));
  EXPECT_NEAR(radius.length, 10 * kPi, 1e-9);
  ExpectAt(radius, 0.5, 0, -10, 0);
  ExpectAt(radius, 1, 10, 0, 0);
}

// GR-21: orientation and auxiliary axes in step with the arc length.
TEST(Arcs, TakeOrientationsAlong) {
  const Segment arc =
      Arc({Frame({10, 0, 0}), {4}}, Center({0, 0, 0}, kCcw), {Frame(KDL::Rotation::RotX(1), {0, 10, 0}), {8}});
  const MovingFrame f = At(arc, arc.length / 4);
  EXPECT_TRUE(KDL::Equal(f.M.R, KDL::Rotation::RotX(0.25), 1e-14));
  EXPECT_NEAR(f.M.w.x(), 1 / arc.length, 1e-15);
  EXPECT_DOUBLE_EQ(AuxiliariesAt(arc, arc.length / 4).position[0], 5);
}

// GR-20: every kind of bad input has its reason and leaves the segment unchanged.
TEST(Arcs, Refuse) {
  const double nan = std::nan("");
  const Point o = testing::At(0, 0), a = testing::At(10, 0), b = testing::At(0, 10);
  Segment out;
  out.length = 7;
  const auto refuse = [&](const Point& from, const Circle& circle, const Point& to, Problem expected) {
    EXPECT_EQ(MakeArc(from, circle, to, out), expected);
    EXPECT_EQ(out.length, 7);
  };
  refuse(o, Border({5, 0, 0}), a, Problem::kCollinear);
  refuse(o, Border({15, 1e-8, 0}), a, Problem::kCollinear);
  refuse(o, Border({10, 0, 0}), a, Problem::kCoincide);
  refuse(o, Border({5, 5, 0}), o, Problem::kCoincide);
  refuse(o, Border({nan, 0, 0}), a, Problem::kNotFinite);
  refuse(testing::At(nan, 0), Border({5, 5, 0}), a, Problem::kNotFinite);
  refuse(o, Border({5, 5, 0}, 0.5), a, Problem::kTurns);
  refuse(o, Border({5, 5, 0}, -1), a, Problem::kTurns);
  refuse(o, Border({5, 5, 0}, nan), a, Problem::kTurns);
  refuse(a, Center({10, 0, 0}, kCcw), b, Problem::kRadiusZero);
  refuse(a, Center({10, 0, 9}, kCcw, {0, 0, 1}), b, Problem::kRadiusZero);
  refuse(a, Center({0.1, 0, 0}, kCcw), b, Problem::kNotOnCircle);
  refuse(a, Center({0, 0, 0}, kCcw), testing::At(0, 10.1), Problem::kNotOnCircle);
  refuse(testing::At(0, 0, 10), Center({0, 0, 0}, kCcw), testing::At(0, 0, -10), Problem::kNoPlane);
  refuse(a, Center({0, 0, 0}, kShort), b, Problem::kChoice);
  refuse(a, Center({0, 0, 0}, kCcw, {nan, 0, 0}), b, Problem::kNotFinite);
  refuse(a, Radius({0, 0, 0}, kShort), b, Problem::kRadiusZero);
  refuse(a, Radius({0, 0, 7}, kShort), b, Problem::kNotOnCircle);
  refuse(a, Radius({0, 0, 10}, kShort), a, Problem::kCoincide);
  refuse(a, Radius({0, 0, 10}, kCcw), b, Problem::kChoice);
  refuse(a, Radius({0, 0, INFINITY}, kShort), b, Problem::kNotFinite);
  refuse(testing::At(1e200, 0), Center({0, 0, 0}, kCcw), testing::At(0, 1e200), Problem::kNotOnCircle);
}

// GR-20: whatever is requested, the result is a reason or a segment of finite numbers with both ends where they have to
// be.
TEST(Arcs, PropertyAnswersEverything) {
  Random random(42);
  const std::vector<double> odd{0, -0.0, 1e-300, 1e300, -1e300, 1e18, std::nan(""), INFINITY};
  int made = 0;
  for (int i = 0; i < Trials(20000); ++i) {
    const double size = random.Size(1e-6, 1e6);
    const auto triple = [&]() -> Triple {
      const KDL::Vector v = random.Direction() * size;
      return {v.x(), v.y(), i % 3 ? 0 : v.z()};
    };
    Triple from = triple(), to = triple();
    Circle circle{static_cast<CircMode>(i % 3), triple(), static_cast<PathChoice>(i / 3 % 4), triple(), 0};
    if (i % 5 == 0)
      circle.auxiliary_point[static_cast<std::size_t>(i) % 3] = odd[static_cast<std::size_t>(i / 5) % odd.size()];
    if (i % 7 == 0) from[static_cast<std::size_t>(i) % 3] = odd[static_cast<std::size_t>(i / 7) % odd.size()];
    if (i % 11 == 0) circle.normal = {};
    if (i % 13 == 0) to = from;
    Segment out;
    if (MakeArc(testing::At(from[0], from[1], from[2]), circle, testing::At(to[0], to[1], to[2]), out) !=
        Problem::kNone) {
      continue;
    }
    ++made;
    ASSERT_TRUE(std::isfinite(out.length) && out.length > 0);
    ASSERT_TRUE(kinematics::Finite(At(out, out.length / 3)));
    // An end that nearly coincides with the start counts as the start.
    const double allowed = kSame + 1e-9 * (out.length + std::abs(to[0]) + std::abs(to[1]) + std::abs(to[2]));
    ASSERT_LT(Length(At(out, out.length).p.p - KDL::Vector(to[0], to[1], to[2])), allowed) << i;
  }
  EXPECT_GT(made, Trials(2000));
}

// GR-20, GR-30: for the cycle.
TEST(Arcs, AllocateNothing) {
  const Point from = testing::At(10, 0), to = testing::At(0, 10);
  const long before = AllocationsOfThisThread();
  Segment out;
  Problem worst = MakeArc(from, Border({7, 8, 1}), to, out);
  worst = std::max(worst, MakeArc(from, Center({0, 0, 0}, kCcw), to, out));
  worst = std::max(worst, MakeArc(from, Radius({0, 0, 12}, kLong), to, out));
  const MovingFrame frame = At(out, 1);
  worst = std::max(worst, MakeLine(from, to, out));
  EXPECT_EQ(AllocationsOfThisThread() - before, 0);
  EXPECT_EQ(worst, Problem::kNone);
  EXPECT_TRUE(kinematics::Finite(frame));
}

}  // namespace
}  // namespace takt::path
