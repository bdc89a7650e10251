// PL-72: the closed form of a run.
#include "takt/routing/run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace takt::routing {
namespace {

constexpr Dynamics kLimits{.velocity = 2000, .acceleration = 10'000, .jerk = 200'000};

TEST(Run, KeepsItsLimitsAndTakesAsLongAsByHand) {
  // 2 m/s are reached: 0.25 s up, 0.25 s down, 500 mm for both.
  EXPECT_NEAR(StraightRun(1500, kLimits).duration(), 0.5 + 1000.0 / 2000, 1e-12);
  // The jerk alone: four times the third root of length / (2 jerk).
  EXPECT_NEAR(StraightRun(0.4, kLimits).duration(), 4 * 0.01, 1e-12);
  EXPECT_EQ(StraightRun(0, kLimits).duration(), 0);
  for (const double length : {0.5, 40.0, 120.0, 480.0, 3000.0}) {
    const StraightRun run(length, kLimits);
    EXPECT_EQ(run.At(-1), 0);
    EXPECT_NEAR(run.At(run.duration()), length, 1e-9);
    constexpr double h = 1e-3;
    for (double t = 0; t < run.duration(); t += h) {
      const double a = run.At(t - h), b = run.At(t), c = run.At(t + h), d = run.At(t + 2 * h);
      EXPECT_GE(c, b);
      EXPECT_LE((c - b) / h, kLimits.velocity * (1 + 1e-9));
      EXPECT_LE(std::abs(c - 2 * b + a) / (h * h), kLimits.acceleration * (1 + 1e-6));
      EXPECT_LE(std::abs(d - 3 * c + 3 * b - a) / (h * h * h), kLimits.jerk * (1 + 1e-4));
    }
  }
}

TEST(Run, SaysWhenItPassesAndWhereItCouldStop) {
  const StraightRun run(1000, kLimits);
  for (double s = 0; s <= 1000; s += 50) EXPECT_NEAR(run.At(run.TimeAt(s)), s, 1e-6);
  double before = 0;
  for (double t = 0; t < run.duration(); t += 1e-3) {
    EXPECT_GE(run.StopAt(t), before - 1e-9);  // never decreasing
    EXPECT_GE(run.StopAt(t), run.At(t) - 1e-9);
    before = run.StopAt(t);
  }
  EXPECT_NEAR(run.StopAt(run.duration() - 1e-6), 1000, 1e-9);
  for (const double s : {100.0, 400.0, 900.0}) {
    const double last = run.LastStopWithin(s);
    EXPECT_LE(run.StopAt(last), s);
    EXPECT_GT(run.StopAt(last + 1e-4), s);
  }
  // From a constant velocity of 2 m/s it takes 250 mm to stop.
  EXPECT_NEAR(run.StopAt(run.TimeAt(500)), 750, 1e-5);
}

}  // namespace
}  // namespace takt::routing
