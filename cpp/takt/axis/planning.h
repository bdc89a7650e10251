// From a request to a profile: its end, its end velocity, and whether the limits allow it. Pure: the axis does not
// change.
#pragma once

#include <optional>
#include <span>

#include "takt/axis/override.h"
#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/planner.h"

namespace takt::axis {

// State of an axis that planning needs besides its parameters.
struct PlanningContext {
  bool limit_positive = false;
  bool limit_negative = false;
  bool bars_positive = false;  // MC_Power does not enable motion upwards
  bool bars_negative = false;
  bool homed = true;
  std::int8_t last_sense = 1;
  std::optional<double> promised;  // [u] unwrapped: end of the positioning command in control, if any
  std::optional<double> begin;     // [u] unwrapped: start of the continuous relative move in control, if any
  // [u] unwrapped: the end of the motion in progress, or the furthest point if it overshoots that. A request that does
  // not itself aim beyond it must not get beyond it (AX-97).
  std::optional<double> furthest;
  bool again = false;      // the request is the one in control, planned anew
  bool passes = false;     // the motion in progress continues beyond its target
  bool committed = false;  // the target must be kept: the previous move was left with a velocity towards it
  Override factors;
};

struct Plan {
  trajectory::Profile profile;
  double target = 0;  // [u] unwrapped end of a positioning request
  LimitedBy limited_by = LimitedBy::kNothing;
  bool held = false;  // by the override: the profile ends where it holds the axis
};

// Plans `request`, scaled by the override, from `from`. `queue`: the blending commands behind it; the profile then ends
// with the highest velocity from which all of them can be executed (AX-12, AX-103). Returns kTargetBehindLimit,
// kNoReference, kAwayFromLimitOnly, kDirection, kState (torque for an analogue drive) or kPlanning.
Status PlanRequest(const AxisParams& params, const PlanningContext& around, trajectory::Planner& planner,
                   const KinematicState& from, const Request& request, std::span<const Request> queue,
                   Plan& out) noexcept;

// Plans a positioning request that is in progress anew: `out.target` is given and stays.
Status Replan(const AxisParams& params, const PlanningContext& around, trajectory::Planner& planner,
              const KinematicState& from, const Request& request, std::span<const Request> queue, Plan& out) noexcept;

// Checks a profile against limit switches and enabled directions. Returns kAwayFromLimitOnly if it moves towards a
// limit switch that is on, kDirection if it moves in a sense that MC_Power does not enable.
Status CheckSwitches(const PlanningContext& around, const KinematicState& from,
                     const trajectory::Profile& profile) noexcept;

// Plans a stop within `limits`, or harder if the SW limits or `furthest` [u] (see OvershootGuard) require it.
Status PlanStop(const AxisParams& params, trajectory::Planner& planner, const KinematicState& from,
                const trajectory::Limits& limits, std::optional<double> furthest, trajectory::Profile& out) noexcept;

// Returns the sense, +1 or -1, of a velocity request.
int SenseOf(const Request& request, std::int8_t last_sense) noexcept;

// Returns the position equal to `position` modulo a turn that is next in `direction` (kShortest: nearest) and reached
// from `from` without reversing (AX-14). Linear axes: `position`.
double ResolveTarget(const AxisParams& params, const KinematicState& from, const trajectory::Limits& limits,
                     double position, Direction direction, std::int8_t last_sense) noexcept;

}  // namespace takt::axis
