// A polynomial of the fifth degree from one state to another, over time or over the position of a master.
#pragma once

#include <array>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::trajectory {

// Derivatives are by x: per s over time, per master unit over a master position.
struct Quintic {
  std::array<double, 6> c{};  // of the powers of x / length, in ascending order
  double length = 1;          // not 0; negative where x falls along the curve

  // Valid outside of 0 to `length`, too: the polynomial continues there.
  KinematicState At(double x) const noexcept {
    const double s = x / length;
    const double y = c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
    const double dy = c[1] + s * (2 * c[2] + s * (3 * c[3] + s * (4 * c[4] + s * 5 * c[5])));
    const double ddy = 2 * c[2] + s * (6 * c[3] + s * (12 * c[4] + s * 20 * c[5]));
    return {y, dy / length, ddy / (length * length)};
  }
};

// Returns the curve from `begin` at 0 to `end` at `length`.
Quintic Connect(double length, const KinematicState& begin, const KinematicState& end) noexcept;

// Returns the motion over time of a value that depends on a master: `over` is the value with its derivatives by the
// master's position, `way` the motion of the master.
inline KinematicState ComposeWithMaster(const KinematicState& over, const KinematicState& way) noexcept {
  return {over.position, over.velocity * way.velocity,
          over.acceleration * way.velocity * way.velocity + over.velocity * way.acceleration};
}

void describe(Description<Quintic>&);

}  // namespace takt::trajectory
