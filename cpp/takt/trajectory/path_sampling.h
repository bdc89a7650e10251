// The time in which accelerations along a path build up, and the spacing of its nodes: so close that everything between
// two of them can be taken as linear, and no closer than a motion within the limits can resolve.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "takt/core/maths.h"
#include "takt/trajectory/path_limits.h"

namespace takt::trajectory {

namespace sampling {
// Travel time between two nodes, as a share of the time in which accelerations build up.
inline constexpr double kTimeShare = 0.35;
// Least travel time between two nodes in cycles, as far as the path allows.
inline constexpr double kCycles = 2;
// About the largest number of nodes between two slow points that StepBetweenSlowPoints alone asks for.
inline constexpr double kMostSteps = 32;
// Largest deviation of an acceleration between two nodes from the line, as a share of its limit.
inline constexpr double kBend = 0.02;
// Largest deviation of the mean acceleration between two nodes from that of the parabola through both and their
// midpoint, as a share of its limit.
inline constexpr double kHidden = 0.002;
// The same for the rate of this change, as a share of the jerk limit.
inline constexpr double kHiddenRate = 0.02;
// A step is not halved below this: differences of slopes over less are rounding.
inline constexpr double kShortest = 1e-8;  // [mm]
inline constexpr int kHalvings = 12;
inline constexpr int kHalvingsForHidden = 5;
}  // namespace sampling

// Returns an acceleration along the path, reduced to what the coordinates' acceleration limits allow without the effect
// of bends.
inline double AccelerationAt(const PathPoint& point, const CoordinateLimits& limits, double acceleration) noexcept {
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double slope = std::abs(point.slopes.first[k]);
    const double own = point.left[k].acceleration * limits.of[k].acceleration;
    if (slope * acceleration > own) acceleration = own / slope;
  }
  return acceleration;
}

// Finds the build-up time T for a motion from one stop to the next, from samples of the known part of its path.
class BuildUp {
 public:
  void Add(const PathPoint& point, const CoordinateLimits& limits) noexcept {
    const double acceleration = AccelerationAt(point, limits, point.limits.acceleration);
    const double deceleration = AccelerationAt(point, limits, point.limits.deceleration);
    double jerk = point.limits.jerk;
    for (std::size_t k = 0; k < limits.count; ++k) {
      const double slope = std::abs(point.slopes.first[k]);
      const double own = point.left[k].jerk * limits.of[k].jerk;
      if (slope * jerk > own) jerk = own / slope;
    }
    ++count_;
    sums_.velocity += std::sqrt(SquareAt(point, limits, 1));
    sums_.acceleration += acceleration;
    sums_.deceleration += deceleration;
    sums_.jerk += jerk;
    least_time_ += std::min(acceleration, deceleration) / jerk;
    most_time_ += std::max(acceleration, deceleration) / jerk;
  }

  // Returns the mean limits of the motion.
  AlongPath Mean() const noexcept {
    const double n = std::max(count_, 1);
    return {sums_.velocity / n, sums_.acceleration / n, sums_.deceleration / n, sums_.jerk / n};
  }

  // Returns T [s], a multiple of the period. T longer than building up the admissible acceleration takes is of no use,
  // nor, over a short distance, T longer than building up the usable acceleration takes: a quarter of the least time
  // from rest to rest with that jerk. Between the times that the weaker and the stronger one of acceleration and
  // deceleration need, the T with the shortest motion is chosen; for an infinite `length` (not known) it is the longer
  // time.
  double For(double length, double period_s, double most_cycles) const noexcept {
    const double n = std::max(count_, 1);
    const AlongPath mean = Mean();
    const bool known = std::isfinite(length);
    const double used = known ? maths::Cbrt(0.5 * length / mean.jerk) : length;
    const double least = std::min(least_time_ / n, used), most = std::min(most_time_ / n, used);
    double time = most;
    for (int i = 0; i < kTried && known; ++i) {
      const double shorter = least + (most - least) * i / kTried;
      if (TimeWith(shorter, length, mean) < TimeWith(time, length, mean)) time = shorter;
    }
    return period_s * std::clamp(std::ceil(time / period_s), 2.0, most_cycles);
  }

 private:
  static constexpr int kTried = 8;

