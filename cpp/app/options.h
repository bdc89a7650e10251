// The command line of taktd.
#pragma once

#include <optional>
#include <string>

#include "takt/engine/scheduler.h"

namespace takt::app {

enum class Task { kRun, kCheck, kSchema, kReference };

struct Options {
  Task task = Task::kRun;
  std::string machine_file;
  std::optional<double> cycle_time_s;   // instead of the machine file's
  std::optional<std::string> lcm_url;   // likewise
  std::optional<std::string> key_file;  // instead of the environment's
  bool lcm = true;
  std::string log_file;  // empty: none
  engine::SchedulerOptions scheduler;
};

// Empty: there is nothing to run (--help, --version, or a mistake, which is on stderr), and `exit_code` is set.
std::optional<Options> ParseOptions(int argc, char** argv, int& exit_code);

}  // namespace takt::app
