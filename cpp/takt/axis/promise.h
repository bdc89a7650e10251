// What has been promised stays promised: an axis on its way to a target does not get beyond it because its ramps were
// lowered, by an override or by another command (AX-97).
#pragma once

#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

// The sense in which something runs that is to stop: of its velocity, at rest of its acceleration.
double SenseOfTravel(const KinematicState& from) noexcept;

// Whether a motion that sets out in this sense gets beyond `furthest`.
bool Passes(const trajectory::Profile& profile, double sense, double furthest) noexcept;
// Whether it gets beyond `target` on the far side.
bool Overshoots(const trajectory::Profile& profile, double target) noexcept;

// The request with as much more deceleration and jerk, up to the axis' own, as it takes to stop at `furthest`.
Request Strengthened(const AxisParams& params, const KinematicState& from, const Request& request,
                     double furthest) noexcept;

}  // namespace takt::axis
