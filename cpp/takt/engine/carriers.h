// What can carry something in a machine: its belts, then the tools of its groups, then poses.
#pragma once

#include "takt/engine/world.h"
#include "takt/group/carriers.h"

namespace takt::engine {

// As this group sees them; `rider` must live on. Belts are numbered from 1, groups and poses go on from there.
group::Carriers CarriersFor(Rider& rider) noexcept;

}  // namespace takt::engine
