// MC_SetOverride: factors on the velocity, the ramps and the jerk of what moves an axis (AX-51).
//
// They act on the moves with a position (their blending velocities, too), on continuous moves, MC_MoveVelocity, jog,
// inch, GT_Touch and what lies on top of a motion: on the one in progress, which is planned anew from where it is, and
// on those that wait. They do not act on what brings an axis to rest (halt, stop, power off, a jog's key let go,
// faults), on homing, torque control, tables over time, nor on axes that follow others: their masters decide.
//
// Velocity factor 0 holds the axis: it comes to rest with its (scaled) ramps, stays in its state, and goes on to where
// it went once the factor is more. Factors above 1 count as far as the axis' own limits; `limited_by` then names the
// limit. The factors stay until they are set anew, also over power off and on.
#pragma once

#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct Context;
struct State;

struct Override {
  double velocity = 1;      // 0, or kSmallestFactor to kLargestFactor
  double acceleration = 1;  // kSmallestFactor to kLargestFactor, of the deceleration, too
  double jerk = 1;

  bool operator==(const Override&) const = default;
};
inline constexpr double kSmallestFactor = 1e-6;
inline constexpr double kLargestFactor = 100;

bool Overridden(RequestKind kind) noexcept;
// Whether the factors keep such a request at rest.
bool Held(const Override& factors, RequestKind kind) noexcept;
// The request with its limits by the factors, never beyond the axis' own: then `clamped` says which. One that is held
// keeps its velocity.
Request Scaled(const AxisParams& params, const Override& factors, const Request& request, LimitedBy& clamped) noexcept;

Status CarryOut(const Context& c, Ticket ticket, const SetOverride& command, State& s) noexcept;

void describe(Description<Override>&);

}  // namespace takt::axis
