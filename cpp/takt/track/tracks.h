// All tracks of a machine, with one function for each stage of the cycle. Free functions over plain state; nothing here
// allocates, locks, throws or reads a clock, except construction and destruction of Tracks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "takt/core/cycle.h"
#include "takt/core/feedback.h"
#include "takt/planar/group_registry.h"
#include "takt/planar/parts.h"
#include "takt/planar/rider.h"
#include "takt/planar/track.h"
#include "takt/track/build_queues.h"
#include "takt/track/commands.h"
#include "takt/track/outputs.h"
#include "takt/track/params.h"
#include "takt/track/state.h"

namespace takt::track {

// Use of a track by movers.
struct Usage {
  std::uint32_t movers = 0;             // on it, including those that join
  bool moves = false;                   // a mover moves along it, or has it on the route of its motion
  bool configures = false;              // a mover joins or leaves
  std::uint32_t one = planar::kNobody;  // one of them; one that moves, joins or leaves, if there is any
};

struct Tracks {
  // Requires: `params` have been checked (build.h). Index i is track i of the machine. `parts` must outlive this
  // object; null: no parts.
  explicit Tracks(const std::vector<TrackParams>& params, const planar::Parts* parts = nullptr);
  ~Tracks();
  Tracks(const Tracks&) = delete;
  Tracks& operator=(const Tracks&) = delete;

  void SetSketch(std::size_t track, const Sketch& sketch) noexcept;

  // Returns a point of a track in its current coordinate system. Requires: the track has a length. `spot`: the current
  // origin of its part.
  planar::TrackPoint At(std::size_t track, double s) const noexcept;
  const planar::Spot& spot(std::size_t track) const noexcept;
  // Returns the commanded origin of its part, which decides on links with other tracks.
  const planar::Spot& goal(std::size_t track) const noexcept;

  std::vector<TrackParams> params;
  const planar::Parts& parts;
  std::vector<std::uint32_t> part_of;  // by track
  std::vector<State> states;
  std::vector<Sketch> sketches;  // by track; the states contain their hashes
  std::vector<Outputs> outputs;
  PendingEdits works;

  // Derived from the states.
  std::vector<const planar::Track*> ways;  // null: no length
  std::vector<planar::TrackArea*> areas;   // area that movers on it may cover; null: no length
  // Linked ends and starts have the same node number, below twice the number of tracks.
  std::vector<std::uint32_t> start_nodes;
  std::vector<std::uint32_t> end_nodes;
  std::vector<std::uint32_t> starts_at;  // by node: number of tracks that start there
  std::vector<std::uint32_t> ends_at;
  std::uint64_t changes = 0;          // counts changes of geometry and links
  std::vector<std::uint8_t> reached;  // by track: scratch memory of a search through links
  std::vector<Usage> usages;          // by track

  BuildQueues desk;
  bool sent = false;  // the request has been put into the queue
};

struct Context {
  Tracks& tracks;
  planar::GroupRegistry& grounds;
  Cycle cycle;
  FeedbackSink& feedback;
};

// Largest number of events in one cycle, besides those of its commands.
constexpr std::size_t EventsOf(std::size_t tracks) {
  return tracks == 0 ? 0 : 2 * tracks + 2 * kOrders;
}

// Stage command: carries it out, appends it to the pending edits, or rejects it.
void Apply(const Context& c, std::size_t track, Ticket ticket, const Command& command) noexcept;

// Starts the reaction of a track to a fault; ignored during a reaction or a reset.
void Fail(const Context& c, std::size_t track, ErrorId error, ErrorReaction reaction) noexcept;

void Use(const Usage& usage, std::size_t track, Tracks& tracks) noexcept;

// Stage move: before the movers.
void Step(const Context& c) noexcept;

void Publish(const Context& c) noexcept;

std::optional<std::size_t> Find(const Tracks& tracks, std::string_view name) noexcept;

}  // namespace takt::track
