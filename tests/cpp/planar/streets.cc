#include "streets.h"

#include <algorithm>
#include <cmath>

namespace takt::planar::testing {

Streets::Streets(const std::vector<Layout>& layouts, std::uint32_t movers, double size)
    : riders_(movers),
      traffic_({movers, static_cast<std::uint32_t>(layouts.size())}),
      search_(layouts.size()),
      body_{size, size, true} {
  for (const Layout& layout : layouts) {
    tracks_.push_back(std::make_unique<Track>(Make(layout)));
    bends_.push_back(BendsOf(*tracks_.back()));
  }
  network_.roads.resize(layouts.size());
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    Road& road = network_.roads[i];
    road.track = tracks_[i].get();
    road.bends = bends_[i];
    road.length = tracks_[i]->length;
    road.closed = tracks_[i]->closed;
  }
  for (std::uint32_t i = 0; i < layouts.size(); ++i) {
    for (std::uint32_t k = 0; k < layouts.size(); ++k) {
      const TrackPoint end = End(*tracks_[i]), start = Start(*tracks_[k]);
      const bool open = !tracks_[i]->closed && !tracks_[k]->closed;
      if (open && SamePlace(end.place, start.place) && SameDirection(end, start)) {
        EXPECT_TRUE(Link(i, k, network_));
      }
    }
  }
  NameNodes(network_);
  for (std::uint32_t i = 0; i < layouts.size(); ++i) SetRanges(i, body_, network_);
}

Rider& Streets::Put(std::uint32_t mover, std::uint32_t track, double s, const Pace& pace, double gap) {
  Rider& r = riders_[mover];
  r = {};
  r.on = true;
  r.at = {s, 0, 0};
  r.route.tracks[0] = track;
  r.route.count = 1;
  r.pace = pace;
  r.brakes = pace.brakes();
  r.gap = gap;
  return r;
}

bool Streets::Send(std::uint32_t mover, std::uint32_t track, double s) {
  Rider& r = riders_[mover];
  Route route = r.route;
  // What it can no longer leave stays.
  const double rest = Brake(r.at, r.brakes).highest;
  std::uint32_t kept = 0;
  double end = 0;
  while (kept < route.count && (kept == 0 || end <= rest)) end += network_[route.tracks[kept++]].length;
  route.count = kept;
  const bool same = route.last() == track && (kept > 1 || s >= r.at.position || (r.at.velocity == 0 && kept == 1));
  if (!same) {
    Route more;
    if (!FindRoute(network_, route.last(), track, search_, more)) return false;
    if (route.count + more.count - 1 > kRouteTracks) return false;
    for (std::uint32_t i = 1; i < more.count; ++i) route.tracks[route.count++] = more.tracks[i];
  }
  for (std::uint32_t i = route.count; i < kRouteTracks; ++i) route.tracks[i] = 0;
  r.route = route;
  r.target = s;
  r.aim = Aim::kTarget;
  r.planned = r.there = false;
  return true;
}

void Streets::Step() {
  traffic_.Step(cycle_, planner_, network_, riders_);
  ++cycle_.count;
  if (watch) watch();
}

bool Streets::Run(double seconds) {
  const double end = now() + seconds;
  const auto there = [](const Rider& r) { return !r.on || r.aim != Aim::kTarget || r.there; };
  while (now() < end) {
    Step();
    if (std::ranges::all_of(riders_, there)) return true;
  }
  return false;
}

TrackPoint Streets::PointOf(std::uint32_t mover) const {
  const Rider& r = riders_[mover];
  return At(*tracks_[r.route.first()], r.at.position);
}

double Streets::Missing() const {
  double most = -INFINITY;
  for (std::size_t i = 0; i < riders_.size(); ++i) {
    const Rider& a = riders_[i];
    if (!a.on) continue;
    for (std::size_t k = 0; k < riders_.size(); ++k) {
      const Rider& b = riders_[k];
      if (!b.on || i == k) continue;
      double offset = 0;
      for (std::uint32_t n = 0; n < a.route.count; ++n) {
        const double apart = offset + b.at.position - a.at.position;
        if (b.route.first() == a.route.tracks[n] && apart > 0) most = std::max(most, a.gap - apart);
        if (n == 0 && b.route.first() == a.route.first() && tracks_[a.route.first()]->closed) {
          most = std::max(most, a.gap - (apart > 0 ? apart : apart + tracks_[a.route.first()]->length));
        }
        offset += network_[a.route.tracks[n]].length;
      }
    }
  }
  return most;
}

double Streets::Nearest() const {
  double least = INFINITY;
  for (std::uint32_t i = 0; i < riders_.size(); ++i) {
    for (std::uint32_t k = 0; k < i; ++k) {
      if (!riders_[i].on || !riders_[k].on) continue;
      const Place a = PointOf(i).place, b = PointOf(k).place;
      least = std::min(least, Distance(a, b));
    }
  }
  return least;
}

void Watcher::Look() {
  std::vector<Rider>& riders = streets_.riders();
  before_.resize(riders.size());
  ways_.resize(riders.size());
  for (std::uint32_t i = 0; i < riders.size(); ++i) {
    const Rider& r = riders[i];
    if (!r.on) continue;
    const KinematicState& b = before_[i];
    speed = std::max(speed, std::abs(r.at.velocity) / r.pace.limits.velocity);
    const bool slows = r.at.velocity * r.at.acceleration < 0;
    acceleration = std::max(
        acceleration, std::abs(r.at.acceleration) / (slows ? r.brakes.deceleration : r.pace.limits.acceleration));
    const double most = std::max(r.brakes.jerk, r.pace.limits.jerk);
    jerk = std::max(jerk, std::abs(r.at.acceleration - b.acceleration) / kPeriod / most);
    lateral = std::max(lateral, r.at.velocity * r.at.velocity * std::abs(streets_.PointOf(i).curvature) / r.pace.lateral);
    // What is said of speed and place is one motion.
    const double way = r.at.position + r.origin;
    if (ways_[i] != 0) {
      // Its jerk may change within the cycle.
      const double constant = kPeriod * (b.velocity + kPeriod * (2 * b.acceleration + r.at.acceleration) / 6);
      EXPECT_NEAR(way - ways_[i], constant, 1e-9 + most * kPeriod * kPeriod * kPeriod);
    }
    before_[i] = r.at;
    ways_[i] = way;
  }
}

}  // namespace takt::planar::testing
