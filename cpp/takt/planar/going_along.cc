#include "takt/planar/going_along.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/core/describe.h"
#include "takt/planar/send.h"
#include "takt/trajectory/chase.h"

namespace takt::planar {
namespace {

constexpr double kSamePlace = 1e-3;  // mm: of borders of tracks, counted in two ways
constexpr double kNear = 10;         // mm: so far ahead it looks at the least

// The extreme speed that is still reached from here when the acceleration ends.
double Peak(const KinematicState& x, double jerk) {
  return x.velocity + x.acceleration * std::abs(x.acceleration) / (2 * jerk);
}

Start StartOf(const Rider& r, const KinematicState& at, std::int8_t direction) {
  return {&r.route, at.position, direction, direction * at.velocity, direction * at.acceleration};
}

// Time at which a braking has come so far, in its direction.
double TimeAt(const Braking& braking, int direction, double from, double way) {
  double low = 0, high = braking.ends_s.back();
  for (int i = 0; i < 40; ++i) {
    const double t = 0.5 * (low + high);
    (direction * (braking.At(t).position - from) < way ? low : high) = t;
  }
  return high;
}

}  // namespace

KinematicState GoAlong(trajectory::Planner& planner, const Rider& r, const KinematicState& demand, double period_s,
                       bool& exact) noexcept {
  const trajectory::Limits own = LimitsNow(r);
  trajectory::ChaseState chase;
  KinematicState next = Chase({own, planner, own, period_s}, trajectory::ChaseMode::kPosition, r.at, demand, chase);
  exact = chase.in_step;
  const int sense = r.gear.was_in_step ? 0 : r.gear.sense;
  if (sense != 0 && (sense * next.velocity < 0 || sense * Peak(next, own.jerk) < -kTolerance)) {
    // It may only wait for the master.
    exact = false;
    trajectory::Profile stop{r.at};
    planner.ToVelocity(r.at, 0, own, stop);
    next = stop.At(period_s);
  }
  return next;
}

int RunsOut(const Network& network, const Rider& r, const KinematicState& at) noexcept {
  if (network[r.route.first()].closed) return 0;
  const Braking braking = Brake(at, r.pace.brakes());
  if (at.velocity < 0 && std::min(at.position, braking.lowest) < -kTolerance) return -1;
  double end = 0;
  for (const std::uint32_t track : r.route.all()) end += network[track].length;
  return std::max(at.position, braking.highest) > end + kTolerance ? 1 : 0;
}

bool KeepsToLimits(const Network& network, const Rider& r, const KinematicState& next,
                   const Braking& braking) noexcept {
  if (Rests(next)) return true;
  const Pace most = MostOf(r);
  const std::int8_t direction = next.velocity < 0 || (next.velocity == 0 && next.acceleration < 0) ? -1 : 1;
  const double ahead = braking.highest - next.position, behind = next.position - braking.lowest;
  const double until = direction > 0 ? ahead : behind, beyond = direction > 0 ? behind : ahead;
  // Where it goes back in the end it is slow: it must be slower than everywhere on the way.
  const double back = -direction * Peak(next, r.brakes.jerk);
  if (back > 0) {
    const auto reverse = static_cast<std::int8_t>(-direction);
    KinematicState turn = next;
    turn.position = direction > 0 ? braking.highest : braking.lowest;
    const Caps caps = CapsAhead(network, StartOf(r, turn, reverse), until + beyond, most);
    for (std::size_t k = 0; k < caps.count; ++k) {
      if (back > caps.of[k].speed) return false;
    }
  }
  const Caps caps = CapsAhead(network, StartOf(r, next, direction), until, most);
  const double fastest = std::max(direction * next.velocity, direction * Peak(next, r.brakes.jerk));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < caps.count; ++k) least = std::min(least, caps.of[k].speed);
  constexpr double kMore = 1 + 1e-8;
  if (fastest <= least * kMore) return true;
  // The speed rises until the acceleration is taken away, and then falls.
  const double peak = std::max(0.0, direction * next.acceleration / r.brakes.jerk);
  double begin = 0;
  for (std::size_t k = 0; k < caps.count; ++k) {
    const double end =
        k + 1 < caps.count ? TimeAt(braking, direction, next.position, caps.of[k + 1].way) : braking.ends_s.back();
    const double speed = direction * braking.At(std::clamp(peak, begin, std::max(begin, end))).velocity;
    if (speed > caps.of[k].speed * kMore) return false;
    begin = end;
  }
  return true;
}

