#include "takt/trajectory/path_plan.h"

#include <algorithm>
#include <cmath>

#include "takt/core/maths.h"

namespace takt::trajectory {

namespace {

double Series(double x) {  // (cosh √x - 1) / x and its counterpart for x < 0, for small x
  return 0.5 + x * (1.0 / 24 + x * (1.0 / 720));
}

// Returns position and rate after `t` of a motion with the acceleration slope + bend * (position - begin).
ReferenceState Move(double root, double slope, double bend, double t) {
  const double x = bend * t * t;
  double c = 0, s = 0, integral = 0;  // cosh, sinh / w, (cosh - 1) / w²
  if (std::abs(x) < 1e-3) {
    integral = t * t * Series(x);
    c = 1 + bend * integral;
    s = t * (1 + x * (1.0 / 6 + x * (1.0 / 120 + x * (1.0 / 5040))));
  } else {
    const double w = std::sqrt(std::abs(bend));
    c = bend > 0 ? maths::Cosh(w * t) : maths::Cos(w * t);
    s = (bend > 0 ? maths::Sinh(w * t) : maths::Sin(w * t)) / w;
    integral = (c - 1) / bend;
  }
  const double way = root * s + slope * integral;
  const double rate = root * c + slope * s;
  return {way, rate, slope + bend * way, bend * rate};
}

}  // namespace

ReferenceState PathPlan::Within(std::size_t interval, double share) const noexcept {
  const Knot& knot = knots_[interval];
  const double way = share * (knots_[interval + 1].reference_s - knot.reference_s);
  const double slope = knot.slope + knot.bend * way;
  const double rate = std::sqrt(knot.square + way * (knot.slope + slope));
  return {knot.reference_s + way, rate, slope, knot.bend * rate};
}

ReferenceState PathPlan::At(double time_s) const noexcept {
  if (count_ == 0) return {};
  const auto end = knots_.begin() + static_cast<std::ptrdiff_t>(count_);
  if (!(time_s > 0)) return Within(0, 0);
  if (time_s >= duration()) return Within(count_ - 2, 1);
  const auto behind = std::upper_bound(knots_.begin(), end, time_s, [](double t, const Knot& k) { return t < k.at_s; });
  const Knot& knot = *(behind - 1);
  ReferenceState state = Move(std::sqrt(knot.square), knot.slope, knot.bend, time_s - knot.at_s);
  state.time = std::min(knot.reference_s + state.time, behind->reference_s);
  return state;
}

// With x = length / (sum of both rates) the duration is 2/w atanh(w x), w² the bend.
double IntervalDuration(double length, double before, double after, double bend) noexcept {
  const double x = length / (std::sqrt(before) + std::sqrt(after));
  const double y = bend * x * x;
  if (std::abs(y) < 1e-3) return 2 * x * (1 + y * (1.0 / 3 + y * (1.0 / 5 + y * (1.0 / 7))));
  const double w = std::sqrt(std::abs(bend));
  return 2 / w * (bend > 0 ? maths::Atanh(w * x) : maths::Atan(w * x));
}

}  // namespace takt::trajectory
