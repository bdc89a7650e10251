#include "takt/planar/going_along.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "takt/core/describe.h"
#include "takt/planar/send.h"
#include "takt/trajectory/demand_follower.h"

namespace takt::planar {
namespace {

constexpr double kSamePlace = 1e-3;  // [mm] tolerance of track borders that are counted in two ways
constexpr double kNear = 10;         // [mm] least preview distance

// Returns the extreme velocity if the acceleration is removed from here with this jerk.
double Peak(const KinematicState& x, double jerk) {
  return x.velocity + x.acceleration * std::abs(x.acceleration) / (2 * jerk);
}

Start StartOf(const Rider& r, const KinematicState& at, std::int8_t direction) {
  return {&r.route, at.position, direction, direction * at.velocity, direction * at.acceleration};
}

// Returns the time [s] at which a braking has covered `way` in its direction.
double TimeAt(const Braking& braking, int direction, double from, double way) {
  double low = 0, high = braking.ends_s.back();
  for (int i = 0; i < 40; ++i) {
    const double t = 0.5 * (low + high);
    (direction * (braking.At(t).position - from) < way ? low : high) = t;
  }
  return high;
}

// A step and the braking after it.
struct Stretch {
  trajectory::Piece piece;
  double duration = 0;  // [s]
};
struct Stretches {
  std::array<Stretch, 4> of;
  std::size_t count = 0;

