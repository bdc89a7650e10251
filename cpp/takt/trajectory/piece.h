// A stretch of motion with constant jerk.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::trajectory {

// The state at its beginning and the jerk that holds during it.
struct Piece {
  double position = 0;      // [u]
  double velocity = 0;      // [u/s]
  double acceleration = 0;  // [u/s²]
  double jerk = 0;          // [u/s³]

  // `t` seconds after its beginning.
  constexpr KinematicState At(double t) const noexcept {
    return {position + t * (velocity + t * (acceleration * 0.5 + t * jerk * (1.0 / 6.0))),
            velocity + t * (acceleration + t * jerk * 0.5), acceleration + t * jerk};
  }

  // Returns the times at which the velocity passes 0, ascending; NaN or infinite if there is no such time.
  std::array<double, 2> VelocityZeros() const noexcept {
    if (jerk == 0) return {-velocity / acceleration, -velocity / acceleration};
    // The larger root first, the other one from their product: no cancellation.
    const double root = std::sqrt(acceleration * acceleration - 2 * jerk * velocity);
    const double sum = -(acceleration + std::copysign(root, acceleration));
    const double one = sum / jerk;
    const double other = 2 * velocity / sum;
    return {std::min(one, other), std::max(one, other)};
  }
};

void describe(Description<Piece>&);

}  // namespace takt::trajectory
