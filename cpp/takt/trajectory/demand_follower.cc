#include "takt/trajectory/demand_follower.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::trajectory {

namespace {

constexpr double kTolerance = 1e-9;  // share of a limit
// Less margin than this share of the axis' own limits counts as none: a chase would take forever.
constexpr double kLeastRoom = 0.02;

// Returns the extreme velocity that is still reached if the acceleration is reduced to 0 with this jerk from here on.
double Peak(const KinematicState& x, double jerk) {
  return jerk > 0 ? x.velocity + x.acceleration * std::abs(x.acceleration) / (2 * jerk) : x.velocity;
}

bool KeepsVelocity(const KinematicState& x, const Limits& own) {
  const double limit = own.velocity * (1 + kTolerance);
  return std::abs(x.velocity) <= limit && std::abs(Peak(x, own.jerk)) <= limit;
}

bool KeepsAcceleration(const KinematicState& before, const KinematicState& x, const Limits& own) {
  const bool growing = x.velocity * x.acceleration > 0;
  const double limit = growing ? own.acceleration : own.deceleration;
  const double allowed = std::max(limit, x.acceleration * before.acceleration > 0 ? std::abs(before.acceleration) : 0);
  return std::abs(x.acceleration) <= allowed * (1 + kTolerance);
}

// Braking harder than the axis may speed up has to be eased before standstill.
bool KeepsReversal(const KinematicState& x, const Limits& own) {
  const double strongest = own.acceleration * (1 + kTolerance);
  const double excess = x.acceleration * x.acceleration - strongest * strongest;
  if (excess <= 0) return true;
  return x.velocity * x.acceleration < 0 && 2 * own.jerk * std::abs(x.velocity) >= (own.jerk > 0 ? excess : 0);
}

// Returns true if a motion within the axis' jerk leads from `before` to `x` in `t` seconds. Between two samples with
// given accelerations the velocity can differ from the linear one by the area of a triangle of jerks, the position by
// less than jerk t^3 / 16; from the mean velocity's distance it never differs by more than jerk t^3 / 12.
bool Continues(const KinematicState& before, const KinematicState& x, const Limits& own, double t) {
  if (own.jerk == 0) {
    const double mean = (x.velocity - before.velocity) / t;
    const double largest = std::max(own.acceleration, own.deceleration) * (1 + kTolerance);
    const double position = before.position + 0.5 * t * (before.velocity + x.velocity);
    return std::abs(mean) <= largest && std::abs(x.position - position) <= 0.25 * largest * t * t;
  }
  const double step = x.acceleration - before.acceleration;
  const double largest = own.jerk * t * (1 + 1e-6);
  if (std::abs(step) > largest) return false;
  const double velocity = before.velocity + 0.5 * t * (before.acceleration + x.acceleration);
  const double bend = 0.25 * (largest * largest - step * step) / own.jerk + kTolerance * own.velocity;
  if (std::abs(x.velocity - velocity) > bend) return false;
  const double away = x.position - before.position - 0.5 * t * (before.velocity + x.velocity);
  const double expected = t * t / 12 * (before.acceleration - x.acceleration);
  const double cube = own.jerk * t * t * t;
  const double rounding = kTolerance * (own.velocity * t + std::abs(x.position) * 1e-3);
  return std::abs(away) <= cube / 12 + rounding && std::abs(away - expected) <= cube / 16 + rounding;
}

// Ramps towards a velocity with the axis' own limits: keeps the invariant from any state that satisfies it.
KinematicState TowardsVelocity(const DemandFollower& c, const KinematicState& before, double velocity) {
  const Limits& own = c.own;
  Profile profile{before};
  c.planner.ToVelocity(before, std::clamp(velocity, -own.velocity, own.velocity), own, profile);
  return profile.At(c.period_s);
}

// Returns the bounds by sign of the acceleration while the speed keeps the direction of `velocity`; 0: it may reverse.
Bounds BoundsInSense(double velocity, const Limits& limits) {
  const double weaker = std::min(limits.acceleration, limits.deceleration);
  if (velocity == 0) return {weaker, weaker, limits.jerk};
  return velocity > 0 ? Bounds{limits.acceleration, limits.deceleration, limits.jerk}
                      : Bounds{limits.deceleration, limits.acceleration, limits.jerk};
}

// Returns the state a cycle earlier from which the demand arrives at its present state with its present acceleration.
KinematicState CycleBefore(const KinematicState& demand, double t) {
  return {demand.position - t * (demand.velocity - 0.5 * t * demand.acceleration),
          demand.velocity - t * demand.acceleration, demand.acceleration};
}

// One cycle of the chase in the frame of the demand, with the ramps of an axis that moves in the direction `sense`.
// Returns false if the limits leave no margin, or no plan is found.
bool InFrame(const DemandFollower& c, DemandMode mode, const KinematicState& before, const KinematicState& demand,
             double sense, KinematicState& next, bool& arrives) {
  const Limits& own = c.own;
  const double t = c.period_s;
  const KinematicState begin = CycleBefore(demand, t);
  const double speed = std::max(std::abs(begin.velocity), std::abs(demand.velocity));
  const double fastest = c.catching_up.velocity > speed ? c.catching_up.velocity : own.velocity;
  const double used = std::abs(demand.acceleration);
  Bounds room = BoundsInSense(sense, c.catching_up);
  room.up -= used;
  room.down -= used;
  if (!(std::min(room.up, room.down) > kLeastRoom * std::min(own.acceleration, own.deceleration))) return false;
  if (mode == DemandMode::kPosition && !(fastest - speed > kLeastRoom * own.velocity)) return false;
  const KinematicState from = {before.position - begin.position, before.velocity - begin.velocity,
                               before.acceleration - begin.acceleration};
  Profile profile{from};
  const Status status = mode == DemandMode::kPosition ? c.planner.ToPosition(from, 0, fastest - speed, room, profile)
                                                      : c.planner.ToVelocity(from, 0, room, profile);
  if (status.failed()) return false;
  const KinematicState relative = profile.At(t);
  next = {demand.position + relative.position, demand.velocity + relative.velocity,
          demand.acceleration + relative.acceleration};
  arrives = profile.duration() <= t;
  return true;
}

bool Sound(const KinematicState& x) {
  return std::isfinite(x.position + x.velocity + x.acceleration);
}

}  // namespace

