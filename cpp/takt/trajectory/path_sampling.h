// How long accelerations along a path take to build up, and where it gets its nodes: so near to one another that
// everything between two of them may be taken for linear, and no nearer than a motion within the limits can tell.
#pragma once

#include <algorithm>
#include <cmath>

#include "takt/trajectory/path_limits.h"

namespace takt::trajectory {

namespace sampling {
// Of the time in which accelerations build up, to be passed between two nodes.
inline constexpr double kTimeShare = 0.35;
// Cycles between two nodes at least, so far as the path allows.
inline constexpr double kCycles = 2;
// How far an acceleration between two nodes may be from the line, as a share of its limit.
inline constexpr double kBend = 0.02;
inline constexpr int kHalvings = 12;
}  // namespace sampling

// Finds T for a motion from one stop to the next, from samples of what is known of its path.
class BuildUp {
 public:
  void Add(const PathPoint& point, const CoordinateLimits& limits) noexcept {
    double acceleration = std::max(point.limits.acceleration, point.limits.deceleration);
    double jerk = point.limits.jerk;
    for (std::size_t k = 0; k < limits.count; ++k) {
      const double slope = std::abs(point.slopes.first[k]);
      const CoordinateLimits::One& own = limits.of[k];
      if (slope * acceleration > point.left * own.acceleration) acceleration = point.left * own.acceleration / slope;
      if (slope * jerk > point.left * own.jerk) jerk = point.left * own.jerk / slope;
    }
    ++count_;
    time_ += acceleration / jerk;
    jerk_ += jerk;
    acceleration_ += acceleration;
    velocity_ += std::sqrt(SquareAt(point, limits, 1));
  }

  // What the motion may do, in the mean.
  AlongPath Mean() const noexcept {
    const double n = std::max(count_, 1);
    return {velocity_ / n, acceleration_ / n, acceleration_ / n, jerk_ / n};
  }

  // Whole cycles. Longer than it takes to build up what may be is of no use, nor, on a short way, longer than it takes
  // to build up what can be used: a quarter of the least time from rest to rest with that jerk.
  double For(double length, double period_s, double most_cycles) const noexcept {
    const double n = std::max(count_, 1);
    const double time = std::min(time_ / n, std::cbrt(0.5 * length * n / jerk_));
    return period_s * std::clamp(std::ceil(time / period_s), 2.0, most_cycles);
  }

 private:
  int count_ = 0;
  double time_ = 0;
  double jerk_ = 0;
  double acceleration_ = 0;
  double velocity_ = 0;
};

// The node behind `before`, at `end` at most. `slopes_at(s, point)` fills slopes and what is left of the limits; it
// answers false where there is no path, then this does, too. The limits along the way are those of `before`.
template <typename SlopesAt>
bool NextPoint(const PathPoint& before, double end, const CoordinateLimits& limits, double build_up_s, double period_s,
               const SlopesAt& slopes_at, PathPoint& next) {
  namespace c = sampling;
  const auto square_at = [&](const PathPoint& point) { return SquareAt(point, limits, 1); };
  const double time = std::max(c::kTimeShare * build_up_s, c::kCycles * period_s);
  const double left = end - before.s;
  const double here = square_at(before);
  double step = std::sqrt(here) * time;
  if (left < 1.5 * step) step = left;
  next = before;
  PathPoint middle = before;
  for (int i = 0;; ++i) {
    next.s = step < left ? before.s + step : end;
    middle.s = before.s + 0.5 * step;
    // In this order: the caller may count on it.
    if (!slopes_at(next.s, next) || !slopes_at(middle.s, middle)) return false;
    const double there = square_at(next);
    bool linear = step <= 2 * std::sqrt(there) * time;
    const double square = std::min(here, there);
    for (std::size_t k = 0; k < limits.count && linear; ++k) {
      const double line = 0.5 * (before.slopes.second[k] + next.slopes.second[k]);
      linear = std::abs(middle.slopes.second[k] - line) * square <= c::kBend * limits.of[k].acceleration;
    }
    if (linear || i == c::kHalvings) return true;
    step *= 0.5;
  }
}

}  // namespace takt::trajectory
