// MC_SetOverride: factors for the velocity, the ramps and the jerk of motions of an axis (AX-51).
//
// They act on moves to a position (including their blending velocities), continuous moves, MC_MoveVelocity, jog, inch,
// GT_Touch and superimposed motions: on the one in progress, which is planned anew from its present state, and on
// buffered ones. They do not act on motions that bring an axis to rest (halt, stop, power off, a released jog key,
// faults), on homing, torque control and tables over time, nor on axes that follow others: their masters determine the
// motion.
//
// Velocity factor 0 holds the axis: it comes to rest with its (scaled) ramps, stays in its state, and resumes the
// motion once the factor is above 0. Factors above 1 act up to the axis' own limits; `limited_by` then names the limit.
// The factors stay until they are set anew, also over power off and on.
#pragma once

#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct Context;
struct State;

struct Override {
  double velocity = 1;      // 0, or kSmallestFactor to kLargestFactor
  double acceleration = 1;  // kSmallestFactor to kLargestFactor; also of the deceleration
  double jerk = 1;

  bool operator==(const Override&) const = default;
};
inline constexpr double kSmallestFactor = 1e-6;
inline constexpr double kLargestFactor = 100;

// Returns true if the factors act on requests of this kind.
bool Overridden(RequestKind kind) noexcept;
// Returns true if the factors hold a request of this kind at rest.
bool Held(const Override& factors, RequestKind kind) noexcept;
// Returns the request with its limits scaled, at most to the axis' own: `clamped` then says which. A held request keeps
// its velocity.
Request Scaled(const AxisParams& params, const Override& factors, const Request& request, LimitedBy& clamped) noexcept;

Status CarryOut(const Context& c, Ticket ticket, const SetOverride& command, State& s) noexcept;

void describe(Description<Override>&);

}  // namespace takt::axis
