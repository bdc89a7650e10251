#include "takt/cam/extremes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "made.h"

namespace takt::cam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// CAM-24 of a law with closed forms: cycloid of height 100 over 180, master 50 u/s and 200 u/s².
TEST(Extremes, OfACycloid) {
  const double pi = std::numbers::pi;
  const Table table = Made(Segments({To(180, 100, Law::kCycloid)}));
  const Extremes e = ExtremesOf(table);
  EXPECT_NEAR(e.y.greatest.value, 100, 1e-12);
  EXPECT_NEAR(e.dy.greatest.value, 2 * 100.0 / 180, 1e-14);
  EXPECT_NEAR(e.dy.greatest.x, 90, 1e-6);
  EXPECT_NEAR(e.ddy.greatest.value, 2 * pi * 100 / (180.0 * 180), 1e-16);
  EXPECT_NEAR(e.ddy.greatest.x, 45, 1e-6);
  EXPECT_NEAR(e.ddy.least.value, -2 * pi * 100 / (180.0 * 180), 1e-16);
  EXPECT_NEAR(e.dddy.greatest.value, 4 * pi * pi * 100 / (180.0 * 180 * 180), 1e-17);
  const SlavePeaks peaks = SlavePeaksOf(table, 50, 200);
  EXPECT_NEAR(peaks.velocity.value, 50 * 2 * 100.0 / 180, 1e-11);
  // |y''| V² + |y'| A = p sin(t) + q (1 - cos(t)) with t = 2 pi x / 180 has its largest value q + sqrt(p² + q²).
  const double p = 2 * pi * 100 / (180.0 * 180) * 50 * 50, q = 100.0 / 180 * 200;
  EXPECT_NEAR(peaks.acceleration.value, q + std::hypot(p, q), 1e-10);
  EXPECT_EQ(SlavePeaksOf(table, 0, 0).acceleration.value, 0);
}

// CAM-24: at a corner of a linear cam both sides count.
TEST(Extremes, CountBothSidesOfAJump) {
  const Extremes e = ExtremesOf(Made(Points(Interpolation::kLinear, {{0, 0}, {1, 5}, {2, -5}, {3, -4}})));
  EXPECT_EQ(e.y.greatest.x, 1);
  EXPECT_EQ(e.y.greatest.value, 5);
  EXPECT_EQ(e.y.least.x, 2);
  EXPECT_EQ(e.y.least.value, -5);
  EXPECT_EQ(e.dy.greatest.value, 5);
  EXPECT_EQ(e.dy.least.value, -10);
}

struct Sampled {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  double largest_step = 0;  // from one sample to the next inside a piece

  void Take(double value, double before, bool joined) {
    least = std::min(least, value);
    greatest = std::max(greatest, value);
    if (joined) largest_step = std::max(largest_step, std::abs(value - before));
  }
};

// Never below a dense sampling, never above it by more than the sampling can miss; and attained at the reported x.
void Compare(const Bounds& bounds, const Sampled& sampled, double scale) {
  const double rounding = 1e-9 * scale;
  EXPECT_GE(bounds.greatest.value, sampled.greatest - rounding);
  EXPECT_LE(bounds.greatest.value, sampled.greatest + sampled.largest_step + rounding);
  EXPECT_LE(bounds.least.value, sampled.least + rounding);
  EXPECT_GE(bounds.least.value, sampled.least - sampled.largest_step - rounding);
}

