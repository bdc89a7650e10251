// The machine taktd runs: as its file says, and what the command line says instead.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "takt/engine/checkers.h"
#include "takt/engine/machine.h"
#include "takt/lcm/key.h"

namespace takt::app {

struct MachineFile {
  std::optional<engine::Machine> machine;  // empty: see problems
  std::string text;                        // as it was read; with files it names written out
  std::string url;                         // the LCM network it runs on; empty: none
  std::optional<lcm::Keys> keys;           // one of which commands must carry; empty: anyone may command
  engine::Checkers checkers;               // of its groups
  std::vector<std::string> problems;       // one line each
  std::vector<std::string> warnings;       // likewise
};

MachineFile ReadMachineFile(const Options& options);

}  // namespace takt::app
