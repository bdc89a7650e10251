// Tracks that go on into one another: a graph whose edges are tracks. From the end of a track one gets to the start of
// those linked with it, never the other way.
//
// Links change while the machine runs (parts move, tracks are configured), so everything here has its memory from the
// start; only where stated it takes some.
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

// A track as the traffic sees it.
struct Road {
  const Track* track = nullptr;  // null: not to be used
  Place origin{};                // mm, which its places count from
  double length = 0;             // mm
  bool closed = false;
  double reach = 0;          // mm, at which the centres of two of its largest movers may touch, however they are turned
  Links before{}, behind{};  // tracks that end at its start, that start from its end
  // mm from its ends, within which movers on other tracks that meet it there may be too near.
  double range_at_start = 0;
  double range_at_end = 0;
  // mm, by tracks that start where it starts, and that end where it ends (see LeadAtStart).
  std::array<double, kLinks> leads_at_start{};
  std::array<double, kLinks> leads_at_end{};
  // Where its ends meet others; kNoNode: nowhere.
  std::uint32_t start_node = kNoNode;
  std::uint32_t end_node = kNoNode;
};

struct Network {
  std::vector<Road> roads;
  std::uint32_t node_count = 0;

  const Road& operator[](std::uint32_t track) const noexcept { return roads[track]; }
};

// The end of `from` goes on into the start of `to`. False: too many links.
bool Link(std::uint32_t from, std::uint32_t to, Network& network) noexcept;
// Names the nodes anew, after links have changed.
void NameNodes(Network& network) noexcept;

// The ranges at both ends of a track: beyond them its movers cannot touch those on tracks that meet it there. At most
// kRangeSlack too long. Takes up to some 100 µs for a pair of tracks.
inline constexpr double kRangeSlack = 40;  // mm
void SetRanges(std::uint32_t track, Network& network) noexcept;

// Within the ranges: how much further on a mover on `ahead` has to be than one on `behind`, counted from where both
// tracks start (end), so that they cannot touch. That is more than their size where the way to there is longer on one
// track than on the other. Too much only as if they were kLeadSlack larger, and by that. Once for each track, when the
// ranges of all are known; takes up to some 100 µs for a pair of tracks.
inline constexpr double kLeadSlack = 1;  // mm, in ranges up to a metre
void SetLeads(std::uint32_t track, Network& network) noexcept;
double LeadAtStart(const Network& network, std::uint32_t ahead, std::uint32_t behind) noexcept;
double LeadAtEnd(const Network& network, std::uint32_t ahead, std::uint32_t behind) noexcept;

// Tracks one after the other, the first one is where the mover is.
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
// [mm] by which positions are less then: the length of these tracks, or whole turns of the closed one.
double LeaveBehind(const Network& network, double position, Route& route) noexcept;

// Memory of a search, for as many tracks as the network has.
struct RouteSearch {
  std::vector<double> way;
  std::vector<std::uint32_t> came_from;
  std::vector<std::uint8_t> settled;
  std::vector<std::uint32_t> queue;

  explicit RouteSearch(std::size_t tracks = 0) : way(tracks), came_from(tracks), settled(tracks), queue(tracks) {}
};

// The shortest way from the end of `from` (which is its first track) to the start of `to`, by length; of ways that are
// equally long that over the tracks with the smaller numbers. False: there is none, or it has too many tracks.
bool FindRoute(const Network& network, std::uint32_t from, std::uint32_t to, RouteSearch& search, Route& out) noexcept;

void describe(Description<Route>&);

}  // namespace takt::planar
