// Reads and checks a machine file: reports all problems in one run, starts nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "takt/engine/checkers.h"
#include "takt/engine/machine.h"

namespace takt::engine {

struct LoadResult {
  std::optional<Machine> machine;
  std::vector<std::string> problems;  // "file:line:column: key.path: expected ..., found ..."
  std::vector<std::string> warnings;  // in the same form; they do not prevent loading
  // The text names other files, so it is not complete by itself; WriteYaml(machine) is, except for the meshes of
  // workspaces.
  bool names_files = false;
  Checkers checkers{};
};

// kSkip: for callers that never check paths, and may not have the mesh files.
enum class Workspaces : std::uint8_t { kMake, kSkip };

// kRefuse: the text comes from a network or a log. No file that it names is opened; naming one is a problem.
enum class Files : std::uint8_t { kOpen, kRefuse };

// Returns the message for a file that was not opened.
std::string NotOpened(const std::string& file);

LoadResult LoadMachine(std::string_view text, std::string_view file_name, Workspaces workspaces = Workspaces::kMake,
                       Files files = Files::kOpen);
// Reads and checks the file; a file that cannot be read is a problem.
LoadResult LoadMachineFile(const std::string& path);

}  // namespace takt::engine
