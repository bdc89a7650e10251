#include "app/summary.h"

#include <iomanip>
#include <sstream>

#include "takt/engine/components.h"

namespace takt::app {
namespace {

const char* Text(engine::Pace pace) {
  switch (pace) {
    case engine::Pace::kRealTime:
      return "in real time";
    case engine::Pace::kPaced:
      return "simulated at the wall clock's pace";
    case engine::Pace::kFast:
      return "simulated as fast as possible";
  }
  return "";
}

const char* Text(engine::RunEnd end) {
  switch (end) {
    case engine::RunEnd::kStopped:
      return "stopped, all loops open";
    case engine::RunEnd::kStopTimeout:
      return "ended although not every axis came to rest in time";
    case engine::RunEnd::kSignal:
      return "ended at once by a second signal";
  }
  return "";
}

double Us(double ns) {
  return ns / 1000;
}
double Us(std::uint64_t ns) {
  return Us(static_cast<double>(ns));
}

}  // namespace

std::string Greeting(const engine::Machine& machine, engine::Pace pace) {
  std::ostringstream text;
  text << machine.name << ": ";
  for (const engine::ComponentKind& kind : engine::ComponentKinds()) {
    const std::size_t count = kind.count(machine);
    if (count > 0) text << count << ' ' << (count == 1 ? kind.one.substr(kind.one.find(' ') + 1) : kind.many) << ", ";
  }
  text << "cycle " << machine.cycle.period_s * 1000 << " ms, " << Text(pace);
  return text.str();
}

std::string Summary(const engine::Engine& engine, const engine::RunResult& result, engine::Pace pace,
                    const lcm::Losses& losses) {
  const engine::EngineFigures& figures = engine.figures();
  std::ostringstream text;
  text << Text(result.end) << ": " << result.cycles << " cycles";
  if (pace == engine::Pace::kRealTime) {
    text << std::fixed << std::setprecision(1) << ", " << figures.overruns << " overruns (" << result.skipped
         << " cycles left out), longest execution " << Us(figures.execution.max) << " us, wake-up latency p50 "
         << Us(figures.latency.Quantile(0.5)) << " us, p99 " << Us(figures.latency.Quantile(0.99)) << " us, max "
         << Us(figures.latency.max) << " us";
  }
  text << "; " << figures.commands_applied << " commands, " << figures.commands_refused
       << " refused by a full queue; lost: " << figures.snapshots_dropped << " states, " << figures.feedback_dropped
       << " feedback events, " << figures.journal_dropped << " journal entries, " << losses.messages << " messages";
  if (!engine.machine().external.drives.empty()) {
    text << "; drives: " << figures.set_points_dropped << " set points lost, " << figures.samples_refused
         << " answers refused";
  }
  if (losses.log) text << "; the log is incomplete";
  return text.str();
}

}  // namespace takt::app
