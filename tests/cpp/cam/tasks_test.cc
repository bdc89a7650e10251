// CAM-89: laws between any velocities and accelerations at both ends (VDI 2143's tasks), asymmetric laws, laws chosen
// automatically, and points that are followed without overshoot.
#include "takt/cam/tasks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "made.h"
#include "takt/cam/extremes.h"
#include "takt/cam/roots.h"
#include "takt/core/describe.h"

namespace takt::cam {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr std::array kAny = {Law::kQuintic,           Law::kModifiedSine,       Law::kModifiedTrapezoid,
                             Law::kCycloid,           Law::kPolynomial345,      Law::kPolynomial4567,
                             Law::kPolynomial8,       Law::kSineConstantCosine, Law::kTask,
                             Law::kLeastAcceleration, Law::kLeastJerk};

std::string NameOf(Law law) {
  return std::string(TypeOf<Law>().FindEnumerator(static_cast<std::int64_t>(law))->name);
}

// Rest, velocity, reversal, motion: whether velocity and acceleration are nonzero at an end.
struct EndKind {
  bool v, a;
};
constexpr std::array<EndKind, 4> kEnds = {{{false, false}, {true, false}, {false, true}, {true, true}}};

TEST(Tasks, MeetTheirEndsInAllSixteenCombinations) {
  Dice dice(89);
  for (const Law law : kAny) {
    for (const EndKind& from : kEnds) {
      for (const EndKind& to : kEnds) {
        for (int run = 0; run < 20; ++run) {
          CamSegment s = To(dice.Real(5, 400), dice.Real(-80, 80), law);
          const auto of = [&](bool any, double most) { return any ? dice.Real(-most, most) : 0.0; };
          s.from = CamPlace{dice.Real(-90, 0), dice.Real(-50, 50)};
          s.begin_v = of(from.v, 3);
          s.begin_a = of(from.a, 0.1);
          s.end_v = of(to.v, 3);
          s.end_a = of(to.a, 0.1);
          s.inflection = law == Law::kPolynomial8 ? dice.Real(0.36, 0.64) : dice.Real(0.1, 0.9);
          const Table table = Made(Segments({s}));  // this also checks for jumps inside
          SCOPED_TRACE(NameOf(law));
          const Value begin = table.At(s.from->x), end = table.At(s.to.x);
          EXPECT_NEAR(begin.y, s.from->y, 1e-9);
          EXPECT_NEAR(begin.dy, *s.begin_v, 1e-9);
          EXPECT_NEAR(begin.ddy, *s.begin_a, 1e-9);
          EXPECT_NEAR(end.y, s.to.y, 1e-8);
          EXPECT_NEAR(end.dy, *s.end_v, 1e-8);
          EXPECT_NEAR(end.ddy, *s.end_a, 1e-8);
          for (std::size_t i = 1; i < table.size(); ++i) {
            const Value before = ValueOf(table.CurveOf(i - 1), table.EndOf(i - 1) - table.BeginOf(i - 1));
            const Value behind = ValueOf(table.CurveOf(i), 0);
            EXPECT_NEAR(before.ddy, behind.ddy, 1e-9 * (1 + std::abs(behind.ddy)));
          }
        }
      }
    }
  }
}

// From rest to rest, the general laws are those of the textbooks.
TEST(Tasks, AreTheTextbooksLawsFromRestToRest) {
  for (const Law law : {Law::kModifiedSine, Law::kModifiedTrapezoid, Law::kCycloid, Law::kPolynomial4567,
                        Law::kPolynomial8, Law::kQuintic}) {
    CamSegment s = To(1, 1, law);
    const Table own = Made(Segments({s}));
    s.inflection = 0.5 + 1e-13;  // the general implementation
    const Table general = Made(Segments({s}));
    for (double x = 0; x <= 1; x += 1.0 / 64) {
      EXPECT_NEAR(general.At(x).y, own.At(x).y, 1e-10) << NameOf(law);
      EXPECT_NEAR(general.At(x).ddy, own.At(x).ddy, 1e-9) << NameOf(law);
    }
  }
}

// Between equal velocities the law is added to a straight line: its peak is the textbooks' factor times the remaining
// rise.
TEST(Tasks, HaveTheirFactorsBetweenEqualVelocities) {
  const std::pair<Law, double> factors[] = {{Law::kModifiedSine, 4 * kHalfTurn * kHalfTurn / (4 + kHalfTurn)},
                                            {Law::kModifiedTrapezoid, 8 * kHalfTurn / (2 + kHalfTurn)},
                                            {Law::kCycloid, 2 * kHalfTurn},
                                            {Law::kQuintic, 10 / std::sqrt(3.0)},
                                            {Law::kPolynomial4567, 84 * std::sqrt(5.0) / 25}};
  for (const auto& [law, factor] : factors) {
    CamSegment s = To(125, 60, law);
    s.begin_v = s.end_v = 0.8;
    s.begin_a = s.end_a = 0.0;
    const Extremes extremes = ExtremesOf(Made(Segments({s})));
    EXPECT_NEAR(extremes.ddy.greatest.value, factor * std::abs(60 - 0.8 * 125) / (125.0 * 125), 1e-9) << NameOf(law);
  }
}

// Published: cv = 3 sqrt(3) pi / 8, ca = pi^2 at the reversal and 9 pi^2 / 16 in between.
TEST(Tasks, DoubleHarmonicHasItsFactors) {
  for (const Law law : {Law::kDoubleHarmonic, Law::kDoubleHarmonicBack}) {
    const Table table = Made(Segments({To(1, 1, law)}));
    const Extremes extremes = ExtremesOf(table);
    EXPECT_NEAR(extremes.dy.greatest.value, 3 * std::sqrt(3.0) * kHalfTurn / 8, 1e-9);
    EXPECT_NEAR(std::max(extremes.ddy.greatest.value, -extremes.ddy.least.value), kHalfTurn * kHalfTurn, 1e-9);
    EXPECT_NEAR(std::min(extremes.ddy.greatest.value, -extremes.ddy.least.value), 9 * kHalfTurn * kHalfTurn / 16, 1e-9);
    double jerk = 0;
    for (int i = 0; i <= 100'000; ++i) jerk = std::max(jerk, std::abs(table.At(i / 100'000.0).dddy));
    EXPECT_NEAR(std::max(extremes.dddy.greatest.value, -extremes.dddy.least.value), jerk, 1e-6 * jerk);
    EXPECT_NEAR(table.At(0.25).y,
                law == Law::kDoubleHarmonic
                    ? (1 - std::cos(kHalfTurn / 4)) / 2 - (1 - std::cos(kHalfTurn / 2)) / 8
                    : 1 - ((1 - std::cos(3 * kHalfTurn / 4)) / 2 - (1 - std::cos(3 * kHalfTurn / 2)) / 8),
                1e-14);
  }
  // Rise and return make one cam without a jump.
  const Built pair = Build(Segments({To(90, 30, Law::kDoubleHarmonic), To(180, 0, Law::kDoubleHarmonicBack)}, true));
  EXPECT_TRUE(pair.errors.empty());
  EXPECT_TRUE(pair.warnings.empty());
}

