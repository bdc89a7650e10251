// Queues for input and output, each of which may be full: commands, feedback, snapshots, figures.
#include "takt/engine/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "machines.h"
#include "takt/engine/components.h"
#include "takt/engine/cycle.h"

namespace takt::engine {
namespace {

// EN-21, EN-22: a full queue refuses; a refused command has no ticket, accepted ones are answered, in order.
TEST(CommandQueue, RefusesWhenFullAndLosesNothing) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.command_queue = 128});
  std::vector<Ticket> accepted;
  int refused = 0;
  for (int i = 0; i < 1000; ++i) {
    const Ticket ticket = engine.Submit(ToAxis(machine, "y1", axis::MoveAbsolute{}));
    ticket ? accepted.push_back(ticket) : void(++refused);
  }
  EXPECT_EQ(accepted.size(), 128u);
  EXPECT_EQ(refused, 1000 - 128);
  std::vector<Ticket> answered;
  for (int i = 0; i < 10; ++i) {
    engine.RunCycle();
    FeedbackEvent event;
    while (engine.feedback().TryPop(event)) answered.push_back(event.ticket);
    if (i == 0) {
      EXPECT_EQ(answered.size(), kCommandsPerCycle);  // the maximum of a cycle
    }
  }
  EXPECT_EQ(engine.figures().commands_applied, 128u);
  EXPECT_EQ(answered, accepted);
  EXPECT_EQ(engine.figures().commands_refused, 872u);
}

// EN-22, EN-23: a flood of commands blocks neither heartbeats nor commands with LetsGo(). At the longest cycle the
// queue alone would delay a heartbeat for longer than its lease.
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

// EN-32: with a full queue every command that stops, releases or switches off is accepted, for every kind of component,
// in its text form and as the parser reads it; nothing else is.
TEST(CommandQueue, TakesWhatLetsGoOfEveryKind) {
  const Machine machine = FullMachine();
  const std::map<std::pair<std::string, std::string>, std::vector<std::string>> lets_go = {
      {{"machine", "stop_all"}, {"", "{open_loops: true}"}},
      {{"machine", "emergency_stop"}, {""}},
      {{"machine", "fail_all_axes"}, {""}},
      {{"machine", "release"}, {"{ticket: 7}"}},
      {{"machine", "hold_routes"}, {"", "{movers: [1]}"}},
      {{"axis", "halt"}, {"", "{deceleration: 10}"}},
      {{"axis", "stop"}, {"", "{hold: true}"}},
      {{"axis", "power"}, {"{enable: false}"}},
      {{"axis", "jog"}, {"", "{forward: false, backward: false, velocity: 3}"}},
      {{"axis", "halt_superimposed"}, {""}},
      {{"axis", "set_override"}, {"{velocity_factor: 0}"}},
      {{"axis", "direct_output"}, {"{voltage: 0}"}},
      {{"flex_cam", "control"}, {"{stop: true}", "{halt: true}", "{regulator_on: false}", "{sync_out_instant: true}"}},
      {{"flex_cam", "jog"}, {""}},
      {{"group", "jog"}, {"", "{x: 0, coordinate_system: wcs}"}},
      {{"group", "stop"}, {""}},
      {{"group", "halt"}, {""}},
      {{"group", "interrupt"}, {""}},
      {{"group", "disable"}, {""}},
      {{"group", "power"}, {"{enable: false}"}},
      {{"group", "set_override"}, {"{velocity_factor: 0}"}},
      {{"pick_place", "control"}, {"{stop_all: true}", "{path_stop: true}", "{path_halt: true}", "{abort: true}"}},
      {{"pick_place", "jog"}, {""}},
      {{"mover", "halt"}, {""}},
      {{"mover", "halt_x"}, {""}},
      {{"mover", "halt_y"}, {""}},
      {{"mover", "halt_z"}, {""}},
      {{"mover", "halt_a"}, {""}},
      {{"mover", "halt_b"}, {""}},
      {{"mover", "halt_c"}, {""}},
      {{"mover", "halt_on_track"}, {""}},
      {{"mover", "disable"}, {""}},
      {{"mover", "stop_external_setpoint_generation"}, {""}},
      {{"track", "disable"}, {""}},
      {{"part", "force_disable"}, {""}},
  };
  std::map<std::string, std::string> target_of = {{"machine", "machine"}};
  for (const ComponentKind& kind : ComponentKinds()) {
    if (kind.count(machine) > 0) target_of[std::string(kind.name)] = std::string(kind.name_of(machine, 0));
  }
  for (const auto& [verb, all_arguments] : lets_go) {
    for (const std::string& arguments : all_arguments) {
      EXPECT_TRUE(LetsGo(verb.first, verb.second, arguments)) << verb.first << ' ' << verb.second << ' ' << arguments;
      if (!target_of.contains(verb.first)) continue;
      Engine engine(machine, {.command_queue = 32});
      while (engine.Submit(ToAxis(machine, "y1", axis::Reset{}))) {
      }
      const ParsedCommand parsed = ParseCommand(machine, target_of[verb.first], verb.second, arguments);
      ASSERT_EQ(parsed.error, ErrorId::kNone) << parsed.sentence;
      EXPECT_NE(engine.Submit(parsed.command), 0u) << verb.first << ' ' << verb.second << ' ' << arguments;
    }
  }
  for (const Verb& verb : Verbs()) {  // without arguments most verbs cannot be parsed, or cause no motion
    if (lets_go.contains({std::string(verb.target_kind), std::string(verb.name)})) continue;
    EXPECT_FALSE(LetsGo(verb.target_kind, verb.name, "")) << verb.target_kind << ' ' << verb.name;
  }
  EXPECT_FALSE(LetsGo("axis", "power", ""));
  EXPECT_FALSE(LetsGo("axis", "jog", "{forward: true}"));
  EXPECT_FALSE(LetsGo("axis", "set_override", "{velocity_factor: 0.5}"));
  EXPECT_FALSE(LetsGo("flex_cam", "control", "{sync_cam: true}"));
  EXPECT_FALSE(LetsGo("flex_cam", "control", "{regulator_on: true, sync_cam: false}"));
  EXPECT_FALSE(LetsGo("pick_place", "control", "{regulator_on: true, override_factor: 0}"));
  EXPECT_FALSE(LetsGo("axis", "halt", "{no_such: 1}"));
  EXPECT_FALSE(LetsGo("axis", "no_such", ""));
}

