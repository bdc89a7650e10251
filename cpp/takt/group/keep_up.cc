#include "takt/group/keep_up.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/core/maths.h"
#include "takt/group/carrier_bindings.h"
#include "takt/group/clutch.h"
#include "takt/group/make_stretch.h"
#include "takt/group/sync.h"

namespace takt::group {

namespace {

using trajectory::PathCoordinateValues;

// Shares of the axes' limits; the rest is a reserve for changes until the tool is there. The larger one where only
// carriers are a little faster or slower than planned.
constexpr double kMostWhenLate = 0.7, kNearlyAll = 0.9;
constexpr double kLeast = 0.02;        // of the path speed: the motion goes on, however slowly
constexpr double kBrakeShare = 0.7;    // of what the axes have left; the rest is for getting there
constexpr double kLeastBrake = 0.03;   // of the path's own deceleration
constexpr double kLeastSpeed = 1;      // [mm/s] for difference quotients
constexpr double kSameSpeed = 0.05;    // relative change of a carrier's velocity that is ignored
constexpr double kJerkOver_s = 0.004;  // time over which the jerk is measured as a change of acceleration
constexpr double kFurthest_s = 1;

bool HasChanged(const Context& c, std::uint64_t number) {
  const CarrierBinding& ride = c.ahead.rides[number % kRides];
  return std::abs(SpeedOf(c, ride.cargo) - ride.speed) > kSameSpeed * std::abs(ride.speed);
}

bool IsLate(const Context& c, const State& s) {
  return s.velocity_factor < 1 || WaitsForClutch(s) || Follows(c, s);
}

bool CarriersHaveChanged(const Context& c, const State& s) {
  const Stretch* here = c.ahead.At(s.pace.raw.position);
  return here && (HasChanged(c, here->from_ride) || HasChanged(c, here->to_ride));
}

// Returns the arc length at which the tool has changed over to its next carrier binding, or at which the sampled path
// ends; 0 if nothing carries it.
double EndOf(const Context& c, const State& s) {
  const LookAhead& ahead = c.ahead;
  double end = 0;
  for (std::uint64_t i = ahead.first; i < ahead.end(); ++i) {
    const Stretch& stretch = ahead[i];
    if (stretch.end() <= s.pace.raw.position || !stretch.begun || !IsCarried(ahead, stretch)) continue;
    end = stretch.end();
    const double over = ahead.rides[stretch.to_ride % kRides].end;
    if (stretch.from_ride != stretch.to_ride && over > s.pace.raw.position) return over;
  }
  return end;
}

bool Begin(const Context& c, const State& s) {
  const double end = EndOf(c, s);
  if (end <= s.pace.raw.position) return false;
  CarriedSpeedBound& k = c.ahead.keep_up;
  k = {.on = true, .begin = s.pace.raw.position, .apart = (end - s.pace.raw.position) / (kPointsAhead - 1)};
  const double none = std::numeric_limits<double>::infinity();
  k.places.fill({none, none, none});
  return true;
}

// Returns the largest v up to which |a + b v + c v²| stays within a limit that it keeps at rest.
double UpTo(double a, double b, double c, double limit) {
  double least = std::numeric_limits<double>::infinity();
  for (const double side : {-limit, limit}) {
    const double rest = a - side;
    if (c == 0) {
      if (b != 0 && -rest / b > 0) least = std::min(least, -rest / b);
      continue;
    }
    const double square = b * b - 4 * c * rest;
    if (square < 0) continue;
    const double q = -0.5 * (b + std::copysign(std::sqrt(square), b));
    for (const double v : {q / c, q != 0 ? rest / q : 0}) {
      if (v > 0) least = std::min(least, v);
    }
  }
  return least;
}

// Returns the earliest time in which the mean of the motion can reach `place` [s].
double TimeTo(const State& s, double place, double acceleration, double wish) {
  const double way = std::max(0.0, place - s.pace.now.position);
  const double v = s.pace.now.velocity;
  double time = acceleration > 0 ? (std::sqrt(v * v + 2 * acceleration * way) - v) / acceleration : kFurthest_s;
  if (wish < trajectory::kFullSpeed && wish > 0) time = std::max(time, way / std::max(wish, v));
  return std::min(time, kFurthest_s);
}

// Computes the largest speed in the next cycle that can still be reduced to `later` over the distance left. A raw
// motion that has accelerated can brake only when that acceleration has left the mean: it accelerates only as far as it
// could hold the speed for that time.
struct Brakes {
  double v = 0;
  double deceleration = 0;
  double build_up_s = 0;
  double period_s = 0;

