// Every number of every command of a cam module, made invalid: refused with a sentence before it reaches the cycle; if
// it reaches the cycle, it moves no axis out of its limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "cam_rig.h"
#include "wrong.h"

namespace takt::engine {
namespace {

using testing::HasSubstr;

// A rotary web, a knife that follows it, two more cams.
const char* kWebText = R"(
name: bad
axes:
  - {name: knife, limits: {velocity: 500, acceleration: 5000, jerk: 100000, lower: -200, upper: 200}}
  - {name: web, kind: rotary, limits: {velocity: 400, acceleration: 4000, jerk: 0}}
cams:
  - name: hill
    cyclic: true
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 180, y: 20, v: 0, a: 0}, {x: 360, y: 0, v: 0, a: 0}]
  - name: valley
    cyclic: true
    points: [{x: 0, y: 0, v: 0, a: 0}, {x: 180, y: -9, v: 0, a: 0}, {x: 360, y: 0, v: 0, a: 0}]
flex_cams:
  - {name: cutter, slave: knife, master: web, cams: [hill, valley],
     settings: {sync_mode: ramp_time, sync_in_time_s: 0.2, slave_absolute: true}}
)";

Machine BadMachine() {
  LoadResult loaded = LoadMachine(kWebText, "bad.yaml");
  if (!loaded.machine) throw std::runtime_error(loaded.problems.front());
  return *loaded.machine;
}

std::vector<flexcam::Command> GoodModuleCommands() {
  return {flexcam::Control{}, flexcam::Configure{}, flexcam::ChangeCam{.cam_table = 2, .position = 10}};
}

constexpr std::size_t kKnife = 0, kWeb = 1;

// The web rotates and the module is on its cam.
void Synchronise(Line& line) {
  line.Give(kWeb, axis::MoveVelocity{.velocity = 100});
  line.engine.Submit(ToModule(line.machine, flexcam::Control{.regulator_on = true}));
  line.engine.Submit(ToModule(line.machine, flexcam::Control{.sync_cam = true}));
  line.Run(500);
}

// CAM-10, EN-22
TEST(FlexCamBadInput, IsRefusedAsTextWithASentence) {
  const Machine machine = BadMachine();
  int refused = 0;
  for (const flexcam::Command& good : GoodModuleCommands()) {
    const CommandText fine = ToText(machine, ToModule(machine, good));
    ASSERT_EQ(ParseCommand(machine, fine.target, fine.verb, fine.arguments).error, ErrorId::kNone) << fine.arguments;
    for (const Wrong<flexcam::Command>& wrong : WrongVersionsOf(good)) {
      const CommandText text = ToText(machine, ToModule(machine, wrong.command));
      const ParsedCommand parsed = ParseCommand(machine, text.target, text.verb, text.arguments);
      EXPECT_EQ(parsed.error, ErrorId::kParameter) << wrong.what;
      EXPECT_THAT(parsed.sentence, HasSubstr(std::string(wrong.field) + ": expected ")) << wrong.what;
      ++refused;
    }
  }
  EXPECT_GT(refused, 200);
}

// CAM-10, EN-22: whole numbers, names of members, texts of the wrong kind, misspelt arguments.
TEST(FlexCamBadInput, SaysWhatWasExpected) {
  const Machine machine = BadMachine();
  const struct {
    const char* verb;
    const char* arguments;
    const char* sentence;
  } cases[] = {
      {"control", "{cam_table: 0}", "cam_table: expected a whole number from 1 to 4, found 0"},
      {"control", "{cam_table: 5}", "cam_table: expected a whole number from 1 to 4, found 5"},
      {"control", "{cam_table: 1.5}", "cam_table: expected a whole number"},
      {"control", "{cam_table: -1}", "cam_table: expected "},
      {"control", "{cam_table: 4294967297}", "cam_table: expected "},
      {"control", "{sync_cam: 3}", "sync_cam: expected true or false"},
      {"control", "{sync_can: true}", "did you mean sync_cam?"},
      {"control", "{scaling_master: 0}", "scaling_master: expected "},
      {"control", "{scaling_slave: -1}", "scaling_slave: expected "},
      {"configure", "{sync_mode: ramp_tim}", "did you mean ramp_time?"},
      {"configure", "{master_sync_in_distance: -1}", "master_sync_in_distance: expected "},
      {"configure", "{jerk: 0}", "jerk: expected "},
      {"set_cam", "{slot: 0, cam: hill}", "slot: expected a whole number from 1 to 4, found 0"},
      {"set_cam", "{slot: 5, cam: hill}", "slot: expected a whole number from 1 to 4, found 5"},
      {"set_cam", "{slot: 1, cam: ''}", "cam: expected the name of a cam, found an empty text"},
      {"set_cam", "{slot: 1}", "cam: "},
      {"set_cam", "{cam: hill}", "slot: "},
      {"change_cam", "{cam_table: 0}", "cam_table: expected a whole number from 1 to 4, found 0"},
      {"change_cam", "{cam_table: 2, when: now}", "when: expected "},
      {"change_cam", "{}", "cam_table: "},
      {"jog", "{positive: 1}", "positive: expected true or false"},
      {"withdraw_changes", "{all: true}", "all"},
  };
  for (const auto& c : cases) {
    const ParsedCommand parsed = ParseCommand(machine, "cutter", c.verb, c.arguments);
    EXPECT_EQ(parsed.error, ErrorId::kParameter) << c.verb << " " << c.arguments;
    EXPECT_THAT(parsed.sentence, HasSubstr(c.sentence)) << c.verb << " " << c.arguments;
  }
  EXPECT_EQ(ParseCommand(machine, "cutter", "controll", "").error, ErrorId::kUnknownVerb);
  EXPECT_THAT(ParseCommand(machine, "cutter", "controll", "").sentence, HasSubstr("did you mean control?"));
  EXPECT_THAT(ParseCommand(machine, "cuter", "control", "").sentence, HasSubstr("did you mean cutter?"));
}

