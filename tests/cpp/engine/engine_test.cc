// The engine as a whole: order, determinism, journal, overruns, shutdown, queues.
#include "takt/engine/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "machines.h"
#include "takt/axis/state.h"
#include "takt/core/describe.h"
#include "takt/core/verify.h"
#include "takt/engine/cycle.h"

namespace takt::engine {
namespace {

// EN-11: nothing of the machine file, the commands, the published state and the hashed state is left out of its
// description.
TEST(Descriptions, AreComplete) {
  EXPECT_THAT(Verify(TypeOf<Machine>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<axis::Outputs>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<axis::State>()), testing::IsEmpty());
  EXPECT_THAT(Verify(TypeOf<plant::ServoState>()), testing::IsEmpty());
  for (const Verb& verb : Verbs()) EXPECT_THAT(Verify(*verb.arguments), testing::IsEmpty()) << verb.name;
}

// Runs the scenario and gives the hash after every cycle.
std::vector<std::uint64_t> HashesOf(const Machine& machine, std::uint64_t cycles, const EngineOptions& options = {}) {
  Engine engine(machine, options);
  const auto commands = Scenario(machine);
  std::vector<std::uint64_t> hashes;
  for (std::uint64_t c = 0; c < cycles; ++c) {
    for (const auto& [when, command] : commands) {
      if (when == c) engine.Submit(command);
    }
    engine.RunCycle();
    hashes.push_back(engine.StateHash());
  }
  return hashes;
}

// EN-06: the same commands give the same bits, with and without anybody looking on.
TEST(Engine, IsBitForBitReproducible) {
  const Machine machine = FullMachine();
  const auto first = HashesOf(machine, 3000);
  EXPECT_EQ(first, HashesOf(machine, 3000));
  EXPECT_EQ(first, HashesOf(machine, 3000, {.publish = true, .every_cycle = true, .journal = true}));
  Machine other = machine;
  other.axes[3].loop.kp *= 1 + 1e-15;
  EXPECT_NE(first, HashesOf(other, 3000));  // and the hash sees the smallest difference
}

// Gives what is in the journal of `engine` to another one, through its text, and compares the hash of every cycle. The
// journalled commands.
std::vector<JournalEntry> ExpectReplayBitForBit(Engine& engine) {
  const Machine& machine = engine.machine();
  Engine again(machine, {.journal = true, .snapshot_queue = 1 << 13});
  std::vector<JournalEntry> entries;
  for (JournalEntry entry; engine.journal().TryPop(entry);) entries.push_back(entry);
  std::size_t next = 0;
  HashEntry expected;
  while (engine.hashes().TryPop(expected)) {
    for (; next < entries.size() && entries[next].cycle == expected.cycle; ++next) {
      const CommandText text = ToText(machine, entries[next].command);
      ParsedCommand parsed = ParseCommand(machine, text.target, text.verb, text.arguments);
      EXPECT_EQ(parsed.sentence, "");
      parsed.command.lease_s = entries[next].command.lease_s;
      parsed.command.ticket = entries[next].command.ticket;
      EXPECT_TRUE(again.Resubmit(parsed.command));
    }
    again.RunCycle();
    EXPECT_EQ(again.figures().state_hash, expected.hash) << expected.cycle;
    if (again.figures().state_hash != expected.hash) break;
  }
  EXPECT_EQ(next, entries.size());
  return entries;
}

// EN-06: the hash is one of axes and of servos, and another one every cycle.
TEST(Engine, HashesEverything) {
  const Machine machine = FullMachine();
  World one(machine), axis(machine), servo(machine);
  axis.axis_states[3].follow_offset = 1e-300;
  servo.servo_states[0].torque = 1e-300;
  EXPECT_NE(one.StateHash(), axis.StateHash());
  EXPECT_NE(one.StateHash(), servo.StateHash());
  Engine engine(machine, {.journal = true});
  for (int i = 0; i < 3; ++i) engine.RunCycle();
  HashEntry first, second;
  ASSERT_TRUE(engine.hashes().TryPop(first));
  ASSERT_TRUE(engine.hashes().TryPop(second));
  EXPECT_NE(first.hash, second.hash);
}

// EN-07: a replay's own commands are numbered behind those of the journal.
TEST(Journal, TicketsGoOnBehindIt) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  Command command = ToAxis(machine, "y1", axis::Halt{});
  command.ticket = 5;
  EXPECT_TRUE(engine.Resubmit(command));
  EXPECT_EQ(engine.Submit(command), 6u);
}

// EN-07: commands taken from the journal give the same hash in every cycle.
TEST(Journal, ReplaysBitForBit) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.journal = true, .snapshot_queue = 1 << 13});
  const auto commands = Scenario(machine);
  for (std::uint64_t c = 0; c < 3000; ++c) {
    for (const auto& [when, command] : commands) {
      if (when == c) engine.Submit(command);
    }
    if (c == 2700) engine.RequestShutdown();
    engine.RunCycle();
  }
  EXPECT_EQ(ExpectReplayBitForBit(engine).size(), commands.size() + 1);  // and the stop of the shutdown
}

