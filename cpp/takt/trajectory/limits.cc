#include "takt/trajectory/limits.h"

#include <cmath>

#include "takt/core/describe.h"

namespace takt::trajectory {

double RampLength(double from, double to, double acceleration, double jerk) noexcept {
  const double change = std::abs(to - from);
  const double full = acceleration * acceleration / jerk;
  const double time = change > full ? change / acceleration + acceleration / jerk : 2 * std::sqrt(change / jerk);
  return 0.5 * (from + to) * time;
}

void describe(Description<Limits>& d) {
  d.about("Limits of a motion.");
  d.internal<&Limits::velocity>("Largest velocity, u/s.");
  d.internal<&Limits::acceleration>("Largest acceleration while the speed grows, u/s².");
  d.internal<&Limits::deceleration>("Largest deceleration while the speed falls, u/s².");
  d.internal<&Limits::jerk>("Largest jerk, u/s³; 0: unlimited.");
}

}  // namespace takt::trajectory
