// Stopping the whole machine: overruns, commands to the machine, shutdown; and releasing commands.
#include "takt/engine/engine.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "machines.h"

namespace takt::engine {
namespace {

// EN-05: late cycles are counted; overruns_in_a_row consecutive ones stop everything along its ramps, with error 3007,
// and the loops stay closed. One fewer has no effect.
TEST(Overruns, InARowStopEverything) {
  Machine machine = FullMachine();
  machine.cycle.overruns_in_a_row = 5;
  Engine engine(machine, {.publish = true});
  const std::size_t y1 = AxisNamed(machine, "y1");
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.Submit(ToAxis(machine, "y2", axis::Power{}));  // its follower
  for (int i = 0; i < 300; ++i) engine.RunCycle({1000, 20000, false});
  engine.Submit(ToAxis(machine, "y1", axis::MoveVelocity{.velocity = 400}));
  for (int i = 0; i < 300; ++i) engine.RunCycle({1000, 20000, false});
  for (int i = 0; i < 4; ++i) engine.RunCycle({2'000'000, 30000, true});
  engine.RunCycle({1000, 20000, false});
  EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kContinuousMotion);
  for (int i = 0; i < 4; ++i) engine.RunCycle({2'000'000, 30000, true});
  EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kContinuousMotion);
  engine.RunCycle({2'000'000, 30000, true});
  EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kErrorStop);
  EXPECT_EQ(engine.outputs(y1).error, ErrorId::kOverrun);
  EXPECT_GT(engine.outputs(y1).set_velocity, 300);  // braking, not switched off
  for (int i = 0; i < 300; ++i) engine.RunCycle({1000, 20000, false});
  EXPECT_EQ(engine.outputs(y1).set_velocity, 0);
  EXPECT_TRUE(engine.outputs(y1).loop_closed);
  EXPECT_EQ(engine.figures().overruns, 9u);
  EXPECT_EQ(engine.figures().latency.max, 2'000'000u);
  EXPECT_EQ(engine.figures().execution.count, 910u);
}

// EN-05: after a stop overruns are counted anew; 0 means never.
TEST(Overruns, CountAnewAfterAStopOrNever) {
  for (const std::uint32_t allowed : {5u, 0u}) {
    Machine machine = FullMachine();
    machine.cycle.overruns_in_a_row = allowed;
    Engine engine(machine);
    const std::size_t y1 = AxisNamed(machine, "y1");
    engine.Submit(ToAxis(machine, "y1", axis::Power{}));
    engine.Submit(ToAxis(machine, "y2", axis::Power{}));  // its follower
    for (int i = 0; i < 300; ++i) engine.RunCycle();
    for (int i = 0; i < 5; ++i) engine.RunCycle({0, 30000, true});
    EXPECT_EQ(engine.outputs(y1).error, allowed ? ErrorId::kOverrun : ErrorId::kNone);
    engine.Submit(ToAxis(machine, "y1", axis::Reset{}));
    for (int i = 0; i < 4; ++i) engine.RunCycle({0, 30000, true});
    EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kStandstill);
    EXPECT_EQ(engine.figures().latency.count, 9u);  // a latency of 0 counts as well
  }
}

// EN-34: lateness is measured as time: a stall counts its periods, whatever its cause.
TEST(Overruns, AStallCountsItsPeriods) {
  struct Stall {
    const char* what;
    std::vector<CycleTiming> timings;
    bool stops;
    std::uint64_t skipped;
  };
  const CycleTiming good{1000, 20000, false}, late{2'000'000, 30000, true};
  const auto stalled = [](std::uint64_t periods, bool overrun) {
    CycleTiming timing{1000, 20000, overrun};
    timing.late_periods = periods;
    return timing;
  };
  const std::vector<Stall> stalls = {
      {"asleep for the limit", {stalled(5, false)}, true, 5},
      {"asleep for less", {stalled(4, false), good}, false, 4},
      {"asleep for hours", {stalled(100'000'000, false)}, true, 100'000'000},
      {"lost while the cycle ran", {stalled(5, true)}, true, 5},
      {"several short ones in a row", {stalled(2, true), stalled(2, false), stalled(1, true)}, true, 5},
      {"several short ones with a good cycle between",
       {stalled(2, true), stalled(2, true), good, stalled(4, true)},
       false,
       8},
      {"overruns that skip nothing and then a stall", {late, late, stalled(3, false)}, true, 3},
  };
  for (const Stall& stall : stalls) {
    Machine machine = FullMachine();
    machine.cycle.overruns_in_a_row = 5;
    Engine engine(machine);
    engine.Submit(ToAxis(machine, "y1", axis::Power{}));
    engine.Submit(ToAxis(machine, "y2", axis::Power{}));  // its follower
    for (int i = 0; i < 300; ++i) engine.RunCycle(good);
    engine.Submit(ToAxis(machine, "y1", axis::MoveVelocity{.velocity = 400}));
    for (int i = 0; i < 300; ++i) engine.RunCycle(good);
    for (const CycleTiming& timing : stall.timings) engine.RunCycle(timing);
    const axis::Outputs& y1 = engine.outputs(AxisNamed(machine, "y1"));
    EXPECT_EQ(y1.error, stall.stops ? ErrorId::kOverrun : ErrorId::kNone) << stall.what;
    EXPECT_GT(y1.set_velocity, 300) << stall.what << ": along its ramp, not dropped";
    EXPECT_EQ(engine.figures().cycles_skipped, stall.skipped) << stall.what;
    for (int i = 0; i < 300; ++i) engine.RunCycle(good);
    EXPECT_EQ(y1.set_velocity, stall.stops ? 0 : 400) << stall.what;
  }
}

