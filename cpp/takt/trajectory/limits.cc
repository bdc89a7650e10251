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
  d.about("How fast a motion may change.");
  d.internal<&Limits::velocity>("u/s.");
  d.internal<&Limits::acceleration>("u/s², while the speed grows.");
  d.internal<&Limits::deceleration>("u/s², while the speed falls.");
  d.internal<&Limits::jerk>("u/s³; 0: unlimited.");
}

}  // namespace takt::trajectory
