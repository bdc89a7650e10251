// From a request to a profile: where it ends, with what speed it is left, and whether limits allow it. Pure: nothing of
// the axis changes.
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

// What planning has to know of an axis besides its parameters.
struct PlanningContext {
  bool limit_positive = false;
  bool limit_negative = false;
  bool bars_positive = false;  // motion upwards is not enabled (MC_Power)
  bool bars_negative = false;
  bool homed = true;
  std::int8_t last_sense = 1;
  std::optional<double> promised;  // [u] unwrapped: where the positioning command in control ends, if there is one
  std::optional<double> begin;     // [u] unwrapped: where that command began, if it goes by a distance
  // [u] unwrapped: the end of the motion in progress, or further out where it passes that. Nothing that does not itself
  // go beyond is to go beyond (AX-97).
  std::optional<double> furthest;
  bool again = false;      // the request is the one in control, planned anew
  bool passes = false;     // and the motion in progress goes on beyond its target
  bool committed = false;  // the target of the request is a promise already: the move before was left towards it
  Override factors;
};

struct Plan {
  trajectory::Profile profile;
  double target = 0;  // unwrapped end of a positioning request
  LimitedBy limited_by = LimitedBy::kNothing;
  bool held = false;  // by the override: the profile ends where that stops it
};

// Plans `request`, scaled by the override, from `from`. `queue` has the blending commands behind it: the profile then
// ends with the highest velocity from which all of them can be done (AX-12, AX-103). Errors: kTargetBehindLimit,
// kAwayFromLimitOnly, kDirection, kPlanning.
Status PlanRequest(const AxisParams& params, const PlanningContext& around, trajectory::Planner& planner,
                   const KinematicState& from, const Request& request, std::span<const Request> queue,
                   Plan& out) noexcept;

// The same for a positioning request that is under way: `out.target` is given and stays.
Status Replan(const AxisParams& params, const PlanningContext& around, trajectory::Planner& planner,
              const KinematicState& from, const Request& request, std::span<const Request> queue, Plan& out) noexcept;

// While a limit switch is on, no motion may go (further) towards it: kAwayFromLimitOnly; and none where MC_Power does
// not enable it: kDirection.
Status CheckSwitches(const PlanningContext& around, const KinematicState& from,
                     const trajectory::Profile& profile) noexcept;

// To standstill as `limits` say, or harder where the SW limits want it, or a promise (PlanningContext).
Status PlanStop(const AxisParams& params, trajectory::Planner& planner, const KinematicState& from,
                const trajectory::Limits& limits, std::optional<double> furthest, trajectory::Profile& out) noexcept;

// +1 or -1: where a velocity request goes.
int SenseOf(const Request& request, std::int8_t last_sense) noexcept;

// The next position equal to `position` modulo the turn that `direction` allows from `from` without reversing on the
// way (AX-14). Linear axes: `position`.
double ResolveTarget(const AxisParams& params, const KinematicState& from, const trajectory::Limits& limits,
                     double position, Direction direction, std::int8_t last_sense) noexcept;

}  // namespace takt::axis
