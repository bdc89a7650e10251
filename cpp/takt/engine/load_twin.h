// The section `twin` of a machine file: checks its names and the data it needs for each axis. Whether a model fits is
// checked with the model (takt.twin).
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/machine.h"

namespace takt::engine {

std::vector<Problem> CheckTwin(const SourceMap& source, const Machine& machine);

}  // namespace takt::engine
