// The same commands give the same bits: hashes of the state, and replays of journals.
#include "takt/engine/engine.h"

#include <gtest/gtest.h>

#include "machines.h"
#include "takt/engine/cycle.h"

namespace takt::engine {
namespace {

// Runs the scenario and returns the hash after every cycle.
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

// EN-06: the same commands give the same bits, with and without readers.
TEST(Engine, IsBitForBitReproducible) {
  const Machine machine = FullMachine();
  const auto first = HashesOf(machine, 3000);
  EXPECT_EQ(first, HashesOf(machine, 3000));
  EXPECT_EQ(first, HashesOf(machine, 3000, {.publish = true, .every_cycle = true, .journal = true}));
  Machine other = machine;
  other.axes[3].loop.kp *= 1 + 1e-15;
  EXPECT_NE(first, HashesOf(other, 3000));  // and the hash sees the smallest difference
}

// Replays the journal of `engine` in another one, through its text form, and compares the hash of every cycle. Returns
// the journalled commands.
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

// EN-06: the hash depends on axes and servos, and changes every cycle.
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

// EN-07: a replay's own commands are numbered after those of the journal.
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

// EN-05, EN-07: also a cycle with the maximum of everything: overruns, renewals, commands, shutdown.
TEST(Journal, ReplaysTheFullestCycleBitForBit) {
  Machine machine = FullMachine();
  machine.cycle.overruns_in_a_row = 1;
  Engine engine(machine, {.journal = true, .snapshot_queue = 1 << 13});
  engine.Submit(ToAxis(machine, "y1", axis::Power{}));
  engine.Submit(ToAxis(machine, "y2", axis::Power{}));  // its follower
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
  engine.RunCycle();  // the jog is renewed before its lease ends
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
  engine.Submit(ToAxis(machine, "y1", axis::Reset{}));  // the last one that the cycle takes
  engine.RunCycle({0, 0, true});
  for (int i = 0; i < 50; ++i) engine.RunCycle();
  const auto entries = ExpectReplayBitForBit(engine);
  EXPECT_EQ(entries.size(), 1 + kCommandsPerCycle + 1);
  EXPECT_EQ(entries.back().cycle, 300u);
}

// EN-07: a journal with losses reports them.
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

}  // namespace
}  // namespace takt::engine