bool CurvesAhead(const Network& network, const Rider& r) noexcept {
  const double speed = r.direction * r.at.velocity;
  const double until = 2 * WayToRest(speed, r.pace.brakes()) + kNear;
  const Caps caps = CapsAhead(network, StartOf(r, r.at, r.direction), until, r.pace);
  return std::any_of(caps.of.begin(), caps.of.begin() + static_cast<std::ptrdiff_t>(caps.count),
                     [&](const Cap& cap) { return cap.speed < r.pace.limits.velocity; });
}

bool RunsFree(const Network& network, const Rider& r, const KinematicState& step) noexcept {
  const double speed = std::max(r.direction * step.velocity, r.direction * Peak(step, r.pace.limits.jerk));
  if (speed > r.pace.limits.velocity) return false;
  const double until = 2 * WayToRest(speed, r.pace.brakes()) + kNear;
  if (r.direction * (EndOfWay(network, r) - step.position) < until) return false;
  const Caps caps = CapsAhead(network, StartOf(r, step, r.direction), until, r.pace);
  return std::all_of(caps.of.begin(), caps.of.begin() + static_cast<std::ptrdiff_t>(caps.count),
                     [&](const Cap& cap) { return cap.speed >= speed; });
}

bool MayTake(const Network& network, const Rider& r, const Route& route) noexcept {
  const double rest = Brake(r.at, r.brakes).rest;
  double end = 0;
  for (std::uint32_t i = 0; i < r.route.count && (i == 0 || end <= rest); ++i) {
    if (i >= route.count || route.tracks[i] != r.route.tracks[i]) return false;
    end += network[r.route.tracks[i]].length;
  }
  return true;
}

bool TakeMastersWay(const Network& network, const Rider& master, Rider& r) noexcept {
  if (network[r.route.first()].closed) return true;
  // Where the tracks of both routes begin, as this mover counts.
  std::uint32_t from_own = 0, from_masters = 0;
  double own = r.origin, its = master.origin + r.gear.apart;
  while (its < own - kSamePlace) {
    if (from_masters + 1 >= master.route.count) return true;  // it is ahead of all that the master is going to do
    its += network[master.route.tracks[from_masters++]].length;
  }
  while (own < its - kSamePlace) {
    if (from_own + 1 >= r.route.count) return false;
    own += network[r.route.tracks[from_own++]].length;
  }
  if (std::abs(own - its) > kSamePlace || r.route.tracks[from_own] != master.route.tracks[from_masters]) return false;
  Route route = r.route;
  route.count = from_own;
  for (std::uint32_t i = from_masters; i < master.route.count && route.count < kRouteTracks; ++i) {
    route.tracks[route.count++] = master.route.tracks[i];
  }
  std::fill(route.tracks.begin() + route.count, route.tracks.end(), 0U);
  if (route == r.route) return true;
  if (!MayTake(network, r, route)) return false;
  r.route = route;
  return true;
}

void describe(Enumeration<GearEnd>& e) {
  e.about("What else became of a mover that goes along with a master.");
  e.value(GearEnd::kNot, "not", "It goes along.");
  e.value(GearEnd::kWay, "way", "Its way ends where the master leads it.");
}

void describe(Description<Gear>& d) {
  using G = Gear;
  d.about("A mover that goes along with a master.");
  d.internal<&G::master>("Number of the mover that is the master; none: an axis.");
  d.internal<&G::offset>(unit::mm, "Own place minus the master's.");
  d.internal<&G::tolerance>(unit::mm, "Within which it counts as in step.");
  d.internal<&G::sense>("The only way it may go until it has been in step.");
  d.internal<&G::takes_masters_way>("Its route is the master's.");
  d.internal<&G::apart>(unit::mm, "The same place as this mover counts it minus as the master does.");
  d.internal<&G::was_in_step>("It has been in step.");
  d.internal<&G::in_step>("It is where it should be.");
  d.internal<&G::error>(unit::mm, "Own place minus where it should be.");
  d.internal<&G::end>("What else became of it.");
}

}  // namespace takt::planar
