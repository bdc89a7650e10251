// What a motion must keep, whatever the command asks for. A command may have weaker ramps than the motion it
// interrupts; planned with those alone, the remainder of the stronger motion could carry the axis beyond its limits.
#pragma once

#include <cmath>

#include "takt/axis/params.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

struct Demands {
  // The motion, and a stop at any time during it, stays inside the SW limits. (Motions without an end are watched each
  // cycle.)
  bool position = true;
  bool straight = false;  // the motion never reverses (braking)
};

// Returns what `profile` violates first: the axis' velocity, acceleration or deceleration, the SW limits (kPosition),
// or the ban on reversing (kJerk: too little of it). A limit that `from` already exceeds is not violated as long as it
// gets no worse.
LimitedBy Breaks(const AxisParams& params, const KinematicState& from, const trajectory::Profile& profile,
                 const Demands& demands) noexcept;

// Returns the range of positions that the axis passes when it brakes from `x` with its own limits. It swings back if
// its present deceleration outlasts the velocity.
trajectory::Profile::Range RangeOfStop(const AxisParams& params, const KinematicState& x) noexcept;

// Returns true if braking from `next` stays inside the SW limits, or gets no further out than `before`. Invariant of
// motions without an end: it holds for each set point. A set point for which it does not is dropped, and the axis
// brakes from the one before, which allowed it (AX-13). `slack` [u]: tolerance beyond the limits.
bool CanStopInside(const AxisParams& params, const KinematicState& before, const KinematicState& next,
                   double slack = 0) noexcept;

// Returns true if the acceleration of a piece exceeds the axis' acceleration while its speed grows, or its deceleration
// while it falls.
bool BreaksRamps(const trajectory::Limits& own, const trajectory::Piece& piece, double duration) noexcept;

// Returns true if a position is inside the SW limits, but for rounding.
bool Inside(const AxisLimits& limits, double position) noexcept;

// Returns the tolerance [u] within which positions of the size of `x` count as equal.
inline double Rounding(double x) noexcept {
  return 1e-9 * (1 + std::abs(x));
}

}  // namespace takt::axis