  // Returns the time [s] from rest to rest with accelerations that build up in T and are removed before the motion
  // brakes.
  static double TimeWith(double time, double length, const AlongPath& mean) noexcept {
    const double built_up = mean.jerk * time;
    const double ramps = 1 / std::min(mean.acceleration, built_up) + 1 / std::min(mean.deceleration, built_up);
    const double full = mean.velocity * (0.5 * mean.velocity * ramps + time);
    if (length > full) return time + 0.5 * mean.velocity * ramps + length / mean.velocity;
    // L = v² ramps / 2 + v T
    const double velocity = (std::sqrt(time * time + 2 * length * ramps) - time) / ramps;
    return 2 * time + velocity * ramps;
  }

  int count_ = 0;
  double least_time_ = 0;  // sum of T for the weaker one of acceleration and deceleration
  double most_time_ = 0;   // sum of T for the stronger one
  AlongPath sums_;
};

// Returns the largest distance [mm] from a node to the next one on a stretch at both ends of which the motion may be
// slow. Between two nodes it can neither speed up and brake again nor exceed what the worse one allows, so nodes are
// the closer the less a motion from rest, or to rest, has sped up.
inline double StepBetweenSlowPoints(const PathPoint& point, double begin, double end, const CoordinateLimits& limits,
                                    double build_up_s, double period_s) noexcept {
  namespace c = sampling;
  const double time = std::max(c::kTimeShare * build_up_s, c::kCycles * period_s);
  // The square root of the distance from rest, 0.5 a t², grows by this much from node to node.
  const auto growth = [&](double acceleration) {
    const double has = AccelerationAt(point, limits, acceleration);
    return std::max(std::sqrt(0.5 * has) * time, std::sqrt(2 * (end - begin)) / c::kMostSteps);
  };
  const double begins = growth(point.limits.acceleration), ends = growth(point.limits.deceleration);
  const double out = 2 * begins * std::sqrt(std::max(0.0, point.s - begin)) + begins * begins;
  const double in = 2 * ends * std::sqrt(end - point.s) - ends * ends;
  const double least = std::min(begins, ends);
  return std::max(least * least, std::min(out, in));
}

// How bends between the sampled points are searched for. Ignored: the second slopes are not the derivatives of the
// first.
enum class BendSearch : std::uint8_t { kIgnored, kInAcceleration, kInJerk };

// Computes the node after `before`, at `end` at most. `slopes_at(s, point)` writes the slopes and the remaining shares
// of the limits; it returns false where there is no path, and so does this function. The limits along the path are
// copied from `before`.
template <typename SlopesAt>
bool NextPoint(const PathPoint& before, double end, const CoordinateLimits& limits, double build_up_s, double period_s,
               BendSearch bends, const SlopesAt& slopes_at, PathPoint& next) {
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
    // In this order: the caller may rely on it.
    if (!slopes_at(next.s, next) || !slopes_at(middle.s, middle)) return false;
    const double there = square_at(next);
    bool linear = step <= 2 * std::sqrt(there) * time;
    const double square = std::min(here, there);
    const bool is_least = 0.5 * step < c::kShortest;
    for (std::size_t k = 0; k < limits.count && linear; ++k) {
      const double line = 0.5 * (before.slopes.second[k] + next.slopes.second[k]);
      linear = std::abs(middle.slopes.second[k] - line) * square <= c::kBend * limits.of[k].acceleration;
      if (!linear || bends == BendSearch::kIgnored || i >= c::kHalvingsForHidden) continue;
      // A bend that all three points miss changes the first slopes.
      const double before_it = before.slopes.second[k], in_it = middle.slopes.second[k], behind = next.slopes.second[k];
      const double whole =
          (before_it + 4 * in_it + behind) / 6 - (next.slopes.first[k] - before.slopes.first[k]) / step;
      const double half =
          (5 * before_it + 8 * in_it - behind) / 24 - (middle.slopes.first[k] - before.slopes.first[k]) / step;
      // A cubic that is 0 at all three points is 16 times as steep at the ends as its mean over a half is far from 0.
      // Details passed within one cycle are finer than the set points resolve.
      double most = c::kHidden * limits.of[k].acceleration;
      const double passing_s = step / std::sqrt(square);
      if (bends == BendSearch::kInJerk && passing_s > period_s)
        most = std::min(most, c::kHiddenRate / 16 * limits.of[k].jerk * passing_s);
      linear = std::max(std::abs(whole), std::abs(half)) * square <= most;
    }
    if (linear || is_least || i == c::kHalvings) {
      next.middle = middle.slopes.second;
      next.has_middle = true;
      return true;
    }
    step *= 0.5;
  }
}

}  // namespace takt::trajectory
