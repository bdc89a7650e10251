// Where acceleration and deceleration limits differ: which of them bounds which sign of the acceleration.
#pragma once

#include "takt/core/kinematic_state.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/profile.h"
#include "takt/trajectory/ramp.h"

namespace takt::trajectory {

// Bounds for a motion that, once it stops running the wrong way, goes in the direction of `way`.
Bounds DirectedBounds(const KinematicState& from, double way, const Limits& limits) noexcept;

// Bounds for the quickest ramp to `velocity`.
Bounds VelocityBounds(const KinematicState& from, double velocity, const Limits& limits) noexcept;

// Holds `plan`, made with `bounds`, against the limits. A bound that let the plan exceed them is lowered to the smaller
// limit. True if any was. An acceleration the start came with is no excess while it falls at full jerk.
bool LowerWhereExceeded(const Profile& plan, const Limits& limits, Bounds& bounds) noexcept;

}  // namespace takt::trajectory