// EN-05, EN-07: also a cycle that applies all it can of everything: overruns, renewals, commands, shutdown.
TEST(Journal, ReplaysTheFullestCycleBitForBit) {
  Machine machine = FullMachine();
  machine.cycle.overruns_in_a_row = 1;
  Engine engine(machine, {.journal = true, .snapshot_queue = 1 << 13});
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  Command jog = ToAxis(machine, "y1", axis::Jog{.forward = true, .velocity = 100});
  jog.lease_s = 0.1;
  const Ticket jogging = engine.Submit(jog);
  for (int i = 0; i < 90; ++i) engine.RunCycle();
  const auto fill = [&] {
    for (std::size_t i = 0; i < kCommandsPerCycle - 1; ++i) engine.Submit(ToAxis(machine, "z", axis::Reset{}));
    engine.Submit(ToAxis(machine, "y1", axis::Reset{}));  // one cycle later it would act in another state
    for (std::size_t i = 0; i < kRenewalsPerCycle; ++i) engine.Submit({.body = MachineCommand(Renew{jogging})});
  };
  fill();
  engine.RunCycle();  // the jog is renewed before its lease is over
  for (int i = 0; i < 50; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(AxisNamed(machine, "y1")).set_velocity, 100);
  fill();
  engine.RequestShutdown();
  engine.RunCycle({0, 0, true});
  for (int i = 0; i < 200; ++i) engine.RunCycle();
  fill();
  engine.RunCycle({0, 0, true});
  ExpectReplayBitForBit(engine);
}

// EN-05, EN-07
TEST(Journal, ReplaysAnOverrunInACycleFullOfCommandsBitForBit) {
  Machine machine = FullMachine();
  machine.cycle.overruns_in_a_row = 1;
  Engine engine(machine, {.journal = true, .snapshot_queue = 1 << 13});
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  for (std::size_t i = 0; i < kCommandsPerCycle - 1; ++i) engine.Submit(ToAxis(machine, "z", axis::Reset{}));
  engine.Submit(ToAxis(machine, "y1", axis::Reset{}));  // the last one the cycle takes
  engine.RunCycle({0, 0, true});
  for (int i = 0; i < 50; ++i) engine.RunCycle();
  const auto entries = ExpectReplayBitForBit(engine);
  EXPECT_EQ(entries.size(), 1 + kCommandsPerCycle + 1);
  EXPECT_EQ(entries.back().cycle, 300u);
}

