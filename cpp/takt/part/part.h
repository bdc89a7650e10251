// One part of the surface that movers float on, with one function for each stage of the cycle. Free functions over
// plain state; nothing here allocates, locks, throws or reads a clock.
//
// It is enabled while a mover in its coordinate system is enabled, unless that is forbidden or it has a fault. Its
// position is reported to it: after a command to another position it is away until that position is reported.
#pragma once

#include <cstdint>

#include "takt/core/cycle.h"
#include "takt/core/feedback.h"
#include "takt/core/object.h"
#include "takt/part/commands.h"
#include "takt/part/outputs.h"
#include "takt/part/params.h"
#include "takt/part/state.h"

namespace takt::part {

struct Context {
  const PartParams& params;
  Cycle cycle;
  FeedbackSink& feedback;
};

// Reported inputs of a part, at the beginning of a cycle.
struct Inputs {
  std::uint32_t position = 1;  // index of its position, from 1; 0: at none
  bool fault = false;
};

// Returns the report of a simulated part after this cycle: at its commanded position, or at none during the travel
// time.
Inputs Simulate(const Context& c, const State& s) noexcept;

// The reason why a part may not leave for another position.
struct MoveBlocker {
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};  // the mover, track or part in the way
};

// Stage command: carries it out or rejects it; reports either way. `hindrance`: of ActivatePosition.
void Apply(const Context& c, Ticket ticket, const Command& command, const MoveBlocker& hindrance, State& s) noexcept;

// State of the movers around a part.
struct Around {
  bool wanted = false;        // an enabled mover in its coordinate system needs it
  bool reset = false;         // a mover in its coordinate system is being reset
  bool movers_rest = true;    // all movers on it or moving over it are at rest; valid while it is Disabling
  bool movers_failed = true;  // none of them is still reacting to a fault; valid while it is ErrorPending
};
// Stage move, before the movers: reads the reported position. Returns true if the position has changed.
bool Arrive(const Context& c, const Inputs& inputs, State& s) noexcept;
// Stage move, after Arrive: updates the state.
void Step(const Context& c, const Around& around, State& s) noexcept;

void Fail(const Context& c, ErrorId error, State& s) noexcept;

void Publish(const planar::Spot& spot, std::uint32_t movers, const State& s, Outputs& out) noexcept;

void describe(Description<Inputs>&);

}  // namespace takt::part
