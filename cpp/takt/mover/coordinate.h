// Motions of one coordinate besides X and Y, and the windows of C.
#pragma once

#include <optional>

#include "takt/core/kinematic_state.h"
#include "takt/mover/commands.h"
#include "takt/mover/params.h"
#include "takt/trajectory/planner.h"

namespace takt::mover {

inline constexpr double kWindow = 90;  // deg from one window of C to the next

// Returns whether the speed stays within `maximum` [mm/s, deg/s].
bool KeepsVelocity(const trajectory::Profile& profile, double maximum) noexcept;
// Returns the maximum acceleration, deceleration and jerk with the velocity that was asked for.
trajectory::Limits WithMaximumDynamics(const trajectory::Limits& limits, const trajectory::Limits& maximum) noexcept;

// To a position, as these limits say; with the maximum dynamics where the mover would leave the coordinate's limits or
// its largest speed else. False: there is no such motion.
bool PlanCoordinate(trajectory::Planner& planner, const KinematicState& from, double position,
                    const trajectory::Limits& limits, const CoordinateParams& params,
                    trajectory::Profile& out) noexcept;
// The same to rest.
bool PlanRest(trajectory::Planner& planner, const KinematicState& from, const trajectory::Limits& limits,
              const CoordinateParams& params, trajectory::Profile& out) noexcept;

// C with the window that it is in as its limits; outside of all, or not `bounded`: without any.
CoordinateParams Windowed(const CoordinateParams& c, double position, bool bounded) noexcept;
// Whether all of [lower, upper] lies within one window.
bool InOneWindow(const CoordinateParams& c, double lower, double upper) noexcept;

// Where move_c leads from a state, which comes to rest at `stop`.
double TargetOf(const MoverParams& params, const KinematicState& from, double stop, const MoveC& command) noexcept;

}  // namespace takt::mover