// EN-32: there is a reserved entry for the stop of every component, and one for the whole machine after all of those.
TEST(CommandQueue, HasAPlaceForEveryStopAtOnce) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.command_queue = 16});
  while (engine.Submit(ToAxis(machine, "y1", axis::Reset{}))) {
  }
  for (const axis::AxisParams& axis : machine.axes) {
    EXPECT_NE(engine.Submit(ToAxis(machine, axis.name, axis::Halt{})), 0u) << axis.name;
    EXPECT_NE(engine.Submit(ToAxis(machine, axis.name, axis::Power{.enable = false})), 0u) << axis.name;
  }
  while (engine.Submit(ToAxis(machine, "y1", axis::Halt{}))) {
  }
  EXPECT_NE(engine.Submit({.body = MachineCommand(EmergencyStop{})}), 0u);
  EXPECT_EQ(engine.Submit({.body = MachineCommand(Release{3})}), 0u);
}

// EN-33: a command that waited in the queue beyond its age limit is refused, unless LetsGo() is true; without a clock
// none is.
TEST(CommandQueue, RefusesWhatExpiredMeanwhile) {
  const Machine machine = FullMachine();
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (const std::int64_t now : {std::int64_t{0}, 2 * kSecond, 2 * kSecond + 1, 60 * kSecond}) {
    Engine engine(machine);
    Command power = ToAxis(machine, "y1", axis::Power{}), halt = ToAxis(machine, "z", axis::Halt{});
    power.expires_ns = halt.expires_ns = 2 * kSecond;
    const Ticket first = engine.Submit(power), second = engine.Submit(halt);
    engine.RunCycle({.now_ns = now});
    std::map<Ticket, ErrorId> errors;
    for (FeedbackEvent event; engine.feedback().TryPop(event);) errors[event.ticket] = event.error;
    EXPECT_EQ(errors[first], now > 2 * kSecond ? ErrorId::kTooOld : ErrorId::kNone) << now;
    EXPECT_NE(errors[second], ErrorId::kTooOld) << now;
  }
}

// Commands with LetsGo() stay behind earlier commands.
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

// EN-21: without a reader of the snapshot queue: counted drops, and the cycle is unaffected.
TEST(Snapshots, AreDroppedAndCountedWhenNobodyReads) {
  const Machine machine = FullMachine();
  Engine engine(machine, {.publish = true, .every_cycle = true, .snapshot_queue = 64});
  for (int i = 0; i < 1000; ++i) engine.RunCycle();
  const std::size_t kept = 7 * 64 + 2 * 64;  // a queue for each kind of components, one for objects on belts
  EXPECT_EQ(engine.figures().snapshots_dropped, 1000 * (engine.components() + machine.belts.size()) - kept);
}

// EN-21: without a reader of the feedback: lost events are counted.
TEST(FeedbackQueue, CountsWhatItLost) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  std::uint64_t given = 0;
  for (int i = 0; i < 1000; ++i) {
    for (std::size_t k = 0; k < kCommandsPerCycle; ++k)
      given += engine.Submit(ToAxis(machine, "y1", axis::MoveAbsolute{})) > 0;
    engine.RunCycle();
  }
  std::uint64_t taken = 0;
  for (FeedbackEvent event; engine.feedback().TryPop(event);) ++taken;
  EXPECT_LT(taken, given);
  EXPECT_EQ(taken + engine.figures().feedback_dropped, given);
}