  double After(double left, double later, double hold_s) const {
    const double linear = deceleration * (0.5 * period_s + hold_s);
    const double room = 2 * deceleration * (left - 0.5 * v * period_s) + later * later;
    return room > 0 ? std::sqrt(linear * linear + room) - linear : 0;
  }
  double Before(double left, double later) const {
    return std::max(std::min(v, After(left, later, 0)), After(left, later, build_up_s));
  }
};

void LookAt(const Context& c, const State& s, double place, double wish, CarriedSpeedBound::Place& seen) {
  const trajectory::PathNode& node = c.ahead.window[s.pace.node];
  const trajectory::CoordinateLimits& limits = c.ahead.window.limits();
  const double own = node.bounds.Gentle(s.pace.raw.velocity * s.pace.raw.velocity);
  const double time = TimeTo(s, place, own, wish);
  const double u = std::max(kLeastSpeed, std::min(node.at.limits.velocity, std::sqrt(node.own)));
  const double of_limits = c.ahead.keep_up.share;
  PathCoordinateValues near, after, velocity, slope, at_rest, by_way, bend;
  near.fill(std::numeric_limits<double>::quiet_NaN());
  const double none = std::numeric_limits<double>::infinity();
  seen = {none, none, none};
  if (!Foresee(c, s, {place, 0, 0}, time, near, velocity, at_rest)) return;
  after = near;
  if (!Foresee(c, s, {place, u, 0}, time, after, slope, by_way)) return;
  if (!Foresee(c, s, {place, -u, 0}, time, after, bend, bend)) return;
  // q_t + q_s v, and q_tt + 2 q_st v + q_ss v².
  for (std::size_t k = 0; k < limits.count; ++k) {
    const trajectory::CoordinateLimits::One& of = limits.of[k];
    slope[k] = (slope[k] - velocity[k]) / u;
    const double plus = by_way[k] - at_rest[k], minus = bend[k] - at_rest[k];
    by_way[k] = (plus - minus) / (2 * u);
    bend[k] = (plus + minus) / (2 * u * u);
    // No path speed can compensate for what carriers demand by themselves.
    if (slope[k] != 0 && std::abs(velocity[k]) < of.velocity) {
      const double toward = std::copysign(velocity[k], velocity[k] * slope[k]);
      seen.velocity = std::min(seen.velocity, (of.velocity - toward) / std::abs(slope[k]));
    }
    const double most = of_limits * of.acceleration;
    if (std::abs(at_rest[k]) < most)
      seen.velocity = std::min(seen.velocity, UpTo(at_rest[k], by_way[k], bend[k], most));
  }
  const double most = std::clamp(seen.velocity, kLeast * u, 4 * u);
  // The jerk grows at most with the third power of the speed.
  PathCoordinateValues later;
  const bool known = Foresee(c, s, {place + most * kJerkOver_s, most, 0}, time + kJerkOver_s, after, later, later);
  double share = 1;
  for (std::size_t k = 0; known && k < limits.count; ++k) {
    const double now = at_rest[k] + most * (by_way[k] + most * bend[k]);
    const double jerk = std::abs(later[k] - now) / kJerkOver_s;
    const double allowed = of_limits * limits.of[k].jerk;
    if (jerk > allowed) share = std::min(share, maths::Cbrt(allowed / jerk));
  }
  seen.velocity = std::max(share * most, kLeast * u);
  for (std::size_t k = 0; k < limits.count; ++k) {
    if (slope[k] == 0) continue;
    const trajectory::CoordinateLimits::One& of = limits.of[k];
    const double v = std::min(seen.velocity, u);
    const double left = of.acceleration - std::abs(at_rest[k] + v * (by_way[k] + v * bend[k]));
    seen.acceleration = std::min(seen.acceleration, left / std::abs(slope[k]));
    seen.change = std::min(seen.change, of_limits * of.jerk * node.build_up_s / std::abs(slope[k]));
  }
  seen.acceleration = std::max(std::min(seen.acceleration, seen.change), kLeastBrake * own);
}

}  // namespace

double SlowDown(const Context& c, const State& s, double wish) noexcept {
  CarriedSpeedBound& k = c.ahead.keep_up;
  const KinematicState& raw = s.pace.raw;
  const bool late = IsLate(c, s);
  if (k.on && raw.position >= k.begin + k.apart * (kPointsAhead - 1)) {
    // A blend may have made the transition longer.
    const Stretch* here = c.ahead.At(raw.position);
    if (!here || here->from_ride == here->to_ride || !Begin(c, s)) k = {};
  }
  if (!k.on && ((!late && !CarriersHaveChanged(c, s)) || !Begin(c, s))) return wish;
  k.share = late ? kMostWhenLate : std::min(k.share, kNearlyAll);
  const trajectory::PathNode& node = c.ahead.window[s.pace.node];
  const double period = c.cycle.period_s;
  const double square = raw.velocity * raw.velocity;
  const double brake = std::min(node.bounds.deceleration, node.bounds.strength.Gentle(square));
  // The mean lags behind the raw motion by this distance, and averages speeds on both sides.
  const double lag = 0.5 * raw.velocity * s.pace.cycles * period;
  const double seen_to = raw.position + lag + square / brake + raw.velocity * node.build_up_s;
  const auto index = [&](double place) {
    return static_cast<std::uint32_t>(std::clamp(std::floor((place - k.begin) / k.apart), 0.0, kPointsAhead - 1.0));
  };
  const std::uint32_t first = index(raw.position - lag),
                      last = std::min<std::uint32_t>(index(seen_to) + 1, kPointsAhead - 1);
  if (k.next < first || k.next > last) k.next = first;
  LookAt(c, s, std::max(k.begin + k.next * k.apart, raw.position), wish, k.places[k.next]);
  ++k.next;
  double gentle = trajectory::kFullSpeed, change = gentle;
  for (std::uint32_t i = first; i <= last; ++i) {
    gentle = std::min(gentle, k.places[i].acceleration);
    change = std::min(change, k.places[i].change);
  }
  k.brake = gentle;
  const Brakes brakes = {raw.velocity, kBrakeShare * std::min(brake, gentle), node.build_up_s, period};
  double most = wish;
  const trajectory::PathWindow& window = c.ahead.window;
  for (std::uint64_t i = s.pace.node; i + 1 < window.known() && !window[i].stop && window[i].at.s < seen_to; ++i) {
    const trajectory::PathNode& next = window[i + 1];
    most = std::min(most, brakes.Before(std::max(0.0, next.at.s - raw.position), std::sqrt(next.ceiling)));
  }
  for (std::uint32_t i = first; i <= last; ++i) {
    const double left = std::max(0.0, k.begin + i * k.apart - raw.position - lag);
    most = std::min(most, brakes.Before(left, k.places[i].velocity));
  }
  // Relative to the acceleration that leaves the mean in this cycle.
  const double before = s.pace.last[s.pace.oldest].acceleration;
  const double least = std::min(std::max(-gentle, before - change), gentle);
  const double greatest = std::max(std::min(gentle, before + change), -gentle);
  return std::max(0.0, std::clamp(most, raw.velocity + least * period, raw.velocity + greatest * period));
}

}  // namespace takt::group
