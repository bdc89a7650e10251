// All environments of a machine, with one function for each stage of the cycle. Nothing here allocates, locks, throws
// or reads a clock, except construction and destruction of Environments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/environment/build_queues.h"
#include "takt/environment/commands.h"
#include "takt/environment/outputs.h"
#include "takt/environment/params.h"
#include "takt/planar/group_registry.h"

namespace takt::environment {

struct State {
  std::uint32_t stator_count = 0;
  std::uint64_t stator_hash = 0;  // of the stators, which are many and rarely change
  std::uint32_t border_count = 0;
  std::uint64_t asked = 0;  // number of the request whose answer is awaited; 0: none
  Ticket ticket = 0;        // of the command that made the request
};

// Requires: the parameters have been checked. Index i is environment i of the machine.
struct Environments {
  explicit Environments(const std::vector<EnvironmentParams>& params);
  ~Environments();
  Environments(const Environments&) = delete;
  Environments& operator=(const Environments&) = delete;

  std::vector<State> states;
  std::vector<std::vector<planar::Place>> stators;  // the states contain their hashes
  std::vector<Outputs> outputs;
  std::uint64_t questions = 0;  // number of requests so far

  // Derived from the states.
  std::vector<const planar::Environment*> surfaces;  // null: no boundary

  BuildQueues desk;
};

struct Context {
  Environments& environments;
  planar::GroupRegistry& grounds;
  Cycle cycle;
  FeedbackSink& feedback;
};

// Stage command: carries it out, requests a boundary, or rejects it.
void Apply(const Context& c, std::size_t environment, Ticket ticket, const Command& command) noexcept;

void Publish(const Context& c) noexcept;

// Conversion to and from the value of a feedback that ends with kStators.
double ToValue(planar::StatorProblem problem, std::uint32_t stator) noexcept;
planar::StatorProblem ProblemOf(double value) noexcept;
std::uint32_t StatorOf(double value) noexcept;  // from 1; 0: none

void describe(Description<State>&);

}  // namespace takt::environment
