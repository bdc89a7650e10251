// The quickest change of velocity, in closed form: the basis of everything that plans in velocity only.
#pragma once

#include <array>
#include <cmath>

#include "takt/core/kinematic_state.h"
#include "takt/trajectory/piece.h"

namespace takt::trajectory {

// A piece of constant jerk as solvers return it, in the solver's scale of length and time.
struct Stretch {
  double duration = 0;
  double acceleration = 0;  // at its beginning
  double jerk = 0;
};

// Acceleration bounds by sign. Jerk 0: unlimited.
struct Bounds {
  double up = 0;    // largest positive acceleration, > 0
  double down = 0;  // magnitude of the largest negative acceleration, > 0
  double jerk = 0;
};

using Ramp = std::array<Stretch, 3>;

inline KinematicState Advance(const KinematicState& from, const Stretch& s) noexcept {
  return Piece{from.position, from.velocity, s.acceleration, s.jerk}.At(s.duration);
}

// Returns the quickest ramp from velocity `v` and acceleration `a` to velocity `target` and no acceleration. An
// acceleration beyond its bound is brought inside at full jerk. Stretches may have the duration 0.
inline Ramp QuickestRamp(double v, double a, double target, const Bounds& bounds) noexcept {
  if (bounds.jerk == 0) {
    const double dv = target - v;
    const double acceleration = dv >= 0 ? bounds.up : -bounds.down;
    return {{{dv / acceleration, acceleration, 0}, {}, {}}};
  }
  const double j = bounds.jerk;
  // The velocity reached if the acceleration is removed at once decides the direction.
  const double rest_dv = a * std::abs(a) / (2 * j);
  if (std::abs(target - v - rest_dv) <= 1e-15 * (std::abs(target) + std::abs(v) + std::abs(rest_dv))) {
    // Removing it is all that is needed. The root below would turn the 1e-16 missing here into 1e-8.
    return {{{std::abs(a) / j, a, -std::copysign(j, a)}, {}, {}}};
  }
  const double sign = target - v > rest_dv ? 1 : -1;
  const double dv = sign * (target - v);
  const double start = sign * a;
  const double bound = sign > 0 ? bounds.up : bounds.down;
  const double square = j * dv + start * start * 0.5;
  double peak = square > 0 ? std::sqrt(square) : 0;
  double hold = 0;
  if (peak > bound || start > bound) {
    const double ends = start > bound ? start * start : 2 * bound * bound - start * start;
    hold = std::fmax(0, (dv - ends / (2 * j)) / bound);
    peak = bound;
  }
  return {{{std::abs(peak - start) / j, a, sign * std::copysign(j, peak - start)},
           {hold, sign * peak, 0},
           {peak / j, sign * peak, -sign * j}}};
}

}  // namespace takt::trajectory
