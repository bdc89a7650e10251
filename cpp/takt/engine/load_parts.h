// Coordinate systems and parts of a machine file: checks them, and where movers stand on them at the start.
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/machine.h"

namespace takt::engine {

// Without problems the parts can be made (part::Make).
std::vector<Problem> CheckParts(const SourceMap& source, const Machine& machine);

}  // namespace takt::engine
