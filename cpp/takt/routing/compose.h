// From steps to legs with times: the order in which movers visit each place is kept, consecutive steps in one direction
// are merged into runs, and each run departs as early as the preceding visits of its places allow.
#pragma once

#include <optional>
#include <vector>

#include "takt/routing/steps.h"
#include "takt/routing/timetable.h"

namespace takt::routing {

// Returns the legs by mover; nothing if the steps cannot be executed by movers that enter a place only after it has
// been left. Steps of FindSteps and SwapTargets always can.
std::optional<std::vector<Legs>> Compose(const Grid& grid, const std::vector<Configuration>& steps);

}  // namespace takt::routing
