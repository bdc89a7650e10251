// PL-01 to PL-03, PL-13, EN-22: planar movers in a machine: loading, commands as text, stopping everything.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "takt/core/describe.h"
#include "takt/engine/engine.h"
#include "takt/engine/load.h"
#include "texts.h"
#include "wrong.h"

namespace takt::engine {
namespace {

using planar::ObjectState;
using testing::HasSubstr;

const std::string kPlaneText = R"(
name: plane
axes:
  - {name: x, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
movers:
  - name: one
    initial: {x: 60, y: 60}
    xy: {maximum: {velocity: 1000, acceleration: 8000, jerk: 200000}}
  - {name: two, initial: {x: 300, y: 60, c: 90}, z: {maximum: {velocity: 50, acceleration: 500, jerk: 9000}, lower: 0, upper: 3}}
tracks:
  - {name: way, elements: [{from: {x: 0, y: 400}, to: {x: 900, y: 400}}]}
planar_groups: [{name: cell}]
)";

Machine PlaneMachine() {
  return MachineOf(kPlaneText);
}

std::vector<mover::Command> GoodMoverCommands() {
  return {mover::Enable{},
          mover::Disable{},
          mover::Reset{},
          mover::Halt{},
          mover::SetPosition{},
          mover::MoveToPosition{},
          mover::MoveZ{},
          mover::MoveA{},
          mover::MoveB{},
          mover::MoveC{},
          mover::JoinTrack{.track = Name::Of("way")},
          mover::LeaveTrack{},
          mover::MoveOnTrack{.track = Name::Of("way")},
          mover::AdoptTrackOrientation{},
          mover::StartExternalSetpointGeneration{},
          mover::SetExternalSetpoint{},
          mover::StopExternalSetpointGeneration{},
          mover::Wait{},
          mover::Release{},
          mover::AddToGroup{Name::Of("cell")},
          mover::RemoveFromGroup{},
          mover::GearInPosOnTrack{.master = Name::Of("x"),
                                  .trail = {{Name::Of("way")}, 1},
                                  .direction_slave_sync_position = mover::TurnDirection::kPositive},
          mover::GearInPosOnTrackWithMasterMover{.master = Name::Of("one"),
                                                 .direction_slave_sync_position = mover::TurnDirection::kPositive,
                                                 .direction_master_sync_position = mover::TurnDirection::kPositive},
          mover::JoinFormation{Name::Of("one")},
          mover::LeaveFormation{},
          mover::MoveX{},
          mover::MoveY{},
          mover::MoveRelativeX{},
          mover::MoveRelativeY{},
          mover::MoveRelativeC{},
          mover::MoveVelocityX{},
          mover::MoveVelocityY{},
          mover::MoveVelocityC{},
          mover::HaltX{},
          mover::HaltY{},
          mover::HaltZ{},
          mover::HaltA{},
          mover::HaltB{},
          mover::HaltC{},
          mover::HaltOnTrack{},
          mover::SetRoute{.visits = {{mover::Visit{}}, 1}},
          mover::ContinueRoute{}};
}

Command To(std::uint32_t mover, const mover::Command& body) {
  return {0, 1 + 1 + mover, 0, body};
}

TEST(MoverMachine, SaysWhatWasExpected) {
  EXPECT_THAT(ProblemOf(kPlaneText, "name: two", "name: one"), HasSubstr("one"));
  EXPECT_THAT(ProblemOf(kPlaneText, "name: one", "name: x"), HasSubstr("expected a name that nothing else has"));
  EXPECT_THAT(ProblemOf(kPlaneText, "name: one", "name: 'o n e'"), HasSubstr("expected 1 to 40 letters"));
  EXPECT_THAT(ProblemOf(kPlaneText, "upper: 3", "upper: -3"), HasSubstr("must not lie below lower"));
  EXPECT_THAT(ProblemOf(kPlaneText, "y: 60, c: 90", "y: 60, z: 4"),
              HasSubstr("must lie within the limits of z, a and b"));
  EXPECT_THAT(ProblemOf(kPlaneText, "jerk: 200000}}", "jerk: 0}}"), HasSubstr("jerk: expected"));
}

// A machine may consist of movers only.
TEST(MoverMachine, NeedsNoAxes) {
  EXPECT_TRUE(LoadMachine("name: plane\naxes: []\nmovers: [{name: one}]\n", "plane.yaml").machine.has_value());
}

// PL-87: a mover placed on another one is an error that names both and the overlap.
TEST(MoverMachine, NoMoverIsPlacedOnAnother) {
  const struct {
    const char *one, *other, *by;  // by: null if they are adjacent
  } rows[] = {
      {"initial: {x: 40, y: 7}", "initial: {x: 40, y: 7}", "113.0 mm"},
      {"initial: {x: 40}", "initial: {x: 141.5}", "11.5 mm"},
      {"initial: {x: 40}", "initial: {x: 153}", ""},
      {"initial: {x: 40}", "initial: {x: 40, y: -113}", ""},
      // A long one beside another, and rotated across it.
      {"width: 240, initial: {x: 0}", "initial: {x: 150}", "26.5 mm"},
      {"width: 240, initial: {x: 0, c: 90}", "initial: {x: 150}", ""},
      // A corner rotated towards a side reaches 79.903 mm from its centre; two sides at 45 deg clear at 79.903 mm in X
      // and Y.
      {"initial: {c: 45}", "initial: {x: 136}", "0.404 mm"},
      {"initial: {c: 45}", "initial: {x: 136.5}", ""},
      {"initial: {c: 45}", "initial: {x: 79.9, y: 79.9, c: 45}", "0.005 mm"},
      {"initial: {c: 45}", "initial: {x: 79.91, y: 79.91, c: 45}", ""},
  };
  for (const auto& row : rows) {
    const std::string text = std::string("name: plane\naxes: []\nmovers:\n  - {name: far, initial: {x: 5000}}\n") +
                             "  - {name: one, " + row.one + "}\n  - {name: other, " + row.other + "}\n";
    const LoadResult loaded = LoadMachine(text, "plane.yaml");
    ASSERT_EQ(loaded.machine.has_value(), *row.by == '\0') << text;
    if (loaded.machine) continue;
    ASSERT_EQ(loaded.problems.size(), 1u);
    EXPECT_THAT(loaded.problems.front(), HasSubstr("plane.yaml:6"));
    EXPECT_THAT(loaded.problems.front(), HasSubstr(std::string("found 'other' on 'one': they overlap by ") + row.by));
  }
}

// PL-87: positions are relative to parts; two coordinate systems are independent.
TEST(MoverMachine, NoMoverIsPlacedOnAnotherAcrossParts) {
  const std::string text = R"(
name: halls
axes: []
coordinate_systems: [{name: below}, {name: above}]
parts:
  - {name: left, positions: [{coordinate_system: below}]}
  - {name: right, positions: [{coordinate_system: below, x: 240}]}
  - {name: top, positions: [{coordinate_system: above}]}
movers:
  - {name: one, reference: left, initial: {x: 180, y: 120}}
  - {name: other, reference: right, initial: {x: 60, y: 120}}
)";
  EXPECT_EQ(ProblemOf(text, "x: 60,", "x: 60,"), "");
  EXPECT_THAT(ProblemOf(text, "x: 60,", "x: 50,"), HasSubstr("'other' on 'one': they overlap by 3.0 mm"));
  EXPECT_THAT(ProblemOf(text, "right, initial: {x: 60", "below, initial: {x: 180"), HasSubstr("overlap by 113.0 mm"));
  EXPECT_EQ(ProblemOf(text, "right, initial: {x: 60", "top, initial: {x: 180"), "");
}

// PL-81: no gap may be smaller than the mover in any orientation; the default gap depends on its size.
TEST(MoverMachine, NoGapIsSmallerThanTheMover) {
  const std::string text = "name: plane\naxes: []\nmovers:\n  - {name: one, width: 150, height: 230, gap: 155}\n";
  EXPECT_EQ(ProblemOf(text, "gap: 155", "gap: 150"), "");
  EXPECT_EQ(ProblemOf(text, "230, gap: 155", "230"), "");
  EXPECT_EQ(ProblemOf(text, "150, height: 230, gap: 155", "250, height: 230"), "");
  EXPECT_THAT(
      ProblemOf(text, "gap: 155", "gap: 149.5"),
      HasSubstr("test.yaml:4:47: movers[0].gap: expected at least the smaller side of the mover, 150.0 mm, found "
                "149.5 mm"));
}

// EN-22, PL-02: every number made invalid is refused with a sentence.
TEST(MoverMachine, BadNumbersAreRefusedAsText) {
  const Machine machine = PlaneMachine();
  ASSERT_EQ(GoodMoverCommands().size(), std::variant_size_v<mover::Command>);
  int refused = 0;
  std::size_t index = 0;
  for (const mover::Command& good : GoodMoverCommands()) {
    EXPECT_EQ(good.index(), index++);
    const CommandText fine = ToText(machine, To(1, good));
    EXPECT_EQ(fine.target, "two");
    ASSERT_EQ(ParseCommand(machine, fine.target, fine.verb, fine.arguments).sentence, "") << fine.verb;
    for (const Wrong<mover::Command>& wrong : WrongVersionsOf(good)) {
      const CommandText text = ToText(machine, To(1, wrong.command));
      const ParsedCommand parsed = ParseCommand(machine, text.target, text.verb, text.arguments);
      EXPECT_EQ(parsed.error, ErrorId::kParameter) << wrong.what;
      EXPECT_THAT(parsed.sentence, HasSubstr(std::string(wrong.field) + ": expected ")) << wrong.what;
      ++refused;
    }
  }
  EXPECT_GT(refused, 200);
  EXPECT_THAT(ParseCommand(machine, "one", "move_c", "{position: 1, additional_turns: 1}").sentence,
              HasSubstr("must be 0 unless"));
  EXPECT_THAT(ParseCommand(machine, "one", "start_external_setpoint_generation", "{mode: none}").sentence,
              HasSubstr("must be absolute or relative"));
}

// The same commands given in C++, without the reader: they do not change the state.
TEST(MoverMachine, BadNumbersAreRefusedInTheCycle) {
  Engine engine(PlaneMachine());
  engine.Submit(To(0, mover::Enable{}));
  for (int i = 0; i < 5; ++i) engine.RunCycle();
  FeedbackEvent event;
  while (engine.feedback().TryPop(event)) {
  }
  for (const mover::Command& good : GoodMoverCommands()) {
    for (const Wrong<mover::Command>& wrong : WrongVersionsOf(good)) {
      const Ticket ticket = engine.Submit(To(0, wrong.command));
      engine.RunCycle();
      ASSERT_TRUE(engine.feedback().TryPop(event));
      EXPECT_EQ(event.ticket, ticket);
      EXPECT_EQ(event.error, ErrorId::kParameter) << wrong.what;
    }
  }
  EXPECT_EQ(engine.mover_outputs(0).x, 60);
}

// Whatever stops everything stops movers, with their maximum dynamics.
TEST(MoverMachine, WhatStopsEverythingStopsMovers) {
  const auto stops = [](const auto& how, ObjectState then) {
    std::string text = kPlaneText;  // without obstacles
    text.replace(text.find("x: 300, y: 60"), 13, "x: 300, y: 900");
    Engine engine(MachineOf(text));
    engine.Submit(To(0, mover::Enable{}));
    for (int i = 0; i < 5; ++i) engine.RunCycle();
    EXPECT_FALSE(engine.all_disabled());
    engine.Submit(To(0, mover::MoveToPosition{.x = 2000, .y = 60, .velocity = 900.0, .jerk = 20000.0}));
    for (int i = 0; i < 700; ++i) engine.RunCycle();
    EXPECT_NEAR(engine.mover_outputs(0).velocity_x, 900, 1);
    EXPECT_FALSE(engine.at_rest());
    const double rest = trajectory::StopPosition(engine.mover_state(0).set_point[mover::kX],
                                                 engine.machine().movers[0].xy.maximum.limits());
    how(engine);
    for (int i = 0; i < 400; ++i) engine.RunCycle();
    EXPECT_EQ(engine.mover_outputs(0).state, then);
    EXPECT_NEAR(engine.mover_outputs(0).x, rest, 1e-3);
    EXPECT_TRUE(engine.at_rest());
    EXPECT_EQ(engine.all_disabled(), then == ObjectState::kDisabled);
  };
  const auto machine = [](const MachineCommand& command) {
    return [command](Engine& engine) { engine.Submit({0, kMachineTarget, 0, command}); };
  };
  stops(machine(StopAll{}), ObjectState::kEnabled);
  stops(machine(StopAll{.open_loops = true}), ObjectState::kDisabled);
  stops(machine(EmergencyStop{}), ObjectState::kDisabled);
  stops(machine(FailAllAxes{}), ObjectState::kError);
  stops([](Engine& engine) { engine.RequestShutdown(); }, ObjectState::kDisabled);
}

// EN-22: a command that stops a mover finds room in a full queue.
TEST(MoverMachine, WhatStopsAMoverLetsGo) {
  std::size_t lets_go = 0;
  for (const mover::Command& command : GoodMoverCommands()) lets_go += LetsGo(To(0, command)) ? 1 : 0;
  EXPECT_EQ(lets_go, 10u);  // including those of one coordinate and on the track
  EXPECT_TRUE(LetsGo(To(0, mover::Halt{})));
  EXPECT_TRUE(LetsGo(To(0, mover::Disable{})));
  EXPECT_TRUE(LetsGo(To(0, mover::StopExternalSetpointGeneration{})));
}

// A mover in Error does not prevent the engine from shutting down.
TEST(MoverMachine, AFaultDoesNotHinderShutdown) {
  Engine engine(PlaneMachine());
  engine.Submit(To(0, mover::Enable{}));
  for (int i = 0; i < 5; ++i) engine.RunCycle();
  engine.Submit({0, kMachineTarget, 0, MachineCommand(FailAllAxes{})});
  for (int i = 0; i < 5; ++i) engine.RunCycle();
  EXPECT_EQ(engine.mover_outputs(0).error, ErrorId::kOverrun);
  EXPECT_FALSE(engine.all_disabled());
  engine.RequestShutdown();
  for (int i = 0; i < 5; ++i) engine.RunCycle();
  EXPECT_TRUE(engine.all_disabled());
}

// EN-07: the state of a mover is in the hash.
TEST(MoverMachine, IsPartOfTheHash) {
  Engine one(PlaneMachine());
  Engine other(PlaneMachine());
  for (int i = 0; i < 300; ++i) {
    if (i == 10 || i == 50) {
      const mover::Command body = i == 10 ? mover::Command(mover::Enable{}) : mover::MoveToPosition{.x = 200};
      one.Submit(To(1, body));
      other.Submit(To(1, body));
    }
    one.RunCycle();
    other.RunCycle();
    ASSERT_EQ(one.StateHash(), other.StateHash());
  }
  one.Submit(To(1, mover::MoveZ{.position = 1}));
  one.RunCycle();
  other.RunCycle();
  EXPECT_NE(one.StateHash(), other.StateHash());
}

}  // namespace
}  // namespace takt::engine
