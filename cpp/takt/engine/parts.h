// Parts of the surface and what is on them: who has to rest before a part goes, and goes with it; and the states that
// movers and parts force on each other (PL-32).
#pragma once

#include <cstddef>

#include "takt/engine/world.h"

namespace takt::engine {

// command: carries it out or refuses it.
void ApplyToPart(World& world, std::size_t part, Ticket ticket, const part::Command& command) noexcept;

// move: before tracks and movers.
void StepParts(World& world) noexcept;

void PublishParts(World& world) noexcept;

// actuate: what ideal parts report in the next cycle, or broken ones.
void SimulateParts(World& world) noexcept;

}  // namespace takt::engine
