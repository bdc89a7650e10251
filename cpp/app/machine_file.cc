#include "app/machine_file.h"

#include <cstdlib>

#include "takt/core/describe.h"
#include "takt/core/writer.h"
#include "takt/core/yaml_reader.h"
#include "takt/engine/load.h"
#include "takt/lcm/network.h"

namespace takt::app {
namespace {

constexpr char kEnvironment[] = "LCM_DEFAULT_URL";
constexpr char kKeyEnvironment[] = "TAKT_KEY_FILE";
constexpr char kDefaultUrl[] = "udpm://239.255.76.67:7667?ttl=0";  // EN-25: stays on this host

// Appends what is wrong with the URL of the machine file or of the environment; the command line's was checked there.
std::string NetworkOf(const Options& options, const engine::Machine& machine, std::vector<std::string>& problems) {
  const auto checked = [&](const std::string& where, const std::string& url) {
    const std::string problem = lcm::WhyNotUrl(url);
    if (!problem.empty()) problems.push_back(where + ": " + problem);
    return url;
  };
  const std::string own =
      machine.lcm.url ? checked(options.machine_file + ": lcm.url", *machine.lcm.url) : std::string();
  if (!options.lcm || options.task != Task::kRun) return {};
  if (options.lcm_url) return *options.lcm_url;
  if (machine.lcm.url) return own;
  const char* const usual = std::getenv(kEnvironment);
  return usual && *usual ? checked(kEnvironment, usual) : kDefaultUrl;
}

// Likewise the keys, if there are to be any.
std::optional<lcm::Keys> KeysOf(const Options& options, std::vector<std::string>& problems) {
  if (!options.lcm || options.task != Task::kRun) return {};
  const char* const usual = std::getenv(kKeyEnvironment);
  if (!options.key_file && (usual == nullptr || *usual == '\0')) return {};
  std::string problem;
  const std::optional<lcm::Keys> keys = lcm::ReadKeys(options.key_file ? *options.key_file : usual, problem);
  if (!keys) problems.push_back(problem);
  return keys;
}

}  // namespace

MachineFile ReadMachineFile(const Options& options) {
  MachineFile file;
  std::string why;
  const std::optional<std::string> text = LoadText(options.machine_file, why);
  if (!text) {
    file.problems.push_back(options.machine_file + ": " + why);
    return file;
  }
  file.text = *text;
  engine::LoadResult loaded = engine::LoadMachine(file.text, options.machine_file);
  file.problems = std::move(loaded.problems);
  file.warnings = std::move(loaded.warnings);
  // Whoever gets the text over the network or finds it in a log has not the files it names.
  if (loaded.machine && loaded.names_files) file.text = WriteYaml(*loaded.machine);
  if (options.cycle_time_s) {
    const Range range = TypeOf<engine::CycleParams>().FindField("period_s")->range;
    if (!range.Holds(*options.cycle_time_s)) file.problems.push_back("--cycle-time: expected seconds " + Text(range));
    if (loaded.machine) loaded.machine->cycle.period_s = *options.cycle_time_s;
  }
  if (loaded.machine) file.url = NetworkOf(options, *loaded.machine, file.problems);
  file.keys = KeysOf(options, file.problems);
  file.checkers = std::move(loaded.checkers);
  if (file.problems.empty()) file.machine = std::move(loaded.machine);
  return file;
}

}  // namespace takt::app
