#include "takt/planar/network.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/planar/nearest.h"

namespace takt::planar {
namespace {

constexpr double kStride = 0.5 * kRangeSlack;  // [mm]
constexpr double kUnreached = std::numeric_limits<double>::infinity();

void Name(std::uint32_t Road::*of, std::uint32_t track, std::uint32_t node, Network& network) noexcept {
  Road& road = network.roads[track];
  if (road.*of == node) return;
  road.*of = node;
  // All ends that meet there get the same number.
  const bool end = of == &Road::end_node;
  for (const std::uint32_t other : (end ? road.behind : road.before).all()) {
    Name(end ? &Road::start_node : &Road::end_node, other, node, network);
  }
}

// Returns the tracks that start, or end, where this track does, including itself.
std::span<const std::uint32_t> Alike(const Network& network, std::uint32_t track, bool at_end) noexcept {
  const Road& road = network[track];
  const Links& others = at_end ? road.behind : road.before;
  if (others.count == 0) return {};
  return (at_end ? network[others.tracks[0]].before : network[others.tracks[0]].behind).all();
}

double Lead(const Network& network, std::uint32_t ahead, std::uint32_t behind, bool at_end) noexcept {
  if (ahead == kNoTrack || ahead == behind) return 0;
  const auto alike = Alike(network, ahead, at_end);
  const auto found = std::ranges::find(alike, behind);
  if (found == alike.end()) return 0;
  const Road& road = network[ahead];
  return (at_end ? road.leads_at_end : road.leads_at_start)[static_cast<std::size_t>(found - alike.begin())];
}

// Samples of a track within its range; each represents positions up to half a stride from it.
struct Strip {
  std::array<Place, 1024> places;
  std::size_t count = 0;
  double stride = 0;  // [mm]

  Strip(const Road& road, bool at_end) noexcept {
    const double range = std::min(road.length, at_end ? road.range_at_end : road.range_at_start);
    stride = std::max(kLeadSlack, range / static_cast<double>(places.size() - 2));
    count = static_cast<std::size_t>(range / stride) + 2;
    for (std::size_t i = 0; i < count; ++i) {
      const double s = std::min(stride * static_cast<double>(i), range);
      places[i] = PlaceAt(*road.track, at_end ? road.length - s : s);
      places[i].x += road.origin.x;
      places[i].y += road.origin.y;
    }
  }
};

// Returns the largest difference [mm], over all positions on both tracks at which movers touch, of the distances from
// the common point: that on `far` minus that on `near`.
double MostApart(const Road& near, const Road& far, bool at_end) noexcept {
  const Strip ours(near, at_end), theirs(far, at_end);
  const double slack = 0.5 * (ours.stride + theirs.stride);
  const double reach = 0.5 * (near.reach + far.reach) + slack;
  double most = 0;
  for (std::size_t i = 0; i < ours.count; ++i) {
    const double s = ours.stride * static_cast<double>(i) - slack;
    // From the far end inwards: movers that are apart stay so while one of them moves by less than that.
    for (std::size_t k = theirs.count; k-- > 0;) {
      const double t = theirs.stride * static_cast<double>(k);
      if (t - s <= most) break;
      const Place &a = ours.places[i], &b = theirs.places[k];
      const double apart = maths::Hypot(b.x - a.x, b.y - a.y) - reach;
      if (apart < 0) {
        most = t - s;
        break;
      }
      k -= std::min(k, static_cast<std::size_t>(apart / theirs.stride));
    }
  }
  return most;
}

}  // namespace

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

void NumberNodes(Network& network) noexcept {
  for (Road& road : network.roads) road.start_node = road.end_node = kNoNode;
  network.node_count = 0;
  for (std::uint32_t i = 0; i < network.roads.size(); ++i) {
    const Road& road = network.roads[i];
    if (road.end_node != kNoNode || road.behind.count == 0) continue;
    Name(&Road::end_node, i, network.node_count++, network);
  }
}

void SetRanges(std::uint32_t track, Network& network) noexcept {
  Road& road = network.roads[track];
  road.range_at_start = road.range_at_end = 0;
  if (!road.track) return;
  // From the end on, as long as anything is near. Between two samples the distance is at least that at the samples,
  // less the distance to them.
  const auto range = [&](const Road& of, bool at_end) {
    const Track& other = *of.track;
    const double reach = 0.5 * (road.reach + of.reach);
    double near = 0;
    for (double s = 0; s < road.length + kStride; s += kStride) {
      const double place = std::min(s, road.length);
      const TrackPoint point = At(*road.track, at_end ? road.length - place : place);
      const Place seen{point.place.x + road.origin.x - of.origin.x, point.place.y + road.origin.y - of.origin.y};
      const double free = NearestTo(other, seen).distance - reach - 0.5 * kStride;
      if (free < 0) {
        near = std::min(s + kStride, road.length);
      } else if (s > near + 5 * reach) {
        break;
      } else {
        s += kStride * std::floor(free / kStride);  // skips positions that cannot be near
      }
    }
    return near;
  };
  for (std::uint32_t i = 0; i < network.roads.size(); ++i) {
    const Road& other = network.roads[i];
    if (i == track || !other.track) continue;
    if (road.start_node != kNoNode && other.start_node == road.start_node) {
      road.range_at_start = std::max(road.range_at_start, range(other, false));
    }
    if (road.end_node != kNoNode && other.end_node == road.end_node) {
      road.range_at_end = std::max(road.range_at_end, range(other, true));
    }
  }
}

void SetLeads(std::uint32_t track, Network& network) noexcept {
  Road& road = network.roads[track];
  for (const bool at_end : {false, true}) {
    auto& leads = at_end ? road.leads_at_end : road.leads_at_start;
    leads = {};
    const auto alike = Alike(network, track, at_end);
    for (std::size_t i = 0; i < alike.size(); ++i) {
      const Road& other = network[alike[i]];
      if (alike[i] == track || !road.track || !other.track) continue;
      // Towards a common end the mover ahead is the one nearer to it.
      leads[i] = at_end ? MostApart(road, other, true) : MostApart(other, road, false);
    }
  }
}

double LeadAtStart(const Network& network, std::uint32_t ahead, std::uint32_t behind) noexcept {
  return Lead(network, ahead, behind, false);
}
double LeadAtEnd(const Network& network, std::uint32_t ahead, std::uint32_t behind) noexcept {
  return Lead(network, ahead, behind, true);
}

bool Route::Contains(std::uint32_t track) const noexcept {
  return std::ranges::find(all(), track) != all().end();
}

double LeaveBehind(const Network& network, double position, Route& route) noexcept {
  const Road& first = network[route.first()];
  if (first.closed) return first.length * std::floor(position / first.length);
  double distance = 0;
  std::uint32_t left = 0;
  while (left + 1 < route.count && position - distance > network[route.tracks[left]].length) {
    distance += network[route.tracks[left++]].length;
  }
  const auto end = route.tracks.begin() + route.count;
  std::fill(std::copy(route.tracks.begin() + left, end, route.tracks.begin()), end, 0u);
  route.count -= left;
  return distance;
}

bool FindRoute(const Network& network, std::uint32_t from, std::uint32_t to, RouteSearch& search, Route& out) noexcept {
  const auto count = static_cast<std::uint32_t>(network.roads.size());
  std::ranges::fill(search.way, kUnreached);
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
      if (search.settled[i] || search.way[i] == kUnreached) continue;
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
  d.about("Sequence of linked tracks.");
  d.internal<&Route::tracks>("Indices of the tracks, the present one of the mover first.");
  d.internal<&Route::count>("Number of tracks.");
}

}  // namespace takt::planar
