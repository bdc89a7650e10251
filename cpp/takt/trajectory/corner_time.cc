#include "takt/trajectory/corner_time.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"

namespace takt::trajectory {

AlongPath AlongLine(const PathPoint& point, const CoordinateLimits& limits) noexcept {
  AlongPath along = point.limits;
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double slope = std::abs(point.slopes.first[k]);
    if (slope == 0) continue;
    const double share = point.left / slope;
    along.velocity = std::min(along.velocity, share * limits.of[k].velocity);
    along.acceleration = std::min(along.acceleration, share * limits.of[k].acceleration);
    along.deceleration = std::min(along.deceleration, share * limits.of[k].acceleration);
    along.jerk = std::min(along.jerk, share * limits.of[k].jerk);
  }
  return along;
}

double HalfLineWithStops(double length, const AlongPath& limits) noexcept {
  const double a = std::min(limits.acceleration, limits.deceleration);
  const double j = limits.jerk, v = limits.velocity;
  const double build_up = a / j;
  // The time in which it speeds up to the peak, or brakes from there: its mean speed is half of the peak.
  double ramp = maths::Cbrt(4 * length / j);  // jerk alone
  if (ramp > 2 * build_up) ramp = 0.5 * (build_up + std::sqrt(build_up * build_up + 4 * length / a));
  const double full = v > a * build_up ? v / a + build_up : 2 * std::sqrt(v / j);
  return ramp <= full ? ramp : 0.5 * (full + length / v);
}

namespace {

// Of the raw motion: `way` from the speed `v`, held over `held`, to the middle of the line.
double FromSpeed(double way, double held, double v, const AlongPath& limits) {
  const double a = std::min(limits.acceleration, limits.deceleration);
  const double build_up = a / limits.jerk;
  const double left = way - held;
  // The peak w of the raw motion: (w² - v²) / (2 a) + w T / 2 is left.
  const double half = 0.5 * a * build_up;
  const double peak = std::min(limits.velocity, std::sqrt(half * half + v * v + 2 * a * std::max(0.0, left)) - half);
  if (!(peak > v)) return std::max(0.0, way) / v;
  const double ramp = (peak - v) / a;
  return 0.5 * build_up + ramp + (left - 0.5 * (v + peak) * ramp) / peak;
}

double BuildUpOf(const AlongPath& limits) {
  return std::min(limits.acceleration, limits.deceleration) / limits.jerk;
}

}  // namespace

double HalfLineWithBlends(double length, double blended, double speed, const AlongPath& limits) noexcept {
  return FromSpeed(0.5 * length - blended, 0.5 * speed * BuildUpOf(limits), speed, limits);
}

double LossFromRest(double length, const AlongPath& limits) noexcept {
  // The mean comes to rest T after the raw motion: half of that on either side.
  const double rest = 0.5 * BuildUpOf(limits) + FromSpeed(0.5 * length, 0, 0, limits);
  return std::max(0.0, rest - HalfLineWithStops(length, limits));
}

}  // namespace takt::trajectory