// Returns the result of one command, from the queue of an engine.
struct Answers {
  std::vector<FeedbackEvent> events;
  void Take(Engine& engine) {
    for (FeedbackEvent event; engine.feedback().TryPop(event);) events.push_back(event);
  }
  bool Has(Ticket ticket, FeedbackState state) const {
    return std::any_of(events.begin(), events.end(),
                       [&](const FeedbackEvent& e) { return e.ticket == ticket && e.state == state; });
  }
};

Ticket GiveMachine(Engine& engine, const MachineCommand& body, double lease_s = 0) {
  return engine.Submit({.target = kMachineTarget, .lease_s = lease_s, .body = body});
}

// Stops every axis along its ramp, keeps or opens the loops; axes in ErrorStop or without power are not affected. Done
// at once.
TEST(Machine, StopAll) {
  for (const bool open : {false, true}) {
    const Machine machine = FullMachine();
    Engine engine(machine);
    Answers answers;
    const std::size_t y1 = AxisNamed(machine, "y1");
    const std::size_t c = AxisNamed(machine, "c");
    engine.Submit(ToAxis(machine, "y1", axis::Power{}));
    engine.Submit(ToAxis(machine, "y2", axis::Power{}));  // its follower
    engine.Submit(ToAxis(machine, "c", axis::Power{}));
    for (int i = 0; i < 300; ++i) engine.RunCycle();
    const Ticket move = engine.Submit(ToAxis(machine, "y1", axis::MoveVelocity{.velocity = 400}));
    for (int i = 0; i < 300; ++i) engine.RunCycle();
    const Ticket stop = GiveMachine(engine, StopAll{.open_loops = open});
    engine.RunCycle();
    EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kStopping);
    EXPECT_GT(engine.outputs(y1).set_velocity, 300);
    for (int i = 0; i < 300; ++i) engine.RunCycle();
    answers.Take(engine);
    EXPECT_TRUE(answers.Has(stop, FeedbackState::kDone));
    EXPECT_TRUE(answers.Has(move, FeedbackState::kAborted));
    for (const std::size_t i : {y1, c}) {
      EXPECT_EQ(engine.outputs(i).state, open ? axis::PlcState::kDisabled : axis::PlcState::kStandstill);
      EXPECT_EQ(engine.outputs(i).error, ErrorId::kNone);
    }
    EXPECT_EQ(engine.outputs(AxisNamed(machine, "z")).state, axis::PlcState::kDisabled);
  }
}

