// Everything in a machine that can carry a workpiece: belts, then the tools of groups, then poses.
#pragma once

#include "takt/engine/world.h"
#include "takt/group/carriers.h"

namespace takt::engine {

// Returns the carriers as this group sees them; `rider` must outlive them. Numbers: belts from 1, then groups, then
// poses.
group::Carriers CarriersFor(Rider& rider) noexcept;

// Returns true if the tool of the group has no pose after this command, or jumps by it.
bool TakesToolAway(const group::Command& command) noexcept;
// Returns true if another group rides, or has a queued motion, on the tool of this group.
bool IsRidden(const World& w, std::size_t group) noexcept;

}  // namespace takt::engine
