#include "takt/planar/network.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/core/describe.h"

namespace takt::planar {
namespace {

constexpr double kStep = 1;             // mm, in which bends are looked at
constexpr double kUneven = 1.4;         // within a bend curvature varies by this factor, which is 1.18 in speed
constexpr double kStraight = 1e-5;      // 1/mm: what bends less is straight
constexpr double kRangeResolution = 1;  // mm
constexpr double kInfinite = std::numeric_limits<double>::infinity();

void Name(std::uint32_t Road::* of, std::uint32_t track, std::uint32_t node, Network& network) noexcept {
  Road& road = network.roads[track];
  if (road.*of == node) return;
  road.*of = node;
  // Everything that meets there gets the same name.
  const bool end = of == &Road::end_node;
  for (const std::uint32_t other : (end ? road.behind : road.before).all()) {
    Name(end ? &Road::start_node : &Road::end_node, other, node, network);
  }
}

}  // namespace

std::vector<Bend> BendsOf(const Track& track) {
  std::vector<Bend> bends;
  double least = 0;
  const auto steps = static_cast<std::size_t>(std::ceil(track.length / kStep));
  for (std::size_t i = 0; i < steps; ++i) {
    const double from = track.length * static_cast<double>(i) / static_cast<double>(steps);
    const double to = track.length * static_cast<double>(i + 1) / static_cast<double>(steps);
    double most = 0;
    for (const double s : {from, 0.5 * (from + to), to}) most = std::max(most, std::abs(At(track, s).curvature));
    if (most < kStraight) most = 0;
    const bool goes_on = !bends.empty() && std::max(bends.back().curvature, most) <= kUneven * std::min(least, most);
    if (goes_on) {
      bends.back().curvature = std::max(bends.back().curvature, most);
      least = std::min(least, most);
    } else {
      bends.push_back({from, most});
      least = most;
    }
  }
  return bends;
}

bool Links::Add(std::uint32_t track) noexcept {
  if (std::ranges::find(all(), track) != all().end()) return true;
  if (count == tracks.size()) return false;
  tracks[count++] = track;
  return true;
}

bool Link(std::uint32_t from, std::uint32_t to, Network& network) noexcept {
  Links& behind = network.roads[from].behind;
  Links& before = network.roads[to].before;
  if (behind.count == kLinks || before.count == kLinks) return false;
  return behind.Add(to) && before.Add(from);
}

void NameNodes(Network& network) noexcept {
  for (Road& road : network.roads) road.start_node = road.end_node = kNoNode;
  network.node_count = 0;
  for (std::uint32_t i = 0; i < network.roads.size(); ++i) {
    const Road& road = network.roads[i];
    if (road.end_node != kNoNode || road.behind.count == 0) continue;
    Name(&Road::end_node, i, network.node_count++, network);
  }
}

void SetRanges(std::uint32_t track, const Footprint& mover, Network& network) {
  Road& road = network.roads[track];
  road.range_at_start = road.range_at_end = 0;
  if (!road.track) return;
  for (std::uint32_t i = 0; i < network.roads.size(); ++i) {
    const Road& other = network.roads[i];
    if (i == track || !other.track) continue;
    const bool at_start = road.start_node != kNoNode && other.start_node == road.start_node;
    const bool at_end = road.end_node != kNoNode && other.end_node == road.end_node;
    if (!at_start && !at_end) continue;
    const std::vector<Range> ranges = Conflicts(*road.track, mover, *other.track, mover, 0, kRangeResolution);
    if (at_start) road.range_at_start = std::max(road.range_at_start, ReachFromStart(ranges));
    if (at_end) road.range_at_end = std::max(road.range_at_end, ReachFromEnd(ranges, road.length));
  }
}

bool Route::Contains(std::uint32_t track) const noexcept {
  return std::ranges::find(all(), track) != all().end();
}

bool FindRoute(const Network& network, std::uint32_t from, std::uint32_t to, RouteSearch& search, Route& out) noexcept {
  const auto count = static_cast<std::uint32_t>(network.roads.size());
  std::ranges::fill(search.way, kInfinite);
  std::ranges::fill(search.settled, std::uint8_t{0});
  const auto leave = [&](std::uint32_t track, double way) {
    for (const std::uint32_t next : network[track].behind.all()) {
      if (!network[next].track || !(way < search.way[next])) continue;
      search.way[next] = way;
      search.came_from[next] = track;
    }
  };
  leave(from, 0);
  for (;;) {
    std::uint32_t nearest = kNoTrack;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (search.settled[i] || search.way[i] == kInfinite) continue;
      if (nearest == kNoTrack || search.way[i] < search.way[nearest]) nearest = i;
    }
    if (nearest == kNoTrack) return false;
    if (nearest == to) break;
    search.settled[nearest] = 1;
    leave(nearest, search.way[nearest] + network[nearest].length);
  }
  Route route;
  for (std::uint32_t track = to;; track = search.came_from[track]) {
    if (route.count == kRouteTracks) return false;
    route.tracks[route.count++] = track;
    if (track == from && route.count > 1) break;
    if (search.came_from[track] == from) {
      if (route.count == kRouteTracks) return false;
      route.tracks[route.count++] = from;
      break;
    }
  }
  std::reverse(route.tracks.begin(), route.tracks.begin() + route.count);
  out = route;
  return true;
}

void describe(Description<Route>& d) {
  d.about("Tracks one after the other.");
  d.internal<&Route::tracks>("Their numbers; the first one is where the mover is.");
  d.internal<&Route::count>("So many.");
}

}  // namespace takt::planar
