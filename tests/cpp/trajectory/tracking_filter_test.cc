#include "takt/trajectory/tracking_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace takt::trajectory {
namespace {

constexpr double kCycle = 0.001;

TrackingFilter Filter(double filter_s, double dead_time_s) {
  return {.filter_s = filter_s, .dead_time_s = dead_time_s};
}

double Sine(double t, double hertz) {
  return std::sin(2 * std::numbers::pi * hertz * t);
}

// CV-20: whatever the time constant, a step decays and does not reappear.
TEST(TrackingFilter, IsFinalTo) {
  for (const double filter_s : {0.0, 0.001, 0.002, 0.003, 0.004, 0.01, 0.1}) {
    TrackingFilterState state;
    for (int k = 0; k < 6000; ++k) {
      const double x = k < 10 ? 0 : 1;
      const KinematicState y = Track({.filter_s = filter_s}, kCycle, x, 0, state);
      ASSERT_LT(std::abs(y.position), 2.1) << filter_s << " " << k;
      if (k > 15e3 * filter_s + 60) {
        ASSERT_NEAR(y.position, 1, 0.03) << filter_s << " " << k;
      }
      if (k > 5000) {
        ASSERT_NEAR(y.position, 1, 1e-9) << filter_s << " " << k;
      }
    }
  }
}

// CV-20: a constant speed passes without lag, and rounding does not accumulate.
TEST(TrackingFilter, HasNoLagAtConstantSpeed) {
  for (const double filter_s : {0.0, 0.002, 0.01, 0.1}) {
    TrackingFilterState state;
    for (int k = 0; k < 20000; ++k) {
      const double x = 333.3 * k * 0.00025;
      const KinematicState y = Track({.filter_s = filter_s, .dead_time_s = 0.01}, 0.00025, x, 333.3, state);
      ASSERT_NEAR(y.position, x + 3.333, 1e-9) << filter_s << " " << k;
      ASSERT_NEAR(y.acceleration, 0, 1e-3);
    }
  }
}

// CV-20, PP-64: nor does a constant acceleration or jerk lag behind, whatever the dead time.
TEST(TrackingFilter, HasNoLagAtConstantJerk) {
  for (const double filter_s : {0.003, 0.01, 0.03}) {
    for (const double dead_time_s : {0.0, 0.001, 0.02}) {
      TrackingFilterState state;
      const auto at = [](double t) { return 5 + t * (40 + t * (-300 + t * 700)); };
      for (int k = 0; k < 2000; ++k) {
        const KinematicState y = Track(Filter(filter_s, dead_time_s), kCycle, at(k * kCycle), 40, state);
        if (k < 40 * filter_s / kCycle + 100) continue;
        const double t = k * kCycle + dead_time_s;
        ASSERT_NEAR(y.position, at(t), 1e-7) << filter_s << " " << dead_time_s << " " << k;
        ASSERT_NEAR(y.velocity, 40 + t * (-600 + t * 2100), 1e-4);
        ASSERT_NEAR(y.acceleration, -600 + t * 4200, 0.1);
      }
    }
  }
}

// PP-64: the error of a sine is below the bound of the header.
TEST(TrackingFilter, MissesOfASineWhatIsPromised) {
  for (const double filter_s : {0.005, 0.009, 0.02}) {
    for (const double dead_time_s : {0.001, 0.005, 0.02}) {
      for (const double hertz : {0.5, 1.0, 2.0, 4.0}) {
        TrackingFilterState state;
        double worst = 0;
        for (int k = 0; k < 3000; ++k) {
          const double t = k * kCycle;
          const KinematicState y = Track(Filter(filter_s, dead_time_s), kCycle, Sine(t, hertz), 0, state);
          if (k > 1500) worst = std::max(worst, std::abs(y.position - Sine(t + dead_time_s, hertz)));
        }
        const double w = 2 * std::numbers::pi * hertz;
        const double both = filter_s + dead_time_s;
        const double bound = 40 * std::pow(w, 4) * std::pow(filter_s * both, 2) + std::pow(w * dead_time_s, 4) / 20;
        EXPECT_LT(worst, bound) << filter_s << " " << dead_time_s << " " << hertz;
      }
    }
  }
}

// PP-64: position, velocity and acceleration are of one motion, whatever the measurement, with a dead time as well.
TEST(TrackingFilter, IsOneMotion) {
  for (TrackingFilter filter : {Filter(0.009, 0), Filter(0.009, 0.02), Filter(0.015, 0.001)}) {
    if (filter.filter_s > 0.01) filter.fast_filter_s = 0.003, filter.band = 0.006;
    TrackingFilterState state;
    KinematicState before;
    for (int k = 0; k < 4000; ++k) {
      const double x = std::round(100 * (Sine(k * kCycle, 1) + 0.5 * k * kCycle)) / 100;
      const KinematicState y = Track(filter, kCycle, x, 0, state);
      if (k > 0) {
        const double mean = 0.5 * kCycle * (y.velocity + before.velocity);
        const double jerk = (y.acceleration - before.acceleration) / kCycle;
        ASSERT_NEAR(y.position - before.position, mean - jerk * kCycle * kCycle * kCycle / 12, 1e-12);
        ASSERT_NEAR(y.velocity - before.velocity, 0.5 * kCycle * (y.acceleration + before.acceleration), 1e-10);
      }
      before = y;
    }
  }
}

// Returns the largest acceleration caused by steps of an encoder at any constant speed.
double Shaken(const TrackingFilter& filter, double step) {
  double worst = 0;
  for (double speed = 0.05; speed < 2000; speed *= 1.13) {
    TrackingFilterState state;
    for (int k = 0; k < 2000; ++k) {
      const double x = step * std::round(speed * k * kCycle / step);
      const KinematicState y = Track(filter, kCycle, x, speed, state);
      if (k > 500) worst = std::max(worst, std::abs(y.acceleration));
    }
  }
  return worst;
}

// PP-64: steps of an encoder cause less acceleration than the header states, at all speeds.
TEST(TrackingFilter, StepsShakeItByLessThanIsPromised) {
  constexpr double kStep = 0.01;
  for (const double filter_s : {0.005, 0.009, 0.02}) {
    const double unit = kStep / (filter_s * filter_s);
    const double one = Shaken(Filter(filter_s, kCycle), kStep);
    EXPECT_LT(one, 2.1 * unit) << filter_s;
    EXPECT_GT(one, unit) << filter_s;
    if (filter_s < 0.008) continue;
    const TrackingFilter two{filter_s, filter_s / 5, 0.6 * kStep, kCycle};
    EXPECT_LT(Shaken(two, kStep), 7 * unit) << filter_s;
    const TrackingFilter late{filter_s, 0.4 * filter_s, 0.6 * kStep, filter_s};
    EXPECT_LT(Shaken(late, kStep), 14 * unit) << filter_s;
  }
}

// PP-64: with two estimates a speed that changes suddenly is followed more than three times as closely as with the slow
// one alone.
TEST(TrackingFilter, TwoEstimatesAreFastWhereTheSpeedChanges) {
  constexpr double kStep = 0.01;
  const auto worst = [&](const TrackingFilter& filter) {
    TrackingFilterState state;
    double most = 0;
    const auto at = [](double t) { return 1000 * t + (t > 1 ? 1500 * (t - 1) * (t - 1) : 0); };  // 3 m/s² from 1 s on
    for (int k = 0; k < 1200; ++k) {
      const double x = kStep * std::round(at(k * kCycle) / kStep);
      const KinematicState y = Track(filter, kCycle, x, 1000, state);
      if (k > 500) most = std::max(most, std::abs(y.position - at((k + 1) * kCycle)));
    }
    return most;
  };
  const double two = worst({0.015, 0.003, 0.6 * kStep, kCycle});
  EXPECT_LT(two, 0.14);
  EXPECT_LT(two, 0.3 * worst(Filter(0.015, kCycle)));
}

}  // namespace
}  // namespace takt::trajectory