// EN-03: the follower stands first in the file and still sees its master's set point of the same cycle, not of the one
// before.
TEST(Order, FollowersSeeTheirMastersValueOfTheSameCycle) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  const std::size_t master = AxisNamed(machine, "y1");
  const std::size_t follower = AxisNamed(machine, "y2");
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.Submit(ToAxis(machine, "y2", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(follower).state, axis::PlcState::kSynchronizedMotion);
  const double offset = engine.outputs(follower).set_position + engine.outputs(master).set_position;
  engine.Submit(ToAxis(machine, "y1", axis::MoveAbsolute{.position = 100}));
  double fastest = 0;
  for (int i = 0; i < 1000; ++i) {
    engine.RunCycle();
    fastest = std::max(fastest, engine.outputs(master).set_velocity);
    ASSERT_EQ(engine.outputs(follower).set_velocity, -engine.outputs(master).set_velocity);
    ASSERT_NEAR(engine.outputs(follower).set_position, offset - engine.outputs(master).set_position, 1e-9);
  }
  EXPECT_GT(fastest, 100);
  // A motion command of its own is refused; a fault of the follower stops the master too.
  engine.Submit(ToAxis(machine, "y2", axis::MoveAbsolute{.position = 0}));
  engine.Submit(ToAxis(machine, "y1", axis::MoveVelocity{.velocity = 100, .direction = axis::Direction::kNegative}));
  for (int i = 0; i < 200; ++i) engine.RunCycle();
  engine.faults(follower).drive_fault = true;
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(master).state, axis::PlcState::kErrorStop);
  EXPECT_EQ(engine.outputs(master).set_velocity, 0);
}

// EN-05: late cycles are counted; so many in a row as the machine allows stop everything along its ramps, with error
// 3007, and the loops stay closed. One less does nothing.
TEST(Overruns, InARowStopEverything) {
  Machine machine = FullMachine();
  machine.cycle.overruns_in_a_row = 5;
  Engine engine(machine, {.publish = true});
  const std::size_t y1 = AxisNamed(machine, "y1");
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
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
  EXPECT_GT(engine.outputs(y1).set_velocity, 300);  // braking, not dropped
  for (int i = 0; i < 300; ++i) engine.RunCycle({1000, 20000, false});
  EXPECT_EQ(engine.outputs(y1).set_velocity, 0);
  EXPECT_TRUE(engine.outputs(y1).loop_closed);
  EXPECT_EQ(engine.figures().overruns, 9u);
  EXPECT_EQ(engine.figures().latency.max, 2'000'000u);
  EXPECT_EQ(engine.figures().execution.count, 910u);
}

// EN-05: after they stopped everything overruns are counted anew; 0 means never.
TEST(Overruns, CountAnewAfterAStopOrNever) {
  for (const std::uint32_t allowed : {5u, 0u}) {
    Machine machine = FullMachine();
    machine.cycle.overruns_in_a_row = allowed;
    Engine engine(machine);
    const std::size_t y1 = AxisNamed(machine, "y1");
    engine.Submit(ToAxis(machine, "y1", axis::Power{}));
    for (int i = 0; i < 300; ++i) engine.RunCycle();
    for (int i = 0; i < 5; ++i) engine.RunCycle({0, 30000, true});
    EXPECT_EQ(engine.outputs(y1).error, allowed ? ErrorId::kOverrun : ErrorId::kNone);
    engine.Submit(ToAxis(machine, "y1", axis::Reset{}));
    for (int i = 0; i < 4; ++i) engine.RunCycle({0, 30000, true});
    EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kStandstill);
    EXPECT_EQ(engine.figures().latency.count, 9u);  // on time is a latency too
  }
}

// What became of one command, from the queue of an engine.
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

