#include "app/options.h"

#include <sched.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <map>

#include "takt/lcm/network.h"

namespace takt::app {

namespace {

constexpr char kExitCodes[] =
    "Exit codes: 0 ended in order; 1 the log is incomplete; 2 wrong options or machine file, or no network or log;\n"
    "130 ended at once by a second signal.";

std::string IsDuration(const std::string& text) {
  double seconds = 0;
  const bool read = CLI::detail::lexical_cast(text, seconds);
  return read && seconds > 0 && std::isfinite(seconds) ? "" : "expected seconds > 0, found " + text;
}

std::string IsCpu(const std::string& text) {
  int cpu = 0;
  const bool read = CLI::detail::lexical_cast(text, cpu);
  return read && cpu >= 0 && cpu < CPU_SETSIZE ? "" : "expected the number of a CPU from 0 on, found " + text;
}

}  // namespace

std::optional<Options> ParseOptions(int argc, char** argv, int& exit_code) {
  using engine::Pace;
  Options options;
  engine::SchedulerOptions& run = options.scheduler;
  std::string pace = "real";
  bool no_lcm = false, check = false, schema = false, reference = false;

  CLI::App cli("Real-time motion engine: runs the machine a machine file describes.", "taktd");
  cli.footer(kExitCodes);
  cli.set_version_flag("--version", TAKT_VERSION);
  cli.add_option("machine", options.machine_file, "Machine file (YAML)");
  cli.add_option("--cycle-time", options.cycle_time_s,
                 "Length of a cycle, 250us to 20ms; a plain number is in seconds [machine file]")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}}));
  cli.add_option("--pace", pace,
                 "real: real time; paced: simulated at the wall clock's pace; fast: as fast as possible [real]")
      ->check(CLI::IsMember({"real", "paced", "fast"}))
      ->option_text("real|paced|fast");
  cli.add_option("--duration", run.duration_s, "Seconds of machine time, then stop [until SIGINT]")->check(IsDuration);
  auto* url = cli.add_option("--lcm-url", options.lcm_url, "LCM network [machine file, LCM_DEFAULT_URL]")
                  ->check(lcm::WhyNotUrl);
  auto* key =
      cli.add_option(
             "--key", options.key_file,
             "Hear only holders of the key in this file, which takt key new FILE makes [TAKT_KEY_FILE, else none]")
          ->option_text("FILE");
  cli.add_flag("--no-lcm", no_lcm, "Neither publish nor listen")->excludes(url)->excludes(key);
  cli.add_option("--log", options.log_file, "Record everything of every cycle, and the journal, into this LCM log")
      ->option_text("FILE");
  cli.add_option("--cpu", run.cpu, "CPU to keep to, real time only [any]")->check(IsCpu);
  cli.add_option("--priority", run.priority, "Of the real-time thread, 1 to 99 [80]")->check(CLI::Range(1, 99));
  auto* tasks = cli.add_option_group("instead of running");
  tasks->add_flag("--check", check, "Say everything that is wrong with the machine file, or ok");
  tasks->add_flag("--schema", schema, "Print the JSON Schema of machine files");
  tasks->add_flag("--reference", reference, "Print everything that is described, as JSON");
  tasks->require_option(0, 1);

  try {
    cli.parse(argc, argv);
    if (options.machine_file.empty() && !schema && !reference) throw CLI::RequiredError("machine");
  } catch (const CLI::ParseError& error) {
    exit_code = error.get_exit_code() == 0 ? cli.exit(error) : 2;
    if (exit_code != 0) std::cerr << "taktd: " << error.what() << " (see taktd --help)\n";
    return {};
  }
  run.pace = pace == "fast" ? Pace::kFast : pace == "paced" ? Pace::kPaced : Pace::kRealTime;
  options.lcm = !no_lcm;
  options.task = check ? Task::kCheck : schema ? Task::kSchema : reference ? Task::kReference : Task::kRun;
  return options;
}

}  // namespace takt::app
