#include "takt/routing/run.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"

namespace takt::routing {
namespace {

constexpr int kBisections = 50;

// Returns the braking distance from velocity v with an initial acceleration of 0.
double BrakingDistance(double v, const Dynamics& limits) noexcept {
  if (v <= 0) return 0;
  const double ramp = limits.acceleration / limits.jerk;
  if (v >= limits.acceleration * ramp) return v / 2 * (v / limits.acceleration + ramp);
  return v * std::sqrt(v / limits.jerk);
}

// Returns the largest t in [0, end] for which `before` holds. Requires: it holds up to some t, and not beyond it.
template <typename Before>
double LastOf(double end, const Before& before) noexcept {
  double low = 0, high = end;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (low + high) / 2;
    (before(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

StraightRun::StraightRun(double length, const Dynamics& dynamics) noexcept : length_(length), dynamics_(dynamics) {
  if (length <= 0) return;
  const auto [v, a, j] = dynamics;
  // The ramp up to the velocity limit.
  if (v < a * a / j) {
    jerk_time_ = std::sqrt(v / j);
  } else {
    jerk_time_ = a / j;
    constant_time_ = v / a - jerk_time_;
  }
  const double ramp = v * (2 * jerk_time_ + constant_time_) / 2;
  if (2 * ramp <= length) {
    cruise_time_ = (length - 2 * ramp) / v;
  } else if (const double t = a / j; 2 * a * t * t <= length) {
    // The acceleration limit is reached: length = a (t + c) (2 t + c), c the time of constant acceleration.
    jerk_time_ = t;
    constant_time_ = (-3 * t + std::sqrt(9 * t * t - 4 * (2 * t * t - length / a))) / 2;
  } else {
    jerk_time_ = maths::Cbrt(length / (2 * j));
    constant_time_ = 0;
  }
  duration_ = 2 * (2 * jerk_time_ + constant_time_) + cruise_time_;
}

StraightRun::Motion StraightRun::MotionAt(double t) const noexcept {
  const double j = dynamics_.jerk;
  const std::array<double, 7> times{jerk_time_, constant_time_, jerk_time_, cruise_time_,
                                    jerk_time_, constant_time_, jerk_time_};
  const std::array<double, 7> jerks{j, 0, -j, 0, -j, 0, j};
  Motion now;
  for (std::size_t i = 0; i < times.size() && t > 0; ++i) {
    const double q = std::min(t, times[i]);
    now.s += q * (now.v + q * (now.a / 2 + q * jerks[i] / 6));
    now.v += q * (now.a + q * jerks[i] / 2);
    now.a += q * jerks[i];
    t -= q;
  }
  return now;
}

double StraightRun::At(double t) const noexcept {
  if (t <= 0) return 0;
  if (t >= duration_) return length_;
  return t > duration_ / 2 ? length_ - MotionAt(duration_ - t).s : MotionAt(t).s;
}

double StraightRun::StopAt(double t) const noexcept {
  if (t <= 0) return 0;
  if (t >= duration_) return length_;
  const Motion now = MotionAt(t);
  const double j = dynamics_.jerk, q = std::abs(now.a) / j;
  double s = 0;
  if (now.a >= 0) {  // the acceleration is ramped down first
    s = now.s + q * (now.v + q * (now.a / 2 - q * j / 6)) + BrakingDistance(now.v + now.a * q / 2, dynamics_);
  } else {  // as if braking had begun q earlier
    const double v = now.v + now.a * now.a / (2 * j);
    s = now.s - q * (v - q * q * j / 6) + BrakingDistance(v, dynamics_);
  }
  return std::min(s, length_);
}

double StraightRun::TimeAt(double s) const noexcept {
  if (s <= 0) return 0;
  if (s >= length_) return duration_;
  return LastOf(duration_, [&](double t) { return At(t) < s; });
}

double StraightRun::LastStopWithin(double s) const noexcept {
  if (s <= 0) return 0;
  constexpr double kRounding = 1e-9;
  const double bound = std::min(s, length_) - kRounding;
  return LastOf(duration_, [&](double t) { return StopAt(t) < bound; });
}

}  // namespace takt::routing
