#include "takt/planar/send.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace takt::planar {
namespace {

double OnLoop(const Destination& to, const Rider& r, double rest, double length) {
  const double now = r.at.position;
  double target = OnLoop(to.way, to.position, to.modulo_tolerance, now, length);
  if (to.way == Way::kNonModulo || to.way == Way::kShortestWay) return target;
  // Near enough for the shortest way, unless there are turns to make.
  if (to.additional_turns == 0 && std::abs(target - now) <= std::max(to.modulo_tolerance, kSame)) return target;
  const double sense = to.way == Way::kPositive ? 1 : -1;
  target += sense * length * to.additional_turns;
  while (sense * (rest - target) > 0) target += sense * length;
  return target;
}

}  // namespace

double OnLoop(Way way, double position, double modulo_tolerance, double now, double length) noexcept {
  if (way == Way::kNonModulo) return position;
  const double up = std::fmod(std::fmod(position - now, length) + length, length);
  const double nearest = up > 0.5 * length ? up - length : up;
  if (way == Way::kShortestWay || std::abs(nearest) <= std::max(modulo_tolerance, kSame)) {
    return now + nearest;
  }
  if (way == Way::kPositive) return now + up;
  return now + (up > 0 ? up - length : 0);
}

bool Send(const Network& network, RouteSearch& search, const Destination& to, Rider& r) noexcept {
  if (!network[to.track].track) return false;
  const Road& here = network[r.route.first()];
  const double rest = Brake(r.at, BrakesOf(r)).rest;
  Route route = r.route;
  double target = to.position;
  if (here.closed) {
    if (to.track != r.route.first()) return false;
    route.count = 1;
    target = OnLoop(to, r, rest, here.length);
  } else {
    // Tracks that it cannot avoid any more stay.
    std::uint32_t kept = 1;
    double end = here.length;
    while (kept < route.count && end <= rest) end += network[route.tracks[kept++]].length;
    route.count = kept;
    const double begin = end - network[route.last()].length;
    const bool ahead = begin + to.position >= rest;
    const bool may_go_back = to.way != Way::kPositive;
    bool there = route.last() == to.track && (ahead ? to.way != Way::kNegative : may_go_back);
    if (!there && to.way != Way::kNegative) {
      Route more;
      there = FindRoute(network, route.last(), to.track, search, more) && route.count + more.count - 1 <= kRouteTracks;
      for (std::uint32_t i = 1; there && i < more.count; ++i) route.tracks[route.count++] = more.tracks[i];
    }
    if (!there) return false;
  }
  std::fill(route.tracks.begin() + route.count, route.tracks.end(), 0U);
  r.route = route;
  r.target = target;
  r.aim = Aim::kTarget;
  r.planned = r.there = false;
  r.waits = Waits::kNot;
  r.waits_for = kNobody;
  return true;
}

UnreachableReason DiagnoseUnreachable(const Network& network, RouteSearch& search, const Destination& to,
                                      const Rider& r) noexcept {
  Destination any = to;
  any.way = Way::kNonModulo;
  Rider then = r;
  if (to.way != any.way && Send(network, search, any, then)) return UnreachableReason::kDirection;
  if (network[r.route.first()].closed || network[to.track].closed) return UnreachableReason::kNotLinked;
  Route route;
  const bool found = FindRoute(network, r.route.first(), to.track, search, route);
  const bool reached = search.way[to.track] < std::numeric_limits<double>::infinity();
  return found || reached ? UnreachableReason::kTooLong : UnreachableReason::kNotLinked;
}

double TargetPosition(const Network& network, const Rider& r) noexcept {
  double end = r.target;
  for (std::uint32_t k = 0; k + 1 < r.route.count; ++k) end += network[r.route.tracks[k]].length;
  return end;
}

void PlanOn(trajectory::Planner& planner, const Network& network, double place, double speed, double acceleration,
            Rider& r) noexcept {
  const double end = TargetPosition(network, r);
  if (speed == 0 && acceleration == 0) r.direction = end < place ? -1 : 1;
  const double way = r.direction * (end - place);
  const Start start{&r.route, place, r.direction, speed, acceleration};
  const Planned made = PlanWay(planner, network, start, way, r.pace, MostOf(r), r.plan, r.plan_ends);
  r.plan_from = place;
  r.plan_time = 0;
  // A geared mover that only brakes for a curve plans anew in each cycle.
  r.planned = made == Planned::kWay || (made == Planned::kStop && r.aim != Aim::kFollow);
}

double TimeAlone(trajectory::Planner& planner, const Network& network, Rider r) noexcept {
  constexpr int kPlans = 2;  // one takes up to 100 us
  double time = 0;
  KinematicState at{r.at.position, r.direction * r.at.velocity, r.direction * r.at.acceleration};
  for (int i = 0; i < kPlans; ++i) {
    const double left = LeaveBehind(network, at.position, r.route);
    at.position -= left;
    if (network[r.route.first()].closed) r.target -= left;
    PlanOn(planner, network, at.position, at.velocity, at.acceleration, r);
    time += r.plan.duration();
    if (r.plan_ends) return time;
    at = r.plan.end();
    at.position = r.plan_from + r.direction * at.position;
  }
  const double way = r.direction * (TargetPosition(network, r) - at.position);
  return time + EstimateTravelTime(network, {&r.route, at.position, r.direction, at.velocity, 0}, way, r.pace);
}

}  // namespace takt::planar
