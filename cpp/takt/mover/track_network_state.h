// What all movers share that go on tracks: the network, and who is where on it.
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

// A track as the machine has it now.
struct TrackView {
  const planar::Track* way = nullptr;  // null: none
  double length = 0;                   // mm; another way may lie at the same address
  bool enabled = false;
  std::uint32_t start_node = 0;  // ends and starts at one point share a number
  std::uint32_t end_node = 0;
  double reach = 0;                      // mm, at which the centres of two of its largest movers may touch
  std::uint32_t part = planar::kNoPart;  // that it lies on
  planar::Spot spot{};                   // where that is, which its places count from
  planar::Spot goal{};                   // where that is to be, as of where tracks meet
  bool manual = false;                   // the ranges are given
  double range_at_start = 0;             // mm
  double range_at_end = 0;
  double width = 0;  // mm, of the largest movers that it is for
  double height = 0;
};

// An axis that movers may follow.
struct Master {
  std::string name;
  double turn = 0;      // u, after which it is where it was; 0: never
  KinematicState at{};  // over all turns and renumberings, at the end of this cycle
  double origin = 0;    // where its positions count from, on that scale
  bool known = false;   // `at` means something
};
// A mover that others may follow.
struct MasterMover {
  std::string name;
  bool enabled = false;
  bool on_track = false;  // and neither joining nor leaving it
};

// What movers do on a track now.
struct TrackUse {
  std::uint32_t movers = 0;             // on it, with those that join
  std::uint32_t moving = 0;             // along it
  std::uint32_t configuring = 0;        // joining or leaving
  std::uint32_t one = planar::kNobody;  // of them: who moves, joins or leaves rather than who stands
};

struct TrackNetworkState {
  // Without parts of a surface if they are not given; else they must live as long.
  TrackNetworkState(std::size_t movers, std::vector<std::string> tracks, const planar::Parts* parts = nullptr);

  // kNoTrack: there is none of that name.
  std::uint32_t Find(std::string_view track) const noexcept;

  // Where a track leads, in the coordinate system where it is now.
  planar::TrackPoint At(std::uint32_t track, double s) const noexcept;

  const planar::Parts* parts;  // of the surface
  std::vector<std::string> names;
  planar::Network network;
  planar::RouteSearch search;
  planar::Traffic traffic;
  std::vector<planar::Rider> riders;  // by mover
  std::vector<TrackUse> uses;         // by track
  std::vector<TrackView> tracks;      // as the network was made of
  // By track: those that it leads on to where their parts are as their links want them, be they there now or not.
  std::vector<planar::Links> declared;
  std::vector<Master> masters;
  std::vector<MasterMover> movers;
};

// Takes over what has changed. Only where geometry or links did it takes more than a look.
void Refresh(std::span<const TrackView> tracks, TrackNetworkState& streets) noexcept;

}  // namespace takt::mover
