// Acceleration and deceleration limits that differ: which of them bounds which sign of the acceleration.
#pragma once

#include "takt/core/kinematic_state.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/profile.h"
#include "takt/trajectory/ramp.h"

namespace takt::trajectory {

// Returns the bounds for a motion in the direction of the sign of `way` (0: positive), which may have to reverse first.
Bounds DirectedBounds(const KinematicState& from, double way, const Limits& limits) noexcept;

// Returns the bounds for the quickest ramp to `velocity`.
Bounds VelocityBounds(const KinematicState& from, double velocity, const Limits& limits) noexcept;

// Checks `plan`, made with `bounds`, against the limits; lowers each bound that let the plan exceed them to the smaller
// limit. Returns true if any bound was lowered. An acceleration inherited from the start does not count as exceeding
// while it falls at full jerk.
bool LowerWhereExceeded(const Profile& plan, const Limits& limits, Bounds& bounds) noexcept;

}  // namespace takt::trajectory
