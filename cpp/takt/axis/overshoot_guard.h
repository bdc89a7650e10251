// What has been promised stays promised: an axis on its way to a target does not get beyond it because its ramps were
// lowered, by an override or by another command (AX-97).
#pragma once

#include <optional>

#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

// The sense in which something runs that is to stop: of its velocity, at rest of its acceleration.
double SenseOfTravel(const KinematicState& from) noexcept;

// Whether it gets beyond `target` on the far side.
bool Overshoots(const trajectory::Profile& profile, double target) noexcept;

// What weaker ramps must not change of a motion in progress.
struct OvershootGuard {
  std::optional<double> furthest;  // [u] it gets no further than this in its sense of travel
  bool straight = false;           // it does not turn round
};

// Whether `profile` breaks one of them.
bool BreaksGuard(const AxisParams& params, const OvershootGuard& guard, const trajectory::Profile& profile) noexcept;

// Whether an axis in `state` stops no further than at `furthest`, and without turning round.
bool StopsBy(const KinematicState& state, const trajectory::Limits& limits, double furthest) noexcept;

// The request with as much more deceleration and jerk, up to the axis' own, as it takes to keep them.
Request WithStrongerRamps(const AxisParams& params, const KinematicState& from, const Request& request,
                          const OvershootGuard& guard) noexcept;

}  // namespace takt::axis