// EN-20: the engine's own figures, at their rate, each of its cycle; none without `publish`.
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

// EN-20: a rate that is no divisor is rounded; every_cycle adds the other cycles, which are not due.
TEST(Snapshots, SayWhetherTheyAreDue) {
  Machine machine = FullMachine();
  machine.lcm.axis_rate_hz = 150;  // every 7th cycle
  Engine engine(machine, {.publish = true, .every_cycle = true});
  for (int i = 0; i < 700; ++i) engine.RunCycle();
  std::vector<int> due(machine.axes.size()), all(due);
  AxisSnapshot snapshot;
  while (engine.snapshots().TryPop(snapshot)) {
    ++all[snapshot.index];
    due[snapshot.index] += snapshot.due;
  }
  EXPECT_THAT(all, testing::Each(700));
  EXPECT_THAT(due, testing::Each(100));
  int due_of_module = 0, all_of_module = 0;
  FlexCamSnapshot of_module;
  while (engine.snapshots<flexcam::Outputs>().TryPop(of_module)) {
    ++all_of_module;
    due_of_module += of_module.due;
  }
  EXPECT_EQ(all_of_module, 700);
  EXPECT_EQ(due_of_module, 100);
}

// EN-20: each component at its own rate.
TEST(Snapshots, ComeAtTheRateOfTheirChannel) {
  Machine machine = FullMachine();
  machine.lcm.axis_rate_hz = 100;
  machine.lcm.rates = {{"c", 500}, {"z", 0}, {"cutter", 250}};
  Engine engine(machine, {.publish = true});
  for (int i = 0; i < 1000; ++i) engine.RunCycle();
  std::vector<int> counts(machine.axes.size());
  AxisSnapshot snapshot;
  while (engine.snapshots().TryPop(snapshot)) ++counts[snapshot.index];
  EXPECT_EQ(counts[AxisNamed(machine, "y1")], 100);
  EXPECT_EQ(counts[AxisNamed(machine, "c")], 500);
  EXPECT_EQ(counts[AxisNamed(machine, "z")], 0);
  int of_module = 0;
  FlexCamSnapshot module;
  while (engine.snapshots<flexcam::Outputs>().TryPop(module)) ++of_module;
  EXPECT_EQ(of_module, 250);
}

// EN-20: axes of one rate are published in the same cycles.
TEST(Snapshots, OfOneRateComeTogether) {
  Machine machine = FullMachine();
  machine.lcm.axis_rate_hz = 100;
  Engine engine(machine, {.publish = true});
  for (int i = 0; i < 1000; ++i) engine.RunCycle();
  std::map<std::uint64_t, std::size_t> axes;  // by cycle
  AxisSnapshot snapshot;
  while (engine.snapshots().TryPop(snapshot)) ++axes[snapshot.cycle];
  EXPECT_EQ(axes.size(), 100u);
  for (const auto& [cycle, count] : axes) EXPECT_EQ(count, machine.axes.size()) << cycle;
}

// EN-21: dropped snapshots are those of another component every time, so that each is published from time to time.
TEST(Snapshots, ThatDoNotFitAreNotAlwaysThoseOfTheSame) {
  for (const double rate_hz : {1000.0, 500.0, 100.0}) {
    Machine machine = FullMachine();
    machine.lcm.axis_rate_hz = rate_hz;
    Engine engine(machine, {.publish = true, .snapshot_queue = 2});
    std::vector<int> counts(machine.axes.size());
    AxisSnapshot snapshot;
    for (int i = 0; i < 1000; ++i) {
      engine.RunCycle();
      while (engine.snapshots().TryPop(snapshot)) ++counts[snapshot.index];
    }
    const double fair = 2 * rate_hz / static_cast<double>(machine.axes.size());
    ASSERT_LT(fair, rate_hz) << "all fit";
    for (const int count : counts) EXPECT_NEAR(count, fair, 0.5 * fair) << rate_hz;
    EXPECT_GT(engine.figures().snapshots_dropped, 0u);
  }
}

// A command for a target that does not exist, given in C++ without the parser.
TEST(CommandQueue, SurvivesAWrongTarget) {
  const Machine machine = FullMachine();
  Engine engine(machine);
  const auto axes = static_cast<std::uint32_t>(machine.axes.size());
  const CommandBody to_axis = axis::Command(axis::Halt{}), to_module = flexcam::Command(flexcam::Control{});
  const std::pair<std::uint32_t, CommandBody> wrong[] = {{77, to_axis},   {0, to_axis},   {axes + 1, to_axis},
                                                         {77, to_module}, {0, to_module}, {axes, to_module}};
  for (const auto& [target, body] : wrong) {
    engine.Submit({.target = target, .body = body});
    engine.RunCycle();
    FeedbackEvent event;
    ASSERT_TRUE(engine.feedback().TryPop(event));
    EXPECT_EQ(event.error, ErrorId::kUnknownTarget) << target;
  }
}

}  // namespace
}  // namespace takt::engine
