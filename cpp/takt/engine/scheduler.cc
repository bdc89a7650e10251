#include "takt/engine/scheduler.h"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "takt/engine/real_time.h"

namespace takt::engine {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kReaderWaitNs = 200'000;
constexpr std::int64_t kFollows = 100;    // a hundredth of the requested shift per cycle: its effect is reported late
constexpr std::int64_t kMostShift = 500;  // 1/500 of a period: 2000 ppm, far more than clocks differ

std::int64_t NowNs() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecondNs + now.tv_nsec;
}

void SleepUntil(std::int64_t instant_ns) {
  const timespec until{instant_ns / kSecondNs, instant_ns % kSecondNs};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

// Decides when a run ends; called before every cycle.
class EndJudge {
 public:
  EndJudge(Engine& engine, const SchedulerOptions& options, const std::atomic<int>& signals)
      : engine_(engine), signals_(signals) {
    const double period_s = engine.cycle().period_s;
    last_cycle_ = InCycles(options.duration_s, period_s);
    stop_timeout_ = InCycles(options.stop_timeout_s, period_s);
  }

  bool Ended(RunResult& result) {
    const int signals = signals_.load(std::memory_order_relaxed);
    if (signals >= 2) {
      result.end = RunEnd::kSignal;
      return true;
    }
    if (!stopping_ && (signals >= 1 || result.cycles >= last_cycle_)) {
      stopping_ = true;
      give_up_cycle_ = result.cycles + stop_timeout_;
      engine_.RequestShutdown();
    }
    if (!stopping_) return false;
    if (engine_.all_disabled()) return true;
    if (result.cycles >= give_up_cycle_) {
      result.end = RunEnd::kStopTimeout;
      return true;
    }
    return false;
  }

 private:
  static std::uint64_t InCycles(double duration_s, double period_s) {
    const double cycles = std::round(duration_s / period_s);
    return cycles < 1e18 ? static_cast<std::uint64_t>(std::max(0.0, cycles))
                         : std::numeric_limits<std::uint64_t>::max() / 2;
  }

  Engine& engine_;
  const std::atomic<int>& signals_;
  std::uint64_t last_cycle_ = 0;
  std::uint64_t stop_timeout_ = 0;
  std::uint64_t give_up_cycle_ = 0;
  bool stopping_ = false;
};

bool IsReady(const SchedulerOptions& options) {
  return !options.ready || options.ready();
}

void RunOne(Engine& engine, const SchedulerOptions& options, const CycleTiming& timing = {}) {
  if (options.program) options.program();
  engine.RunCycle(timing);
}

std::int64_t Shift(const SchedulerOptions& options, std::int64_t period_ns) {
  if (!options.later_ns) return 0;
  return std::clamp(options.later_ns() / kFollows, -period_ns / kMostShift, period_ns / kMostShift);
}

RunResult RunRealTime(Engine& engine, const SchedulerOptions& options, EndJudge& judge, std::int64_t period_ns) {
  RunResult result;
  CycleTiming timing;
  std::int64_t deadline = NowNs() + period_ns;
  std::int64_t skipped = 0;  // periods lost while the previous cycle ran
  while (!judge.Ended(result)) {
    SleepUntil(deadline);
    const std::int64_t woken = NowNs();
    // periods lost before this cycle
    const std::int64_t asleep = std::max<std::int64_t>(0, (woken - deadline) / period_ns);
    timing.late_periods = static_cast<std::uint64_t>(skipped + asleep);
    timing.now_ns = woken;
    RunOne(engine, options, timing);
    ++result.cycles;
    const std::int64_t end = NowNs();
    const std::int64_t next = deadline + period_ns + Shift(options, period_ns);
    timing.latency_ns = static_cast<std::uint64_t>(woken - deadline);
    timing.execution_ns = static_cast<std::uint64_t>(end - woken);
    timing.overrun = end > next;
    const std::int64_t missed = timing.overrun ? (end - next) / period_ns + 1 : 0;
    skipped = std::max<std::int64_t>(0, missed - asleep);
    result.skipped += static_cast<std::uint64_t>(missed);
    deadline = next + missed * period_ns;
  }
  return result;
}

RunResult RunPaced(Engine& engine, const SchedulerOptions& options, EndJudge& judge, std::int64_t period_ns) {
  RunResult result;
  const std::int64_t start = NowNs();
  while (!judge.Ended(result)) {
    SleepUntil(start + static_cast<std::int64_t>(result.cycles) * period_ns);
    if (!IsReady(options)) continue;
    RunOne(engine, options, {.now_ns = NowNs()});
    ++result.cycles;
  }
  return result;
}

template <typename T>
bool IsHalfFull(const SpscQueue<T>& queue) {
  return queue.size() * 2 > queue.capacity();
}

template <typename... Outputs>
bool AreHalfFull(Engine& engine, const std::tuple<Outputs...>*) {
  return (IsHalfFull(engine.snapshots<Outputs>()) || ...);
}

bool ReaderIsBehind(Engine& engine) {
  return AreHalfFull(engine, static_cast<PublishedKinds*>(nullptr)) || IsHalfFull(engine.feedback()) ||
         IsHalfFull(engine.journal()) || IsHalfFull(engine.drive_journal()) || IsHalfFull(engine.hashes()) ||
         IsHalfFull(engine.figure_queue());
}

RunResult RunFast(Engine& engine, const SchedulerOptions& options, EndJudge& judge) {
  RunResult result;
  while (!judge.Ended(result)) {
    if (options.wait_for_reader && ReaderIsBehind(engine)) {
      SleepUntil(NowNs() + kReaderWaitNs);
      continue;
    }
    if (!IsReady(options)) continue;
    RunOne(engine, options, {.now_ns = NowNs()});
    ++result.cycles;
  }
  return result;
}

}  // namespace

RunResult Run(Engine& engine, const SchedulerOptions& options, const std::atomic<int>& signals) {
  EndJudge judge(engine, options, signals);
  const std::int64_t period_ns = std::llround(engine.cycle().period_s * 1e9);
  switch (options.pace) {
    case Pace::kRealTime: {
      const RealTimeThread thread(options.priority, options.cpu);
      if (!thread.refused().empty()) {
        std::fprintf(stderr, "not permitted, running without: %s\n", thread.refused().c_str());
      }
      return RunRealTime(engine, options, judge, period_ns);
    }
    case Pace::kPaced:
      return RunPaced(engine, options, judge, period_ns);
    case Pace::kFast:
      return RunFast(engine, options, judge);
  }
  return {};
}

}  // namespace takt::engine
