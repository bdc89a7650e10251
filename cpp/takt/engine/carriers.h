// What can carry something in a machine: its belts, then the tools of its groups, then poses.
#pragma once

#include "takt/engine/world.h"
#include "takt/group/carriers.h"

namespace takt::engine {

// As this group sees them; `rider` must live on. Belts are numbered from 1, groups and poses go on from there.
group::Carriers CarriersFor(Rider& rider) noexcept;

// A command of a group after which its tool is nowhere, or elsewhere by a jump.
bool TakesToolAway(const group::Command& command) noexcept;
// Whether another group rides on the tool of this one.
bool IsRidden(const World& w, std::size_t group) noexcept;

}  // namespace takt::engine
