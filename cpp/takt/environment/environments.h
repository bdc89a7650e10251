// All environments of a machine, stage by stage of the cycle. Nothing here allocates, locks, throws or reads a clock,
// but for the making and the end of all.
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
  std::uint64_t stator_hash = 0;  // of the stators, which change rarely and are many
  std::uint32_t border_count = 0;
  std::uint64_t asked = 0;  // number of the question whose answer is awaited; 0: none
  Ticket ticket = 0;        // of the command that asked
};

// Of what the machine file says, which must have been checked. Index i is environment i of the machine.
struct Environments {
  explicit Environments(const std::vector<EnvironmentParams>& params);
  ~Environments();
  Environments(const Environments&) = delete;
  Environments& operator=(const Environments&) = delete;

  std::vector<State> states;
  std::vector<std::vector<planar::Place>> stators;  // the states have their hashes
  std::vector<Outputs> outputs;
  std::uint64_t questions = 0;  // so many have been asked

  // What follows from the states.
  std::vector<const planar::Environment*> surfaces;  // null: no boundary

  BuildQueues desk;
};

struct Context {
  Environments& environments;
  planar::GroupRegistry& grounds;
  Cycle cycle;
  FeedbackSink& feedback;
};

// command: carries it out, has it made, or refuses it.
void Apply(const Context& c, std::size_t environment, Ticket ticket, const Command& command) noexcept;

void Publish(const Context& c) noexcept;

// What a feedback that ends with kStators has as its value, and what that says.
double ToValue(planar::StatorProblem problem, std::uint32_t stator) noexcept;
planar::StatorProblem ProblemOf(double value) noexcept;
std::uint32_t StatorOf(double value) noexcept;  // from 1; 0: none

void describe(Description<State>&);

}  // namespace takt::environment
