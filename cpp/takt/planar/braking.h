// How a mover on a track comes to rest at the earliest, and how near two movers get that both do so: what every rule of
// traffic is made of (traffic.h).
#pragma once

#include <array>

#include "takt/core/kinematic_state.h"
#include "takt/trajectory/piece.h"

namespace takt::planar {

// How hard a mover brakes.
struct Brakes {
  double deceleration = 0;  // mm/s², > 0
  double jerk = 0;          // mm/s³, > 0
};

// From one instant on the mover brakes, until it stands. No motion with the same brakes that never reverses is slower
// at any time, nor behind it.
struct Braking {
  std::array<trajectory::Piece, 3> pieces{};
  std::array<double, 3> ends_s{};  // s from the start, ascending
  double rest = 0;                 // mm, where it stands then
  double lowest = 0;               // mm, the least place on the way: start or rest, but where it first goes back
  double highest = 0;

  // s from its start, from 0 on.
  KinematicState At(double t) const noexcept;
};
Braking Brake(const KinematicState& from, const Brakes& brakes) noexcept;

// mm: the least distance from `behind` to `ahead`, both starting now; `apart` is added to all places of `ahead`.
// Below 0 if it is behind somewhere. Exact: from the roots of the derivatives of the distance.
double LeastDistance(const Braking& behind, const Braking& ahead, double apart) noexcept;

// A speed that falls with the way left: from no acceleration at speed v to rest takes v/2 (v/d + d/j), or v sqrt(v/j)
// where d is not reached.
double WayToRest(double speed, const Brakes& brakes) noexcept;
// The inverse; mm/s.
double SpeedForWay(double way, const Brakes& brakes) noexcept;
// The highest speed (without acceleration) from which a mover gets down to `end` on so long a way.
double SpeedBefore(double way, double end, const Brakes& brakes) noexcept;

}  // namespace takt::planar
