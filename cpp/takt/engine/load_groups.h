// The groups of axes of a machine file and the paths for them: reads their files, checks them.
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

// Puts what stands in files (URDF, paths as CSV) into the machine. A file's path counts from the machine file's folder.
// kMake: what knows whether paths are free is made, too, unless no files may be opened.
GroupLoading LoadGroups(const SourceMap& source, Machine& machine, Workspaces workspaces, Files files);

}  // namespace takt::engine
