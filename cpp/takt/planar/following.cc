#include "takt/planar/following.h"

#include <algorithm>
#include <cmath>

namespace takt::planar {
namespace {

// [mm] A mover stops this far before it would become active at a node.
constexpr double kBeforeNode = 1e-3;
// Share of the dynamics common to follower and leader that following uses: the rest covers the delay of a cycle.
constexpr double kReserve = 0.95;
// Largest time [s], and least number of cycles, in which a mover removes excess speed.
constexpr double kCalm = 0.1;
constexpr double kQuick = 5;
// [mm] A mover stops this much farther away than required, for rounding on the way.
constexpr double kShort = 1e-3;
// Share of the closing speed that could still be stopped.
constexpr double kClosing = 0.5;

// Returns the limits that following uses: those common to both, less a reserve.
Brakes Common(const Brakes& a, const Brakes& b) {
  return {kReserve * std::min(a.deceleration, b.deceleration), kReserve * std::min(a.jerk, b.jerk)};
}

// Returns the derivative [s] of the stopping distance with respect to the speed.
double SlopeOfStoppingDistance(double speed, const Brakes& b) {
  const double ramp = b.deceleration / b.jerk;
  return speed >= b.deceleration * ramp ? speed / b.deceleration + 0.5 * ramp : 1.5 * std::sqrt(speed / b.jerk);
}

// Returns the acceleration with which a mover follows a limit. With the distance R left it may have the speed v(R) from
// which it just comes to rest in it. If it keeps that speed, its stopping point keeps its distance from the limit; so a
// chain of movers propagates the stop of the first one, and each settles on the speed of the one ahead without
// oscillation.
double Follow(const Limit& limit, double speed, double period_s) {
  const Brakes& brakes = limit.brakes;
  const double allowed = SpeedForDistance(limit.room - kShort, brakes);
  const double slope = SlopeOfStoppingDistance(allowed, brakes);
  const double quick = kQuick * period_s;
  const double calm = std::clamp(slope, quick, kCalm);
  const double acceleration = (limit.rate - speed) / std::max(slope, quick) + (allowed - speed) / calm;
  if (acceleration <= 0) return acceleration;
  // An acceleration a has to be removed first, which takes more distance: speed * a / jerk, and for the speed gained
  // meanwhile slope * a² / (2 jerk).
  const double jerk = brakes.jerk * calm, linear = 1 + speed / (jerk * std::max(slope, quick));
  return jerk * (std::sqrt(linear * linear + 2 * acceleration / jerk) - linear);
}

}  // namespace

void LimitBy(const RightOfWay& w, std::uint32_t i, double speed, Limit& limit, double& least) noexcept {
  const Rider& r = w.rider(i);
  const Now& now = w.now(i);
  const int direction = r.direction;
  const Brakes own_brakes = WithShare(r.pace.brakes(), r.pace, r.share);
  // End of its own plan.
  const bool plans = r.aim == Aim::kTarget && r.planned && r.plan_ends;
  const double end = r.plan_from + direction * r.plan.end().position;
  const auto take = [&](const Limit& one) {
    // Before a stationary mover it comes to rest by its plan.
    const bool stands = one.by != kNobody && Rests(w.rider(one.by).at) && Rests(w.now(one.by).next);
    if (plans && stands && direction * (end - r.at.position) <= one.room + kTolerance) return;
    const double acceleration = Follow(one, speed, w.period_s());
    if (acceleration < least) {
      least = acceleration;
      limit = one;
    }
  };
  // An accelerating leader will stop farther ahead than its current speed implies; that distance is not available yet.
  // Behind an equally fast leader the gap suffices, and no faster mover comes nearer.
  const auto as_fast = [&](Limit one) {
    const Rider& before = w.rider(one.by);
    const double its_speed = direction * before.at.velocity;
    if (its_speed <= 0 || direction * before.at.acceleration <= 0) return;
    one.room += direction * (before.at.position - w.now(one.by).rest_before) + StoppingDistance(its_speed, one.brakes);
    one.rate = its_speed + SlopeOfStoppingDistance(its_speed, one.brakes) * direction * before.at.acceleration;
    take(one);
  };
  const auto behind = [&](std::uint32_t other, double apart, double gap) {
    const Rider& before = w.rider(other);
    const Now& its = w.now(other);
    Limit one;
    one.room = direction * (its.rest_before + apart - r.at.position) - gap;
    one.brakes = Common(own_brakes, before.brakes);
    one.by = other;
    const double its_speed = direction * before.at.velocity, its_acceleration = direction * before.at.acceleration;
    if (its_speed < 0) {
      one.rate = direction * (its.hard.rest - its.rest_before) / w.period_s();
      return one;
    }
    // From speed and acceleration; with the jerk the point would fluctuate, and all followers with it.
    one.rate = its_speed + SlopeOfStoppingDistance(its_speed, before.brakes) * its_acceleration;
    // Follow uses the speed alone. The distance that the follower saves because it already brakes is added, at most as
    // much as the leader saves by braking; otherwise the follower would brake harder than the leader.
    const double spared =
        StoppingDistance(its_speed, before.brakes) - direction * (its.rest_before - before.at.position);
    const double own = direction * r.at.acceleration;
    if (spared > 0 && own < 0 && its_acceleration < 0) {
      one.room +=
          std::clamp(StoppingDistance(speed, one.brakes) - Brake({0, speed, own}, one.brakes).rest, 0.0, spared);
    }
    return one;
  };
  if (now.leader != kNobody) {
    const Limit one = behind(now.leader, now.leader_offset, w.GapTo(i, now.leader, direction));
    take(one);
    as_fast(one);
  }
  if (direction < 0) {
    // Movers that come towards it across the start of its track.
    w.Followers(i, [&](std::uint32_t k, double offset) {
      if (w.rider(k).route.first() != r.route.first()) take(behind(k, -offset, std::max(r.gap, w.rider(k).gap)));
    });
  }
  const double reach = 2 * StoppingDistance(r.pace.limits.velocity, r.pace.brakes()) + r.gap;
  w.AlongNodes(r, r.at.position + reach, [&](const Passage& p) {
    const double way = direction * (p.offset - r.at.position);
    if (way > reach + std::max(p.range_before, p.range_behind)) return;
    bool active = false;
    const auto counts = [&](const Meeting& m) {
      active = w.IsActive(r.zone, m.off, now.next, now.braking, p);
      // If active: the other is behind. If not: the node is behind.
      if (active ? direction * m.place < 0 : way < 0) return false;
      return w.IsActive(m);
    };
    w.MeetAt(i, p, counts, [&](const Meeting& m) {
      const Now& its = w.now(m.other);
      const double zone = std::max(r.zone, direction > 0 ? p.range_before : p.range_behind) + m.off;
      const double distance = direction * m.place;
      // `free`: distance available whatever the other does.
      const auto keep = [&](double gap, double free) {
        if (gap == 0) return;
        Limit one = behind(m.other, m.apart, gap);
        if (distance < 0) {
          // The other is behind and must have room to stop there.
          const double rest = direction * (r.at.position - its.rest_before - m.apart);
          if (rest >= gap - kTolerance) return;
          one.room = -kInfinite;
        }
        const bool is_free = free > one.room;
        if (is_free) {
          one.room = free;
          one.rate = 0;
          one.brakes = Common(own_brakes, own_brakes);
        }
        take(one);
        if (active && distance > 0 && !is_free) as_fast(one);
      };
      const bool past = m.ahead ? r.at.position > p.offset : its.braking.highest + m.apart > p.offset;
      keep(past ? std::max(m.gap, m.split) : m.gap, active ? -kInfinite : way - zone - kBeforeNode);
      if (direction > 0 && m.ahead && !past) keep(m.split, way - kBeforeNode);
    });
  });
}

bool IsNoFasterThanLeader(const RightOfWay& w, std::uint32_t i, const KinematicState& wish,
                          const Limit& limit) noexcept {
  const Rider& r = w.rider(i);
  if (limit.by == kNobody || limit.by != w.now(i).leader) return false;
  const Rider& before = w.rider(limit.by);
  const KinematicState& other = w.now(limit.by).next;
  const Brakes own = BrakesOf(r);
  return own.deceleration >= before.brakes.deceleration && own.jerk >= before.brakes.jerk &&
         r.direction * (wish.velocity - other.velocity) <= 1e-9 &&
         r.direction * (wish.acceleration - other.acceleration) <= 1e-6;
}

double ApproachAcceleration(const Rider& r, double room, const KinematicState& there, const Brakes& brakes,
                            double period_s) noexcept {
  const double speed = r.direction * r.at.velocity, its_speed = r.direction * there.velocity;
  const double slope = std::max(SlopeOfStoppingDistance(std::max({0.0, speed, its_speed}), brakes), kQuick * period_s);
  const double closing = kClosing / slope, faster = speed - its_speed;
  return r.direction * there.acceleration - closing * faster + (closing * room - faster) / std::min(slope, kCalm);
}

double CloseGapAcceleration(const RightOfWay& w, std::uint32_t i, const Limit& limit) noexcept {
  const Rider& r = w.rider(i);
  if (limit.by == kNobody || limit.by != w.now(i).leader) return -kInfinite;
  const Rider& before = w.rider(limit.by);
  const Brakes own = BrakesOf(r);
  if (own.deceleration < before.brakes.deceleration || own.jerk < before.brakes.jerk) return -kInfinite;
  const double room = r.direction * (before.at.position + w.now(i).leader_offset - r.at.position) - r.gap;
  if (room < 0 || r.direction * before.at.velocity < 0) return -kInfinite;
  return ApproachAcceleration(r, room, {0, before.at.velocity, w.now(limit.by).next.acceleration}, r.brakes,
                              w.period_s());
}

}  // namespace takt::planar
