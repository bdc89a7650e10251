// Field buses of a machine file: checks them, and makes external drives of their axes.
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/machine.h"

namespace takt::engine {

std::vector<Problem> CheckBuses(const SourceMap& source, const Machine& machine);

// Axes on buses become external drives, those that are listed as such already excepted.
void AddDrivesOfBuses(Machine& machine);

}  // namespace takt::engine
