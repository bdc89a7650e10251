// Where the cycle has tracks made. It puts what a track is to be into a queue; whoever works outside the cycle makes
// the track, hands it over and answers with the command TrackMade. What is not used any more goes back to be freed. A
// replay takes the answer from the journal and makes the track once more: it depends on nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "takt/core/spsc_queue.h"
#include "takt/planar/parts.h"
#include "takt/planar/track_area.h"
#include "takt/track/commands.h"
#include "takt/track/sketch.h"

namespace takt::track {

struct BuildRequest {
  std::uint64_t number = 0;
  std::uint32_t track = 0;               // from 0
  std::uint32_t part = planar::kNoPart;  // that it lies on
  planar::Footprint mover{};             // the largest one
  Sketch sketch;
};

struct Delivery {
  std::uint64_t number = 0;  // of the question
  const planar::Track* way = nullptr;
  planar::TrackArea* area = nullptr;  // what movers on it may cover
};

struct BuildQueues {
  BuildQueues(std::size_t tracks, const planar::Parts& of_parts) : parts(of_parts), retired(2 * tracks + 8) {}
  ~BuildQueues();
  BuildQueues(const BuildQueues&) = delete;
  BuildQueues& operator=(const BuildQueues&) = delete;

  const planar::Parts& parts;            // of which only the shapes are looked at: they never change
  SpscQueue<BuildRequest> questions{2};  // one at a time
  SpscQueue<Delivery> deliveries{8};
  SpscQueue<Delivery> retired;
};

// Outside the cycle, one thread: answers the next question. Frees what is retired.
struct BuiltTrack {
  std::uint32_t track = 0;
  TrackMade made;
};
std::optional<BuiltTrack> Make(BuildQueues& desk);

}  // namespace takt::track
