// The cams of a machine file: reads their files and checks them.
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/load.h"
#include "takt/engine/machine.h"

namespace takt::engine {

struct CamLoading {
  std::vector<Problem> problems;
  std::vector<Problem> warnings;
  bool files = false;  // at least one cam came from a file
};

// Puts the points of files into the machine. Paths are relative to the folder of the machine file.
CamLoading LoadCams(const SourceMap& source, Machine& machine, Files files);

}  // namespace takt::engine
