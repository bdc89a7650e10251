// From steps to legs with times: the order in which movers visit each place stays, steps straight on are merged into
// runs, and each run departs as early as those before it in its places allow.
#pragma once

#include <optional>
#include <vector>

#include "takt/routing/steps.h"
#include "takt/routing/timetable.h"

namespace takt::routing {

// Returns the legs by mover. Steps of FindSteps and SwapTargets always have them; nothing: those of somebody else's
// cannot be carried out by movers that need a place to be left before they enter it.
std::optional<std::vector<Legs>> Compose(const Grid& grid, const std::vector<Configuration>& steps);

}  // namespace takt::routing
