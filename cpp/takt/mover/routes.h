// Commands that give movers routes over the free surface, and start and hold them together.
#pragma once

#include <cstdint>

#include "takt/mover/follow_route.h"
#include "takt/planar/group_registry.h"

namespace takt::mover {

// Cycle stage command. Start begins the routes that movers have received, all of them or none, and returns why not;
// Hold brings movers to rest at places of their routes, or continues these.
planar::Verdict Start(const RoutedMovers& all, const StartRoutes& command) noexcept;
planar::Verdict Hold(const RoutedMovers& all, const HoldRoutes& command) noexcept;

std::uint64_t HashOf(const SurfaceRoutes& routes, std::uint64_t hash) noexcept;

}  // namespace takt::mover
