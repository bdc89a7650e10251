// Queues by which the cycle has boundaries built, like track/build_queues.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "takt/core/spsc_queue.h"
#include "takt/environment/commands.h"
#include "takt/planar/environment.h"

namespace takt::environment {

struct BuildRequest {
  std::uint64_t number = 0;
  std::uint32_t environment = 0;                        // index, from 0
  const std::vector<planar::Place>* stators = nullptr;  // unchanged until the answer is taken
};

struct Delivery {
  std::uint64_t number = 0;  // of the request
  const planar::Environment* surface = nullptr;
};

struct BuildQueues {
  explicit BuildQueues(std::size_t environments)
      : questions(environments + 1), deliveries(environments + 1), retired(2 * environments + 2) {}
  ~BuildQueues();
  BuildQueues(const BuildQueues&) = delete;
  BuildQueues& operator=(const BuildQueues&) = delete;

  SpscQueue<BuildRequest> questions;  // one for each environment at a time
  SpscQueue<Delivery> deliveries;
  SpscQueue<const planar::Environment*> retired;
};

// To be called outside the cycle, by one thread: answers the next request, and frees retired objects. Nothing if there
// is no request.
struct BuiltBoundary {
  std::uint32_t environment = 0;
  BoundaryMade made;
};
std::optional<BuiltBoundary> Make(BuildQueues& desk);

}  // namespace takt::environment
