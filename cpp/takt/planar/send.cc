#include "takt/planar/send.h"

#include <algorithm>
#include <cmath>

namespace takt::planar {
namespace {

double OnLoop(const Destination& to, const Rider& r, double rest, double length) {
  const double now = r.at.position;
  double target = OnLoop(to.way, to.position, to.modulo_tolerance, now, length);
  if (to.way == Way::kNonModulo || to.way == Way::kShortestWay) return target;
  // Near enough to go the shortest way.
  if (std::abs(target - now) <= to.modulo_tolerance) return target;
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
  if (way == Way::kShortestWay || std::abs(nearest) <= modulo_tolerance) return now + nearest;
  if (way == Way::kPositive) return now + up;
  return now + (up > 0 ? up - length : 0);
}

bool Send(const Network& network, RouteSearch& search, const Destination& to, Rider& r) noexcept {
  if (!network[to.track].track) return false;
  const Road& here = network[r.route.first()];
  const double rest = Brake(r.at, r.brakes).rest;
  Route route = r.route;
  double target = to.position;
  if (here.closed) {
    if (to.track != r.route.first()) return false;
    route.count = 1;
    target = OnLoop(to, r, rest, here.length);
  } else {
    // Tracks that it gets onto whatever happens stay.
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

}  // namespace takt::planar
