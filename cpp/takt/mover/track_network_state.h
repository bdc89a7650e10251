// State that all movers on tracks share: the network, and the position of each mover on it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/core/cycle.h"
#include "takt/planar/network.h"
#include "takt/planar/parts.h"
#include "takt/planar/send.h"
#include "takt/planar/traffic.h"
#include "takt/trajectory/planner.h"

namespace takt::mover {

// A track in its present state.
struct TrackView {
  const planar::Track* way = nullptr;  // geometry; null: none
  double length = 0;                   // [mm] distinguishes another geometry at the same address
  bool enabled = false;
  std::uint32_t start_node = 0;  // track ends at one point share a number
  std::uint32_t end_node = 0;
  double reach = 0;                      // [mm] distance of centres at which two of its largest movers may touch
  std::uint32_t part = planar::kNoPart;  // part that it lies on
  planar::Spot spot{};                   // present spot of the part: origin of the coordinates of the track
  planar::Spot goal{};                   // commanded spot of the part: decides which tracks meet
  bool manual = false;                   // the ranges are configured
  double range_at_start = 0;             // [mm]
  double range_at_end = 0;
  double width = 0;  // [mm] of the largest movers for which it is made
  double height = 0;
};

// An axis that may be the master of movers.
struct Master {
  std::string name;
  double turn = 0;      // [u] period of its position; 0: not periodic
  KinematicState at{};  // over all turns and redefinitions of its position, at the end of this cycle
  double origin = 0;    // zero of its positions on that scale
  bool known = false;   // `at` is valid
};
// A mover that may be the master of others.
struct MasterMover {
  std::string name;
  bool enabled = false;
  bool on_track = false;  // on a track, neither joining nor leaving it
};

// Present use of a track by movers.
struct TrackUse {
  std::uint32_t movers = 0;       // on the track, including joining ones
  std::uint32_t moving = 0;       // moving along it
  std::uint32_t configuring = 0;  // joining or leaving
  // one of these movers; one that moves, joins or leaves rather than one at rest
  std::uint32_t one = planar::kNobody;
};

struct TrackNetworkState {
  // `parts`: of the surface, has to outlive this object; null: none.
  TrackNetworkState(std::size_t movers, std::vector<std::string> tracks, const planar::Parts* parts = nullptr);

  // Returns the index of the track with that name; kNoTrack: none.
  std::uint32_t Find(std::string_view track) const noexcept;

  // Returns the point at arc length `s` [mm] of a track, in the coordinate system in which the track now is.
  planar::TrackPoint At(std::uint32_t track, double s) const noexcept;

  const planar::Parts* parts;  // of the surface
  std::vector<std::string> names;
  planar::Network network;
  planar::RouteSearch search;
  planar::Traffic traffic;
  std::vector<planar::Rider> riders;  // by mover
  std::vector<TrackUse> uses;         // by track
  std::vector<TrackView> tracks;      // from which the network was made
  // By track: the tracks that follow it if their parts are where the links need them, whether the parts are there or
  // not.
  std::vector<planar::Links> declared;
  std::vector<Master> masters;
  std::vector<MasterMover> movers;
};

// Takes over changes of the tracks. Only changed geometry or links cost more than a comparison.
void Refresh(std::span<const TrackView> tracks, TrackNetworkState& streets) noexcept;

}  // namespace takt::mover
