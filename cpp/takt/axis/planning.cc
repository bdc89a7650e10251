#include "takt/axis/planning.h"

#include <algorithm>
#include <cmath>

namespace takt::axis {

using trajectory::Limits;
using trajectory::Planner;
using trajectory::Profile;

namespace {

constexpr int kBisections = 24;  // of a blending velocity: 1e-7 of the velocity asked for

double Sense(double x) {
  return x < 0 ? -1.0 : 1.0;
}

// Rounding of positions of the size of `x`.
double Rounding(double x) {
  return 1e-9 * (1 + std::abs(x));
}

bool Inside(const AxisLimits& limits, double position) {
  return !(limits.lower && position < *limits.lower - Rounding(*limits.lower)) &&
         !(limits.upper && position > *limits.upper + Rounding(*limits.upper));
}

// Whether a profile keeps the SW limits and the axis' velocity, or at least leaves them no further than it began. One
// planned with weak limits of a command, from the middle of a stronger motion, may not.
bool Fits(const AxisLimits& limits, const KinematicState& from, const Profile& profile) {
  const Profile::Range velocity = profile.VelocityRange();
  const double fastest = std::max(limits.velocity, std::abs(from.velocity)) * (1 + 1e-9);
  if (velocity.max > fastest || velocity.min < -fastest) return false;
  const Profile::Range range = profile.PositionRange();
  const double low = std::min(from.position, range.min);
  const double high = std::max(from.position, range.max);
  return !(limits.lower && low < std::min(*limits.lower, from.position) - Rounding(*limits.lower)) &&
         !(limits.upper && high > std::max(*limits.upper, from.position) + Rounding(*limits.upper));
}

// Never backwards and never past the end: what a move that is to be left with a velocity must be.
bool RunsStraight(const Profile& profile, double sense) {
  const Profile::Range velocity = profile.VelocityRange();
  const double backwards = sense > 0 ? -velocity.min : velocity.max;
  const double allowed = std::max(0.0, -sense * profile.start().velocity);
  return backwards <= allowed + 1e-9 * (1 + allowed);
}

// The speed at which `next` may take over at the end of `request`, from what its buffer mode asks, lowered so far that
// it can still end where it has to. 0: not at all (reversal).
double TakeOverSpeed(const AxisParams& params, const Request& request, double target, double sense, const Request& next,
                     std::int8_t last_sense) {
  double speed = 0;
  switch (next.buffer_mode) {
    case BufferMode::kBlendingLow:
      speed = std::min(request.velocity, next.velocity);
      break;
    case BufferMode::kBlendingPrevious:
      speed = request.velocity;
      break;
    case BufferMode::kBlendingNext:
      speed = next.velocity;
      break;
    case BufferMode::kBlendingHigh:
      speed = std::max(request.velocity, next.velocity);
      break;
    default:
      return 0;
  }
  if (next.kind == RequestKind::kMoveVelocity) {
    return SenseOf(next, last_sense) == static_cast<int>(sense) ? speed : 0;
  }
  const KinematicState at_target{target, 0, 0};
  const double next_target = next.kind == RequestKind::kMoveRelative
                                 ? target + next.value
                                 : ResolveTarget(params, at_target, next.limits(), next.value, next.direction,
                                                 static_cast<std::int8_t>(sense));
  const double room = sense * (next_target - target);
  if (room <= 0 || !Inside(params.limits, next_target)) return 0;
  const auto stops_in_time = [&](double v) { return trajectory::StopPosition({0, v, 0}, next.limits()) <= room; };
  if (stops_in_time(speed)) return speed;
  double low = 0;
  double high = speed;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (stops_in_time(middle) ? low : high) = middle;
  }
  return low;
}

// To `target`, left with `speed` in the sense of travel: at the request's velocity first, then up to a higher `speed`
// so late that it is reached at the target.
bool PlanLeaving(Planner& planner, const KinematicState& from, double target, double sense, double speed,
                 const Limits& limits, Profile& out) {
  Profile profile;
  if (speed <= limits.velocity) {
    if (planner.ToPosition(from, target, sense * speed, limits, profile).failed() || !RunsStraight(profile, sense))
      return false;
    out = profile;
    return true;
  }
  Limits faster = limits;
  faster.velocity = speed;
  Profile ramp;
  if (planner.ToVelocity({0, sense * limits.velocity, 0}, sense * speed, faster, ramp).failed()) return false;
  const double begin = target - ramp.end().position;
  if (planner.ToPosition(from, begin, sense * limits.velocity, limits, profile).failed() ||
      !RunsStraight(profile, sense))
    return false;
  ramp.Shift(begin);
  if (!profile.Append(ramp)) return false;
  profile.SnapEnd({target, sense * speed, 0});
  out = profile;
  return true;
}

// The plan with the highest speed at its end not above `speed`; standing still at the end is always one.
Status PlanBlended(Planner& planner, const KinematicState& from, double target, double sense, double speed,
                   const Limits& limits, Plan& out) {
  if (PlanLeaving(planner, from, target, sense, speed, limits, out.profile)) return Status::Ok();
  out.limited_by = LimitedBy::kDistance;
  double low = 0;
  double high = std::min(speed, limits.velocity);
  if (PlanLeaving(planner, from, target, sense, high, limits, out.profile)) return Status::Ok();
  const Status standing = planner.ToPosition(from, target, 0, limits, out.profile);
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (PlanLeaving(planner, from, target, sense, middle, limits, out.profile) ? low : high) = middle;
  }
  return low > 0 ? Status::Ok() : standing;
}

