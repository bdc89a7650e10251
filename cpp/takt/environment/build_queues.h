// Where the cycle has boundaries made, as it has tracks made (track/build_queues.h).
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
  std::uint32_t environment = 0;                        // from 0
  const std::vector<planar::Place>* stators = nullptr;  // they stay as they are until the answer is taken
};

struct Delivery {
  std::uint64_t number = 0;  // of the question
  const planar::Environment* surface = nullptr;
};

struct BuildQueues {
  explicit BuildQueues(std::size_t environments)
      : questions(environments + 1), deliveries(environments + 1), retired(2 * environments + 2) {}
  ~BuildQueues();
  BuildQueues(const BuildQueues&) = delete;
  BuildQueues& operator=(const BuildQueues&) = delete;

  SpscQueue<BuildRequest> questions;  // one of each environment at a time
  SpscQueue<Delivery> deliveries;
  SpscQueue<const planar::Environment*> retired;
};

// Outside the cycle, one thread: answers the next question. Frees what is retired.
struct BuiltBoundary {
  std::uint32_t environment = 0;
  BoundaryMade made;
};
std::optional<BuiltBoundary> Make(BuildQueues& desk);

}  // namespace takt::environment
