// The groups of axes of a machine file and their paths: reads their files and checks them.
#pragma once

#include <vector>

#include "takt/core/problem.h"
#include "takt/engine/checkers.h"
#include "takt/engine/load.h"
#include "takt/engine/machine.h"

namespace takt::engine {

struct GroupLoading {
  std::vector<Problem> problems;
  bool files = false;  // something came from a file
  Checkers checkers{};
};

// Puts the contents of files (URDF, paths as CSV) into the machine. Paths are relative to the folder of the machine
// file. kMake: also makes the collision checkers, unless files may not be opened.
GroupLoading LoadGroups(const SourceMap& source, Machine& machine, Workspaces workspaces, Files files);

}  // namespace takt::engine
