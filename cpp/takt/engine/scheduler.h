// Lets time go on: calls an engine's cycle at the right instants, or as fast as it goes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "takt/engine/engine.h"

namespace takt::engine {

enum class Pace : std::uint8_t {
  kRealTime,  // deadlines on the monotonic clock, with the rights of a real-time thread; what comes too late is left
              // out and counted
  kPaced,     // simulated time that keeps up with the wall clock; nothing is left out, nothing measured
  kFast,      // simulated time as fast as possible
};

struct SchedulerOptions {
  Pace pace = Pace::kRealTime;
  // s of the engine's time, then everything is stopped as by a signal.
  double duration_s = std::numeric_limits<double>::infinity();
  std::optional<int> cpu{};      // real time: keep to this CPU
  int priority = 80;             // real time: of SCHED_FIFO
  double stop_timeout_s = 5;     // s of the engine's time for stopping along the ramps
  bool wait_for_reader = false;  // fast: do not run away from the thread that empties the engine's queues
  // Paced and fast: asked before every cycle. False: what it needs has not come yet (lcm/drives.h); after a little
  // waiting, so that the signals can be looked at, too.
  std::function<bool()> ready{};
  // Real time: asked after every cycle how much later [ns] the next ones ought to begin, for a bus with a clock of its
  // own (lcm/drives.h). They follow a little in each cycle, by a hundredth of it, and 1/500 of a period at the most.
  std::function<std::int64_t()> later_ns{};
  // A cyclic program: called in the cycle's thread before every cycle, and part of its time (takt/plcopen/program.h).
  std::function<void()> program{};
};

enum class RunEnd : std::uint8_t {
  kStopped,      // after the duration or the first signal: all axes at rest, loops open
  kStopTimeout,  // the same, but some axis did not come to rest in time
  kSignal,       // second signal: ended at once
};

struct RunResult {
  RunEnd end = RunEnd::kStopped;
  std::uint64_t cycles = 0;   // run here
  std::uint64_t skipped = 0;  // real time: instants of the grid left out because a cycle before them took too long
};

// Runs until the duration is over or a signal was counted in `signals` (EN-08: the first stops everything along its
// ramps, the second ends at once). In real time the calling thread is a real-time thread meanwhile; what the system
// does not permit is said in one line on stderr (EN-02).
RunResult Run(Engine& engine, const SchedulerOptions& options, const std::atomic<int>& signals);

}  // namespace takt::engine