// Stops every axis along its ramp, keeps or opens the loops; those in ErrorStop or without power are left alone. Done
// at once.
TEST(Machine, StopAll) {
  for (const bool open : {false, true}) {
    const Machine machine = FullMachine();
    Engine engine(machine);
    Answers answers;
    const std::size_t y1 = AxisNamed(machine, "y1");
    const std::size_t c = AxisNamed(machine, "c");
    engine.Submit(ToAxis(machine, "y1", axis::Power{}));
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

// EN-23: the owner of a level-sensitive command is found on whatever axis it is; renewing keeps it, releasing ends it;
// what is over already, or never was, is no error.
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

// An axis that was told to switch on is not disabled, though its drive is not ready yet.
TEST(Engine, IsNotDisabledWhileADriveGetsReady) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  EXPECT_TRUE(engine.all_disabled());
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.RunCycle();
  EXPECT_FALSE(engine.outputs(AxisNamed(machine, "y1")).loop_closed);
  EXPECT_FALSE(engine.all_disabled());
}

// The first cycle sees what the machine is like, not zeros.
TEST(Engine, SeesTheMachineInItsFirstCycle) {
  Machine machine = FullMachine();
  machine.simulation.servos[0].switches.limit_positive.from = -1;
  machine.simulation.servos[0].mechanics.start_position = 10;
  Engine engine(machine);
  engine.RunCycle();
  EXPECT_TRUE(engine.outputs(AxisNamed(machine, "z")).limit_positive);
  EXPECT_NEAR(engine.outputs(AxisNamed(machine, "z")).actual_position, 10, 0.01);
}

// EN-08: shutdown brakes along the ramps, opens the loops, refuses what comes after.
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
    // What was under way says why it ended.
    aborted += event.state == FeedbackState::kAborted && event.error == ErrorId::kShutdown ? 1 : 0;
  }
  EXPECT_TRUE(refused);
  EXPECT_GE(aborted, 3);  // a move and one buffered behind it on y1, a move_velocity on c
}

// AX-38: every drive off and every brake on in the same cycle, commands aborted, faults cleared, state Disabled; power
// on works at once.
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
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(y1).state, axis::PlcState::kStandstill);
}

// EN-08: what an overrun ended in the same cycle was not ended by the shutdown.
TEST(Shutdown, IsNotTheReasonForWhatEndedBeforeIt) {
  Machine machine = FullMachine();
  machine.cycle.overruns_in_a_row = 1;
  Engine engine(machine);
  Answers answers;
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
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

// EN-21, EN-22: a full queue refuses; what was refused has no ticket, what was accepted is answered, in order.
TEST(CommandQueue, RefusesWhenFullAndLosesNothing) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.command_queue = 128});
  std::vector<Ticket> accepted;
  int refused = 0;
  for (int i = 0; i < 1000; ++i) {
    const Ticket ticket = engine.Submit(ToAxis(machine, "y1", axis::Halt{}));
    ticket ? accepted.push_back(ticket) : void(++refused);
  }
  EXPECT_EQ(accepted.size(), 120u);  // the rest is kept for what lets go
  EXPECT_EQ(refused, 1000 - 120);
  std::vector<Ticket> answered;
  for (int i = 0; i < 10; ++i) {
    engine.RunCycle();
    FeedbackEvent event;
    while (engine.feedback().TryPop(event)) answered.push_back(event.ticket);
    if (i == 0) {
      EXPECT_EQ(answered.size(), kCommandsPerCycle);  // a cycle takes so many at most
    }
  }
  EXPECT_EQ(engine.figures().commands_applied, 120u);
  EXPECT_EQ(answered, accepted);
  EXPECT_EQ(engine.figures().commands_refused, 880u);
}

