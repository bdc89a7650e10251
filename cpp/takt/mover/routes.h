// Commands that give movers routes over the free surface, and start them at once.
#pragma once

#include <cstdint>

#include "takt/mover/follow_route.h"
#include "takt/planar/group_registry.h"

namespace takt::mover {

// command: movers begin what they were told, or none: the answer says why.
planar::Verdict Start(const Everyone& all, const StartRoutes& command) noexcept;
planar::Verdict Hold(const Everyone& all, const HoldRoutes& command) noexcept;

std::uint64_t HashOf(const SurfaceRoutes& routes, std::uint64_t hash) noexcept;

}  // namespace takt::mover
