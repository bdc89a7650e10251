// How long accelerations along a path take to build up, and where it gets its nodes: so near to one another that
// everything between two of them may be taken for linear, and no nearer than a motion within the limits can tell.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "takt/core/maths.h"
#include "takt/trajectory/path_limits.h"

namespace takt::trajectory {

namespace sampling {
// Of the time in which accelerations build up, to be passed between two nodes.
inline constexpr double kTimeShare = 0.35;
// Cycles between two nodes at least, so far as the path allows.
inline constexpr double kCycles = 2;
// Nodes from one slow place to the next, no more than about so many for that alone.
inline constexpr double kMostSteps = 32;
// How far an acceleration between two nodes may be from the line, as a share of its limit.
inline constexpr double kBend = 0.02;
// How far the mean of the acceleration between two nodes may be from that of the parabola through both and their
// middle.
inline constexpr double kHidden = 0.002;
// The same for the rate of this change, as a share of the limit of jerk.
inline constexpr double kHiddenRate = 0.02;
// A step is not halved below this: differences of slopes over less are rounding.
inline constexpr double kShortest = 1e-8;  // mm
inline constexpr int kHalvings = 12;
inline constexpr int kHalvingsForHidden = 5;
}  // namespace sampling

// What the coordinates leave at a place, but for bends, of an acceleration along the way.
inline double AccelerationAt(const PathPoint& point, const CoordinateLimits& limits, double acceleration) noexcept {
  for (std::size_t k = 0; k < limits.count; ++k) {
    const double slope = std::abs(point.slopes.first[k]);
    const double own = point.left[k].acceleration * limits.of[k].acceleration;
    if (slope * acceleration > own) acceleration = own / slope;
  }
  return acceleration;
}

// Finds T for a motion from one stop to the next, from samples of what is known of its path.
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

  // What the motion may do, in the mean.
  AlongPath Mean() const noexcept {
    const double n = std::max(count_, 1);
    return {sums_.velocity / n, sums_.acceleration / n, sums_.deceleration / n, sums_.jerk / n};
  }

  // Whole cycles. Longer than it takes to build up what may be is of no use, nor, on a short way, longer than it takes
  // to build up what can be used: a quarter of the least time from rest to rest with that jerk. Between what one of
  // acceleration and deceleration needs and what the other does, the time of the whole motion decides; it is not known
  // of an infinite length.
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

  // From rest to rest with accelerations that build up in T, and are taken back before it brakes.
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
  double least_time_ = 0;  // T for the weaker one of acceleration and deceleration
  double most_time_ = 0;   // and for the stronger one
  AlongPath sums_;
};

// How far from a node the next one may be on a stretch at both ends of which the motion may be slow. Between two nodes
// it can neither speed up and brake again nor do better than the worse one allows, so they are the nearer to one
// another the less a motion from rest, or to rest, has speeded up.
inline double StepBetweenSlowPlaces(const PathPoint& point, double begin, double end, const CoordinateLimits& limits,
                                    double build_up_s, double period_s) noexcept {
  namespace c = sampling;
  const double time = std::max(c::kTimeShare * build_up_s, c::kCycles * period_s);
  // The square root of the way from rest, 0.5 a t², grows so much from node to node.
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

// Where bends between the places that are looked at are searched for. Ignored: the second slopes are not those of the
// first.
enum class HiddenBends : std::uint8_t { kIgnored, kInAcceleration, kInJerk };

// The node behind `before`, at `end` at most. `slopes_at(s, point)` fills slopes and what is left of the limits; it
// answers false where there is no path, then this does, too. The limits along the way are those of `before`.
template <typename SlopesAt>
bool NextPoint(const PathPoint& before, double end, const CoordinateLimits& limits, double build_up_s, double period_s,
               HiddenBends bends, const SlopesAt& slopes_at, PathPoint& next) {
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
    const bool is_least = 0.5 * step < c::kShortest;
    for (std::size_t k = 0; k < limits.count && linear; ++k) {
      const double line = 0.5 * (before.slopes.second[k] + next.slopes.second[k]);
      linear = std::abs(middle.slopes.second[k] - line) * square <= c::kBend * limits.of[k].acceleration;
      if (!linear || bends == HiddenBends::kIgnored || i >= c::kHalvingsForHidden) continue;
      // A bend that all three places miss changes the first slopes.
      const double before_it = before.slopes.second[k], in_it = middle.slopes.second[k], behind = next.slopes.second[k];
      const double whole =
          (before_it + 4 * in_it + behind) / 6 - (next.slopes.first[k] - before.slopes.first[k]) / step;
      const double half =
          (5 * before_it + 8 * in_it - behind) / 24 - (middle.slopes.first[k] - before.slopes.first[k]) / step;
      // A cubic that is 0 at all three places is 16 times as steep at the ends as its mean over a half is far from 0.
      // What is passed within a cycle is no finer than the set points.
      double most = c::kHidden * limits.of[k].acceleration;
      const double passing_s = step / std::sqrt(square);
      if (bends == HiddenBends::kInJerk && passing_s > period_s)
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
