// What a motion has to keep whatever a command asked for. A command may bring weaker ramps than the motion it
// interrupts; planned with those alone, the rest of the stronger motion can carry the axis beyond its limits.
#pragma once

#include <cmath>

#include "takt/axis/params.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

struct Demands {
  // It, and a stop at any time of it, stays inside the SW limits. (Motions without an end are watched cycle by cycle.)
  bool position = true;
  bool straight = false;  // never turns round (braking)
};

// The first thing that `profile` breaks: the axis' velocity, acceleration or deceleration, the SW limits (kPosition),
// or that it may not turn round (kJerk: too little of it). What `from` already is beyond a limit is no fault as long as
// it gets no worse.
LimitedBy Breaks(const AxisParams& params, const KinematicState& from, const trajectory::Profile& profile,
                 const Demands& demands) noexcept;

// All positions, from `x` on, that braking with all the axis has leads through. It swings back where the deceleration
// there is outlasts the speed.
trajectory::Profile::Range RangeOfStop(const AxisParams& params, const KinematicState& x) noexcept;

// Invariant of motions that go on: braking now, from this set point, ends inside the SW limits. A set point that would
// break it is not taken; the brake begins in its place, which the set point before allowed (AX-13). `slack`, u: so far
// beyond them still counts as inside.
bool CanStopInside(const AxisParams& params, const KinematicState& before, const KinematicState& next,
                   double slack = 0) noexcept;

// Whether the acceleration of a piece is beyond what the axis allows while its speed grows, or falls.
bool BreaksRamps(const trajectory::Limits& own, const trajectory::Piece& piece, double duration) noexcept;

// Whether a position lies inside the SW limits.
bool Inside(const AxisLimits& limits, double position) noexcept;

// What counts as equal among positions of the size of `x`.
inline double Rounding(double x) noexcept {
  return 1e-9 * (1 + std::abs(x));
}

}  // namespace takt::axis