// EN-22, EN-23: a flood of commands keeps out neither heartbeats nor what lets go or stops. At the longest cycle the
// queue alone would hold a heartbeat up for longer than its lease.
TEST(CommandQueue, AFloodKeepsOutNeitherRenewalsNorStops) {
  Machine machine = FullMachine();
  machine.cycle.period_s = 0.02;
  Engine engine(machine);
  const std::size_t z = AxisNamed(machine, "z");
  const std::size_t y1 = AxisNamed(machine, "y1");
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.Submit(ToAxis(machine, "z", axis::Power{}));
  for (int i = 0; i < 50; ++i) engine.RunCycle();
  Command jog = ToAxis(machine, "z", axis::Jog{.forward = true, .velocity = 5});
  jog.lease_s = 0.25;
  const Ticket jogging = engine.Submit(jog);
  const auto flood = [&] {
    while (engine.Submit(ToAxis(machine, "c", axis::Reset{}))) {
    }
  };
  const auto run = [&](int cycles) {
    for (int i = 0; i < cycles; ++i) {
      flood();
      if (i % 5 == 0) {
        EXPECT_NE(engine.Submit({.body = MachineCommand(Renew{jogging})}), 0u);
      }
      engine.RunCycle();
    }
  };
  run(200);
  EXPECT_NEAR(engine.outputs(z).set_velocity, 5, 1e-9);
  flood();
  EXPECT_NE(engine.Submit({.body = MachineCommand(Release{jogging})}), 0u);
  EXPECT_NE(engine.Submit({.body = MachineCommand(StopAll{})}), 0u);
  EXPECT_NE(engine.Submit(ToAxis(machine, "z", axis::Stop{})), 0u);
  EXPECT_NE(engine.Submit(ToAxis(machine, "y1", axis::Power{.enable = false})), 0u);
  EXPECT_EQ(engine.Submit(ToAxis(machine, "y1", axis::Power{})), 0u);
  run(100);
  EXPECT_EQ(engine.outputs(z).set_velocity, 0);
  EXPECT_FALSE(engine.outputs(y1).loop_closed);
}

// What lets go keeps its place behind what was given before it.
TEST(CommandQueue, KeepsTheOrder) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  engine.Submit(ToAxis(machine, "y1", axis::MoveAbsolute{.position = 100}));
  engine.Submit(ToAxis(machine, "y1", axis::Stop{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  EXPECT_EQ(engine.outputs(AxisNamed(machine, "y1")).set_velocity, 0);
  EXPECT_LT(std::abs(engine.outputs(AxisNamed(machine, "y1")).set_position), 1);
}

// EN-21: nobody empties the snapshot queue: counted drops, and the cycle goes on unchanged.
TEST(Snapshots, AreDroppedAndCountedWhenNobodyReads) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.publish = true, .every_cycle = true, .snapshot_queue = 64});
  for (int i = 0; i < 1000; ++i) engine.RunCycle();
  EXPECT_EQ(engine.figures().snapshots_dropped, 4000u - 64u);
}

// EN-07: a journal that lost something says so.
TEST(Journal, CountsWhatItLost) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.journal = true, .snapshot_queue = 64});
  for (int i = 0; i < 64; ++i) engine.RunCycle();
  EXPECT_EQ(engine.figures().journal_dropped, 0u);
  for (int i = 0; i < 10; ++i) engine.RunCycle();
  EXPECT_EQ(engine.figures().journal_dropped, 10u);
}

// EN-07: lost commands count like lost hashes.
TEST(Journal, CountsLostCommands) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.journal = true, .snapshot_queue = 64});
  for (int i = 0; i < 100; ++i) engine.Submit(ToAxis(machine, "y1", axis::Halt{}));
  for (int i = 0; i < 10; ++i) engine.RunCycle();
  EXPECT_EQ(engine.figures().journal_dropped, 36u);
}

// EN-21: nobody takes the feedback: what is lost is counted.
TEST(FeedbackQueue, CountsWhatItLost) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  std::uint64_t given = 0;
  for (int i = 0; i < 400; ++i) {
    for (std::size_t k = 0; k < kCommandsPerCycle; ++k) given += engine.Submit(ToAxis(machine, "y1", axis::Halt{})) > 0;
    engine.RunCycle();
  }
  std::uint64_t taken = 0;
  for (FeedbackEvent event; engine.feedback().TryPop(event);) ++taken;
  EXPECT_LT(taken, given);
  EXPECT_EQ(taken + engine.figures().feedback_dropped, given);
}