// CAM-24: random cams, compared with dense sampling of every piece.
TEST(Extremes, AgreeWithDenseSampling) {
  Dice dice(3);
  constexpr int kSamples = 500;
  for (int run = 0; run < 300; ++run) {
    SCOPED_TRACE(run);
    const Table table = Made(RandomCam(dice));
    const double v = dice.Real(0, 100), a = dice.Real(0, 1000);
    Sampled y, dy, ddy, dddy, slave_velocity, slave_acceleration;
    Value before;
    double acceleration_before = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
      const Curve curve = table.CurveOf(i);
      const double h = table.EndOf(i) - table.BeginOf(i);
      for (int k = 0; k <= kSamples; ++k) {
        const Value value = ValueOf(curve, h * k / kSamples);
        y.Take(value.y, before.y, k > 0);
        dy.Take(value.dy, before.dy, k > 0);
        ddy.Take(value.ddy, before.ddy, k > 0);
        dddy.Take(value.dddy, before.dddy, k > 0);
        slave_velocity.Take(std::abs(value.dy) * v, std::abs(before.dy) * v, k > 0);
        const double acceleration = std::abs(value.ddy) * v * v + std::abs(value.dy) * a;
        slave_acceleration.Take(acceleration, acceleration_before, k > 0);
        before = value;
        acceleration_before = acceleration;
      }
    }
    const Extremes e = ExtremesOf(table);
    const auto scale = [](const Sampled& s) { return std::max(std::abs(s.least), std::abs(s.greatest)); };
    Compare(e.y, y, scale(y));
    Compare(e.dy, dy, scale(dy));
    Compare(e.ddy, ddy, scale(ddy));
    Compare(e.dddy, dddy, scale(dddy));
    EXPECT_NEAR(table.At(e.y.greatest.x).y, e.y.greatest.value, 1e-9 * scale(y));
    const SlavePeaks peaks = SlavePeaksOf(table, v, a);
    EXPECT_EQ(peaks.position.greatest.value, e.y.greatest.value);
    EXPECT_GE(peaks.velocity.value, slave_velocity.greatest * (1 - 1e-12));
    EXPECT_LE(peaks.velocity.value, slave_velocity.greatest + slave_velocity.largest_step);
    EXPECT_GE(peaks.acceleration.value, slave_acceleration.greatest * (1 - 1e-12));
    EXPECT_LE(peaks.acceleration.value, slave_acceleration.greatest + slave_acceleration.largest_step);
  }
}

// CAM-71: inverse from y to x.
TEST(Inverse, FindsEveryX) {
  const Table table =
      Made(Segments({To(90, 100, Law::kModifiedSine), To(180, 100, Law::kDwell), To(360, 0, Law::kPolynomial345)}));
  const std::vector<double> up_and_down = AllX(table, 50);
  ASSERT_EQ(up_and_down.size(), 2u);
  EXPECT_NEAR(up_and_down[0], 45, 1e-12);
  EXPECT_NEAR(up_and_down[1], 270, 1e-12);
  const std::vector<double> top = AllX(table, 100);
  EXPECT_EQ(top.front() <= 90.0001 && top.back() == 180, true) << testing::PrintToString(top);
  EXPECT_THAT(AllX(table, 100.1), IsEmpty());
  EXPECT_THAT(AllX(table, -0.1), IsEmpty());
  EXPECT_FALSE(NearestX(table, 101, 90).has_value());
  EXPECT_NEAR(NearestX(table, 50, 100).value(), 45, 1e-12);
  EXPECT_NEAR(NearestX(table, 50, 200).value(), 270, 1e-12);
  EXPECT_NEAR(NearestX(table, 50, -1000).value(), 45, 1e-12);
  EXPECT_NEAR(NearestX(table, 50, 1000).value(), 270, 1e-12);
}

// CAM-71, property: each returned x has this y; the x from which y was computed is among them, or one with nearly the
// same y; the nearest one is the nearest of all.
TEST(Inverse, LeadsBack) {
  Dice dice(4);
  for (int run = 0; run < 1000; ++run) {
    SCOPED_TRACE(run);
    const Table table = Made(RandomCam(dice));
    const Extremes e = ExtremesOf(table);
    const double height = e.y.greatest.value - e.y.least.value;
    const double from = dice.Real(table.begin(), table.end());
    const double y = table.At(from).y;
    const std::vector<double> all = AllX(table, y);
    ASSERT_FALSE(all.empty());
    for (const double x : all) ASSERT_NEAR(table.At(x).y, y, 1e-11 * (1 + height));
    const bool found =
        std::any_of(all.begin(), all.end(), [&](double x) { return std::abs(x - from) < 1e-6 * table.length(); });
    const bool flat = std::abs(table.At(from).dy) * table.length() < 1e-3 * height;
    ASSERT_TRUE(found || flat) << from << " " << testing::PrintToString(all);
    const double near = dice.Real(table.begin() - 10, table.end() + 10);
    double distance = std::numeric_limits<double>::infinity();
    for (const double x : all) distance = std::min(distance, std::abs(x - near));
    ASSERT_NEAR(std::abs(NearestX(table, y, near).value() - near), distance, 1e-11 * table.length());
    ASSERT_FALSE(AllX(table, e.y.greatest.value).empty());
    ASSERT_FALSE(AllX(table, e.y.least.value).empty());
    ASSERT_THAT(AllX(table, e.y.greatest.value + 1e-6 * (1 + height)), IsEmpty());
  }
}

}  // namespace
}  // namespace takt::cam