  void Add(const trajectory::Piece& piece, double duration) {
    if (duration > 0) of[count++] = {piece, duration};
  }
  std::span<const Stretch> all() const { return {of.data(), count}; }
};

// Returns the largest values between two times of a piece. Where the acceleration passes 0 the speed may exceed that at
// both ends.
Stress StressOf(const trajectory::Piece& piece, double from, double to) {
  Stress most{0, 0, std::abs(piece.jerk)};
  const double top = piece.jerk != 0 ? -piece.acceleration / piece.jerk : from;
  for (const double t : {from, std::clamp(top, from, to), to}) {
    const KinematicState at = piece.At(t);
    most.speed = std::max(most.speed, std::abs(at.velocity));
    most.acceleration = std::max(most.acceleration, std::abs(at.acceleration));
  }
  return most;
}

// Returns the time [s] at which a stretch without reversal reaches a position.
template <typename Way>
double TimeOn(const Stretch& stretch, const Way& way, double place) {
  double low = 0, high = stretch.duration;
  if (place <= way(low)) return low;
  if (place >= way(high)) return high;
  for (int i = 0; i < 24; ++i) {
    const double t = 0.5 * (low + high);
    (way(t) < place ? low : high) = t;
  }
  return high;
}

}  // namespace

KinematicState FollowDemandAlone(trajectory::Planner& planner, const Rider& r, const KinematicState& demand,
                                 double period_s, bool& exact) noexcept {
  const trajectory::Limits own = LimitsNow(r);
  trajectory::DemandFollowerState chase;
  KinematicState next =
      FollowDemand({own, planner, own, period_s}, trajectory::DemandMode::kPosition, r.at, demand, chase);
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

int LeavesRoute(const Network& network, const Rider& r, const KinematicState& at) noexcept {
  if (network[r.route.first()].closed) return 0;
  const Braking braking = Brake(at, r.pace.brakes());
  if (at.velocity < 0 && std::min(at.position, braking.lowest) < -kTolerance) return -1;
  double end = 0;
  for (const std::uint32_t track : r.route.all()) end += network[track].length;
  return std::max(at.position, braking.highest) > end + kTolerance ? 1 : 0;
}

bool KeepsToLimits(const Network& network, const Rider& r, const KinematicState& next, const Braking& braking,
                   double jerk) noexcept {
  if (Rests(next)) return true;
  const Pace most = MostOf(r);
  const std::int8_t direction = next.velocity < 0 || (next.velocity == 0 && next.acceleration < 0) ? -1 : 1;
  const double ahead = braking.highest - next.position, behind = next.position - braking.lowest;
  const double until = direction > 0 ? ahead : behind, beyond = direction > 0 ? behind : ahead;
  // If it reverses at the end, it is slow then: that speed must keep all caps on the way back.
  const double back = -direction * Peak(next, jerk);
  if (back > 0) {
    const auto reverse = static_cast<std::int8_t>(-direction);
    KinematicState turn = next;
    turn.position = direction > 0 ? braking.highest : braking.lowest;
    const Caps caps = CapsAhead(network, StartOf(r, turn, reverse), until + beyond, most);
    for (std::size_t k = 0; k < caps.count; ++k) {
      if (back > caps.of[k].speed) return false;
    }
  }
  const Start start = StartOf(r, next, direction);
  const double fastest = std::max(direction * next.velocity, direction * Peak(next, jerk));
  constexpr double kMore = 1 + 1e-8;
  if (fastest <= most.limits.velocity * kMore && IsStraight(network, start, until)) return true;
  const Caps caps = CapsAhead(network, start, until, most);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < caps.count; ++k) least = std::min(least, caps.of[k].speed);
  if (fastest <= least * kMore) return true;
  // The speed rises until the acceleration is removed, and then falls.
  const double peak = std::max(0.0, direction * next.acceleration / jerk);
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

bool KeepsToVectors(const Network& network, const Rider& r, const KinematicState& next, const Braking& braking,
                    double period_s) noexcept {
  if (!std::isfinite(r.pace.vector_jerk) || (Rests(r.at) && Rests(next))) return true;
  const Pace most = MostOf(r);
  const std::int8_t direction = next.velocity < 0 || (next.velocity == 0 && next.acceleration < 0) ? -1 : 1;
  const double lowest = std::min(r.at.position, braking.lowest), highest = std::max(r.at.position, braking.highest);
  KinematicState from = r.at;
  from.position = direction > 0 ? lowest : highest;
  const Start start = StartOf(r, from, direction);
  if (IsStraight(network, start, highest - lowest)) return true;
  const Caps caps = CapsAhead(network, start, highest - lowest, most);
  Bend tightest;
  for (const Cap& cap : caps.all()) {
    tightest = {0, std::max(tightest.curvature, cap.curvature), std::max(tightest.rate, cap.rate)};
  }
  if (!(tightest.curvature > 0)) return true;
  // This step, then the braking. The step's jerk is its mean, as the set points show it.
  Stretches all;
  all.Add({r.at.position, r.at.velocity, r.at.acceleration, (next.acceleration - r.at.acceleration) / period_s},
          period_s);
  double begin = 0;
  for (std::size_t i = 0; i < braking.pieces.size(); ++i) {
    all.Add(braking.pieces[i], braking.ends_s[i] - begin);
    begin = std::max(begin, braking.ends_s[i]);
  }
  for (const Stretch& stretch : all.all()) {
    const Stress whole = StressOf(stretch.piece, 0, stretch.duration);
    if (KeepsVectors(tightest, whole, most)) continue;
    const auto way = [&](double t) { return direction * (stretch.piece.At(t).position - from.position); };
    const double at = way(0), to = way(stretch.duration);
    for (std::size_t k = 0; k < caps.count; ++k) {
      const double enters = caps.of[k].way, leaves = k + 1 < caps.count ? caps.of[k + 1].way : kInfinite;
      if (leaves < std::min(at, to) || enters > std::max(at, to)) continue;
      if (KeepsVectors(caps.of[k].bend(), whole, most)) continue;
      // If it reverses it may be in a bend more than once: the whole stretch counts.
      const bool one_way = stretch.piece.velocity * stretch.piece.At(stretch.duration).velocity >= 0 && at <= to;
      const double first = one_way ? TimeOn(stretch, way, enters) : 0;
      const double last = one_way ? TimeOn(stretch, way, leaves) : stretch.duration;
      if (!KeepsVectors(caps.of[k].bend(), StressOf(stretch.piece, first, last), most)) return false;
    }
  }
  return true;
}

bool CurvesAhead(const Network& network, const Rider& r) noexcept {
  const double speed = r.direction * r.at.velocity;
  const double until = 2 * StoppingDistance(speed, r.pace.brakes()) + kNear;
  const Caps caps = CapsAhead(network, StartOf(r, r.at, r.direction), until, r.pace);
  return std::any_of(caps.of.begin(), caps.of.begin() + static_cast<std::ptrdiff_t>(caps.count),
                     [&](const Cap& cap) { return cap.speed < r.pace.limits.velocity; });
}

bool IsUnconstrained(const Network& network, const Rider& r, const KinematicState& step) noexcept {
  const double speed = std::max(r.direction * step.velocity, r.direction * Peak(step, r.pace.limits.jerk));
  if (speed > r.pace.limits.velocity) return false;
  const double until = 2 * StoppingDistance(speed, r.pace.brakes()) + kNear;
  if (r.direction * (TargetPosition(network, r) - step.position) < until) return false;
  const Caps caps = CapsAhead(network, StartOf(r, step, r.direction), until, r.pace);
  return std::all_of(caps.of.begin(), caps.of.begin() + static_cast<std::ptrdiff_t>(caps.count),
                     [&](const Cap& cap) { return cap.speed >= speed; });
}

bool MayTake(const Network& network, const Rider& r, const Route& route) noexcept {
  const double rest = Brake(r.at, BrakesOf(r)).rest;
  double end = 0;
  for (std::uint32_t i = 0; i < r.route.count && (i == 0 || end <= rest); ++i) {
    if (i >= route.count || route.tracks[i] != r.route.tracks[i]) return false;
    end += network[r.route.tracks[i]].length;
  }
  return true;
}

bool TakeMastersRoute(const Network& network, const Rider& master, Rider& r) noexcept {
  if (network[r.route.first()].closed) return true;
  // Starts of the tracks of both routes, as this mover counts positions.
  std::uint32_t from_own = 0, from_masters = 0;
  double own = r.origin, its = master.origin + r.gear.apart;
  while (its < own - kSamePlace) {
    if (from_masters + 1 >= master.route.count) return true;  // it is ahead of the master's whole route
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
  e.about("How a geared motion ended.");
  e.value(GearEnd::kNot, "not", "It has not ended.");
  e.value(GearEnd::kWay, "way", "The route ends short of the position that the master demands.");
}

void describe(Description<Gear>& d) {
  using G = Gear;
  d.about("Coupling of a mover on tracks to a master.");
  d.internal<&G::master>("Index of the mover that is the master; none: an axis.");
  d.internal<&G::offset>(unit::mm, "Own position minus the master's.");
  d.internal<&G::tolerance>(unit::mm, "Largest error that counts as in sync.");
  d.internal<&G::sense>("Only direction of motion until it has been in sync; 0: either.");
  d.internal<&G::takes_masters_way>("True: it takes the route of the master.");
  d.internal<&G::apart>(unit::mm, "Position of a point as this mover counts it minus as the master counts it.");
  d.internal<&G::was_in_step>("True: it has been in sync.");
  d.internal<&G::in_step>("True: it is in sync.");
  d.internal<&G::error>(unit::mm, "Own position minus the demanded one.");
  d.internal<&G::end>("How the motion ended.");
}

}  // namespace takt::planar
