#include "takt/mover/follow.h"

#include <algorithm>
#include <cmath>

#include "takt/mover/coordinate.h"
#include "takt/mover/on_parts.h"
#include "takt/mover/run.h"

namespace takt::mover {

namespace {

constexpr double kSlack = 1e-6;  // of the limits, for what programs add up
constexpr double kStill = 1e-9;  // mm, deg

double Length(double x, double y) {
  return std::hypot(x, y);
}

// Of one coordinate, or of two as a vector (the second one all 0 else).
bool Keeps(const KinematicState& from_x, const KinematicState& from_y, const KinematicState& x, const KinematicState& y,
           const trajectory::Limits& limits, double period) {
  constexpr double kMore = 1 + kSlack;
  const double most = kMore * std::max(limits.acceleration, limits.deceleration);
  const double a = Length(x.acceleration, y.acceleration);
  // Where the speed gets to even if the acceleration is taken away at once.
  const double still = a / (2 * limits.jerk);
  const double speed = Length(x.velocity + still * x.acceleration, y.velocity + still * y.acceleration);
  const auto off = [&](const KinematicState& from, const KinematicState& to) {
    return to.position - from.position - 0.5 * period * (from.velocity + to.velocity);
  };
  return Length(x.velocity, y.velocity) <= kMore * limits.velocity && speed <= kMore * limits.velocity && a <= most &&
         Length(x.velocity - from_x.velocity, y.velocity - from_y.velocity) <= most * period &&
         Length(off(from_x, x), off(from_y, y)) <= 0.5 * most * period * period + kStill;
}

// What was given last goes on with its acceleration.
void GoOn(double period, SetPoint& given) {
  for (KinematicState& k : given) {
    k.position += period * (k.velocity + 0.5 * period * k.acceleration);
    k.velocity += period * k.acceleration;
  }
}

}  // namespace

bool CanFollow(const Context& c, const State& s, const SetPoint& from, const SetPoint& to) noexcept {
  const double period = c.cycle.period_s;
  if (!Keeps(from[kX], from[kY], to[kX], to[kY], c.params.xy.maximum.limits(), period)) return false;
  for (std::size_t i = 0; i < kOthers.size(); ++i) {
    const CoordinateParams params = ParamsOf(c, s, i);
    const KinematicState& k = to[kOthers[i]];
    if (!Keeps(from[kOthers[i]], {}, k, {}, params.maximum.limits(), period)) return false;
    if (k.position < params.lower - kSlack || k.position > params.upper + kSlack) return false;
  }
  const bool locked = s.mode == CommandMode::kCRotationFreeMovement || s.mode == CommandMode::kCRotationOnTrack;
  return !locked || Length(to[kX].position - from[kX].position, to[kY].position - from[kY].position) <= kStill;
}

ErrorId Follow(const Context& c, SetPoint& at, State& s) noexcept {
  External& external = s.external;
  if (!external.begun) return ErrorId::kNone;
  external.missing = external.fresh ? 0 : external.missing + 1;
  if (external.missing >= c.params.missing_setpoints) return ErrorId::kNoSetPoint;
  if (!external.fresh) GoOn(c.cycle.period_s, external.given);
  external.fresh = false;
  SetPoint to = external.given;
  if (external.mode == SetpointMode::kRelative) {
    for (std::size_t i = 0; i < kCoordinates; ++i) {
      to[i].position += at[i].position;
      to[i].velocity += at[i].velocity;
      to[i].acceleration += at[i].acceleration;
    }
  }
  if (!CanFollow(c, s, s.set_point, to)) return ErrorId::kWildSetPoint;
  if (!IsOnTrack(s)) {
    if (const ErrorId why = WhyNotOn(c, s, CoverOfStop(c, to)); why != ErrorId::kNone) return why;
  }
  at = to;
  return ErrorId::kNone;
}

}  // namespace takt::mover
