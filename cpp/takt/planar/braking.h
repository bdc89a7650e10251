// The quickest stop of a mover on a track, and the least distance of two movers that both stop: the basis of all rules
// of traffic (traffic.h).
#pragma once

#include <array>

#include "takt/core/kinematic_state.h"
#include "takt/trajectory/piece.h"

namespace takt::planar {

// Limits of braking.
struct Brakes {
  double deceleration = 0;  // [mm/s²] > 0
  double jerk = 0;          // [mm/s³] > 0
};

// A stop: the mover brakes from one instant on until it is at rest. Of all motions within the same limits that never
// reverse, none is slower at any time, nor farther back.
struct Braking {
  std::array<trajectory::Piece, 3> pieces{};
  std::array<double, 3> ends_s{};  // [s] from the start, ascending
  double rest = 0;                 // [mm] position of rest
  double lowest = 0;               // [mm] least position: that of the start or of rest, unless the mover reverses first
  double highest = 0;

  // Returns the state `t` [s] after the start. Requires: t >= 0.
  KinematicState At(double t) const noexcept;
};
Braking Brake(const KinematicState& from, const Brakes& brakes) noexcept;

// Returns the least distance [mm] from `behind` to `ahead`, both starting now; `apart` is added to all positions of
// `ahead`. Below 0 if `ahead` is behind at some time. Exact: evaluated at the roots of the derivatives of the distance.
double LeastDistance(const Braking& behind, const Braking& ahead, double apart) noexcept;

// Returns the distance [mm] from `speed`, without acceleration, to rest: v/2 (v/d + d/j), or v sqrt(v/j) if d is not
// reached.
double StoppingDistance(double speed, const Brakes& brakes) noexcept;
// The inverse: returns the speed [mm/s] from which the mover comes to rest in the distance `way` [mm].
double SpeedForDistance(double way, const Brakes& brakes) noexcept;
// Returns the highest speed [mm/s], without acceleration, from which a mover slows down to `end` within `way` [mm].
double SpeedBefore(double way, double end, const Brakes& brakes) noexcept;

}  // namespace takt::planar
