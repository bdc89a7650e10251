// All groups of movers of a machine, stage by stage of the cycle: whether they watch. What they watch is the ground
// (planar/group_registry.h), which movers ask. Nothing here allocates, locks, throws or reads a clock, but for the
// making.
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
  std::uint64_t since = 0;  // cycle in which it became so
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

// Events that one cycle may report besides those of the commands that come in it.
constexpr std::size_t EventsOf(std::size_t groups) {
  return 2 * groups;
}

// command: carries it out or refuses it.
void Apply(const Context& c, std::size_t group, Ticket ticket, const Command& command) noexcept;

// A fault of a group. It does not watch any more.
void Fail(const Context& c, std::size_t group, ErrorId error, bool aborts) noexcept;

// move: behind the movers.
void Step(const Context& c) noexcept;

void Publish(const Context& c) noexcept;

void describe(Description<State>&);

}  // namespace takt::planargroup
