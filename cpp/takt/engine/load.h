// Reads and checks a machine file: all problems in one run, nothing is started.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/engine/machine.h"

namespace takt::engine {

struct LoadResult {
  std::optional<Machine> machine;
  std::vector<std::string> problems;  // "file:line:column: key.path: expected ..., found ..."
  std::vector<std::string> warnings;  // in the same form; nothing that hinders
  bool names_files = false;           // the text alone does not say everything; WriteYaml(machine) does
};

LoadResult LoadMachine(std::string_view text, std::string_view file_name);
// Reads the file; a problem when it cannot be read.
LoadResult LoadMachineFile(const std::string& path);

}  // namespace takt::engine
