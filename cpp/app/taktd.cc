// The standalone engine: taktd machine.yaml.

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include "app/machine_file.h"
#include "app/options.h"
#include "app/summary.h"
#include "takt/engine/path_checks.h"
#include "takt/engine/reference.h"
#include "takt/lcm/authentication.h"
#include "takt/lcm/drives.h"
#include "takt/lcm/service.h"

namespace takt::app {
namespace {

constexpr int kLogIncomplete = 1;
constexpr int kWrongInput = 2;
constexpr int kEndedAtOnce = 130;
constexpr char kWithKey[] = "only holders of the key may command";
constexpr char kWithKeys[] = "only holders of either key may command: it is being changed";
constexpr char kWithoutKey[] = "no key: anyone who reaches the network may command (--key, TAKT_KEY_FILE)";
constexpr unsigned kCloseWithinS = 1;  // s for closing the log after a second signal

std::atomic<int> signals{0};
std::atomic<bool> cycle_runs{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free, "for a signal handler");

// The cycle looks at the count itself. Before and after it, whatever may hold the program up, a log that is not read
// for instance, a signal after the first ends it.
void OnSignal(int) {
  if (signals.fetch_add(1, std::memory_order_relaxed) > 0 && !cycle_runs) _exit(kEndedAtOnce);
}

// Whatever would end the program without ramps, unless it is a fault of the program itself (EN-34).
void HandleSignals() {
  for (const int signal :
       {SIGINT, SIGTERM, SIGQUIT, SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGVTALRM, SIGPROF, SIGIO, SIGPWR}) {
    std::signal(signal, OnSignal);
  }
  if (std::signal(SIGHUP, OnSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup: runs on without its terminal
  // A closed reader of the log and a file at its size limit (EPIPE, EFBIG) are errors of writing it.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
}

int ExitCode(engine::RunEnd end, const lcm::Losses& losses) {
  if (end == engine::RunEnd::kSignal) return kEndedAtOnce;
  return losses.log ? kLogIncomplete : 0;
}

int Refuse(const std::string& problem) {
  std::cerr << "taktd: " << problem << '\n';
  return kWrongInput;
}

void SayOnStderr(const std::string& sentence) {
  std::fprintf(stderr, "%s\n", sentence.c_str());
}

int Run(const Options& options, MachineFile file) {
  const engine::Machine& machine = *file.machine;
  const bool log = !options.log_file.empty();
  const bool has_drives = !machine.external.drives.empty();
  if (has_drives && !options.lcm) return Refuse("the machine has external drives, which --no-lcm leaves out of reach");
  engine::Engine engine(machine,
                        {.publish = options.lcm || log, .every_cycle = log, .drives = has_drives, .journal = log});
  engine::PathChecks checks(engine, std::move(file.checkers));
  engine::SchedulerOptions scheduler = options.scheduler;
  const lcm::RunInfo info{file.text, TAKT_VERSION, static_cast<std::int8_t>(scheduler.pace)};
  std::string problem;
  const auto authentication = file.keys ? std::make_shared<lcm::Authentication>(*file.keys, SayOnStderr) : nullptr;
  std::unique_ptr<lcm::Service> service;
  if (options.lcm || log) {
    const auto explain = [&checks](const FeedbackEvent& event) { return checks.Sentence(event); };
    service = lcm::Service::Open(engine,
                                 {.url = file.url,
                                  .log_path = options.log_file,
                                  .info = info,
                                  .authentication = authentication,
                                  .explain = explain},
                                 problem);
    if (!service) return Refuse(problem);
    scheduler.wait_for_reader = log;
  }
  std::unique_ptr<lcm::Drives> drives;
  const bool real_time = scheduler.pace == engine::Pace::kRealTime;
  if (has_drives) {
    drives = lcm::Drives::Open(engine,
                               {.url = file.url,
                                .run_id = info.run_id,
                                .real_time = real_time,
                                .authentication = authentication,
                                .complain = SayOnStderr},
                               problem);
    if (!drives) return Refuse(problem);
  }
  scheduler.ready = [&] {  // in simulated time
    checks.Run();
    return !drives || drives->Ready();
  };
  if (drives) scheduler.later_ns = [&] { return drives->TakeCycleShiftNs(); };

  std::cout << Greeting(machine, scheduler.pace);
  if (!file.url.empty())
    std::cout << ", on " << file.url << '\n' << (!file.keys ? kWithoutKey : file.keys->other ? kWithKeys : kWithKey);
  std::cout << std::endl;
  std::optional<engine::PathCheckThread> checking;
  if (real_time) checking.emplace(checks);
  cycle_runs = true;
  const engine::RunResult result = engine::Run(engine, scheduler, signals);
  cycle_runs = false;
  checking.reset();
  // A second signal after the last look of the cycle and before cycle_runs was false counts, too.
  const bool at_once = result.end == engine::RunEnd::kSignal || signals > 1;
  if (at_once) alarm(kCloseWithinS);
  drives.reset();
  const lcm::Losses losses = service ? service->Close() : lcm::Losses{};
  std::cout << Summary(engine, result, scheduler.pace, losses) << std::endl;
  return ExitCode(result.end, losses);
}

int Main(int argc, char** argv) {
  HandleSignals();
  int exit_code = 0;
  const std::optional<Options> options = ParseOptions(argc, argv, exit_code);
  if (!options) return exit_code;
  if (options->task == Task::kSchema || options->task == Task::kReference) {
    std::cout << (options->task == Task::kSchema ? engine::SchemaText() : engine::ReferenceText(TAKT_VERSION)) << '\n';
    return 0;
  }
  MachineFile file = ReadMachineFile(*options);
  for (const std::string& problem : file.problems) std::cerr << problem << '\n';
  for (const std::string& warning : file.warnings) std::cerr << warning << '\n';
  if (!file.machine) return kWrongInput;
  if (options->task == Task::kCheck) {
    std::cout << "ok\n";
    return 0;
  }
  return Run(*options, std::move(file));
}

}  // namespace
}  // namespace takt::app

int main(int argc, char** argv) {
  return takt::app::Main(argc, argv);
}
