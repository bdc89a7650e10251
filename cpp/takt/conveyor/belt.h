// One belt, stage by stage of the cycle. Free functions over plain state; nothing here allocates, locks, throws or
// reads a clock.
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

// What every stage gets besides the belt itself.
struct Context {
  const BeltParams& params;
  const axis::State& axis;
  const axis::AxisParams& axis_params;
  Cycle cycle;
  FeedbackSink& feedback;
};

// command: carries it out or refuses it; reports either way. "Now" is the end of the cycle before.
void Apply(const Context& c, Ticket ticket, const Command& command, State& s) noexcept;

// move: behind the axis if its set position counts, before all axes if the measured one does; before whoever rides on
// the belt. Objects that have left the range are deleted.
void Step(const Context& c, State& s) noexcept;

// The belt's travel when its axis shows this position [u]; of an axis with a modulus: the last time it did.
double TravelAt(const Context& c, const State& s, double position) noexcept;

void Publish(const Context& c, const State& s, Outputs& out) noexcept;

}  // namespace takt::conveyor
