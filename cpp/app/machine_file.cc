#include "app/machine_file.h"

#include "takt/core/describe.h"
#include "takt/core/writer.h"
#include "takt/core/yaml_reader.h"
#include "takt/engine/load.h"
#include "takt/lcm/network.h"

namespace takt::app {

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
  if (loaded.machine) {
    const std::string problem = lcm::WhyNotUrl(loaded.machine->lcm.url);
    if (!problem.empty()) file.problems.push_back(options.machine_file + ": lcm.url: " + problem);
  }
  file.checkers = std::move(loaded.checkers);
  if (file.problems.empty()) file.machine = std::move(loaded.machine);
  return file;
}

}  // namespace takt::app
