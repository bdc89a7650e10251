#include "takt/axis/planning.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/axis/fit.h"
#include "takt/axis/look_ahead.h"
#include "takt/axis/overshoot_guard.h"

namespace takt::axis {

using trajectory::Limits;
using trajectory::Planner;
using trajectory::Profile;

namespace {

constexpr int kBlendBisections = 12;  // of a blending velocity: to 1/4096 of the velocity asked for

double Sense(double x) {
  return x < 0 ? -1.0 : 1.0;
}

// Returns the speed [u/s] in this sense that the present acceleration still adds until it is reduced to 0.
double Gained(const KinematicState& from, double sense, double jerk) {
  return jerk > 0 && sense * from.acceleration > 0 ? from.acceleration * from.acceleration / (2 * jerk) : 0;
}

// Returns true if a motion never runs backwards, and so never past its end: required of a move that is left with a
// velocity.
bool RunsStraight(const Profile& profile, double sense) {
  const Profile::Range velocity = profile.VelocityRange();
  const double backwards = sense > 0 ? -velocity.min : velocity.max;
  const double allowed = std::max(0.0, -sense * profile.start().velocity);
  return backwards <= allowed + 1e-9 * (1 + allowed);
}

// Plans to `target`, left with `speed` in this sense. If the axis is faster than its limit, the planner first brakes to
// the limit as hard as allowed, even if it runs backwards then: in that case the axis brakes gently, or, if it is too
// near for that, moves to the target at its present speed (`limited_by`).
Status PlanTo(Planner& planner, const KinematicState& from, double target, double sense, double speed,
              const Limits& limits, Plan& out) {
  const Status status = planner.ToPosition(from, target, sense * speed, limits, out.profile);
  const double fastest = sense * from.velocity + Gained(from, sense, limits.jerk);
  if (status.failed() || fastest <= limits.velocity || RunsStraight(out.profile, sense)) return status;
  Profile gently;
  Profile rest;
  if (planner.ToVelocity(from, sense * limits.velocity, limits, gently).ok() &&
      planner.ToPosition(gently.end(), target, sense * speed, limits, rest).ok() && gently.Append(rest) &&
      RunsStraight(gently, sense)) {
    out.profile = gently;
    return status;
  }
  Limits at_speed = limits;
  at_speed.velocity = fastest;
  Profile at_once;
  if (planner.ToPosition(from, target, sense * speed, at_speed, at_once).ok() && RunsStraight(at_once, sense)) {
    out.profile = at_once;
    out.limited_by = LimitedBy::kDistance;
  }
  return status;
}

// Plans to `target`, left with `speed` in the sense of travel: at the request's velocity first, then up to a higher
// `speed` so late that it is reached at the target.
bool PlanLeaving(Planner& planner, const KinematicState& from, double target, double sense, double speed,
                 const Limits& limits, Plan& out) {
  const double first = std::min(speed, limits.velocity);
  Profile ramp;
  if (speed > first) {
    Limits faster = limits;
    faster.velocity = speed;
    if (planner.ToVelocity({0, sense * first, 0}, sense * speed, faster, ramp).failed()) return false;
  }
  const double begin = target - ramp.end().position;
  Plan plan = out;
  if (PlanTo(planner, from, begin, sense, first, limits, plan).failed() || !RunsStraight(plan.profile, sense)) {
    return false;
  }
  if (speed > first) {
    ramp.Shift(begin);
    if (!plan.profile.Append(ramp)) return false;
    plan.profile.SnapEnd({target, sense * speed, 0});
  }
  out = plan;
  return true;
}

// Plans with the highest end speed up to `speed`; standstill at the end is always possible.
Status PlanBlended(Planner& planner, const KinematicState& from, double target, double sense, double speed,
                   const Limits& limits, Plan& out) {
  if (PlanLeaving(planner, from, target, sense, speed, limits, out)) return Status::Ok();
  out.limited_by = LimitedBy::kDistance;
  double low = 0;
  double high = std::min(speed, limits.velocity);
  const bool at_own_velocity = PlanLeaving(planner, from, target, sense, high, limits, out);
  if (at_own_velocity && speed <= high) return Status::Ok();
  if (at_own_velocity) {  // more than its own velocity, but not all that was asked for
    low = high;
    high = speed;
  }
  const Status standing = at_own_velocity ? Status::Ok() : PlanTo(planner, from, target, sense, 0, limits, out);
  for (int i = 0; i < kBlendBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (PlanLeaving(planner, from, target, sense, middle, limits, out) ? low : high) = middle;
  }
  return low > 0 ? Status::Ok() : standing;
}

// How a plan begins, from the ramps of the command alone to the axis' own. The axis' own ramps are used only as far as
// needed; the remainder keeps those of the command.
enum class Opening : std::uint8_t {
  kNone,  // with the ramps of the command
  kEase,  // the present acceleration ends with the axis' jerk
  kStop,  // the axis brakes to standstill with its own limits
};

Profile Open(const AxisParams& params, Planner& planner, const KinematicState& from, Opening opening) {
  const Limits own = params.planner_limits();
  Profile profile{from};
  if (opening == Opening::kEase) {
    // Without a jerk limit the acceleration may step to 0.
    if (own.jerk > 0) profile.Append(std::abs(from.acceleration) / own.jerk, -Sense(from.acceleration) * own.jerk);
    profile.SnapEnd({profile.end().position, profile.end().velocity, 0});
  } else if (opening == Opening::kStop) {
    planner.Stop(from, own, profile);
  }
  return profile;
}

// Plans to `speed`, and past the target at whatever speed is reached there. Returns false if the motion does not reach
// the target, or could not stop inside the SW limits from there.
bool PassAt(const AxisParams& params, Planner& planner, const KinematicState& from, double target, double sense,
            double speed, const Limits& limits, Profile& out) {
  if (sense * from.velocity < 0) return false;
  Limits ramps = limits;
  ramps.velocity = std::max(limits.velocity, speed);
  Profile whole;
  for (const Opening opening : {Opening::kNone, Opening::kEase}) {
    whole = Open(params, planner, from, opening);
    Profile ramp;
    if (planner.ToVelocity(whole.end(), sense * speed, ramps, ramp).failed() || !whole.Append(ramp)) return false;
    // Beyond the target, too: the motion continues there with its acceleration.
    if (Breaks(params, from, whole, {.position = false}) == LimitedBy::kNothing) break;
  }
  const double t = whole.TimeAt(target);
  const double left = sense * (target - whole.end().position);
  if (!std::isnan(t)) {
    whole.Cut(t);
  } else if (speed == 0 || !whole.Append(left / speed, 0)) {
    return false;
  }
  whole.SnapEnd({target, whole.end().velocity, whole.end().acceleration});
  const bool stops = Inside(params.limits, trajectory::StopPosition(whole.end(), params.planner_limits()));
  if (sense * whole.end().velocity <= 0 || !stops) return false;
  out = whole;
  return true;
}

// Passes the target with another speed than planned: with `speed` if possible, else braking.
bool PlanPast(const AxisParams& params, Planner& planner, const KinematicState& from, double target, double sense,
              double speed, const Limits& limits, Profile& out) {
  if (sense * from.velocity <= 0) return false;
  return PassAt(params, planner, from, target, sense, speed, limits, out) ||
         PassAt(params, planner, from, target, sense, 0, params.planner_limits(), out);
}

// Plans one motion with the following commands of the same limits, cut at the target. Returns false if there are none,
// or if the motion reverses.
bool PlanRun(Planner& planner, const KinematicState& from, double target, const Limits& limits, const LookAhead& ahead,
             Plan& out) {
  if (ahead.run_end == target) return false;
  Plan plan = out;
  const Status status = ahead.run_end_speed > 0
                            ? PlanBlended(planner, from, ahead.run_end, ahead.sense, ahead.run_end_speed, limits, plan)
                            : PlanTo(planner, from, ahead.run_end, ahead.sense, 0, limits, plan);
  if (status.failed() || !RunsStraight(plan.profile, ahead.sense)) return false;
  const double t = plan.profile.TimeAt(target);
  if (std::isnan(t)) return false;
  plan.profile.Cut(t);
  const KinematicState end = plan.profile.end();
  if (ahead.sense * end.velocity <= 0) return false;
  plan.profile.SnapEnd({target, end.velocity, end.acceleration});
  plan.limited_by =
      ahead.sense * end.velocity < ahead.asked - Rounding(ahead.asked) ? LimitedBy::kDistance : out.limited_by;
  out = plan;
  return true;
}

// Plans the motion of a request with its own limits; positions: to `out.target`.
Status PlanOn(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
              const Request& request, const LookAhead& ahead, Plan& out) {
  const Limits limits = request.limits();
  if (request.kind == RequestKind::kMoveVelocity) {
    Limits ramps = limits;
    ramps.velocity = params.limits.velocity;  // the request's own may be 0, which is no limit
    return planner.ToVelocity(from, SenseOf(request, around.last_sense) * request.velocity, ramps, out.profile);
  }
  if (!request.positions()) return planner.Stop(from, limits, out.profile);
  const double sense = Sense(out.target - from.position);
  double speed = 0;
  if (request.continuous()) {
    const double room = RoomToLimit(params.limits, out.target, sense);
    speed = room > 0 ? FastestWithin(request.end_velocity, 0, params.planner_limits(), room) : 0;
    if (speed < request.end_velocity) out.limited_by = LimitedBy::kPosition;
  } else if (ahead.blends && ahead.sense == sense) {
    if (PlanRun(planner, from, out.target, limits, ahead, out)) return Status::Ok();
    speed = ahead.speed;
    if (speed < ahead.asked - Rounding(ahead.asked)) out.limited_by = LimitedBy::kDistance;
  }
  // Too near for its end velocity, it passes its position at the nearest speed possible, and reaches the end velocity
  // beyond (AX-102).
  if (request.continuous() && speed > 0) {
    if (PlanLeaving(planner, from, out.target, sense, speed, limits, out)) return Status::Ok();
    if (PassAt(params, planner, from, out.target, sense, speed, limits, out.profile)) {
      out.limited_by = LimitedBy::kDistance;
      return Status::Ok();
    }
  }
  const Status status = speed > 0 ? PlanBlended(planner, from, out.target, sense, speed, limits, out)
                                  : PlanTo(planner, from, out.target, sense, 0, limits, out);
  if (around.passes && (status.failed() || !RunsStraight(out.profile, sense)) &&
      PlanPast(params, planner, from, out.target, sense, speed, limits, out.profile)) {
    return Status::Ok();
  }
  return status;
}

Demands DemandsOn(const Request& request) {
  const bool endless = request.kind == RequestKind::kMoveVelocity;
  return {.position = !endless, .straight = !endless && !request.positions()};
}

// Plans with the first opening that violates nothing; if each does, with the strongest.
Status PlanOpened(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
                  const Request& request, const LookAhead& ahead, Plan& out) {
  const bool endless = request.kind == RequestKind::kMoveVelocity;
  LimitedBy broken = LimitedBy::kNothing;
  for (const Opening opening : {Opening::kNone, Opening::kEase, Opening::kStop}) {
    if (opening == Opening::kStop && endless) break;
    Plan plan{.profile = {}, .target = out.target, .limited_by = broken};
    Profile whole = Open(params, planner, from, opening);
    const Status status = PlanOn(params, around, planner, whole.end(), request, ahead, plan);
    if (opening == Opening::kNone && status.failed()) return status;
    if (status.failed() || !whole.Append(plan.profile)) continue;
    plan.profile = whole;
    out = plan;
    broken = Breaks(params, from, whole, DemandsOn(request));
    if (broken == LimitedBy::kNothing) break;
  }
  return Status::Ok();
}

// Returns what the request must keep of the motion in progress.
OvershootGuard KeptFor(const PlanningContext& around, const KinematicState& from, const Request& request,
                       double target) {
  const double sense = SenseOfTravel(from);
  const bool stops = request.kind == RequestKind::kHalt || request.kind == RequestKind::kStop;
  const bool onwards =
      request.positions() ? sense * (target - from.position) >= 0 : SenseOf(request, around.last_sense) == int(sense);
  OvershootGuard kept;
  kept.straight = (around.again || around.committed || around.furthest) && onwards;
  if (around.committed && request.positions()) kept.furthest = target;
  const bool beyond = around.furthest && sense * (target - *around.furthest) > Rounding(target);
  if (around.furthest && (stops || (request.positions() && !beyond))) kept.furthest = around.furthest;
  return kept;
}

// Plans so that promised ends are kept: with the ramps of the request, or stronger ones.
Status PlanKept(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
                const Request& request, const LookAhead& ahead, const OvershootGuard& kept, Plan& out) {
  const Status status = PlanOpened(params, around, planner, from, request, ahead, out);
  if (status.failed() || !BreaksGuard(params, kept, out.profile)) return status;
  const Request stronger = WithStrongerRamps(params, from, request, kept);
  Plan plan{.profile = {}, .target = out.target};
  if (PlanOpened(params, around, planner, from, stronger, ahead, plan).failed()) return status;
  out = plan;
  out.limited_by = LimitedBy::kDistance;
  return status;
}

// Returns where the commands behind the one in control come to rest, if the motion in progress already continues
// towards it.
std::optional<double> PassingTo(const PlanningContext& around, const LookAhead& ahead) {
  return around.passes && ahead.blends ? ahead.stops_at : std::nullopt;
}

// Plans past the target so that the next move can still stop at its promised end.
void PlanPassing(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
                 const Request& request, const LookAhead& ahead, const OvershootGuard& kept, Plan& out) {
  const Request stronger = WithStrongerRamps(params, from, request, kept);
  Plan plan{.profile = {}, .target = out.target};
  if (PlanOpened(params, around, planner, from, stronger, ahead, plan).ok() &&
      StopsBy(plan.profile.end(), params.planner_limits(), *kept.furthest)) {
    out = plan;
  } else {
    const double sense = Sense(out.target - from.position);
    PlanPast(params, planner, from, out.target, sense, 0, stronger.limits(), out.profile);
  }
  out.limited_by = LimitedBy::kDistance;
}

// Plans a request that moves, and is already scaled.
Status PlanMoving(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
                  const Request& request, const LookAhead& ahead, Plan& out) {
  OvershootGuard kept = KeptFor(around, from, request, out.target);
  const Status status = PlanKept(params, around, planner, from, request, ahead, kept, out);
  kept.furthest = PassingTo(around, ahead);
  if (status.ok() && kept.furthest && !StopsBy(out.profile.end(), ahead.next, *kept.furthest)) {
    PlanPassing(params, around, planner, from, request, ahead, kept, out);
  }
  if (status.ok() && request.positions() && Overshoots(out.profile, out.target)) {
    out.limited_by = LimitedBy::kOvershoot;
  }
  return status;
}

// Plans to rest for a request that the override holds; past its target if the motion in progress continues beyond it.
Status PlanHeld(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
                const Request& request, const LookAhead& ahead, Plan& out) {
  const double sense = Sense(out.target - from.position);
  OvershootGuard kept = KeptFor(around, from, request, out.target);
  Request braking = request;
  if (around.passes) {
    OvershootGuard passing = kept;
    passing.furthest = PassingTo(around, ahead);
    braking = WithStrongerRamps(params, from, request, passing);
    out.limited_by = LimitedBy::kOverride;
    if (PlanPast(params, planner, from, out.target, sense, 0, braking.limits(), out.profile)) return Status::Ok();
  }
  braking.kind = RequestKind::kHalt;
  const Status status = PlanKept(params, around, planner, from, braking, {}, kept, out);
  const KinematicState end = out.profile.end();
  out.held = !request.positions() || std::abs(end.position - out.target) > 10 * Rounding(out.target);
  if (!out.held) out.profile.SnapEnd({out.target, end.velocity, end.acceleration});
  if (out.limited_by == LimitedBy::kNothing) out.limited_by = LimitedBy::kOverride;
  return status;
}

// Plans `request` and `queue` as commanded, before scaling; positions: to `out.target`.
Status PlanScaled(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
                  const Request& request, std::span<const Request> queue, Plan& out) {
  LimitedBy clamped = LimitedBy::kNothing;
  const Request scaled = Scaled(params, around.factors, request, clamped);
  const LookAhead ahead = LookAheadOf(params, around.factors, from, scaled, out.target, queue);
  // In a run of blended moves the axis may be too fast to come to rest at this target: it was promised to continue.
  PlanningContext now = around;
  now.passes |= ahead.blends && ahead.stops_at && !StopsBy(from, params.planner_limits(), out.target);
  if (Held(around.factors, request.kind)) return PlanHeld(params, now, planner, from, scaled, ahead, out);
  const Status status = PlanMoving(params, now, planner, from, scaled, ahead, out);
  if (out.limited_by == LimitedBy::kNothing) out.limited_by = clamped;
  return status;
}

// At rest at a SW limit, no motion further out is allowed.
Status CheckAtLimit(const AxisLimits& limits, const KinematicState& from, double velocity) {
  if (from.velocity != 0 || velocity == 0) return Status::Ok();
  const bool stuck = RoomToLimit(limits, from.position, Sense(velocity)) <= Rounding(from.position);
  return stuck ? Status::Failed(ErrorId::kTargetBehindLimit) : Status::Ok();
}

// A torque must push neither onto a limit switch that is on nor through a SW limit.
Status CheckTorque(const AxisParams& params, const PlanningContext& around, const KinematicState& from, double torque) {
  if (params.drive.mode == DriveMode::kAnalog) return Status::Failed(ErrorId::kState);  // takes no torque
  if ((around.limit_positive && torque > 0) || (around.limit_negative && torque < 0))
    return Status::Failed(ErrorId::kAwayFromLimitOnly);
  if ((around.bars_positive && torque > 0) || (around.bars_negative && torque < 0))
    return Status::Failed(ErrorId::kDirection);
  return CheckAtLimit(params.limits, from, torque);
}

double TargetOf(const AxisParams& params, const PlanningContext& around, const KinematicState& from,
                const Request& request) {
  if (request.kind == RequestKind::kMoveAdditive) return around.promised.value_or(from.position) + request.value;
  if (request.update && around.begin) return *around.begin + request.value;
  if (request.by_distance()) return from.position + request.value;
  const auto resolved = [&](const Limits& limits) {
    return ResolveTarget(params, from, limits, request.value, request.direction, around.last_sense);
  };
  const double at_its_best = resolved(params.planner_limits());
  if (around.committed) return at_its_best;
  const bool again = around.promised && std::abs(at_its_best - *around.promised) <= Rounding(at_its_best);
  return again ? *around.promised : resolved(request.limits());
}

// Resolves the target, if there is one, and rejects what can be rejected before planning.
Status Check(const AxisParams& params, const PlanningContext& around, const KinematicState& from,
             const Request& request, Plan& out) {
  if (request.kind == RequestKind::kMoveVelocity) {
    return CheckAtLimit(params.limits, from, SenseOf(request, around.last_sense) * request.velocity);
  }
  if (request.kind == RequestKind::kTorqueControl) return CheckTorque(params, around, from, request.value);
  if (!request.positions()) return Status::Ok();
  if (params.requires_reference && !around.homed && !request.by_distance())
    return Status::Failed(ErrorId::kNoReference);
  out.target = TargetOf(params, around, from, request);
  return Inside(params.limits, out.target) ? Status::Ok() : Status::Failed(ErrorId::kTargetBehindLimit);
}

}  // namespace

Status CheckSwitches(const PlanningContext& around, const KinematicState& from, const Profile& profile) noexcept {
  const Profile::Range velocity = profile.VelocityRange();
  const double up = std::max(velocity.max, profile.end().velocity);
  const double down = std::min(velocity.min, profile.end().velocity);
  const bool goes_up = up > std::max(0.0, from.velocity) + Rounding(0);
  const bool goes_down = down < std::min(0.0, from.velocity) - Rounding(0);
  if ((around.limit_positive && goes_up) || (around.limit_negative && goes_down))
    return Status::Failed(ErrorId::kAwayFromLimitOnly);
  if ((around.bars_positive && goes_up) || (around.bars_negative && goes_down))
    return Status::Failed(ErrorId::kDirection);
  return Status::Ok();
}

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

Status PlanRequest(const AxisParams& params, const PlanningContext& around, Planner& planner,
                   const KinematicState& from, const Request& request, std::span<const Request> queue,
                   Plan& out) noexcept {
  LimitedBy clamped = LimitedBy::kNothing;
  const Request scaled = Scaled(params, around.factors, request, clamped);
  Status status = Check(params, around, from, scaled, out);
  if (status.ok()) status = PlanScaled(params, around, planner, from, request, queue, out);
  const bool brakes = !request.positions() && request.kind != RequestKind::kMoveVelocity;
  if (status.failed() || brakes) return status;
  if (!out.held) return CheckSwitches(around, from, out.profile);
  Plan released{.profile = {}, .target = out.target};  // the motion after the hold must be allowed, too
  status = PlanMoving(params, around, planner, from, scaled, {}, released);
  return status.failed() ? status : CheckSwitches(around, from, released.profile);
}

Status Replan(const AxisParams& params, const PlanningContext& around, Planner& planner, const KinematicState& from,
              const Request& request, std::span<const Request> queue, Plan& out) noexcept {
  return PlanScaled(params, around, planner, from, request, queue, out);
}

Status PlanStop(const AxisParams& params, Planner& planner, const KinematicState& from, const Limits& limits,
                std::optional<double> furthest, Profile& out) noexcept {
  Request halt;
  halt.kind = RequestKind::kHalt;
  halt.velocity = limits.velocity;
  halt.acceleration = limits.acceleration;
  halt.deceleration = limits.deceleration;
  halt.jerk = limits.jerk;
  Plan plan;
  const Status status = PlanKept(params, {}, planner, from, halt, {}, {furthest}, plan);
  if (status.ok()) out = plan.profile;
  return status;
}

}  // namespace takt::axis