TEST(Machine, FailAllAxes) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  Answers answers;
  engine.Submit(ToAxis(machine, "z", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  const Ticket fail = GiveMachine(engine, FailAllAxes{});
  engine.RunCycle();
  answers.Take(engine);
  EXPECT_TRUE(answers.Has(fail, FeedbackState::kDone));
  EXPECT_EQ(engine.outputs(AxisNamed(machine, "z")).error, ErrorId::kOverrun);
  EXPECT_TRUE(engine.outputs(AxisNamed(machine, "z")).loop_closed);
}

// EN-23: the owner of a level-sensitive command is found on any axis; renewing keeps it in force, releasing ends it; a
// command that has ended, or never existed, is no error.
TEST(Machine, RenewsAndReleases) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  Answers answers;
  const std::size_t z = AxisNamed(machine, "z");
  engine.Submit(ToAxis(machine, "z", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  Command jog = ToAxis(machine, "z", axis::Jog{.forward = true, .velocity = 50});
  jog.lease_s = 0.2;
  const Ticket first = engine.Submit(jog);
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 150; ++i) engine.RunCycle();
    const Ticket renew = GiveMachine(engine, Renew{first});
    engine.RunCycle();
    answers.Take(engine);
    EXPECT_TRUE(answers.Has(renew, FeedbackState::kDone));
    EXPECT_NEAR(engine.outputs(z).set_velocity, 50, 1e-9);
  }
  const Ticket release = GiveMachine(engine, Release{first});
  engine.RunCycle();
  EXPECT_EQ(engine.outputs(z).state, axis::PlcState::kDiscreteMotion);
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  const Ticket second = engine.Submit(jog);
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  const Ticket over = GiveMachine(engine, Release{second});
  const Ticket never = GiveMachine(engine, Renew{12345});
  engine.RunCycle();
  answers.Take(engine);
  EXPECT_TRUE(answers.Has(release, FeedbackState::kDone));
  EXPECT_TRUE(answers.Has(first, FeedbackState::kDone));
  EXPECT_TRUE(answers.Has(second, FeedbackState::kAborted));
  EXPECT_TRUE(answers.Has(over, FeedbackState::kDone));
  EXPECT_TRUE(answers.Has(never, FeedbackState::kDone));
}

// EN-08: shutdown brakes along the ramps, opens the loops, refuses later commands.
TEST(Shutdown, BrakesAndOpensTheLoops) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  const std::size_t y1 = AxisNamed(machine, "y1");
  for (const auto& [when, command] : Scenario(machine)) {
    if (when >= 320) break;
    engine.Submit(command);
    for (int i = 0; i < 40; ++i) engine.RunCycle();
  }
  for (int i = 0; i < 320; ++i) engine.RunCycle();
  EXPECT_FALSE(engine.all_disabled());
  engine.RequestShutdown();
  engine.RunCycle();
  const Ticket late = engine.Submit(ToAxis(machine, "y1", axis::MoveAbsolute{.position = 0}));
  double before = engine.outputs(y1).set_velocity;
  int cycles = 0;
  for (; cycles < 5000 && !engine.all_disabled(); ++cycles) {
    engine.RunCycle();
    ASSERT_LE(std::abs(engine.outputs(y1).set_velocity - before), 5000 * 0.001 * (1 + 1e-9));
    before = engine.outputs(y1).set_velocity;
  }
  EXPECT_TRUE(engine.all_disabled());
  FeedbackEvent event;
  bool refused = false;
  int aborted = 0;
  while (engine.feedback().TryPop(event)) {
    refused |= event.ticket == late && event.error == ErrorId::kShutdown;
    // Commands in progress report why they ended.
    aborted += event.state == FeedbackState::kAborted && event.error == ErrorId::kShutdown ? 1 : 0;
  }
  EXPECT_TRUE(refused);
  EXPECT_GE(aborted, 3);  // a move and a buffered one on y1, a move_velocity on c
}

// AX-38: every drive off and every brake applied in the same cycle, commands aborted, faults cleared, state Disabled;
// switching on works at once.
TEST(EmergencyStop, SwitchesEverythingOffAtOnce) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  for (const auto& [when, command] : Scenario(machine)) {
    if (when < 320) engine.Submit(command);
    for (int i = 0; i < 40; ++i) engine.RunCycle();
  }
  const std::size_t y1 = AxisNamed(machine, "y1");
  engine.Submit(ToAxis(machine, "y1", axis::MoveVelocity{.velocity = 300}));
  engine.faults(AxisNamed(machine, "z")).drive_fault = true;
  for (int i = 0; i < 100; ++i) engine.RunCycle();
  ASSERT_EQ(engine.outputs(AxisNamed(machine, "z")).state, axis::PlcState::kErrorStop);
  ASSERT_GT(engine.outputs(y1).set_velocity, 100);
  engine.faults(AxisNamed(machine, "z")).drive_fault = false;
  engine.RunCycle();
  Command stop;
  stop.body = MachineCommand(EmergencyStop{});
  engine.Submit(stop);
  engine.RunCycle();
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    EXPECT_EQ(engine.outputs(i).state, axis::PlcState::kDisabled);
    EXPECT_FALSE(engine.outputs(i).loop_closed);
    EXPECT_EQ(engine.outputs(i).error, ErrorId::kNone);
    EXPECT_EQ(engine.outputs(i).active_command, 0u);
  }
  for (int i = 0; i < 500; ++i) engine.RunCycle();
  EXPECT_NEAR(engine.outputs(y1).actual_velocity, 0, 1);  // the brake holds
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.Submit(ToAxis(machine, "y2", axis::Power{}));  // its follower
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kStandstill);
}

