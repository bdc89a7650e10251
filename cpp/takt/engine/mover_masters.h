// Movers that follow axes, and axes and movers that follow movers.
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

// The axis that a mover would follow by this command; kNoAxis: none.
std::uint32_t AxisFollowedBy(const World& world, const mover::Command& command) noexcept;

}  // namespace takt::engine
