// How long half of a line takes, beside what the planner finds.
#include "takt/trajectory/corner_time.h"

#include <gtest/gtest.h>

#include <random>

#include "takt/trajectory/planner.h"

namespace takt::trajectory {
namespace {

TEST(CornerTime, WithStopsIsHalfOfThePlannersTime) {
  Planner planner;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-3, 3);
  for (int i = 0; i < 500; ++i) {
    const AlongPath limits{std::pow(10, exponent(random) + 1), std::pow(10, exponent(random) + 2),
                           std::pow(10, exponent(random) + 2), std::pow(10, exponent(random) + 3)};
    const double a = std::min(limits.acceleration, limits.deceleration);
    const double length = std::pow(10, exponent(random));
    Profile profile{};
    ASSERT_TRUE(planner.ToPosition({}, length, 0, {limits.velocity, a, a, limits.jerk}, profile).ok());
    EXPECT_NEAR(HalfLineWithStops(length, limits), profile.duration() / 2, 1e-6 * profile.duration());
  }
}

TEST(CornerTime, PastBlendsFallsWithTheirSpeed) {
  const AlongPath limits{500, 5000, 5000, 100000};
  double before = 1e99;
  for (const double speed : {1.0, 5.0, 25.0, 100.0, 400.0, 500.0}) {
    const double time = HalfLineWithBlends(100, 1, speed, limits);
    EXPECT_LT(time, before);
    EXPECT_GE(time, 49 / limits.velocity);
    before = time;
  }
  EXPECT_NEAR(before, 49 / limits.velocity, 0.026);  // at full speed nothing but the way, and T/2 held
}

// A coordinate that changes twice as fast as the path has half of its limits to give.
TEST(CornerTime, LimitsAreThoseOfTheCoordinateThatBinds) {
  CoordinateLimits limits;
  limits.count = 2;
  limits.of[0] = {300, 3000, 30000};
  limits.of[1] = {1000, 1000, CoordinateLimits::kNone};
  PathPoint point;
  point.limits = {500, 5000, 5000, 100000};
  point.slopes.first[0] = -2;
  point.slopes.first[1] = 0.25;
  const AlongPath along = AlongLine(point, limits);
  EXPECT_EQ(along.velocity, 150);
  EXPECT_EQ(along.acceleration, 1500);
  EXPECT_EQ(along.deceleration, 1500);
  EXPECT_EQ(along.jerk, 15000);
}

}  // namespace
}  // namespace takt::trajectory
