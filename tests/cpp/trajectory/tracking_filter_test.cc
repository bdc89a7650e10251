#include "takt/trajectory/tracking_filter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace takt::trajectory {
namespace {

// CV-20: whatever the time constant, a step dies away and is not seen again.
TEST(TrackingFilter, Settles) {
  for (const double filter_s : {0.0, 0.001, 0.002, 0.003, 0.004, 0.01, 0.1}) {
    TrackingFilterState state;
    for (int k = 0; k < 5000; ++k) {
      const double x = k < 10 ? 0 : 1;
      const KinematicState y = Track(filter_s, 0, 0.001, x, 0, state);
      ASSERT_LT(std::abs(y.position), 1.5) << filter_s << " " << k;
      if (k > 3000) {
        ASSERT_NEAR(y.position, 1, 1e-9) << filter_s << " " << k;
      }
    }
  }
}

// CV-20: a constant speed passes without lag, and rounding does not pile up.
TEST(TrackingFilter, HasNoLagAtConstantSpeed) {
  for (const double filter_s : {0.0, 0.002, 0.01, 0.1}) {
    TrackingFilterState state;
    for (int k = 0; k < 20000; ++k) {
      const double x = 333.3 * k * 0.00025;
      const KinematicState y = Track(filter_s, 0.01, 0.00025, x, 333.3, state);
      ASSERT_NEAR(y.position, x + 3.333, 1e-9) << filter_s << " " << k;
      ASSERT_NEAR(y.acceleration, 0, 1e-4);
    }
  }
}

}  // namespace
}  // namespace takt::trajectory
