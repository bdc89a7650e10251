// The standalone engine: taktd machine.yaml.

#include <atomic>
#include <csignal>
#include <iostream>
#include <memory>

#include "app/machine_file.h"
#include "app/options.h"
#include "app/summary.h"
#include "takt/engine/reference.h"
#include "takt/lcm/service.h"

namespace takt::app {
namespace {

constexpr int kWrongInput = 2;
constexpr int kEndedAtOnce = 130;

std::atomic<int> signals{0};
static_assert(std::atomic<int>::is_always_lock_free, "counted in a signal handler");

int Run(const Options& options, const engine::Machine& machine, const std::string& text) {
  const bool log = !options.log_file.empty();
  engine::Engine engine(machine, {.publish = options.lcm || log, .every_cycle = log, .journal = log});
  engine::SchedulerOptions scheduler = options.scheduler;
  std::unique_ptr<lcm::Service> service;
  if (options.lcm || log) {
    std::string problem;
    service = lcm::Service::Open(engine,
                                 {.url = options.lcm ? options.lcm_url.value_or(machine.lcm.url) : "",
                                  .log_path = options.log_file,
                                  .info = {text, TAKT_VERSION, static_cast<std::int8_t>(scheduler.pace)}},
                                 problem);
    if (!service) {
      std::cerr << "taktd: " << problem << '\n';
      return kWrongInput;
    }
    scheduler.wait_for_reader = log;
  }
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) { signals.fetch_add(1, std::memory_order_relaxed); });
  }

  std::cout << Greeting(machine, scheduler.pace) << std::endl;
  const engine::RunResult result = engine::Run(engine, scheduler, signals);
  const std::uint64_t send_failures = service ? service->Close() : 0;
  std::cout << Summary(engine, result, scheduler.pace, send_failures) << std::endl;
  return result.end == engine::RunEnd::kSignal ? kEndedAtOnce : 0;
}

int Main(int argc, char** argv) {
  int exit_code = 0;
  const std::optional<Options> options = ParseOptions(argc, argv, exit_code);
  if (!options) return exit_code;
  if (options->task == Task::kSchema || options->task == Task::kReference) {
    std::cout << (options->task == Task::kSchema ? engine::SchemaText() : engine::ReferenceText(TAKT_VERSION)) << '\n';
    return 0;
  }
  const MachineFile file = ReadMachineFile(*options);
  for (const std::string& problem : file.problems) std::cerr << problem << '\n';
  if (!file.machine) return kWrongInput;
  if (options->task == Task::kCheck) {
    std::cout << "ok\n";
    return 0;
  }
  return Run(*options, *file.machine, file.text);
}

}  // namespace
}  // namespace takt::app

int main(int argc, char** argv) {
  return takt::app::Main(argc, argv);
}
