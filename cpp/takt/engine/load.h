// Reads and checks a machine file: all problems in one run, nothing is started.
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
  std::vector<std::string> warnings;  // in the same form; nothing that hinders
  // The text alone does not say everything; WriteYaml(machine) does, but for the meshes of workspaces.
  bool names_files = false;
  Checkers checkers{};
};

// kSkip: for whoever never asks whether a path is free, and may not have the files of meshes.
enum class Workspaces : std::uint8_t { kMake, kSkip };

// kRefuse: the text is from a network or a log. None of the files that it names is opened; to name one is a problem.
enum class Files : std::uint8_t { kOpen, kRefuse };

// What is wrong with naming it.
std::string NotOpened(const std::string& file);

LoadResult LoadMachine(std::string_view text, std::string_view file_name, Workspaces workspaces = Workspaces::kMake,
                       Files files = Files::kOpen);
// Reads the file; a problem when it cannot be read.
LoadResult LoadMachineFile(const std::string& path);

}  // namespace takt::engine