// While a limit switch is on, no motion may go (further) towards it.
Status CheckSwitches(const Surroundings& around, const KinematicState& from, const Profile& profile) {
  const Profile::Range velocity = profile.VelocityRange();
  const double up = std::max(velocity.max, profile.end().velocity);
  const double down = std::min(velocity.min, profile.end().velocity);
  const bool goes_up = up > std::max(0.0, from.velocity) + Rounding(0);
  const bool goes_down = down < std::min(0.0, from.velocity) - Rounding(0);
  if ((around.limit_positive && goes_up) || (around.limit_negative && goes_down))
    return Status::Failed(ErrorId::kAwayFromLimitOnly);
  return Status::Ok();
}

// Standing at a SW limit there is no way further out.
Status CheckAtLimit(const AxisLimits& limits, const KinematicState& from, double velocity) {
  const bool at_upper = limits.upper && from.position >= *limits.upper - Rounding(*limits.upper);
  const bool at_lower = limits.lower && from.position <= *limits.lower + Rounding(*limits.lower);
  if (from.velocity == 0 && ((velocity > 0 && at_upper) || (velocity < 0 && at_lower)))
    return Status::Failed(ErrorId::kTargetBehindLimit);
  return Status::Ok();
}

// To `out.target`.
Status PlanTo(const AxisParams& params, const Surroundings& around, Planner& planner, const KinematicState& from,
              const Request& request, const Request* next, Plan& out) {
  const Limits limits = request.limits();
  if (!Inside(params.limits, out.target)) return Status::Failed(ErrorId::kTargetBehindLimit);
  const double sense = Sense(out.target - from.position);
  const double speed = next ? TakeOverSpeed(params, request, out.target, sense, *next, around.last_sense) : 0;
  if (next && speed == 0) out.limited_by = LimitedBy::kDistance;
  if (speed > 0) return PlanBlended(planner, from, out.target, sense, speed, limits, out);
  return planner.ToPosition(from, out.target, 0, limits, out.profile);
}

Status PlanPositioning(const AxisParams& params, const Surroundings& around, Planner& planner,
                       const KinematicState& from, const Request& request, const Request* next, Plan& out) {
  const Limits limits = request.limits();
  out.target = request.kind == RequestKind::kMoveRelative
                   ? from.position + request.value
                   : ResolveTarget(params, from, limits, request.value, request.direction, around.last_sense);
  return PlanTo(params, around, planner, from, request, next, out);
}

