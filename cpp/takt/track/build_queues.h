// Queues by which the cycle has tracks built. The cycle requests a track; a thread outside the cycle builds it,
// delivers it and answers with the command TrackMade. Objects no longer in use return to be freed. A replay takes the
// answer from the journal and builds the track again: the result depends on nothing else.
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
  std::uint32_t track = 0;               // index, from 0
  std::uint32_t part = planar::kNoPart;  // part that it lies on
  planar::Footprint mover{};             // largest mover on it
  Sketch sketch;
};

struct Delivery {
  std::uint64_t number = 0;  // of the request
  const planar::Track* way = nullptr;
  planar::TrackArea* area = nullptr;  // area that movers on it may cover
};

struct BuildQueues {
  BuildQueues(std::size_t tracks, const planar::Parts& of_parts) : parts(of_parts), retired(2 * tracks + 8) {}
  ~BuildQueues();
  BuildQueues(const BuildQueues&) = delete;
  BuildQueues& operator=(const BuildQueues&) = delete;

  const planar::Parts& parts;            // only their shapes are read, which never change
  SpscQueue<BuildRequest> questions{2};  // one at a time
  SpscQueue<Delivery> deliveries{8};
  SpscQueue<Delivery> retired;
};

// To be called outside the cycle, by one thread: answers the next request, and frees retired objects. Nothing if there
// is no request.
struct BuiltTrack {
  std::uint32_t track = 0;
  TrackMade made;
};
std::optional<BuiltTrack> Make(BuildQueues& desk);

}  // namespace takt::track
