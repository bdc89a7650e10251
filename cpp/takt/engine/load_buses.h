// Field buses of a machine file: checks them, and makes their axes' drives external drives.
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/machine.h"

namespace takt::engine {

std::vector<Problem> CheckBuses(const SourceMap& source, const Machine& machine);

// Adds the axes on buses to the external drives, except those that are listed there already.
void AddDrivesOfBuses(Machine& machine);

}  // namespace takt::engine
