#include "takt/trajectory/path_limits.h"

#include <algorithm>

#include "takt/core/describe.h"

namespace takt::trajectory {

namespace {

// First slopes that differ by more (relative and absolute) form a corner.
constexpr double kSameSlope = 1e-6;
constexpr double kNoSlope = 1e-8;
// Share of the coordinates' jerk. More than 1: its terms hardly ever add up, and rehearsal reduces what is too much.
// With all terms added up the gentle share applies.
constexpr double kJerkShare = 1.05;
constexpr double kGentleJerkShare = 0.98;

}  // namespace

AlongPath Least(const AlongPath& a, const AlongPath& b) noexcept {
  return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration),
          std::min(a.deceleration, b.deceleration), std::min(a.jerk, b.jerk)};
}

AccelerationCap Least(const AccelerationCap& a, const AccelerationCap& b, double square) noexcept {
  const double at_rest = std::min(a.at_rest, b.at_rest);
  const double last = std::min(a.At(square), b.At(square));
  const double gentle = std::min(a.gentle, b.gentle);
  if (at_rest == CoordinateLimits::kNone || square == 0) return {at_rest, 0, last, gentle};
  return {at_rest, std::max(0.0, at_rest - last) / square, last, gentle};
}

double AccelerationBounds::Least(double square, bool full) const noexcept {
  double least = full ? -strength.At(square) : std::max(-deceleration, -strength.At(square));
  for (std::size_t k = 0; k < count; ++k) least = std::max(least, tilt[k] * square - reach[k]);
  return least;
}

double AccelerationBounds::Most(double square) const noexcept {
  double most = std::min(acceleration, strength.At(square));
  for (std::size_t k = 0; k < count; ++k) most = std::min(most, tilt[k] * square + reach[k]);
  return most;
}

AccelerationBounds BoundsAt(const PathPoint& point, const CoordinateLimits& limits, double build_up_s,
                            double share) noexcept {
  const PathSlopes& slopes = point.slopes;
  const AlongPath& along = point.limits;
  AccelerationBounds bounds;
  bounds.acceleration = std::min(along.acceleration, along.jerk * build_up_s);
  bounds.deceleration = std::min(along.deceleration, along.jerk * build_up_s);
  const double largest = std::max(bounds.acceleration, bounds.deceleration);
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double own = share * point.left[k].acceleration * limits.of[k].acceleration;
    // Where a coordinate hardly moves along the path, only the squared speed is limited (SquareAt).
    if (own == CoordinateLimits::kNone || std::abs(slopes.first[k]) * largest <= 1e-6 * own) continue;
    const double inverse = 1 / slopes.first[k];
    bounds.tilt[bounds.count] = -slopes.second[k] * inverse;
    bounds.reach[bounds.count] = own * std::abs(inverse);
    ++bounds.count;
  }
  return bounds;
}

double SquareAt(const PathPoint& point, const CoordinateLimits& limits, double share) noexcept {
  double square = point.limits.velocity * point.limits.velocity;
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double slope = std::abs(point.slopes.first[k]);
    const double bend = std::abs(point.slopes.second[k]);
    const CoordinateLimits::One& own = limits.of[k];
    const double velocity = point.left[k].velocity * own.velocity;
    if (slope * slope * square > velocity * velocity) square = velocity * velocity / (slope * slope);
    const double acceleration = share * point.left[k].acceleration * own.acceleration;
    if (bend * square > acceleration) square = acceleration / bend;
  }
  return square;
}

AccelerationCap AccelerationCapAt(const PathPoint& point, const std::array<double, kPathCoordinates>& third,
                                  const CoordinateLimits& limits, double square, double build_up_s) noexcept {
  const auto most_at = [&](double v, bool together) {
    double most = CoordinateLimits::kNone;
    for (std::size_t k = 0; k < limits.count; ++k) {
      // The term of the bends is hardly ever largest where the others are: added as if at right angles.
      const double own = (together ? kGentleJerkShare : kJerkShare) * point.left[k].jerk * limits.of[k].jerk;
      const double bends = std::min(third[k] * v * v * v, (together ? 0.8 : 0.99) * own);
      const double left = together ? own - bends : std::sqrt(own * own - bends * bends);
      const double asked = 3 * std::abs(point.slopes.second[k]) * v + std::abs(point.slopes.first[k]) / build_up_s;
      if (asked * most > left) most = left / asked;
    }
    return most;
  };
  // Without bends no term is left that could compensate.
  double straight = CoordinateLimits::kNone;
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double own = kGentleJerkShare * point.left[k].jerk * limits.of[k].jerk * build_up_s;
    const double slope = std::abs(point.slopes.first[k]);
    if (slope * straight > own) straight = own / slope;
  }
  const auto at = [&](double w) { return std::min(straight, most_at(std::sqrt(w), false)); };
  // The tangent at half the squared speed, or what is below the curve at the whole one.
  const double last = at(square);
  const double half = at(0.5 * square);
  if (last == CoordinateLimits::kNone) return {};
  const double v = std::sqrt(0.5 * square);
  const double gentle = std::min(1.0, most_at(std::min(v + 0.5 * half * build_up_s, std::sqrt(square)), true) / half);
  const double fading = std::max(0.0, (at(0.49 * square) - half) / (0.01 * square));
  const double at_rest = std::min({half + 0.5 * fading * square, last + fading * square, straight});
  if (at_rest - fading * square < 0.3 * last) return {last, 0, last, gentle};
  return {at_rest, fading, at_rest - fading * square, gentle};
}

double SquareBefore(const AccelerationBounds& bounds, double length, double later, double highest) noexcept {
  // The least squared speed reached is a convex, piecewise linear function of the present one: from above, Newton steps
  // along its lines lead to the largest admissible value.
  double square = highest;
  for (int i = 0; i < 2 * static_cast<int>(kPathCoordinates); ++i) {
    double least = -bounds.deceleration;
    double tilt = 0;
    if (bounds.strength.At(square) < bounds.deceleration) {
      least = -bounds.strength.At(square);
      tilt = -least > bounds.strength.least ? bounds.strength.fading : 0;
    }
    for (std::size_t k = 0; k < bounds.count; ++k) {
      const double one = bounds.tilt[k] * square - bounds.reach[k];
      if (one <= least) continue;
      least = one;
      tilt = bounds.tilt[k];
    }
    const double over = square + 2 * length * least - later;
    const double slope = 1 + 2 * length * tilt;
    if (over <= 1e-12 * square) break;
    if (slope <= 0) return 0;
    square = std::max(0.0, square - over / slope);
    if (square == 0) break;
  }
  return square;
}

double JointSquare(const PathSlopes& before, const PathSlopes& after, const CoordinateLimits& limits,
                   double time) noexcept {
  double square = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double corner = std::abs(after.first[k] - before.first[k]);
    if (corner > kSameSlope * (std::abs(after.first[k]) + std::abs(before.first[k])) + kNoSlope) return 0;
    const double bend = std::abs(after.second[k] - before.second[k]);
    const double step = std::min(limits.of[k].jerk * time, 0.5 * limits.of[k].acceleration);
    if (bend * square > step) square = step / bend;
  }
  return square;
}

void describe(Description<AlongPath>& d) {
  d.about("Limits along a path.");
  d.internal<&AlongPath::velocity>("Largest speed, mm/s.");
  d.internal<&AlongPath::acceleration>("Largest acceleration, mm/s².");
  d.internal<&AlongPath::deceleration>("Largest deceleration, mm/s².");
  d.internal<&AlongPath::jerk>("Largest jerk, mm/s³.");
}

}  // namespace takt::trajectory
