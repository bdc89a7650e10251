// Coordinate systems and parts of a machine file: checks them, and the initial positions of movers on them.
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/machine.h"

namespace takt::engine {

// If it returns no problems, the parts can be made (part::Make).
std::vector<Problem> CheckParts(const SourceMap& source, const Machine& machine);

}  // namespace takt::engine
