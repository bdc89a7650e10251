#include "takt/engine/scheduler.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

namespace takt::engine {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

Machine OneAxis() {
  Machine machine;
  machine.name = "test";
  axis::AxisParams axis;
  axis.name = "x";
  axis.limits.velocity = 100;
  axis.limits.acceleration = 1000;
  axis.limits.jerk = 20000;
  machine.axes.push_back(axis);
  return machine;
}

void Give(Engine& engine, std::string_view verb, std::string_view arguments = "") {
  const ParsedCommand parsed = ParseCommand(engine.machine(), "x", verb, arguments);
  ASSERT_EQ(parsed.error, ErrorId::kNone) << parsed.sentence;
  ASSERT_NE(engine.Submit(parsed.command), 0u);
}

void PowerUpAndMove(Engine& engine) {
  Give(engine, "power");
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  Give(engine, "move_velocity", "{velocity: 100}");
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  ASSERT_NEAR(engine.outputs(0).set_velocity, 100, 1e-9);
}

double Seconds(Clock::duration d) {
  return std::chrono::duration<double>(d).count();
}

// EN-01, EN-06
TEST(Scheduler, FastRunsExactlyTheCyclesOfTheDuration) {
  Engine engine(OneAxis());
  const std::atomic<int> signals{0};
  const RunResult result = takt::engine::Run(engine, {.pace = Pace::kFast, .duration_s = 12.345}, signals);
  EXPECT_EQ(result.end, RunEnd::kStopped);
  EXPECT_EQ(result.cycles, 12'345u);
  EXPECT_EQ(engine.cycle().count, 12'345u);
  EXPECT_EQ(engine.figures().latency.count, 0u);  // nothing is measured, so that runs are identical
  EXPECT_EQ(engine.figures().execution.count, 0u);
}

// EN-01
TEST(Scheduler, PacedKeepsUpWithTheWallClock) {
  Engine engine(OneAxis());
  const std::atomic<int> signals{0};
  const auto start = Clock::now();
  const RunResult result = takt::engine::Run(engine, {.pace = Pace::kPaced, .duration_s = 0.3}, signals);
  EXPECT_EQ(result.cycles, 300u);
  EXPECT_GE(Seconds(Clock::now() - start), 0.299);
  EXPECT_EQ(engine.figures().overruns, 0u);
}

// EN-02, EN-05: absolute deadlines: cycles and skipped instants together are the time that passed.
TEST(Scheduler, RealTimeStaysOnItsGrid) {
  Engine engine(OneAxis());
  const std::atomic<int> signals{0};
  const auto start = Clock::now();
  const RunResult result = takt::engine::Run(engine, {.duration_s = 0.5}, signals);
  const double elapsed_ms = Seconds(Clock::now() - start) * 1000;
  EXPECT_EQ(result.cycles, 500u);
  EXPECT_GE(elapsed_ms, static_cast<double>(result.cycles + result.skipped) - 1);
  EXPECT_EQ(engine.figures().latency.count, result.cycles - 1);  // of the previous cycle
  EXPECT_GT(engine.figures().execution.max, 0u);
  EXPECT_LE(engine.figures().overruns, result.skipped);
}

// EN-05: a delay in the cycle is counted as an overrun, and missed instants are skipped, not made up for.
TEST(Scheduler, AHoldUpIsCountedAndLeftOut) {
  struct sigaction action {};
  action.sa_handler = [](int) {
    const auto until = Clock::now() + 20ms;
    while (Clock::now() < until) {
    }
  };
  struct sigaction before {};
  ASSERT_EQ(sigaction(SIGUSR1, &action, &before), 0);
  Engine engine(OneAxis());
  const std::atomic<int> signals{0};
  const pthread_t cycle_thread = pthread_self();
  std::thread disturber([&] {
    std::this_thread::sleep_for(100ms);
    pthread_kill(cycle_thread, SIGUSR1);
  });
  const RunResult result = takt::engine::Run(engine, {.duration_s = 0.3}, signals);
  disturber.join();
  sigaction(SIGUSR1, &before, nullptr);
  EXPECT_EQ(result.cycles, 300u);
  EXPECT_GE(engine.figures().overruns, 1u);
  EXPECT_GE(result.skipped, 18u);
}

// EN-02: missing permissions are reported in one line, and the run continues.
TEST(Scheduler, WhatIsNotPermittedIsSaidInOneLine) {
  Engine engine(OneAxis());
  const std::atomic<int> signals{0};
  testing::internal::CaptureStderr();
  const RunResult result = takt::engine::Run(engine, {.duration_s = 0.05, .cpu = 100'000, .priority = 1000}, signals);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(result.cycles, 50u);
  EXPECT_NE(text.find("SCHED_FIFO priority 1000"), std::string::npos) << text;
  EXPECT_NE(text.find("CPU 100000"), std::string::npos) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

// EN-02: the thread is a real-time thread only while it runs the cycle.
TEST(Scheduler, TheThreadIsAsBeforeAfterwards) {
  int policy = -1;
  sched_param priority{};
  cpu_set_t before, after;
  sched_getaffinity(0, sizeof before, &before);
  int first = 0;
  while (!CPU_ISSET(static_cast<unsigned>(first), &before)) ++first;
  Engine engine(OneAxis());
  const std::atomic<int> signals{0};
  takt::engine::Run(engine, {.duration_s = 0.01, .cpu = first}, signals);
  pthread_getschedparam(pthread_self(), &policy, &priority);
  sched_getaffinity(0, sizeof after, &after);
  EXPECT_EQ(policy, SCHED_OTHER);
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

// EN-08
TEST(Scheduler, TheFirstSignalStopsAlongTheRampsAndOpensTheLoops) {
  Engine engine(OneAxis());
  PowerUpAndMove(engine);
  const std::atomic<int> signals{1};
  const std::uint64_t start = engine.cycle().count;
  const RunResult result = takt::engine::Run(engine, {.pace = Pace::kFast}, signals);
  EXPECT_EQ(result.end, RunEnd::kStopped);
  EXPECT_TRUE(engine.all_disabled());
  EXPECT_EQ(engine.outputs(0).state, axis::PlcState::kDisabled);
  EXPECT_FALSE(engine.outputs(0).loop_closed);
  // From 100 u/s with 1000 u/s² and 20000 u/s³: 0.1 s + 0.05 s, then the power is off.
  const auto cycles = static_cast<double>(engine.cycle().count - start);
  EXPECT_GE(cycles, 149);
  EXPECT_LE(cycles, 300);
}

// EN-08: the end of the duration stops in the same way.
TEST(Scheduler, TheEndOfTheDurationStopsAlongTheRampsToo) {
  Engine engine(OneAxis());
  PowerUpAndMove(engine);
  const std::atomic<int> signals{0};
  const RunResult result = takt::engine::Run(engine, {.pace = Pace::kFast, .duration_s = 1}, signals);
  EXPECT_GT(result.cycles, 1100u);
  EXPECT_TRUE(engine.all_disabled());
}

// EN-08
TEST(Scheduler, TheSecondSignalEndsAtOnce) {
  Engine engine(OneAxis());
  PowerUpAndMove(engine);
  const std::atomic<int> signals{2};
  const RunResult result = takt::engine::Run(engine, {}, signals);
  EXPECT_EQ(result.end, RunEnd::kSignal);
  EXPECT_EQ(result.cycles, 0u);
}

// EN-08: an axis that does not come to rest does not block the end for ever.
TEST(Scheduler, GivesUpWhenStoppingTakesTooLong) {
  Engine engine(OneAxis());
  PowerUpAndMove(engine);
  const std::atomic<int> signals{1};
  const RunResult result = takt::engine::Run(engine, {.pace = Pace::kFast, .stop_timeout_s = 0.02}, signals);
  EXPECT_EQ(result.end, RunEnd::kStopTimeout);
  EXPECT_EQ(result.cycles, 20u);
}

// EN-08: a signal during a real-time run.
TEST(Scheduler, ASignalEndsARealTimeRun) {
  Engine engine(OneAxis());
  std::atomic<int> signals{0};
  std::thread sender([&] {
    std::this_thread::sleep_for(50ms);
    signals = 1;
  });
  const RunResult result = takt::engine::Run(engine, {}, signals);
  sender.join();
  EXPECT_EQ(result.end, RunEnd::kStopped);
  EXPECT_GT(result.cycles, 0u);
}

// EN-05
TEST(Histogram, CountsByPowersOfTwo) {
  Histogram h;
  for (const std::uint64_t ns : {0ull, 1ull, 2ull, 3ull, 4ull, 1023ull, 1024ull, 1ull << 31, 1ull << 40}) h.Add(ns);
  EXPECT_EQ(h.buckets[0], 2u);
  EXPECT_EQ(h.buckets[1], 2u);
  EXPECT_EQ(h.buckets[2], 1u);
  EXPECT_EQ(h.buckets[9], 1u);
  EXPECT_EQ(h.buckets[10], 1u);
  EXPECT_EQ(h.buckets[31], 2u);
  EXPECT_EQ(h.count, 9u);
  EXPECT_EQ(h.max, 1ull << 40);
}

// EN-05
TEST(Histogram, QuantilesLieWithinTheirBucket) {
  EXPECT_EQ(Histogram{}.Quantile(0.5), 0);
  Histogram h;
  for (std::uint64_t ns = 1; ns <= 1000; ++ns) h.Add(ns);
  EXPECT_NEAR(h.Quantile(0.5), 500, 12);  // 1 to 1000, evenly: exact except at the ends of the buckets
  EXPECT_NEAR(h.Quantile(0.99), 990, 12);
  EXPECT_EQ(h.Quantile(1), 1000);
  Histogram same;
  for (int i = 0; i < 100; ++i) same.Add(700);
  EXPECT_GE(same.Quantile(0.01), 512);
  EXPECT_LE(same.Quantile(0.99), 700);
}

}  // namespace
}  // namespace takt::engine