// CAM-10, AX-13: C++ programs may give values that texts cannot express. Set points stay finite and within the axis'
// limits, whatever commands follow.
TEST(FlexCamBadInput, MovesNoAxisOutOfItsLimits) {
  using flexcam::Control;
  const std::vector<flexcam::Command> then = {Control{.offset_slave = 3.0},
                                              Control{.scaling_slave = 0.5},
                                              Control{.cam_table = 2u},
                                              Control{.sync_cam = false},
                                              Control{.sync_cam = true},
                                              Control{.sync_out_instant = true},
                                              Control{.sync_cam = false, .sync_out_instant = false},
                                              flexcam::Jog{.positive = true},
                                              flexcam::Jog{},
                                              Control{.halt = true},
                                              Control{.halt = false},
                                              Control{.stop = true}};
  for (const flexcam::Command& good : GoodModuleCommands()) {
    for (const Wrong<flexcam::Command>& wrong : WrongVersionsOf(good)) {
      Line line(BadMachine());
      Synchronise(line);
      ASSERT_EQ(line.engine.flex_cam_outputs(0).state, flexcam::ModuleState::kSync);
      line.engine.Submit(ToModule(line.machine, wrong.command));
      for (std::size_t k = 0; k <= then.size(); ++k) {
        for (int i = 0; i < 250; ++i) {
          line.Step();
          const axis::Outputs& knife = line.At(kKnife);
          const std::string where = wrong.what + ", step " + std::to_string(k);
          ASSERT_TRUE(std::isfinite(knife.set_position + knife.set_velocity + knife.set_acceleration)) << where;
          ASSERT_LE(std::abs(knife.set_position), 200 + 1e-6) << where;
          ASSERT_LE(std::abs(knife.set_velocity), 500 * (1 + 1e-6)) << where;
          ASSERT_LE(std::abs(knife.set_acceleration), 5000 * (1 + 1e-6)) << where;
          ASSERT_NE(knife.error, ErrorId::kInternal) << where;
        }
        if (k < then.size()) line.engine.Submit(ToModule(line.machine, then[k]));
      }
    }
  }
}

// Every command is among those that are made invalid, or has no real number.
TEST(FlexCamBadInput, KnowsEveryCommand) {
  std::set<std::size_t> known;
  for (const flexcam::Command& good : GoodModuleCommands()) known.insert(good.index());
  for (std::size_t i : {flexcam::Command(flexcam::Jog{}).index(), flexcam::Command(flexcam::SetCam{}).index(),
                        flexcam::Command(flexcam::WithdrawChanges{}).index()}) {
    known.insert(i);
  }
  EXPECT_EQ(known.size(), std::variant_size_v<flexcam::Command>);
}

// CAM-10, EN-22: a slot that no module has is refused, and the state is identical to that of a twin without the
// command.
TEST(FlexCamBadInput, RefusesSlotsThatAreNotThere) {
  Line asked(BadMachine());
  Line twin(BadMachine());
  Synchronise(asked);
  Synchronise(twin);
  std::vector<flexcam::Command> wrong;
  for (const std::uint32_t slot : {0u, 5u, 4'000'000'000u}) {
    wrong.push_back(flexcam::SetCam{.slot = slot, .cam = Name::Of("hill")});
    wrong.push_back(flexcam::ChangeCam{.cam_table = slot});
    wrong.push_back(flexcam::Control{.cam_table = slot});
  }
  for (const flexcam::Command& command : wrong) {
    const Ticket ticket = asked.engine.Submit(ToModule(asked.machine, command));
    asked.Step();
    twin.Step();
    EXPECT_EQ(asked.last[ticket].state, FeedbackState::kError) << command.index();
    EXPECT_EQ(asked.last[ticket].error, ErrorId::kParameter) << command.index();
    ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash()) << command.index();
  }
}

// The same for values that are not finite: refused as axes refuse them.
TEST(FlexCamBadInput, RefusesNumbersThatAreNone) {
  Line asked(BadMachine());
  Line twin(BadMachine());
  Synchronise(asked);
  Synchronise(twin);
  for (const flexcam::Command& good : GoodModuleCommands()) {
    for (const Wrong<flexcam::Command>& wrong : WrongVersionsOf(good)) {
      const Ticket ticket = asked.engine.Submit(ToModule(asked.machine, wrong.command));
      asked.Step();
      twin.Step();
      EXPECT_EQ(asked.last[ticket].error, ErrorId::kParameter) << wrong.what;
      ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash()) << wrong.what;
    }
  }
}

}  // namespace
}  // namespace takt::engine