// Sums of two sines and a polynomial: extremes from roots against dense sampling.
TEST(Tasks, ExtremesOfTwoSinesAreExact) {
  Dice dice(2);
  for (int run = 0; run < 200; ++run) {
    Curve curve{.amplitude = dice.Real(-2, 2),
                .frequency = dice.Real(0.5, 3),
                .phase = dice.Real(-6, 6),
                .amplitude2 = dice.Real(-2, 2),
                .phase2 = dice.Real(-6, 6)};
    for (std::size_t i = 0; i < dice.Whole(5); ++i) curve.c[i] = dice.Real(-1, 1);
    const double h = dice.Real(0.1, 2);
    double largest = 0;
    for (int i = 0; i <= 20'000; ++i) largest = std::max(largest, std::abs(curve.At(h * i / 20'000)));
    EXPECT_NEAR(LargestMagnitude(curve, h), largest, 1e-6 * largest) << run;
    EXPECT_GE(LargestMagnitude(curve, h), largest * (1 - 1e-12));
  }
}

double Peak(const Table& table, bool jerk) {
  const Extremes extremes = ExtremesOf(table);
  const Bounds& bounds = jerk ? extremes.dddy : extremes.ddy;
  return std::max(bounds.greatest.value, -bounds.least.value);
}

TEST(Tasks, TheLeastPeakIsChosen) {
  Dice dice(7);
  for (const bool jerk : {false, true}) {
    const Law least = jerk ? Law::kLeastJerk : Law::kLeastAcceleration;
    for (int run = 0; run < 100; ++run) {
      CamSegment s = To(dice.Real(20, 200), dice.Real(-50, 50), least);
      s.begin_v = dice.Flip() ? dice.Real(-2, 2) : 0;
      s.end_v = dice.Flip() ? dice.Real(-2, 2) : 0;
      s.begin_a = dice.Flip() ? dice.Real(-0.05, 0.05) : 0;
      const double peak = Peak(Made(Segments({s})), jerk);
      for (const Law other :
           {Law::kQuintic, Law::kModifiedSine, Law::kModifiedTrapezoid, Law::kCycloid, Law::kPolynomial4567}) {
        s.law = other;
        EXPECT_LE(peak, Peak(Made(Segments({s})), jerk) * (1 + 1e-12)) << NameOf(other);
      }
    }
  }
  EXPECT_NEAR(Peak(Made(Segments({To(1, 1, Law::kLeastAcceleration)})), false), 8 * kHalfTurn / (2 + kHalfTurn), 1e-9);
  EXPECT_NEAR(Peak(Made(Segments({To(1, 1, Law::kLeastJerk)})), true), 4 * kHalfTurn * kHalfTurn, 1e-8);
}

