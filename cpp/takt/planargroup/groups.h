// All groups of movers of a machine, with one function for each stage of the cycle: their states. Their members and
// reservations are in planar/group_registry.h, which movers query. Nothing here allocates, locks, throws or reads a
// clock, except construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/planar/group_registry.h"
#include "takt/planargroup/commands.h"
#include "takt/planargroup/outputs.h"

namespace takt::planargroup {

struct State {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  std::uint64_t since = 0;  // cycle in which the state was entered
  Ticket ticket = 0;        // of the command that changes the state; 0: none
  ErrorId error = ErrorId::kNone;
  bool aborts = false;  // a reset leads to Disabled
};

// Index i is group i of the machine.
struct Groups {
  explicit Groups(std::size_t count) : states(count), outputs(count) {}

  std::vector<State> states;
  std::vector<Outputs> outputs;
};

struct Context {
  Groups& groups;
  planar::GroupRegistry& grounds;
  Cycle cycle;
  FeedbackSink& feedback;
};

// Largest number of events in one cycle, besides those of its commands.
constexpr std::size_t EventsOf(std::size_t groups) {
  return 2 * groups;
}

// Stage command: carries it out or rejects it.
void Apply(const Context& c, std::size_t group, Ticket ticket, const Command& command) noexcept;

// Starts the reaction of a group to a fault; ignored during a reaction or a reset. The group drops its reservations and
// refuses nothing any more.
void Fail(const Context& c, std::size_t group, ErrorId error, bool aborts) noexcept;

// Stage move: after the movers.
void Step(const Context& c) noexcept;

void Publish(const Context& c) noexcept;

void describe(Description<State>&);

}  // namespace takt::planargroup
