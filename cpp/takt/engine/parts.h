// Parts of the surface and the movers on them: which movers must be at rest before a part moves and travel with it, and
// the states that movers and parts force on each other (PL-32).
#pragma once

#include <cstddef>

#include "takt/engine/world.h"

namespace takt::engine {

// Stage Apply: carries the command out or refuses it.
void ApplyToPart(World& world, std::size_t part, Ticket ticket, const part::Command& command) noexcept;

// Stage Move: before tracks and movers.
void StepParts(World& world) noexcept;

void PublishParts(World& world) noexcept;

// Stage Actuate: computes what simulated parts, ideal or with faults, report in the next cycle.
void SimulateParts(World& world) noexcept;

}  // namespace takt::engine