TEST(Tasks, ChooseByTheirEndsAndTakeThemFromTheNeighbours) {
  CamSegment between = To(100, 70, Law::kTask);
  const Table line = Made(Segments({To(40, 20, Law::kLine), between, To(160, 130, Law::kLine)}));
  EXPECT_NEAR(line.At(40 + 1e-9).dy, 0.5, 1e-6);
  EXPECT_NEAR(line.At(100 - 1e-9).dy, 1, 1e-6);
  EXPECT_GT(line.size(), 3u);  // modified sine: no acceleration at the ends
  between.end_a = 0.01;
  EXPECT_EQ(Made(Segments({To(40, 20, Law::kLine), between})).size(), 2u);  // quintic
}

// Asymmetric: the acceleration changes its sign at the inflection, and braking over more of the length is gentler.
TEST(Tasks, TheInflectionIsWhereItIsTold) {
  for (const Law law : {Law::kModifiedSine, Law::kModifiedTrapezoid, Law::kCycloid, Law::kPolynomial8}) {
    CamSegment s = To(200, 35, law);
    s.inflection = 0.4;
    const Table table = Made(Segments({s}));
    EXPECT_NEAR(table.At(80).ddy, 0, 1e-12) << NameOf(law);
    const Bounds ddy = ExtremesOf(table).ddy;
    EXPECT_GT(ddy.greatest.value, -ddy.least.value) << NameOf(law);
    if (law == Law::kPolynomial8) continue;
    EXPECT_NEAR(ddy.greatest.value / -ddy.least.value, 1.5, 1e-9) << NameOf(law);  // 0.6 / 0.4
  }
}

TEST(Monotone, NeverLeavesTheRangeOfTwoPoints) {
  Dice dice(31);
  for (int run = 0; run < 2000; ++run) {
    const bool cyclic = dice.Flip();
    std::vector<CamPoint> points;
    double x = 0, y = 0;
    const std::size_t n = 2 + dice.Whole(8);
    for (std::size_t i = 0; i < n; ++i) {
      points.push_back({x, y, {}, {}});
      x += std::pow(10, dice.Real(-1, 1.5));
      y += dice.Whole(4) == 0 ? 0 : std::pow(10, dice.Real(-1, 1.5)) * (dice.Whole(3) == 0 ? -1 : 1);
    }
    const Table table = Made(Points(Interpolation::kMonotone, points, cyclic));
    ASSERT_EQ(table.size(), n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double h = points[i + 1].x - points[i].x;
      const double low = std::min(points[i].y, points[i + 1].y), high = std::max(points[i].y, points[i + 1].y);
      for (const double d : ExtremePlaces(table.CurveOf(i), h)) {
        const double at = table.CurveOf(i).At(d);
        EXPECT_GE(at, low - 1e-9 * (1 + std::abs(low)));
        EXPECT_LE(at, high + 1e-9 * (1 + std::abs(high)));
      }
    }
  }
}

}  // namespace
}  // namespace takt::cam