// AX-100: while an emergency stop is held nothing is powered or moved, by any command, with an error of its own; a stop
// with several holders is on until the last one releases it; and nothing restarts by itself.
TEST(EmergencyStop, HoldsUntilEveryHolderLetsGo) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  Answers answers;
  for (const axis::AxisParams& a : machine.axes) engine.Submit(ToAxis(machine, a.name, axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  engine.Submit(ToAxis(machine, "y1", axis::MoveVelocity{.velocity = 300}));
  engine.Submit(ToAxis(machine, "c", axis::MoveAbsolute{.position = 90, .velocity = 50}));
  engine.Submit(ToAxis(machine, "c", axis::MoveAbsolute{.position = 10, .buffer_mode = axis::BufferMode::kBuffered}));
  for (int i = 0; i < 200; ++i) engine.RunCycle();
  const Ticket first = GiveMachine(engine, EmergencyStop{.hold = true});
  const Ticket second = GiveMachine(engine, EmergencyStop{.hold = true});
  const auto expect_disabled = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) {
      engine.RunCycle();
      for (std::size_t k = 0; k < machine.axes.size(); ++k) {
        ASSERT_EQ(engine.outputs(k).state, axis::PlcState::kDisabled) << machine.axes[k].name;
        ASSERT_FALSE(engine.outputs(k).loop_closed);
        ASSERT_TRUE(engine.outputs(k).emergency_stopped);
        ASSERT_EQ(engine.outputs(k).error, ErrorId::kNone);
      }
    }
  };
  const auto expect_refused = [&] {
    const Ticket ask = engine.Submit(ToAxis(machine, "c", axis::Power{}));
    expect_disabled(300);
    answers.Take(engine);
    const bool refused = std::any_of(answers.events.begin(), answers.events.end(), [&](const FeedbackEvent& e) {
      return e.ticket == ask && e.error == ErrorId::kEmergencyStop;
    });
    EXPECT_TRUE(refused);
  };
  expect_refused();
  GiveMachine(engine, Release{first});
  expect_refused();
  GiveMachine(engine, EmergencyStop{});  // for one cycle, meanwhile
  expect_refused();
  GiveMachine(engine, Release{second});
  expect_disabled(500);  // and nothing continues
  engine.Submit(ToAxis(machine, "c", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  const std::size_t c = AxisNamed(machine, "c");
  EXPECT_EQ(engine.outputs(c).state, axis::PlcState::kStandstill);
  EXPECT_FALSE(engine.outputs(c).emergency_stopped);
  for (int i = 0; i < 40; ++i) GiveMachine(engine, EmergencyStop{.hold = true});  // more than it can distinguish
  for (int i = 0; i < 5; ++i) engine.RunCycle();
  expect_refused();
  GiveMachine(engine, ReleaseEmergencyStop{});
  engine.Submit(ToAxis(machine, "c", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(c).state, axis::PlcState::kStandstill);
}

// EN-08: a command that an overrun ended in the same cycle was not ended by the shutdown.
TEST(Shutdown, IsNotTheReasonForWhatEndedBeforeIt) {
  Machine machine = FullMachine();
  machine.cycle.overruns_in_a_row = 1;
  Engine engine(machine);
  Answers answers;
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.Submit(ToAxis(machine, "y2", axis::Power{}));  // its follower
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  engine.Submit(ToAxis(machine, "y1", axis::MoveAbsolute{.position = 100}));
  const Ticket waits = engine.Submit(
      ToAxis(machine, "y1", axis::MoveAbsolute{.position = 0, .buffer_mode = axis::BufferMode::kBuffered}));
  for (int i = 0; i < 50; ++i) engine.RunCycle();
  engine.RequestShutdown();
  engine.RunCycle({0, 0, true});
  answers.Take(engine);
  ASSERT_TRUE(answers.Has(waits, FeedbackState::kAborted));
  for (const FeedbackEvent& event : answers.events) EXPECT_NE(event.error, ErrorId::kShutdown);
}

}  // namespace
}  // namespace takt::engine
