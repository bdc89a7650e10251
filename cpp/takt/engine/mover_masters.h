// Movers that follow axes, and axes and movers that follow movers; belts that axes follow.
#pragma once

#include <cstdint>

#include "takt/engine/world.h"

namespace takt::engine {

// Once, when a world is made.
void NameMasters(World& world);
// Before movers step: where axes are at the end of this cycle.
void ShowAxesToMovers(World& world) noexcept;
// Behind that: where movers are then.
void ShowMovers(World& world) noexcept;

// Behind each belt: where it is then.
void ShowBelt(World& world, std::uint32_t belt) noexcept;

// The axis that has to step before what follows this master (numbered as axis::FindMaster does): itself, that of a
// belt, or for movers the number of all of them; kNoAxis: none.
std::uint32_t StepsBefore(const World& world, std::uint32_t master) noexcept;

// The axis that a mover would follow by this command; kNoAxis: none.
std::uint32_t AxisFollowedBy(const World& world, const mover::Command& command) noexcept;

}  // namespace takt::engine
