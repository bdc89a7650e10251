// Motions of one coordinate besides X and Y, and the windows of C.
#pragma once

#include <optional>

#include "takt/core/kinematic_state.h"
#include "takt/mover/commands.h"
#include "takt/mover/params.h"
#include "takt/trajectory/planner.h"

namespace takt::mover {

inline constexpr double kWindow = 90;  // [deg] from one window of C to the next

// Returns true if the speed stays within `maximum` [mm/s, deg/s].
bool KeepsVelocity(const trajectory::Profile& profile, double maximum) noexcept;
// Returns the maximum acceleration, deceleration and jerk with the requested velocity.
trajectory::Limits WithMaximumDynamics(const trajectory::Limits& limits, const trajectory::Limits& maximum) noexcept;

// Plans a motion to rest at `position` with these limits, or with the maximum dynamics if it would otherwise leave the
// range of the coordinate or exceed its maximum velocity. Returns false if there is no such motion.
bool PlanCoordinate(trajectory::Planner& planner, const KinematicState& from, double position,
                    const trajectory::Limits& limits, const CoordinateParams& params,
                    trajectory::Profile& out) noexcept;
// The same for a stop; its end position is not prescribed.
bool PlanRest(trajectory::Planner& planner, const KinematicState& from, const trajectory::Limits& limits,
              const CoordinateParams& params, trajectory::Profile& out) noexcept;

// Returns C limited to the window that contains `position`; without limits outside of all windows, or if not `bounded`.
CoordinateParams Windowed(const CoordinateParams& c, double position, bool bounded) noexcept;
// Returns true if [lower, upper] lies within one window.
bool InOneWindow(const CoordinateParams& c, double lower, double upper) noexcept;

// Returns the target [deg] of move_c from the state `from`, which would come to rest at `stop` [deg].
double TargetOf(const MoverParams& params, const KinematicState& from, double stop, const MoveC& command) noexcept;

}  // namespace takt::mover
