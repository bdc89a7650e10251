// The network of linked tracks: a graph whose edges are tracks. Movers pass from the end of a track to the start of
// those linked with it, never back.
//
// Links change while the machine runs (parts move, tracks are configured), so all memory here is allocated at the
// start; nothing allocates later unless stated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/track.h"

namespace takt::planar {

inline constexpr std::uint32_t kNoTrack = 0xffffffff;
inline constexpr std::uint32_t kNoNode = 0xffffffff;
inline constexpr std::size_t kLinks = 64;  // tracks that start, or end, at one point

// Tracks linked with one end of a track.
struct Links {
  std::array<std::uint32_t, kLinks> tracks{};
  std::uint32_t count = 0;

  std::span<const std::uint32_t> all() const noexcept { return {tracks.data(), count}; }
  bool Add(std::uint32_t track) noexcept;
};

// A track as traffic uses it.
struct Road {
  const Track* track = nullptr;  // null: not usable
  Place origin{};                // [mm] origin of its coordinates
  double length = 0;             // [mm]
  bool closed = false;
  // [mm] largest distance at which the centres of two of its largest movers may touch, at any angles
  double reach = 0;
  Links before{}, behind{};  // tracks that end at its start; tracks that start at its end
  // [mm] from its ends: movers within it may touch movers on other tracks that meet it there.
  double range_at_start = 0;
  double range_at_end = 0;
  // [mm] by tracks that start where it starts, and by tracks that end where it ends (see LeadAtStart).
  std::array<double, kLinks> leads_at_start{};
  std::array<double, kLinks> leads_at_end{};
  // Nodes of its ends; kNoNode: not linked.
  std::uint32_t start_node = kNoNode;
  std::uint32_t end_node = kNoNode;
};

struct Network {
  std::vector<Road> roads;
  std::uint32_t node_count = 0;

  const Road& operator[](std::uint32_t track) const noexcept { return roads[track]; }
};

// Links the end of `from` to the start of `to`. Returns false if there are too many links.
bool Link(std::uint32_t from, std::uint32_t to, Network& network) noexcept;
// Numbers the nodes anew, after links have changed.
void NumberNodes(Network& network) noexcept;

// Computes the ranges at both ends of a track: beyond them its movers cannot touch those on tracks that meet it there.
// At most kRangeSlack too long. Takes up to some 100 µs for a pair of tracks.
inline constexpr double kRangeSlack = 40;  // [mm]
void SetRanges(std::uint32_t track, Network& network) noexcept;

// Computes the leads within the ranges: how much farther than a mover on `behind` a mover on `ahead` has to be, counted
// from the common start (end) of the tracks, so that they cannot touch. That exceeds their size if the distance to that
// point is longer on one track than on the other. At most as large as for movers larger by kLeadSlack, plus kLeadSlack.
// To be called once for each track, after the ranges of all; takes up to some 100 µs for a pair of tracks.
inline constexpr double kLeadSlack = 1;  // [mm] in ranges up to 1 m
void SetLeads(std::uint32_t track, Network& network) noexcept;
double LeadAtStart(const Network& network, std::uint32_t ahead, std::uint32_t behind) noexcept;
double LeadAtEnd(const Network& network, std::uint32_t ahead, std::uint32_t behind) noexcept;

// A sequence of linked tracks; the mover is on the first one.
inline constexpr std::size_t kRouteTracks = 256;
struct Route {
  std::array<std::uint32_t, kRouteTracks> tracks{};
  std::uint32_t count = 0;

  std::uint32_t first() const noexcept { return tracks[0]; }
  std::uint32_t last() const noexcept { return tracks[count - 1]; }
  std::span<const std::uint32_t> all() const noexcept { return {tracks.data(), count}; }
  bool Contains(std::uint32_t track) const noexcept;
  bool operator==(const Route&) const = default;
};

// Removes from a route the tracks that end before a position along it [mm]; a closed track stays. Returns the distance
// [mm] by which positions decrease: the length of these tracks, or whole turns of the closed one.
double LeaveBehind(const Network& network, double position, Route& route) noexcept;

// Memory of a search; sized for the tracks of the network.
struct RouteSearch {
  std::vector<double> way;
  std::vector<std::uint32_t> came_from;
  std::vector<std::uint8_t> settled;
  std::vector<std::uint32_t> queue;

  explicit RouteSearch(std::size_t tracks = 0) : way(tracks), came_from(tracks), settled(tracks), queue(tracks) {}
};

// Finds the shortest route, by length, from the end of `from` (its first track) to the start of `to`; of equally long
// ones, that over the tracks with the smaller numbers. Returns false if there is none, or if it has too many tracks.
bool FindRoute(const Network& network, std::uint32_t from, std::uint32_t to, RouteSearch& search, Route& out) noexcept;

void describe(Description<Route>&);

}  // namespace takt::planar
