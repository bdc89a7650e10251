// GR-20, GR-21: lines by arc length, orientations along great arcs, auxiliary axes.
#include "takt/path/segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

#include "../core/trials.h"
#include "paths.h"
#include "takt/core/angle.h"
#include "takt/core/describe.h"
#include "takt/core/verify.h"
#include "takt/path/blend.h"
#include "takt/path/spline.h"

namespace takt::path {
namespace {

using testing::DifferencesAt;
using testing::Kind;
using testing::kKinds;
using testing::Length;
using testing::Line;
using testing::MakeCorner;
using testing::PeakCurvature;
using testing::Random;

// GR-20: a segment is state: plain data whose members are all described.
TEST(Segments, ArePlainAndDescribed) {
  EXPECT_TRUE(std::is_trivially_copyable_v<Segment>);
  for (const Type* type :
       {&TypeOf<Segment>(), &TypeOf<Problem>(), &TypeOf<CircMode>(), &TypeOf<PathChoice>(), &TypeOf<Spacing>()}) {
    EXPECT_EQ(Verify(*type), std::vector<std::string>{});
  }
}

// GR-20: every problem has a text of its own.
TEST(Segments, ExplainProblems) {
  std::vector<std::string_view> texts;
  for (const Enumerator& e : TypeOf<Problem>().enumerators) {
    const std::string_view text = Text(static_cast<Problem>(e.value));
    EXPECT_EQ(text.empty(), e.value == 0);
    EXPECT_EQ(std::count(texts.begin(), texts.end(), text), 0) << text;
    texts.push_back(text);
  }
}

// GR-20: by hand: 3, 4 and 12 make 13.
TEST(Lines, GoStraight) {
  const Segment line = Line(testing::At(1, 2, 3), testing::At(4, 6, 15));
  EXPECT_EQ(line.measure, Measure::kWay);
  EXPECT_DOUBLE_EQ(line.length, 13);
  const MovingFrame middle = At(line, 6.5);
  EXPECT_LT(Length(middle.p.p - KDL::Vector(2.5, 4, 9)), 1e-14);
  EXPECT_LT(Length(middle.p.v - KDL::Vector(3, 4, 12) / 13), 1e-15);
  EXPECT_EQ(Length(middle.p.dv), 0);
  EXPECT_EQ(middle.M.R, KDL::Rotation::Identity());
  EXPECT_LT(Length(At(line, 13).p.p - KDL::Vector(4, 6, 15)), 1e-14);
}

// GR-20: an s outside of the segment, or no number, is one of its ends.
TEST(Lines, KeepToTheirEnds) {
  const Segment line = Line(testing::At(1, 2, 3), {Frame(KDL::Rotation::RotX(1), {4, 6, 15}), {5}});
  for (const double before : {-1.0, -1e308, std::nan("")}) {
    EXPECT_EQ(At(line, before).p.p, At(line, 0).p.p);
    EXPECT_EQ(AuxiliariesAt(line, before).position[0], 0);
  }
  for (const double behind : {13.1, 1e308}) {
    EXPECT_EQ(At(line, behind).p.p, At(line, 13).p.p);
    EXPECT_EQ(At(line, behind).M.R, At(line, 13).M.R);
    EXPECT_EQ(AuxiliariesAt(line, behind).position[0], 5);
  }
}

// GR-21: the orientation after a share of the length is the start turned by that share of the whole angle about one
// axis.
TEST(Lines, TurnAlongTheGreatArc) {
  const KDL::Rotation start = KDL::Rotation::RPY(0.3, -1, 2);
  const KDL::Vector axis(2 / 3.0, -1 / 3.0, 2 / 3.0);
  const Segment line = Line({Frame(start), {}}, {Frame(KDL::Rotation::Rot(axis, 2.4) * start, {10, 0, 0}), {}});
  for (const double s : {0.0, 2.5, 5.0, 10.0}) {
    const MovingFrame f = At(line, s);
    EXPECT_TRUE(KDL::Equal(f.M.R, KDL::Rotation::Rot(axis, 0.24 * s) * start, 1e-14));
    EXPECT_LT(Length(f.M.w - axis * 0.24), 1e-15);
    EXPECT_EQ(Length(f.M.dw), 0);
  }
}

// GR-21: auxiliary axes in step with the arc length, at whatever index.
TEST(Lines, TakeAuxiliariesAlong) {
  const Segment line = Line({Frame(), {1, 0, 7}}, {Frame({10, 0, 0}), {5, 0, 7, -2}});
  EXPECT_EQ(line.auxiliary_count, 4);
  const AuxiliaryMotion a = AuxiliariesAt(line, 2.5);
  EXPECT_EQ(a.position, (Auxiliaries{2, 0, 7, -0.5}));
  EXPECT_EQ(a.velocity, (Auxiliaries{0.4, 0, 0, -0.2}));
  EXPECT_EQ(a.acceleration, Auxiliaries{});
  EXPECT_EQ(PointAt(line, 2.5).auxiliaries, a.position);
}

// GR-20: the unit of s if the tool does not move: degrees of its turn, or the largest displacement of the auxiliary
// axes.
TEST(Lines, CountTurnsAndAuxiliaries) {
  const Segment turn = Line({Frame({1, 2, 3}), {}}, {Frame(KDL::Rotation::RotY(1.5), {1, 2, 3}), {300}});
  EXPECT_EQ(turn.measure, Measure::kTurn);
  EXPECT_NEAR(turn.length, 1.5 / kDegree, 1e-12);
  EXPECT_LT(Length(At(turn, 10).M.w - KDL::Vector(0, kDegree, 0)), 1e-15);
  EXPECT_EQ(Length(At(turn, 10).p.v), 0);
  const Segment moved = Line({Frame({1, 2, 3}), {4, -8}}, {Frame({1, 2, 3}), {14, -38}});
  EXPECT_EQ(moved.measure, Measure::kAuxiliaries);
  EXPECT_DOUBLE_EQ(moved.length, 30);
  EXPECT_DOUBLE_EQ(AuxiliariesAt(moved, 15).position[0], 9);
}

// GR-20: bad input is refused with a reason and leaves the segment unchanged.
TEST(Lines, Refuse) {
  const double nan = std::nan("");
  Segment out;
  out.length = 7;
  const auto refuse = [&](const Point& from, const Point& to, Problem expected) {
    EXPECT_EQ(MakeLine(from, to, out), expected);
    EXPECT_EQ(out.length, 7);
  };
  refuse(testing::At(1, 2), testing::At(1, 2), Problem::kLengthZero);
  refuse(testing::At(1, nan), testing::At(1, 2), Problem::kNotFinite);
  refuse(testing::At(1, 2), testing::At(INFINITY, 2), Problem::kNotFinite);
  refuse(testing::At(1e300, 2), testing::At(-1e300, 2), Problem::kNotFinite);
  refuse({Frame(), {nan}}, testing::At(1, 2), Problem::kNotFinite);
  refuse({Frame(KDL::Rotation(2, 0, 0, 0, 1, 0, 0, 0, 1)), {}}, testing::At(1, 2), Problem::kNotFinite);
  refuse({Frame(KDL::Rotation(-1, 0, 0, 0, 1, 0, 0, 0, 1)), {}}, testing::At(1, 2), Problem::kNotFinite);
}

// Compares the result of At with differences, scaled to a path of length 1. `bend`: [mm] on which it bends by about 1
// rad.
void ExpectDerivatives(const Segment& segment, double bend) {
  const double l = segment.length;
  const double step = std::min(l / 200, bend / 40);
  for (int i = 0; i <= 20; ++i) {
    const double s = 4 * step + (l - 8 * step) * i / 20;
    const auto expected = DifferencesAt(segment, s, step);
    const MovingFrame f = At(segment, s);
    const AuxiliaryMotion a = AuxiliariesAt(segment, s);
    ASSERT_NEAR(Length(f.p.v), 1, 1e-12);
    ASSERT_NEAR(KDL::dot(f.p.v, f.p.dv) * bend, 0, 1e-9);
    // Of 1000 mm some 1e-13 mm are lost to rounding.
    ASSERT_LT(Length(f.p.v - expected.frame.p.v), 2e-9 + 1e-12 / step) << "at " << s;
    ASSERT_LT(Length(f.p.dv - expected.frame.p.dv) * bend, 1e-6 + 1e-11 * bend / (step * step)) << "at " << s;
    const double turning = 1e-8 * (1 + Length(f.M.w) * l) + 1e-14 * l / step;
    ASSERT_LT(Length(f.M.w - expected.frame.M.w) * l, turning) << "at " << s;
    ASSERT_LT(Length(f.M.dw - expected.frame.M.dw) * l * l,
              1e-5 * (1 + (Length(f.M.w) + Length(f.M.dw) * l) * l) + 1e-13 * l * l / (step * step))
        << "at " << s;
    for (std::size_t k = 0; k < kMaxAuxiliaries; ++k) {
      ASSERT_NEAR(a.velocity[k] * l, expected.auxiliaries.velocity[k] * l, 1e-6 + 1e-12 * l / step);
      ASSERT_NEAR(a.acceleration[k] * l * l, expected.auxiliaries.acceleration[k] * l * l,
                  1e-4 + 1e-11 * l * l / (step * step));
    }
  }
}

// GR-20, GR-21, GR-22: on segments of every kind and on blends between them, |dp/ds| is 1 to 2e-9 (differences have
// errors, too) and everything that At calls a derivative is one.
TEST(Segments, PropertyDerivativesAreDerivatives) {
  Random random(31);
  for (const Kind first : kKinds) {
    for (const Kind second : kKinds) {
      for (int i = 0; i < Trials(10); ++i) {
        const double angle = i % 2 ? random.Between(0.1, 170) : random.Size(0.1, 30);
        const auto c = MakeCorner(random, first, second, angle * kDegree, random.Size(1, 1e4));
        const auto bend = [](const Segment& s) { return std::min(s.length, 1 / PeakCurvature(s)); };
        ASSERT_NO_FATAL_FAILURE(ExpectDerivatives(c.first, bend(c.first)));
        ASSERT_NO_FATAL_FAILURE(ExpectDerivatives(c.second, bend(c.second)));
        const double d = CornerDistance(c.first, c.second, c.first.length / 30, HalfOf(c.first, c.second));
        Segment blend;
        ASSERT_EQ(Blend(c.first, c.first.length - d, c.second, d, blend), Problem::kNone);
        ASSERT_NO_FATAL_FAILURE(ExpectDerivatives(blend, bend(blend)));
      }
    }
  }
}

// GR-20: the length of a curve is the sum of a million chords, and s counts them, on the sharpest of blends, too.
TEST(Segments, LengthIsTheSumOfChords) {
  for (const double degrees : {1.0, 60.0, 120.0, 175.0, 179.0}) {
    const Segment a = Line(testing::At(-10, 0), {});
    const Segment b = Line({}, testing::At(10 * std::cos(degrees * kDegree), 10 * std::sin(degrees * kDegree), 0));
    Segment blend;
    ASSERT_EQ(Blend(a, 6, b, 5, blend), Problem::kNone);
    constexpr int kChords = 1000000;
    double sum = 0;
    KDL::Vector last = At(blend, 0).p.p;
    for (int i = 1; i <= kChords; ++i) {
      // By the parameter, not by s: how the length was found must not matter.
      const double u = static_cast<double>(i) / kChords;
      KDL::Vector p;
      for (int k = 0; k < 3; ++k) {
        for (std::size_t n = 6; n-- > 0;) p[k] = p[k] * u + blend.place[n][static_cast<std::size_t>(k)];
      }
      sum += Length(p - last);
      last = p;
      if (i % 50000 == 0) {
        ASSERT_LT(Length(At(blend, sum).p.p - p), 1e-9) << degrees << " deg at " << u;
      }
    }
    EXPECT_NEAR(blend.length, sum, 1e-9 * sum) << degrees;
  }
}

// GR-20: s grows, and so does the position: in the smallest steps of numbers, at joints of the table, too.
TEST(Segments, PlacesGoOnWithLength) {
  const Segment a = Line(testing::At(-10, 0), {}), b = Line({}, testing::At(0, 10));
  Segment blend;
  ASSERT_EQ(Blend(a, 5, b, 5, blend), Problem::kNone);
  for (std::size_t i = 0; i + 1 < blend.cells; ++i) {
    for (double s = blend.cell_length[i] - 1e-9; s < blend.cell_length[i] + 1e-9; s += 1e-12) {
      const MovingFrame f = At(blend, s);
      ASSERT_NEAR(KDL::dot(At(blend, s + 1e-12).p.p - f.p.p, f.p.v), 1e-12, 1e-14) << i;
    }
  }
}

}  // namespace
}  // namespace takt::path
