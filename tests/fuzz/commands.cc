// EN-38: commands as anyone may give them, to machines of every kind, one after the other while the engine runs: it
// neither ends nor publishes what is no number. The input is one byte for the machine, then commands: a byte for the
// component (0: the machine), one for the verb, one for how many cycles run before the next, then the arguments, as far
// as the end of the line.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "takt/engine/components.h"
#include "takt/engine/engine.h"
#include "takt/engine/load.h"
#include "takt/engine/path_checks.h"

namespace {

using namespace takt::engine;

constexpr const char* kMachines[] = {"flying_saw",         "pick_cell",    "planar_line",
                                     "positioning_module", "rotary_knife", "six_axes"};
constexpr std::size_t kMostCommands = 12;
constexpr std::size_t kMostCycles = 64;

std::string FileOf(const char* machine) {
  return std::string(TAKT_SOURCE_DIR) + "/python/examples/" + machine + "/machine.yaml";
}

// Every number that a component publishes is one, where it says nothing else.
void CheckNumbers(const Engine& engine) {
  for (std::size_t i = 0; i < engine.machine().axes.size(); ++i) {
    const takt::axis::Outputs& outputs = engine.outputs(i);
    for (const double value : {outputs.set_position, outputs.set_velocity, outputs.set_acceleration,
                               outputs.actual_position, outputs.actual_velocity, outputs.voltage_v}) {
      if (!std::isfinite(value)) std::abort();
    }
  }
  for (std::size_t i = 0; i < engine.machine().movers.size(); ++i) {
    const takt::mover::Outputs& outputs = engine.mover_outputs(i);
    for (const double value : {outputs.x, outputs.y, outputs.c, outputs.velocity_x, outputs.velocity_y}) {
      if (!std::isfinite(value)) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  LoadResult loaded = LoadMachineFile(FileOf(kMachines[data[0] % std::size(kMachines)]));
  if (!loaded.machine) std::abort();
  Engine engine(std::move(*loaded.machine));
  PathChecks checks(engine, std::move(loaded.checkers));
  const std::vector<std::string_view> names = ComponentNames(engine.machine());
  std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto byte = [&] {
    const auto first = static_cast<std::uint8_t>(rest.empty() ? 0 : rest.front());
    rest.remove_prefix(rest.empty() ? 0 : 1);
    return first;
  };
  for (std::size_t given = 0; given < kMostCommands && !rest.empty(); ++given) {
    const std::size_t component = byte() % (names.size() + 1);
    const std::string_view target = component == 0 ? "machine" : names[component - 1];
    const std::string_view kind = component == 0 ? "machine" : PlaceOf(engine.machine(), component - 1).kind->name;
    std::vector<std::string_view> verbs;
    for (const Verb& verb : Verbs()) {
      if (verb.target_kind == kind) verbs.push_back(verb.name);
    }
    const std::string_view verb = verbs[byte() % verbs.size()];
    const std::size_t cycles = byte() % kMostCycles;
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view arguments = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const ParsedCommand parsed = ParseCommand(engine.machine(), target, verb, arguments);
    if ((parsed.error == takt::ErrorId::kNone) != parsed.sentence.empty()) std::abort();
    if (parsed.error == takt::ErrorId::kNone) engine.Submit(parsed.command);
    for (std::size_t i = 0; i <= cycles; ++i) {
      engine.RunCycle();
      checks.Run();
      CheckNumbers(engine);
    }
  }
  return 0;
}
