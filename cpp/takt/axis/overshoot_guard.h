// Keeps promised ends: an axis that moves to a target does not overshoot it because its ramps were lowered, by an
// override or by another command (AX-97).
#pragma once

#include <optional>

#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

// Returns the sense, +1 or -1, in which an axis that is to stop moves: that of its velocity, at rest of its
// acceleration.
double SenseOfTravel(const KinematicState& from) noexcept;

// Returns true if the profile gets beyond `target` on the far side.
bool Overshoots(const trajectory::Profile& profile, double target) noexcept;

// Properties of the motion in progress that weaker ramps must not change.
struct OvershootGuard {
  std::optional<double> furthest;  // [u] limit of its travel in its sense
  bool straight = false;           // it does not reverse
};

// Returns true if `profile` violates the guard.
bool BreaksGuard(const AxisParams& params, const OvershootGuard& guard, const trajectory::Profile& profile) noexcept;

// Returns true if an axis in `state` stops no further than at `furthest`, without reversing.
bool StopsBy(const KinematicState& state, const trajectory::Limits& limits, double furthest) noexcept;

// Returns the request with as much more deceleration and jerk, at most the axis' own, as the guard requires.
Request WithStrongerRamps(const AxisParams& params, const KinematicState& from, const Request& request,
                          const OvershootGuard& guard) noexcept;

}  // namespace takt::axis