// EN-20: the engine's own figures, at their rate, each of its cycle; nothing where nobody asked for it.
TEST(Figures, ComeAtTheirRate) {
  Machine machine = FullMachine();
  machine.lcm.engine_rate_hz = 20;
  Engine engine(machine, {.publish = true});
  Engine silent(machine);
  engine.Submit(ToAxis(machine, "z", axis::Power{}));
  for (int i = 0; i < 300; ++i) engine.RunCycle();
  engine.Submit(ToAxis(
      machine, "z", axis::MoveAbsolute{.position = 1e12, .velocity = 1e-300, .acceleration = 1e-300, .jerk = 1e-300}));
  for (int i = 0; i < 200; ++i) engine.RunCycle();
  for (int i = 0; i < 500; ++i) silent.RunCycle();
  std::vector<std::uint64_t> cycles;
  EngineFigures figures;
  while (engine.figure_queue().TryPop(figures)) cycles.push_back(figures.cycle);
  EXPECT_THAT(cycles, testing::ElementsAre(0, 50, 100, 150, 200, 250, 300, 350, 400, 450));
  EXPECT_EQ(figures.planner_failures, 1u);
  EXPECT_FALSE(silent.figure_queue().TryPop(figures));
}

// EN-20: a rate that is no divisor is rounded; every_cycle adds the others, which are not due.
TEST(Snapshots, SayWhetherTheyAreDue) {
  Machine machine = FullMachine();
  machine.lcm.axis_rate_hz = 150;  // every 7th cycle
  Engine engine(machine, {.publish = true, .every_cycle = true});
  for (int i = 0; i < 700; ++i) engine.RunCycle();
  std::vector<int> due(4), all(4);
  AxisSnapshot snapshot;
  while (engine.snapshots().TryPop(snapshot)) {
    ++all[snapshot.axis];
    due[snapshot.axis] += snapshot.due;
  }
  EXPECT_THAT(all, testing::Each(700));
  EXPECT_THAT(due, testing::Each(100));
}

// EN-20: each axis at its own rate.
TEST(Snapshots, ComeAtTheRateOfTheirChannel) {
  Machine machine = FullMachine();
  machine.lcm.axis_rate_hz = 100;
  machine.lcm.rates = {{"c", 500}, {"z", 0}};
  Engine engine(machine, {.publish = true});
  for (int i = 0; i < 1000; ++i) engine.RunCycle();
  std::vector<int> counts(4);
  AxisSnapshot snapshot;
  while (engine.snapshots().TryPop(snapshot)) ++counts[snapshot.axis];
  EXPECT_EQ(counts[AxisNamed(machine, "y1")], 100);
  EXPECT_EQ(counts[AxisNamed(machine, "c")], 500);
  EXPECT_EQ(counts[AxisNamed(machine, "z")], 0);
}

// EN-20: axes of one rate come in the same cycles.
TEST(Snapshots, OfOneRateComeTogether) {
  Machine machine = FullMachine();
  machine.lcm.axis_rate_hz = 100;
  Engine engine(machine, {.publish = true});
  for (int i = 0; i < 1000; ++i) engine.RunCycle();
  std::map<std::uint64_t, int> axes;  // by cycle
  AxisSnapshot snapshot;
  while (engine.snapshots().TryPop(snapshot)) ++axes[snapshot.cycle];
  EXPECT_EQ(axes.size(), 100u);
  for (const auto& [cycle, count] : axes) EXPECT_EQ(count, 4) << cycle;
}

// A command for a target that does not exist, handed in from C++ past the parser.
TEST(CommandQueue, SurvivesAWrongTarget) {
  Engine engine(FullMachine());
  Command command;
  command.target = 77;
  command.body = axis::Command(axis::Halt{});
  engine.Submit(command);
  engine.RunCycle();
  FeedbackEvent event;
  ASSERT_TRUE(engine.feedback().TryPop(event));
  EXPECT_EQ(event.error, ErrorId::kUnknownTarget);
}

}  // namespace
}  // namespace takt::engine
