// How a distance is put on top of a motion so that the sum keeps the limits of the axis. Pure.
#pragma once

#include "takt/axis/params.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/planner.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

// The motion beneath, as far as it is known ahead.
struct BaseAhead {
  const trajectory::Profile* profile = nullptr;  // null: a coupled axis, taken to go on as it moves now
  double elapsed_s = 0;                          // of it
  KinematicState now;
};

// Whether base and `added` together keep velocity, acceleration, deceleration and jerk of the axis and stay inside the
// SW limits, from now on to the end of both.
bool SumKeeps(const AxisParams& params, const BaseAhead& base, const trajectory::Profile& added) noexcept;

// Plans `added` from `from` (relative to the base) to `target` with no more than `limits`. Of the plans with which the
// sum keeps the limits the one that ends first: with all its ramps at once, with what the base leaves of the ramps, or
// later. If there is none, that with all its ramps at once: the axis will lag behind the sum for a while. kPlanning.
Status PlanOverlay(const AxisParams& params, trajectory::Planner& planner, const BaseAhead& base,
                   const KinematicState& from, double target, const trajectory::Limits& limits,
                   trajectory::Profile& added) noexcept;

}  // namespace takt::axis
