// All tracks of a machine, stage by stage of the cycle. Free functions over plain state; nothing here allocates, locks,
// throws or reads a clock, but for the making and the end of all tracks.
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

// Of what the machine file says, which must have been checked (build.h). Index i is track i of the machine.
// What movers do on a track.
struct Usage {
  std::uint32_t movers = 0;             // on it, with those that join
  bool moves = false;                   // along it, or over it on their way
  bool configures = false;              // joins or leaves
  std::uint32_t one = planar::kNobody;  // of them: who moves, joins or leaves rather than who stands
};

struct Tracks {
  // On these parts, which must live as long; null: there are none.
  explicit Tracks(const std::vector<TrackParams>& params, const planar::Parts* parts = nullptr);
  ~Tracks();
  Tracks(const Tracks&) = delete;
  Tracks& operator=(const Tracks&) = delete;

  void SetSketch(std::size_t track, const Sketch& sketch) noexcept;

  // Where one is along a track that has a way, in the coordinate system where it is now; and where its part is.
  planar::TrackPoint At(std::size_t track, double s) const noexcept;
  const planar::Spot& spot(std::size_t track) const noexcept;
  // Where its part is to be: as of there it is linked with others.
  const planar::Spot& goal(std::size_t track) const noexcept;

  std::vector<TrackParams> params;
  const planar::Parts& parts;
  std::vector<std::uint32_t> part_of;  // by track
  std::vector<State> states;
  std::vector<Sketch> sketches;  // what each is given by; the states have their hashes
  std::vector<Outputs> outputs;
  PendingEdits works;

  // What follows from the states.
  std::vector<const planar::Track*> ways;  // null: none, then the length is 0
  std::vector<planar::TrackArea*> areas;   // what movers on it may cover; null: none
  // Where tracks are linked: ends and starts at one point have one number, below twice that of tracks.
  std::vector<std::uint32_t> start_nodes;
  std::vector<std::uint32_t> end_nodes;
  std::vector<std::uint32_t> starts_at;  // by node: so many tracks
  std::vector<std::uint32_t> ends_at;
  std::uint64_t changes = 0;          // of ways and links, counted
  std::vector<std::uint8_t> reached;  // by track: scratch of a search through links
  std::vector<Usage> usages;          // of each

  BuildQueues desk;
  bool sent = false;  // the question has found room in the queue
};

struct Context {
  Tracks& tracks;
  planar::GroupRegistry& grounds;
  Cycle cycle;
  FeedbackSink& feedback;
};

// Events that one cycle may report besides those of the commands that come in it.
constexpr std::size_t EventsOf(std::size_t tracks) {
  return tracks == 0 ? 0 : 2 * tracks + 2 * kOrders;
}

// command: carries it out, puts it into the works, or refuses it.
void Apply(const Context& c, std::size_t track, Ticket ticket, const Command& command) noexcept;

// A fault of a track: of whatever happens on it.
void Fail(const Context& c, std::size_t track, ErrorId error, ErrorReaction reaction) noexcept;

void Use(const Usage& usage, std::size_t track, Tracks& tracks) noexcept;

// move: before the movers.
void Step(const Context& c) noexcept;

void Publish(const Context& c) noexcept;

std::optional<std::size_t> Find(const Tracks& tracks, std::string_view name) noexcept;

}  // namespace takt::track
