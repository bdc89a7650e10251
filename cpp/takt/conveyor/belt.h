// The stages of a belt in the cycle: free functions over plain state that do not allocate, lock, throw or read a clock.
#pragma once

#include "takt/axis/axis.h"
#include "takt/conveyor/commands.h"
#include "takt/conveyor/objects.h"
#include "takt/conveyor/outputs.h"
#include "takt/conveyor/params.h"
#include "takt/conveyor/state.h"
#include "takt/core/cycle.h"
#include "takt/core/feedback.h"

namespace takt::conveyor {

// The context of every stage.
struct Context {
  const BeltParams& params;
  const axis::State& axis;
  const axis::AxisParams& axis_params;
  Cycle cycle;
  FeedbackSink& feedback;
};

// Stage Apply: carries the command out or refuses it, and reports either. "Now" is the end of the previous cycle.
void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept;

// Stage Move: after the axis if its set position is used, before all axes if the measured one is; before the groups
// that ride on the belt. Objects that have left the range are deleted.
void Step(const Context& c, State& s) noexcept;

// Returns the belt's travel at which its axis shows this position [u]; of an axis with a modulus: the most recent one.
double TravelAt(const Context& c, const State& s, double position) noexcept;

void Publish(const Context& c, const State& s, Outputs& out) noexcept;

}  // namespace takt::conveyor
