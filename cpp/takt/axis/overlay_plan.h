// Planning of a superimposed distance so that the sum keeps the limits of the axis. Pure.
#pragma once

#include "takt/axis/params.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

// The base motion, as far as it is known ahead.
struct BaseAhead {
  const trajectory::Profile* profile = nullptr;  // null: it follows something; assumed to keep its velocity
  double elapsed_s = 0;                          // [s] of the profile
  KinematicState now;
};

// Returns true if the sum of base and `added` keeps the velocity, acceleration, deceleration and jerk of the axis and
// stays inside the SW limits, from now to the end of both.
bool SumKeeps(const AxisParams& params, const BaseAhead& base, const trajectory::Profile& added) noexcept;

// Plans `added` from `from` (relative to the base) to `target` within `limits`. Of the plans whose sum keeps the limits
// it takes the one that ends first: with all its ramps at once, with the ramps that the base leaves, or delayed. If
// there is none, the one with all its ramps at once: the axis then lags behind the sum for a while. Returns kPlanning
// if there is no plan.
Status PlanOverlay(const AxisParams& params, trajectory::Planner& planner, const BaseAhead& base,
                   const KinematicState& from, double target, const trajectory::Limits& limits,
                   trajectory::Profile& added) noexcept;

}  // namespace takt::axis
