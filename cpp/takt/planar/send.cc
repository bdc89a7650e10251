#include "takt/planar/send.h"

#include <algorithm>
#include <cmath>

namespace takt::planar {
namespace {

// A place on a loop, turns counted from the one the mover is in.
double OnLoop(const Destination& to, const Rider& r, double rest, double length) {
  if (to.way == Way::kNonModulo) return to.position;
  const double now = r.at.position;
  const double up = std::fmod(std::fmod(to.position - now, length) + length, length);
  const double nearest = up > 0.5 * length ? up - length : up;
  if (to.way == Way::kShortestWay || std::abs(nearest) <= to.modulo_tolerance) return now + nearest;
  const double turns = length * to.additional_turns;
  if (to.way == Way::kPositive) {
    double target = now + up + turns;
    while (target < rest) target += length;
    return target;
  }
  double target = now + (up > 0 ? up - length : 0) - turns;
  while (target > rest) target -= length;
  return target;
}

}  // namespace

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