KinematicState FollowDemand(const DemandFollower& c, DemandMode mode, const KinematicState& before,
                            const KinematicState& demand, DemandFollowerState& state) noexcept {
  const Limits& own = c.own;
  const auto keeps = [&](const KinematicState& x) {
    return KeepsVelocity(x, own) && KeepsAcceleration(before, x, own) && KeepsReversal(x, own) &&
           Continues(before, x, own, c.period_s);
  };
  const bool was_in_step = state.in_step;
  state.in_step = false;
  if (!Sound(demand)) return TowardsVelocity(c, before, 0);
  KinematicState wanted = demand;
  if (mode == DemandMode::kVelocity) wanted.position += state.offset;
  if ((mode == DemandMode::kPosition || was_in_step) && keeps(wanted)) {
    state.in_step = true;
    return wanted;
  }
  KinematicState next;
  bool arrives = false;
  const auto chases = [&](double sense) {
    return InFrame(c, mode, before, demand, sense, next, arrives) && KeepsVelocity(next, own) &&
           KeepsAcceleration(before, next, own) && KeepsReversal(next, own);
  };
  double sense = demand.velocity * before.velocity < 0 ? 0 : demand.velocity + before.velocity;
  if (demand.velocity == 0 && before.velocity == 0) sense = demand.position - before.position;
  if (!(sense != 0 && chases(sense)) && !chases(0)) return TowardsVelocity(c, before, demand.velocity);
  if (arrives) {  // in step; in velocity mode with an offset
    if (mode == DemandMode::kVelocity) state.offset = next.position - demand.position;
    state.in_step = true;
  }
  return next;
}

LimitedBy Beyond(const Limits& own, const KinematicState& demand, bool in_step) noexcept {
  const double left = in_step ? 0 : kLeastRoom * own.velocity;
  if (std::abs(demand.velocity) > own.velocity - left) return LimitedBy::kVelocity;
  const double ramp = demand.velocity * demand.acceleration > 0 ? own.acceleration : own.deceleration;
  return std::abs(demand.acceleration) > ramp ? LimitedBy::kAcceleration : LimitedBy::kNothing;
}

void describe(Description<DemandFollowerState>& d) {
  d.about("State of following a demand.");
  d.internal<&DemandFollowerState::offset>(unit::u, "Own position minus that of the demand, in velocity mode.");
  d.internal<&DemandFollowerState::in_step>("The last set point was the demand itself.");
}

}  // namespace takt::trajectory
