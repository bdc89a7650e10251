#include "takt/mover/coordinate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace takt::mover {

namespace {

using trajectory::Limits;
using trajectory::Profile;

constexpr double kSlack = 1e-9;  // [deg, mm] of a limit or window

bool Holds(const Profile& profile, const CoordinateParams& params) {
  if (!KeepsVelocity(profile, params.maximum.velocity)) return false;
  const Profile::Range range = profile.PositionRange();
  // A coordinate that is already outside may come back.
  return range.min >= std::min(params.lower, profile.start().position) - kSlack &&
         range.max <= std::max(params.upper, profile.start().position) + kSlack;
}

// Returns the angle [deg] by which the window that begins at or below this position is turned.
double WindowAt(const CoordinateParams& c, double position) {
  return kWindow * std::floor((position - c.lower + kSlack) / kWindow);
}

// Returns the nearest whole number; of two equally near ones that towards 0, so half a turn leads to the given
// position.
double RoundTowardsZero(double x) {
  return std::copysign(std::ceil(std::abs(x) - 0.5 - kSlack), x);
}

}  // namespace

bool KeepsVelocity(const Profile& profile, double maximum) noexcept {
  const double speed = maximum * (1 + 1e-9);
  const Profile::Range velocity = profile.VelocityRange();
  return velocity.max <= speed && velocity.min >= -speed;
}

Limits WithMaximumDynamics(const Limits& limits, const Limits& maximum) noexcept {
  Limits out = maximum;
  out.velocity = std::min(limits.velocity, maximum.velocity);
  return out;
}

bool PlanCoordinate(trajectory::Planner& planner, const KinematicState& from, double position, const Limits& limits,
                    const CoordinateParams& params, Profile& out) noexcept {
  Profile plan;
  for (const Limits& as : {limits, WithMaximumDynamics(limits, params.maximum.limits())}) {
    if (!planner.ToPosition(from, position, 0, as, plan).ok() || !Holds(plan, params)) continue;
    out = plan;
    return true;
  }
  return false;
}

bool PlanRest(trajectory::Planner& planner, const KinematicState& from, const Limits& limits,
              const CoordinateParams& params, Profile& out) noexcept {
  Profile plan;
  if (!planner.Stop(from, limits, plan).ok()) return false;
  if (!Holds(plan, params) && !planner.Stop(from, params.maximum.limits(), plan).ok()) return false;
  out = plan;
  return true;
}

CoordinateParams Windowed(const CoordinateParams& c, double position, bool bounded) noexcept {
  CoordinateParams params = c;
  if (bounded && InOneWindow(c, position, position)) {
    // Wide windows overlap: the one with the nearest centre.
    const double turned = kWindow * std::round((position - 0.5 * (c.lower + c.upper)) / kWindow);
    params.lower += turned;
    params.upper += turned;
  } else {
    params.lower = -std::numeric_limits<double>::infinity();
    params.upper = std::numeric_limits<double>::infinity();
  }
  return params;
}

bool InOneWindow(const CoordinateParams& c, double lower, double upper) noexcept {
  const double turned = WindowAt(c, lower);
  return lower >= turned + c.lower - kSlack && upper <= turned + c.upper + kSlack;
}

double TargetOf(const MoverParams& params, const KinematicState& from, double stop, const MoveC& command) noexcept {
  const double turn = params.c_modulus;
  const double slack = std::max(1e-9 * turn, params.c_modulo_tolerance);
  const double p = command.position;
  switch (command.direction) {
    case TurnDirection::kPositive:
      return p + turn * (std::ceil((std::max(stop, from.position) - slack - p) / turn) + command.additional_turns);
    case TurnDirection::kNegative:
      return p + turn * (std::floor((std::min(stop, from.position) + slack - p) / turn) - command.additional_turns);
    case TurnDirection::kShortestWay:
      return p + turn * RoundTowardsZero((stop - p) / turn);
    default:
      return p;
  }
}

}  // namespace takt::mover
