#include "streets.h"

#include <algorithm>
#include <cmath>

namespace takt::planar::testing {

namespace {

bool Meet(const TrackPoint& a, const TrackPoint& b) {
  return SamePoint(a.place, b.place) && SameDirection(a, b);
}

// The track comes near itself, which traffic does not check.
bool ComesBack(const Track& track, double near) {
  constexpr double kStep = 25;
  for (double s = 0; s < track.length; s += kStep) {
    for (double t = s + 3 * near; t < track.length; t += kStep) {
      if (Distance(At(track, s).place, At(track, t).place) < near + kStep) return true;
    }
  }
  return false;
}

// Bodies on both tracks come too near only from a common start on, or up to a common end; or from the end of one to the
// start of the other.
bool GoTogether(const Track& a, const Track& b, const Footprint& body) {
  const bool starts = Meet(StartOf(a), StartOf(b)), ends = Meet(EndOf(a), EndOf(b));
  const bool ab = Meet(EndOf(a), StartOf(b)), ba = Meet(EndOf(b), StartOf(a));
  for (const Range& range : Conflicts(a, body, b, body, 0, 5)) {
    const bool at_start = range.from <= 0 && (starts || ba), at_end = range.to >= a.length && (ends || ab);
    if (!at_start && !at_end) return false;
    if (range.to - range.from > 0.6 * a.length) return false;
  }
  return true;
}

}  // namespace

std::vector<Layout> RandomCity(Random& random, int count, double size) {
  const Footprint body{size, size, true};
  std::vector<TrackPoint> crossings;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      crossings.push_back({{900.0 * x + random.Between(-100, 100), 900.0 * y + random.Between(-100, 100)},
                           random.Between(-M_PI, M_PI),
                           0,
                           0});
    }
  }
  std::vector<Layout> layouts;
  std::vector<Track> tracks;
  for (int trial = 0; trial < 3000 && static_cast<int>(tracks.size()) < count; ++trial) {
    Layout layout;
    const TrackPoint& from = crossings[static_cast<std::size_t>(random.Below(16))];
    const TrackPoint& to = crossings[static_cast<std::size_t>(random.Below(16))];
    if (&from == &to || Distance(from.place, to.place) > 1500) continue;
    const double out = random.Between(50, 200), in = random.Between(50, 200);
    const Place a = Ahead(from.place, from.direction, out), b = Ahead(to.place, to.direction, -in);
    layout.elements = {Line(from.place, a), Line(b, to.place)};
    Track track;
    if (MakeTrack(layout, track).problem != Problem::kNone || track.length > 3000) continue;
    if (PeakCurvature(track, 0, track.length) > 1 / 150.0 || ComesBack(track, 1.5 * size)) continue;
    const auto fits = [&](const Track& other) {
      return GoTogether(track, other, body) && GoTogether(other, track, body);
    };
    if (!std::ranges::all_of(tracks, fits)) continue;
    layouts.push_back(layout);
    tracks.push_back(track);
  }
  // Tracks that only start, or only end, at the same point are not linked: traffic does not keep their movers apart.
  for (std::size_t i = 0; i < tracks.size();) {
    const auto linked = [&](const TrackPoint& place, const auto& own, const auto& across) {
      int alike = 0, linked = 0;
      for (const Track& other : tracks) {
        alike += Meet(place, own(other)) ? 1 : 0;
        linked += Meet(place, across(other)) ? 1 : 0;
      }
      return alike == 1 || linked > 0;
    };
    if (linked(StartOf(tracks[i]), StartOf, EndOf) && linked(EndOf(tracks[i]), EndOf, StartOf)) {
      ++i;
    } else {
      tracks.erase(tracks.begin() + static_cast<std::ptrdiff_t>(i));
      layouts.erase(layouts.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
  }
  return layouts;
}

TrackNetworkState::TrackNetworkState(const std::vector<Layout>& layouts, std::uint32_t movers, double size)
    : riders_(movers),
      traffic_({movers, static_cast<std::uint32_t>(layouts.size())}),
      search_(layouts.size()),
      reach_(std::hypot(size, size)) {
  for (const Layout& layout : layouts) {
    tracks_.push_back(std::make_unique<Track>(Make(layout)));
  }
  network_.roads.resize(layouts.size());
  for (std::size_t i = 0; i < layouts.size(); ++i) {
    Road& road = network_.roads[i];
    road.track = tracks_[i].get();
    road.length = tracks_[i]->length;
    road.closed = tracks_[i]->closed;
    road.reach = reach_;
  }
  for (std::uint32_t i = 0; i < layouts.size(); ++i) {
    for (std::uint32_t k = 0; k < layouts.size(); ++k) {
      const TrackPoint end = EndOf(*tracks_[i]), start = StartOf(*tracks_[k]);
      const bool open = !tracks_[i]->closed && !tracks_[k]->closed;
      if (open && SamePoint(end.place, start.place) && SameDirection(end, start)) {
        EXPECT_TRUE(Link(i, k, network_));
      }
    }
  }
  NumberNodes(network_);
  for (std::uint32_t i = 0; i < layouts.size(); ++i) SetRanges(i, network_);
  for (std::uint32_t i = 0; i < layouts.size(); ++i) SetLeads(i, network_);
}

Rider& TrackNetworkState::Put(std::uint32_t mover, std::uint32_t track, double s, const Pace& pace, double gap) {
  Rider& r = riders_[mover];
  r = {};
  r.on = true;
  r.at = {s, 0, 0};
  r.route.tracks[0] = track;
  r.route.count = 1;
  r.pace = pace;
  r.brakes = pace.brakes();
  r.top_speed = pace.limits.velocity;
  r.gap = r.zone = gap;
  return r;
}

bool TrackNetworkState::Send(std::uint32_t mover, std::uint32_t track, double s) {
  return Send(mover, {.track = track, .position = s});
}

bool TrackNetworkState::Send(std::uint32_t mover, const Destination& to) {
  return planar::Send(network_, search_, to, riders_[mover]);
}

void TrackNetworkState::Step() {
  traffic_.Step(cycle_, planner_, network_, riders_);
  ++cycle_.count;
  if (watch) watch();
}

bool TrackNetworkState::Run(double seconds) {
  const double end = now() + seconds;
  const auto there = [](const Rider& r) { return !r.on || r.aim != Aim::kTarget || r.there; };
  while (now() < end) {
    Step();
    if (std::ranges::all_of(riders_, there)) return true;
  }
  return false;
}

TrackPoint TrackNetworkState::PointOf(std::uint32_t mover) const {
  const Rider& r = riders_[mover];
  return At(*tracks_[r.route.first()], r.at.position);
}

double TrackNetworkState::MissingOf(const std::function<double(const Rider&)>& gap) const {
  double most = -INFINITY;
  for (std::size_t i = 0; i < riders_.size(); ++i) {
    const Rider& a = riders_[i];
    if (!a.on) continue;
    for (std::size_t k = 0; k < riders_.size(); ++k) {
      const Rider& b = riders_[k];
      if (!b.on || i == k) continue;
      const double between = gap(a) + a.off + b.off;
      double offset = 0;
      for (std::uint32_t n = 0; n < a.route.count; ++n) {
        const double apart = offset + b.at.position - a.at.position;
        if (b.route.first() == a.route.tracks[n] && apart > 0) most = std::max(most, between - apart);
        if (n == 0 && b.route.first() == a.route.first() && tracks_[a.route.first()]->closed) {
          most = std::max(most, between - (apart > 0 ? apart : apart + tracks_[a.route.first()]->length));
        }
        offset += network_[a.route.tracks[n]].length;
      }
    }
  }
  return most;
}

double TrackNetworkState::Nearest() const {
  double least = INFINITY;
  for (std::uint32_t i = 0; i < riders_.size(); ++i) {
    for (std::uint32_t k = 0; k < i; ++k) {
      if (!riders_[i].on || !riders_[k].on) continue;
      const Place a = PointOf(i).place, b = PointOf(k).place;
      least = std::min(least, Distance(a, b) - reach_);
    }
  }
  return least;
}

void Watcher::Look() {
  std::vector<Rider>& riders = streets_.riders();
  before_.resize(riders.size());
  ways_.resize(riders.size());
  most_.resize(riders.size());
  pushes_.resize(riders.size());
  for (std::uint32_t i = 0; i < riders.size(); ++i) {
    const Rider& r = riders[i];
    if (!r.on) {
      before_[i] = {};
      ways_[i] = most_[i] = 0;
      pushes_[i] = {};
      continue;
    }
    const KinematicState& b = before_[i];
    speed = std::max(speed, std::abs(r.at.velocity) / r.top_speed);
    const bool slows = r.at.velocity * r.at.acceleration < 0;
    // It may keep the speed of an earlier command.
    most_[i] = std::max(most_[i], r.pace.limits.acceleration);
    acceleration = std::max(acceleration, std::abs(r.at.acceleration) / (slows ? r.brakes.deceleration : most_[i]));
    const double most = std::max(r.brakes.jerk, r.pace.limits.jerk);
    jerk = std::max(jerk, std::abs(r.at.acceleration - b.acceleration) / kPeriod / most);
    lateral =
        std::max(lateral, r.at.velocity * r.at.velocity * std::abs(streets_.PointOf(i).curvature) / r.pace.lateral);
    const TrackPoint point = streets_.PointOf(i);
    const double across = r.at.velocity * r.at.velocity * point.curvature;
    const double c = std::cos(point.direction), s = std::sin(point.direction);
    const Place push{r.at.acceleration * c - across * s, r.at.acceleration * s + across * c};
    vector_acceleration = std::max(vector_acceleration, std::hypot(push.x, push.y) / r.pace.vector_acceleration);
    vector_jerk = std::max(vector_jerk, Distance(push, pushes_[i]) / kPeriod / r.pace.vector_jerk);
    pushes_[i] = push;
    // Speed and position belong to one motion.
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
