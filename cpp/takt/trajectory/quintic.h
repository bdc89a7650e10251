// A curve of the fifth degree from one state to another, over time or over the way of something that moves.
#pragma once

#include <array>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::trajectory {

// Positions, velocities and accelerations are those over x: per s for a time, per master's unit for a way.
struct Quintic {
  std::array<double, 6> c{};  // over the share x / length, from the lowest power on
  double length = 1;          // not 0; negative where x falls on the way

  // Not only between both ends: the curve goes on beyond them.
  KinematicState At(double x) const noexcept {
    const double s = x / length;
    const double y = c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
    const double dy = c[1] + s * (2 * c[2] + s * (3 * c[3] + s * (4 * c[4] + s * 5 * c[5])));
    const double ddy = 2 * c[2] + s * (6 * c[3] + s * (12 * c[4] + s * 20 * c[5]));
    return {y, dy / length, ddy / (length * length)};
  }
};

// From `begin` at 0 to `end` at `length`.
Quintic Connect(double length, const KinematicState& begin, const KinematicState& end) noexcept;

// What follows something with the motion `way`, `over` being its place and its derivatives over that way.
inline KinematicState AlongWay(const KinematicState& over, const KinematicState& way) noexcept {
  return {over.position, over.velocity * way.velocity,
          over.acceleration * way.velocity * way.velocity + over.velocity * way.acceleration};
}

void describe(Description<Quintic>&);

}  // namespace takt::trajectory
