// One part of the surface that movers float on, stage by stage of the cycle. Free functions over plain state; nothing
// here allocates, locks, throws or reads a clock.
//
// It is enabled as long as a mover in its coordinate system is, unless that is forbidden or it has a fault. Where it
// is, it is told: commanded to another position, it is nowhere until that is reported.
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

// What is reported of it, at the beginning of a cycle.
struct Inputs {
  std::uint32_t position = 1;  // index of the position where it is, from 1; 0: none
  bool fault = false;
};

// What a simulated part reports after this cycle: it is where it is to be, or nowhere for as long as it takes to get
// there.
Inputs Simulate(const Context& c, const State& s) noexcept;

// What keeps it from going to another position.
struct Hindrance {
  ErrorId error = ErrorId::kNone;
  ObjectInfo object{};  // the mover, track or part
};

// command: carries it out or refuses it; reports either way. `hindrance`: of activate_position.
void Apply(const Context& c, Ticket ticket, const Command& command, const Hindrance& hindrance, State& s) noexcept;

// What it has to know about movers.
struct Around {
  bool wanted = false;        // one in its coordinate system is enabled
  bool reset = false;         // one of those is being reset
  bool movers_rest = true;    // those on it do
  bool movers_failed = true;  // and the reaction of those with a fault is over
};
// move: before the movers. Whether it is where it is to be. True: it is somewhere else now than it was.
bool Arrive(const Context& c, const Inputs& inputs, State& s) noexcept;
// Behind that.
void Step(const Context& c, const Around& around, State& s) noexcept;

void Fail(const Context& c, ErrorId error, State& s) noexcept;

void Publish(const planar::Spot& spot, std::uint32_t movers, const State& s, Outputs& out) noexcept;

void describe(Description<Inputs>&);

}  // namespace takt::part
