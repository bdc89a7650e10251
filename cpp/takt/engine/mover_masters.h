// Masters across component kinds: axes for movers; movers and belts for axes.
#pragma once

#include <cstdint>

#include "takt/engine/world.h"

namespace takt::engine {

// Fills the tables of masters; called once, when a world is made.
void NameMasters(World& world);
// Before movers step: passes the states of axes at the end of this cycle to movers.
void ShowAxesToMovers(World& world) noexcept;
// After that: passes the states of movers to axes.
void ShowMovers(World& world) noexcept;

// After each belt has stepped: passes its travel to axes.
void ShowBelt(World& world, std::uint32_t belt) noexcept;

// Returns the axis that must step before the followers of this master (numbered as by axis::FindMaster): the axis
// itself, the axis of a belt, or the common number of all movers; kNoAxis if none.
std::uint32_t StepsBefore(const World& world, std::uint32_t master) noexcept;

// Returns the axis that a mover would follow by this command; kNoAxis if none.
std::uint32_t AxisFollowedBy(const World& world, const mover::Command& command) noexcept;

}  // namespace takt::engine
