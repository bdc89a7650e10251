// CAM-01, CAM-02: curves through points.
#include "takt/cam/points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "made.h"

namespace takt::cam {
namespace {

// Returns y, y', y'', y''', y'''' at an end of a piece.
std::array<double, 5> FiveOf(const Table& table, std::size_t i, bool at_end) {
  std::array<double, 5> five{};
  Curve curve = table.CurveOf(i);
  const double d = at_end ? table.EndOf(i) - table.BeginOf(i) : 0;
  for (double& value : five) {
    value = curve.At(d);
    curve = Derivative(curve);
  }
  return five;
}

// Returns the largest magnitude of each in the cam, as a scale.
std::array<double, 5> Largest(const Table& table) {
  std::array<double, 5> largest{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (const bool at_end : {false, true}) {
      const auto five = FiveOf(table, i, at_end);
      for (std::size_t k = 0; k < 5; ++k) largest[k] = std::max(largest[k], std::abs(five[k]));
    }
  }
  return largest;
}

// A polynomial of the fifth degree through given positions, velocities and accelerations is that polynomial.
TEST(Quintic, MeetsWhatIsGiven) {
  const auto y = [](double x) {
    return Value{x * x * x * x * x - 2 * x * x, 5 * x * x * x * x - 4 * x, 20 * x * x * x - 4, 60 * x * x};
  };
  std::vector<CamPoint> points;
  for (const double x : {-1.0, 0.0, 0.5, 2.0}) points.push_back({x, y(x).y, y(x).dy, y(x).ddy});
  const Table table = Made(Points(Interpolation::kQuintic, points));
  for (double x = -1; x <= 2; x += 0.01) {
    const Value value = table.At(x);
    EXPECT_NEAR(value.y, y(x).y, 1e-12);
    EXPECT_NEAR(value.dy, y(x).dy, 1e-11);
    EXPECT_NEAR(value.ddy, y(x).ddy, 1e-10);
    EXPECT_NEAR(value.dddy, y(x).dddy, 1e-9);
  }
}

// Rest to rest between two points is the polynomial 3-4-5.
TEST(Quintic, FromRestToRestIsPolynomial345) {
  const Table points = Made(Points(Interpolation::kQuintic, {{10, 5, 0, 0}, {30, 25, 0, 0}}));
  CamSegment segment = To(30, 25, Law::kPolynomial345);
  segment.from = CamPlace{10, 5};
  const Table law = Made(Segments({segment}));
  for (double x = 10; x <= 30; x += 0.25) EXPECT_NEAR(points.At(x).y, law.At(x).y, 1e-13);
}

// Two points only: a straight line, cyclic or not.
TEST(Quintic, OfTwoPointsIsALine) {
  for (const bool cyclic : {false, true}) {
    const Table table = Made(Points(Interpolation::kQuintic, {{0, 0}, {360, 90}}, cyclic));
    for (double x = 0; x <= 360; x += 7) {
      EXPECT_NEAR(table.At(x).y, x / 4, 1e-12);
      EXPECT_NEAR(table.At(x).dy, 0.25, 1e-14);
      EXPECT_NEAR(table.At(x).ddy, 0, 1e-15);
    }
  }
}

// A parabola has y''' = 0: free points reproduce it.
TEST(Quintic, ReproducesAParabola) {
  std::vector<CamPoint> points;
  for (const double x : {0.0, 1.0, 1.1, 4.0, 9.0}) points.push_back({x, 3 - x + 0.5 * x * x});
  const Table table = Made(Points(Interpolation::kQuintic, points));
  for (double x = 0; x <= 9; x += 0.1) EXPECT_NEAR(table.At(x).dy, x - 1, 1e-11);
}

// Free values are as smooth as possible: y''' and y'''' are continuous where the acceleration and the velocity are
// free, and y, y', y'' everywhere; they are 0 at free ends, and continuous over the seam of a cyclic cam.
TEST(Quintic, IsAsSmoothAsItCanBe) {
  Dice dice(4);
  for (int run = 0; run < 300; ++run) {
    CamParams params = RandomPoints(dice, Interpolation::kQuintic);
    if (params.points.size() == 2) continue;
    const Table table = Made(params);
    const auto scale = Largest(table);
    const std::size_t n = table.size();
    const auto check = [&](const CamPoint& p, const auto& before, const auto& behind, bool with_y) {
      for (std::size_t k = with_y ? 0 : 1; k < 3; ++k) ASSERT_NEAR(before[k], behind[k], 1e-9 * scale[k]);
      if (p.v) {
        ASSERT_NEAR(behind[1], *p.v, 1e-12 * (1 + std::abs(*p.v)));
      }
      if (p.a) {
        ASSERT_NEAR(behind[2], *p.a, 1e-12 * (1 + std::abs(*p.a)));
      }
      if (!p.a) {
        ASSERT_NEAR(before[3], behind[3], 1e-7 * scale[3]);
      }
      if (!p.v) {
        ASSERT_NEAR(before[4], behind[4], 1e-7 * scale[4]);
      }
    };
    for (std::size_t i = 1; i < n; ++i) {
      ASSERT_NO_FATAL_FAILURE(check(params.points[i], FiveOf(table, i - 1, true), FiveOf(table, i, false), true));
    }
    if (params.cyclic) {
      ASSERT_NO_FATAL_FAILURE(check(params.points[0], FiveOf(table, n - 1, true), FiveOf(table, 0, false), false));
    } else {
      for (const bool at_end : {false, true}) {
        const auto five = FiveOf(table, at_end ? n - 1 : 0, at_end);
        const CamPoint& p = at_end ? params.points.back() : params.points.front();
        if (!p.a) {
          ASSERT_NEAR(five[3], 0, 1e-7 * scale[3]);
        }
        if (!p.v) {
          ASSERT_NEAR(five[4], 0, 1e-7 * scale[4]);
        }
      }
    }
  }
}

// Natural: the textbook's smallest example, by hand. 4 M1 = 6 (y0 - 2 y1 + y2).
TEST(CubicSpline, IsNatural) {
  const Table table = Made(Points(Interpolation::kCubicSpline, {{0, 0}, {1, 1}, {2, 0}}));
  EXPECT_NEAR(table.At(0).ddy, 0, 1e-14);
  EXPECT_NEAR(table.At(1).ddy, -3, 1e-14);
  EXPECT_NEAR(table.At(2).ddy, 0, 1e-14);
  EXPECT_NEAR(table.At(0).dy, 1.5, 1e-14);
  EXPECT_NEAR(table.At(0.5).y, 0.6875, 1e-15);
}

// Periodic through a sine at n points: at the points the velocity of the periodic spline is known in closed form,
// 3 sin(k) / (k (2 + cos(k))) with k = 2 pi / n.
TEST(CubicSpline, IsPeriodic) {
  constexpr std::size_t n = 8;
  constexpr double k = 2 * std::numbers::pi / n;
  std::vector<CamPoint> points;
  for (std::size_t i = 0; i <= n; ++i)
    points.push_back({k * static_cast<double>(i), std::sin(k * static_cast<double>(i % n))});
  const Table table = Made(Points(Interpolation::kCubicSpline, points, true));
  for (std::size_t i = 0; i <= n; ++i) {
    const double x = k * static_cast<double>(i);
    EXPECT_NEAR(table.At(x).dy, std::cos(x) * 3 * std::sin(k) / (k * (2 + std::cos(k))), 1e-14);
  }
  EXPECT_NEAR(table.At(0).ddy, table.At(table.end()).ddy, 1e-13);
}

TEST(CubicSpline, HasNoJumpUpToTheAcceleration) {
  Dice dice(5);
  for (int run = 0; run < 300; ++run) {
    const CamParams params = RandomPoints(dice, Interpolation::kCubicSpline);
    const Table table = Made(params);
    const auto scale = Largest(table);
    for (std::size_t i = 1; i < table.size(); ++i) {
      const auto before = FiveOf(table, i - 1, true), behind = FiveOf(table, i, false);
      ASSERT_NEAR(before[0], behind[0], 1e-11 * scale[0]);
      ASSERT_NEAR(before[1], behind[1], 1e-11 * scale[1]);
      if (!params.points[i].v) {
        ASSERT_NEAR(before[2], behind[2], 1e-10 * scale[2]);
      }
    }
  }
}

// 100,000 points, distances from 1 to 1000: the given values are met, without jumps.
TEST(Quintic, TakesManyPoints) {
  Dice dice(6);
  std::vector<CamPoint> points;
  double x = 0;
  for (std::size_t i = 0; i < kMaxPoints; ++i) {
    points.push_back({x, std::sin(1e-4 * x)});
    x += std::pow(10, dice.Real(0, 3));
  }
  const Table table = Made(Points(Interpolation::kQuintic, points));
  for (std::size_t i = 0; i < kMaxPoints; ++i) {
    const double at = points[i].x;
    ASSERT_NEAR(table.At(at).dy, 1e-4 * std::cos(1e-4 * at), 1e-6) << i;
    if (i > 0) {
      ASSERT_NEAR(FiveOf(table, i - 1, true)[2], table.At(at).ddy, 1e-14) << i;
    }
    if (i + 2 == kMaxPoints) break;
  }
}

}  // namespace
}  // namespace takt::cam
