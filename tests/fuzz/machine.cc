// EN-37, EN-38: machine files as anyone may write them. What is accepted has to run, too: each machine that loads makes
// an engine, which runs for some cycles with a command for each component, and publishes numbers.
#include <cmath>
#include <cstdlib>
#include <string>

#include "takt/engine/components.h"
#include "takt/engine/engine.h"
#include "takt/engine/load.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace takt::engine;
  constexpr int kCycles = 10;
  const std::string text(reinterpret_cast<const char*>(data), size);
  LoadResult loaded = LoadMachine(text, "machine.yaml", Workspaces::kMake, Files::kRefuse);
  if (loaded.machine.has_value() != loaded.problems.empty()) std::abort();
  for (const std::string& problem : loaded.problems) {
    if (problem.empty() || problem.size() > 2000) std::abort();
  }
  if (!loaded.machine) return 0;
  Engine engine(std::move(*loaded.machine));
  for (const char* verb : {"power", "enable", "home", "move_velocity", "jog"}) {
    for (const std::string_view name : ComponentNames(engine.machine())) {
      const ParsedCommand parsed = ParseCommand(engine.machine(), name, verb, "");
      if (parsed.error == takt::ErrorId::kNone) engine.Submit(parsed.command);
    }
  }
  for (int i = 0; i < kCycles; ++i) engine.RunCycle();
  for (std::size_t i = 0; i < engine.machine().axes.size(); ++i) {
    const takt::axis::Outputs& outputs = engine.outputs(i);
    if (!std::isfinite(outputs.set_position) || !std::isfinite(outputs.set_velocity)) std::abort();
  }
  return 0;
}