Status PlanAsAsked(const AxisParams& params, const Surroundings& around, Planner& planner, const KinematicState& from,
                   const Request& request, const Request* next, Plan& out) {
  out.limited_by = LimitedBy::kNothing;
  Status status;
  switch (request.kind) {
    case RequestKind::kMoveAbsolute:
    case RequestKind::kMoveRelative:
      status = PlanPositioning(params, around, planner, from, request, next, out);
      break;
    case RequestKind::kMoveVelocity: {
      const double velocity = SenseOf(request, around.last_sense) * request.velocity;
      Limits limits = request.limits();
      limits.velocity = params.limits.velocity;  // the request's own may be 0, which is no limit
      status = CheckAtLimit(params.limits, from, velocity);
      if (status.ok()) status = planner.ToVelocity(from, velocity, limits, out.profile);
      break;
    }
    default:
      return planner.Stop(from, request.limits(), out.profile);
  }
  return status.ok() ? CheckSwitches(around, from, out.profile) : status;
}

// The same request with all that the axis has for its ramps.
Request Hardest(const AxisParams& params, const Request& request) {
  const Limits own = params.planner_limits();
  Request harder = request;
  harder.acceleration = own.acceleration;
  harder.deceleration = own.deceleration;
  harder.jerk = own.jerk;
  return harder;
}

}  // namespace

int SenseOf(const Request& request, std::int8_t last_sense) noexcept {
  if (request.direction == Direction::kCurrent) return last_sense;
  return request.direction == Direction::kNegative ? -1 : 1;
}

double ResolveTarget(const AxisParams& params, const KinematicState& from, const Limits& limits, double position,
                     Direction direction, std::int8_t last_sense) noexcept {
  if (!params.rotary()) return position;
  const double turn = params.modulus;
  const double stop = trajectory::StopPosition(from, limits);
  const double slack = 1e-9 * turn;
  const auto first_above = [&](double p) { return position + turn * std::ceil((p - slack - position) / turn); };
  const auto first_below = [&](double p) { return position + turn * std::floor((p + slack - position) / turn); };
  if (direction == Direction::kCurrent) direction = last_sense < 0 ? Direction::kNegative : Direction::kPositive;
  switch (direction) {
    case Direction::kPositive:
      return first_above(std::max(stop, from.position));
    case Direction::kNegative:
      return first_below(std::min(stop, from.position));
    default:
      break;
  }
  const double above = first_above(stop);
  const double below = first_below(stop);
  return above - stop <= stop - below + slack ? above : below;
}

Status PlanRequest(const AxisParams& params, const Surroundings& around, Planner& planner, const KinematicState& from,
                   const Request& request, const Request* next, Plan& out) noexcept {
  Status status = PlanAsAsked(params, around, planner, from, request, next, out);
  if (status.ok() && !Fits(params.limits, from, out.profile)) {
    status = PlanAsAsked(params, around, planner, from, Hardest(params, request), next, out);
    out.limited_by = LimitedBy::kPosition;
  }
  return status;
}

Status Replan(const AxisParams& params, const Surroundings& around, Planner& planner, const KinematicState& from,
              const Request& request, const Request* next, Plan& out) noexcept {
  out.limited_by = LimitedBy::kNothing;
  Status status = PlanTo(params, around, planner, from, request, next, out);
  if (status.ok() && !Fits(params.limits, from, out.profile)) {
    status = PlanTo(params, around, planner, from, Hardest(params, request), next, out);
  }
  return status;
}

Status PlanStop(const AxisParams& params, Planner& planner, const KinematicState& from, const Limits& limits,
                Profile& out) noexcept {
  const Status status = planner.Stop(from, limits, out);
  if (status.failed() || Fits(params.limits, from, out)) return status;
  return planner.Stop(from, params.planner_limits(), out);
}

}  // namespace takt::axis
