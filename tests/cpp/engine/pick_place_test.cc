// PP-01, EN-22: pick and place modules in a machine: loading, commands as text, a pick from a moving belt.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "takt/engine/engine.h"
#include "takt/engine/load.h"
#include "texts.h"
#include "wrong.h"

namespace takt::engine {
namespace {

using testing::HasSubstr;

const std::string kCellText = R"(
name: cell
axes:
  - {name: x, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: y, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: z, limits: {velocity: 1500, acceleration: 10000, jerk: 500000}}
  - {name: drive, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}
groups:
  - name: portal
    axes: [x, y, z]
    kinematics: {gantry: {axes: [x, y, z]}}
    path: {velocity: 1000, acceleration: 8000, jerk: 400000}
belts:
  - {name: infeed, axis: drive, origin: {y: 200, z: -50}, lower_limit: 0, upper_limit: 600}
pick_and_place:
  - name: picker
    group: portal
    belts: [{belt: infeed, settings: {park_x: 300, park_y: 200, park_z: 20, z_distance: 25, sync_time: 0.05}}]
    settings: {path_velocity: 1000, path_acceleration: 8000, path_deceleration: 8000, path_jerk: 400000, keep_orientation: true,
               blending_radius: 10, z_start_distance: 30, z_target_distance: 20, x_target: 100,
               max_velocity: [0, 0, 0, 0, 0, 0, 0], max_acceleration: [0, 0, 0, 0, 0, 0, 0], max_jerk: [0, 0, 0, 0, 0, 0, 0]}
)";

constexpr std::uint32_t kPicker = 4 + 1 + 1 + 1;

Machine CellMachine() {
  return MachineOf(kCellText);
}

// PP-01: mistakes in a machine file.
TEST(PickPlaceMachine, SaysWhatWasExpected) {
  EXPECT_THAT(ProblemOf(kCellText, "group: portal", "group: portl"),
              HasSubstr("expected the name of a group, found 'portl'; did you mean portal?"));
  EXPECT_THAT(ProblemOf(kCellText, "belt: infeed", "belt: infed"),
              HasSubstr("expected the name of a belt, found 'infed'"));
  EXPECT_THAT(ProblemOf(kCellText, "name: picker", "name: portal"), HasSubstr("expected a name that nothing else has"));
  EXPECT_THAT(ProblemOf(kCellText, "x_target: 100", "x_targt: 100"), HasSubstr("did you mean x_target?"));
  EXPECT_THAT(ProblemOf(kCellText, "    group: portal", "    group: portal\n    homing: [{axis: drive, homing: {}}]"),
              HasSubstr("expected the name of an axis of its group, found 'drive'"));
}

// PP-01, EN-22: every number made invalid is refused with a sentence.
TEST(PickPlaceMachine, BadNumbersAreRefusedAsText) {
  const Machine machine = CellMachine();
  int refused = 0;
  for (const pickplace::Command& good :
       {pickplace::Command(pickplace::Control{}), pickplace::Command(pickplace::Configure{}),
        pickplace::Command(pickplace::ConfigureBelt{})}) {
    const CommandText fine = ToText(machine, {0, kPicker, 0, good});
    ASSERT_EQ(ParseCommand(machine, fine.target, fine.verb, fine.arguments).sentence, "") << fine.verb;
    for (const Wrong<pickplace::Command>& wrong : WrongVersionsOf(good)) {
      const CommandText text = ToText(machine, {0, kPicker, 0, wrong.command});
      const ParsedCommand parsed = ParseCommand(machine, text.target, text.verb, text.arguments);
      EXPECT_EQ(parsed.error, ErrorId::kParameter) << wrong.what;
      EXPECT_THAT(parsed.sentence, HasSubstr(std::string(wrong.field) + ": expected ")) << wrong.what;
      ++refused;
    }
  }
  EXPECT_GT(refused, 200);
  EXPECT_THAT(ParseCommand(machine, "picker", "configure", "{max_velocity: [1, 2]}").sentence,
              HasSubstr("max_velocity"));
  EXPECT_THAT(ParseCommand(machine, "picker", "control", "{select_axis: q}").sentence, HasSubstr("select_axis"));
  EXPECT_THAT(ParseCommand(machine, "picker", "exekute", "{}").sentence, HasSubstr("expected a command of a pick and"));
}

struct Cell {
  explicit Cell(EngineOptions options = {}) : machine(CellMachine()), engine(machine, options) {}
  Ticket Give(std::uint32_t target, CommandBody body) { return engine.Submit({0, target, 0, std::move(body)}); }
  void Cycles(int n) {
    while (n-- > 0) engine.RunCycle();
  }
  const pickplace::Outputs& out() { return engine.pick_place_outputs(0); }

  Machine machine;
  Engine engine;
};

void PickOne(Cell& run) {
  run.Give(kPicker, pickplace::Command(pickplace::Control{.regulator_on = true}));
  run.Give(4, axis::Command(axis::Power{}));
  run.Cycles(1000);
  run.Give(4, axis::Command(axis::MoveVelocity{.velocity = 100}));
  run.Give(4 + 1 + 1, conveyor::Command(conveyor::Detect{.x = 50}));
  run.Give(kPicker, pickplace::Command(pickplace::Control{.execute = true, .set_target = 1}));
  run.Cycles(2500);
}

// PP-42, PP-44: from the belt of a machine, and parked.
TEST(PickPlaceMachine, PicksFromABelt) {
  Cell run;
  PickOne(run);
  EXPECT_EQ(run.out().picked, 1u);
  EXPECT_EQ(run.out().error, ErrorId::kNone);
  EXPECT_EQ(run.out().state, pickplace::PickPlaceState::kReady);
  EXPECT_TRUE(run.out().in_park_position);
  EXPECT_EQ(run.engine.belt_outputs(0).object_count, 0u);
  EXPECT_NEAR(run.engine.group_outputs(0).x, 300, 1e-6);
}

// EN-11: two equal runs are identical to the last bit of the state.
TEST(PickPlaceMachine, TheSameAgain) {
  Cell one, other;
  PickOne(one);
  PickOne(other);
  EXPECT_EQ(one.engine.StateHash(), other.engine.StateHash());
}

}  // namespace
}  // namespace takt::engine
