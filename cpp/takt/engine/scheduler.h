// Runs an engine's cycles at the right instants, or as fast as possible.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "takt/engine/engine.h"

namespace takt::engine {

enum class Pace : std::uint8_t {
  // deadlines on the monotonic clock, in a real-time thread; instants that are missed are skipped and counted
  kRealTime,
  kPaced,  // simulated time that keeps up with the wall clock; no cycle is skipped, nothing is measured
  kFast,   // simulated time as fast as possible
};

struct SchedulerOptions {
  Pace pace = Pace::kRealTime;
  // [s] of the engine's time, after which everything is stopped as by a signal.
  double duration_s = std::numeric_limits<double>::infinity();
  std::optional<int> cpu{};      // real time: pin the thread to this CPU
  int priority = 80;             // real time: priority of SCHED_FIFO
  double stop_timeout_s = 5;     // [s] of the engine's time for stopping along the ramps
  bool wait_for_reader = false;  // fast: do not outrun the thread that drains the engine's queues
  // Paced and fast: called before every cycle. Returns false if the data for the cycle has not arrived yet
  // (lcm/drives.h); it waits only briefly, so that signals are checked, too.
  std::function<bool()> ready{};
  // Real time: called after every cycle; returns the delay [ns] by which later cycles should begin, for a bus with its
  // own clock (lcm/drives.h). Each cycle follows by a hundredth of it, at most 1/500 of a period.
  std::function<std::int64_t()> later_ns{};
  // A cyclic program: called in the cycle's thread before every cycle, within its time (takt/plcopen/program.h).
  std::function<void()> program{};
};

enum class RunEnd : std::uint8_t {
  kStopped,      // after the duration or the first signal: all axes at rest, loops open
  kStopTimeout,  // likewise, but some axis or mover was not disabled in time
  kSignal,       // after the second signal: ended at once
};

struct RunResult {
  RunEnd end = RunEnd::kStopped;
  std::uint64_t cycles = 0;   // run by this call
  std::uint64_t skipped = 0;  // real time: instants of the grid skipped because an earlier cycle took too long
};

// Runs until the duration is over or a signal was counted in `signals` (EN-08: the first stops everything along its
// ramps, the second ends at once). In real time the calling thread is a real-time thread meanwhile; one line on stderr
// says what the system does not permit (EN-02).
RunResult Run(Engine& engine, const SchedulerOptions& options, const std::atomic<int>& signals);

}  // namespace takt::engine
