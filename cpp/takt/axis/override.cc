#include "takt/axis/override.h"

#include <algorithm>
#include <cmath>

#include "takt/axis/request_builder.h"
#include "takt/axis/sequence.h"

namespace takt::axis {

namespace {

// Returns a limit scaled by its factor, at most `own`; 0: unlimited.
double Times(double limit, double factor, double own, LimitedBy reason, LimitedBy& clamped) {
  const double wanted = limit * factor;
  if (own == 0 || wanted <= own) return wanted;
  if (wanted > own * (1 + 1e-12) && clamped == LimitedBy::kNothing) clamped = reason;
  return own;
}

}  // namespace

bool Overridden(RequestKind kind) noexcept {
  switch (kind) {
    case RequestKind::kMoveAbsolute:
    case RequestKind::kMoveRelative:
    case RequestKind::kMoveAdditive:
    case RequestKind::kMoveVelocity:
    case RequestKind::kMoveContinuousAbsolute:
    case RequestKind::kMoveContinuousRelative:
    case RequestKind::kInch:
    case RequestKind::kJog:
    case RequestKind::kTouch:
      return true;
    default:
      return false;
  }
}

bool Held(const Override& factors, RequestKind kind) noexcept {
  return factors.velocity == 0 && Overridden(kind);
}

Request Scaled(const AxisParams& params, const Override& factors, const Request& request, LimitedBy& clamped) noexcept {
  Request r = request;
  if (factors == Override{} || !Overridden(request.kind)) return r;
  const trajectory::Limits own = params.planner_limits();
  const double speed = factors.velocity > 0 ? factors.velocity : 1;
  r.velocity = Times(r.velocity, speed, own.velocity, LimitedBy::kVelocity, clamped);
  r.end_velocity = Times(r.end_velocity, speed, own.velocity, LimitedBy::kVelocity, clamped);
  r.acceleration = Times(r.acceleration, factors.acceleration, own.acceleration, LimitedBy::kAcceleration, clamped);
  r.deceleration = Times(r.deceleration, factors.acceleration, own.deceleration, LimitedBy::kAcceleration, clamped);
  r.jerk = Times(r.jerk, factors.jerk, own.jerk, LimitedBy::kJerk, clamped);
  return r;
}

Status CarryOut(const Context& c, Ticket ticket, const SetOverride& command, State& s) noexcept {
  const Override before = s.override_factors;
  s.override_factors = {command.velocity_factor, command.acceleration_factor, command.jerk_factor};
  if (s.override_factors != before) PlanAgain(c, s);
  Report(c, ticket, FeedbackState::kActive);
  Report(c, ticket, FeedbackState::kDone);
  return Status::Ok();
}

void describe(Description<Override>& d) {
  using O = Override;
  d.about("Factors of the command in control and of buffered ones.");
  d.internal<&O::velocity>("Factor of velocities; 0: held.");
  d.internal<&O::acceleration>("Factor of accelerations and decelerations.");
  d.internal<&O::jerk>("Factor of the jerk.");
}

bool Fill(const RequestBuilder& m, const SetOverride& o) {
  const double slowest = o.velocity_factor == 0 ? 0 : kSmallestFactor;
  return m.In("velocity_factor", o.velocity_factor, slowest, kLargestFactor) &&
         m.In("acceleration_factor", o.acceleration_factor, kSmallestFactor, kLargestFactor) &&
         m.In("jerk_factor", o.jerk_factor, kSmallestFactor, kLargestFactor);
}

}  // namespace takt::axis
