#include "takt/mover/track_network_state.h"

#include <algorithm>

namespace takt::mover {

namespace {

const planar::Parts kNoParts;

bool SameShape(const TrackView& a, const TrackView& b) {
  return a.way == b.way && a.length == b.length && a.reach == b.reach && a.start_node == b.start_node &&
         a.end_node == b.end_node && a.goal == b.goal;
}

void LinkAll(std::span<const TrackView> tracks, planar::Network& network) {
  for (std::uint32_t i = 0; i < tracks.size(); ++i) {
    planar::Road& road = network.roads[i];
    road.track = tracks[i].way;
    road.length = road.track ? road.track->length : 0;
    road.closed = road.track && road.track->closed;
    road.reach = tracks[i].reach;
    road.origin = tracks[i].goal.origin;
    road.before = road.behind = {};
  }
  for (std::uint32_t i = 0; i < tracks.size(); ++i) {
    for (std::uint32_t k = 0; k < tracks.size(); ++k) {
      const bool both = tracks[i].way && tracks[k].way && !tracks[i].way->closed && !tracks[k].way->closed;
      if (both && tracks[i].end_node == tracks[k].start_node) planar::Link(i, k, network);
    }
  }
  planar::NumberNodes(network);
}

// Cuts the route of a mover at rest, and the tracks that it has passed, at links that no longer exist.
void CutRoute(const planar::Network& network, planar::Rider& rider) {
  if (!rider.on) return;
  const auto linked = [&](std::uint32_t from, std::uint32_t to) {
    return std::ranges::find(network[from].behind.all(), to) != network[from].behind.all().end();
  };
  for (std::uint32_t k = 1; k < rider.route.count; ++k) {
    if (linked(rider.route.tracks[k - 1], rider.route.tracks[k])) continue;
    std::fill(rider.route.tracks.begin() + k, rider.route.tracks.begin() + rider.route.count, 0u);
    rider.route.count = k;
    rider.aim = planar::Aim::kRest;
    rider.softly = false;
  }
  std::uint32_t behind = rider.route.first();
  for (std::uint32_t k = 0; k < rider.passed_count; behind = rider.passed[k++]) {
    if (linked(rider.passed[k], behind)) continue;
    std::fill(rider.passed.begin() + k, rider.passed.end(), 0u);
    rider.passed_count = k;
  }
}

}  // namespace

TrackNetworkState::TrackNetworkState(std::size_t movers, std::vector<std::string> of_tracks,
                                     const planar::Parts* of_parts)
    : parts(of_parts != nullptr ? of_parts : &kNoParts),
      names(std::move(of_tracks)),
      search(names.size()),
      traffic({static_cast<std::uint32_t>(movers), static_cast<std::uint32_t>(names.size())}),
      riders(movers),
      uses(names.size()),
      tracks(names.size()),
      declared(names.size()) {
  network.roads.resize(names.size());
}

std::uint32_t TrackNetworkState::Find(std::string_view track) const noexcept {
  const auto found = std::ranges::find(names, track);
  return found == names.end() ? planar::kNoTrack : static_cast<std::uint32_t>(found - names.begin());
}

planar::TrackPoint TrackNetworkState::At(std::uint32_t track, double s) const noexcept {
  planar::TrackPoint point = planar::At(*network[track].track, s);
  point.place = point.place + tracks[track].spot.origin;
  return point;
}

void Refresh(std::span<const TrackView> now, TrackNetworkState& s) noexcept {
  if (!std::ranges::equal(now, s.tracks, SameShape)) {
    LinkAll(now, s.network);
    for (planar::Rider& rider : s.riders) CutRoute(s.network, rider);
    // Tracks that meet a changed track are updated, too.
    const auto changed = [&](std::uint32_t i) {
      for (std::uint32_t k = 0; k < now.size(); ++k) {
        const bool meets = now[k].start_node == now[i].start_node || now[k].end_node == now[i].end_node;
        if (!SameShape(now[k], s.tracks[k]) && (k == i || meets)) return true;
      }
      return false;
    };
    for (std::uint32_t i = 0; i < now.size(); ++i) {
      planar::Road& road = s.network.roads[i];
      if (now[i].manual) {
        road.range_at_start = now[i].range_at_start;
        road.range_at_end = now[i].range_at_end;
      } else if (changed(i)) {
        planar::SetRanges(i, s.network);
      }
    }
    for (std::uint32_t i = 0; i < now.size(); ++i) {
      if (changed(i)) planar::SetLeads(i, s.network);
    }
  }
  std::ranges::copy(now, s.tracks.begin());
}

}  // namespace takt::mover
