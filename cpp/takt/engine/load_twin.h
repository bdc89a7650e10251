// The section `twin` of a machine file: its names, and what it must say of each axis. Whether a model fits is judged
// where the model is (takt.twin).
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/machine.h"

namespace takt::engine {

std::vector<Problem> CheckTwin(const SourceMap& source, const Machine& machine);

}  // namespace takt::engine
