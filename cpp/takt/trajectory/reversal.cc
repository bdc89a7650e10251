#include "takt/trajectory/reversal.h"

#include <algorithm>
#include <cmath>

namespace takt::trajectory {

namespace {

constexpr double kStandstill = 1e-9;  // share of the velocity limit
constexpr double kSlack = 1e-9;       // share of an acceleration limit: rounding

double Smaller(const Limits& l) noexcept {
  return std::min(l.acceleration, l.deceleration);
}

// Returns the largest positive acceleration for velocities from `low` to `high`.
double BoundBetween(double low, double high, const Limits& l) noexcept {
  const double standstill = kStandstill * l.velocity;
  if (low >= -standstill) return l.acceleration;
  return high <= standstill ? l.deceleration : Smaller(l);
}

}  // namespace

Bounds DirectedBounds(const KinematicState& from, double way, const Limits& l) noexcept {
  const double sign = way >= 0 ? 1 : -1;
  const double forward = sign * from.velocity < -kStandstill * l.velocity ? Smaller(l) : l.acceleration;
  return sign > 0 ? Bounds{forward, l.deceleration, l.jerk} : Bounds{l.deceleration, forward, l.jerk};
}

Bounds VelocityBounds(const KinematicState& from, double velocity, const Limits& l) noexcept {
  const double taken = l.jerk > 0 ? from.acceleration * from.acceleration / (2 * l.jerk) : 0;
  const double lowest = from.acceleration < 0 ? from.velocity - taken : from.velocity;
  const double highest = from.acceleration > 0 ? from.velocity + taken : from.velocity;
  return {BoundBetween(lowest, velocity, l), BoundBetween(-highest, -velocity, l), l.jerk};
}

bool LowerWhereExceeded(const Profile& plan, const Limits& l, Bounds& bounds) noexcept {
  if (l.acceleration == l.deceleration) return false;
  const double start = plan.start().acceleration;
  bool up = false;
  bool down = false;
  const auto check = [&](double t, double a, double v) {
    if (std::abs(v) <= kStandstill * l.velocity) return;
    const double limit = (a > 0) == (v > 0) ? l.acceleration : l.deceleration;
    const bool inherited = l.jerk > 0 && start * a > 0 && std::abs(a) <= std::abs(start) * (1 + kSlack) - l.jerk * t;
    if (std::abs(a) <= limit * (1 + kSlack) || inherited) return;
    (a > 0 ? up : down) = true;
  };
  for (int i = 0; i < plan.size(); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Piece& piece = plan.pieces[n];
    const double begin = i == 0 ? 0 : plan.piece_ends_s[n - 1];
    const double length = plan.piece_ends_s[n] - begin;
    // The acceleration is linear: between two zeros of the velocity only its ends count.
    const auto check_between = [&](double left, double right) {
      const double v = piece.At(0.5 * (left + right)).velocity;
      check(begin + left, piece.At(left).acceleration, v);
      check(begin + right, piece.At(right).acceleration, v);
    };
    double left = 0;
    for (const double zero : piece.VelocityZeros()) {
      if (!(zero > left && zero < length)) continue;
      check_between(left, zero);
      left = zero;
    }
    check_between(left, length);
  }
  const double before = bounds.up + bounds.down;
  if (up) bounds.up = std::min(bounds.up, Smaller(l));
  if (down) bounds.down = std::min(bounds.down, Smaller(l));
  return bounds.up + bounds.down < before;
}

}  // namespace takt::trajectory
