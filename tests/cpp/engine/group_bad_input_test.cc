// Every number of every command of a group, made invalid: refused with a sentence before it reaches the cycle; given
// without the reader, refused in the cycle, and the machine is identical to a twin that did not receive the command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "portal.h"
#include "wrong.h"

namespace takt::engine {
namespace {

using testing::HasSubstr;

// One valid command of each kind.
std::vector<group::Command> GoodGroupCommands() {
  using group::CoordinateSystem;
  const Name square = Name::Of("square");
  return {group::MoveLinearAbsolute{.x = 10},
          group::MoveLinearRelative{.x = 10},
          group::MoveCircularAbsolute{.aux_x = 10, .aux_y = 10, .x = 20},
          group::MoveCircularRelative{.aux_x = 10, .aux_y = 10, .x = 20},
          group::MoveDirectAbsolute{.a1 = 10},
          group::MoveDirectRelative{.a1 = 10},
          group::MoveArch{.x = 10, .height = 5},
          group::Jog{.x = 10},
          group::Calibrate{.x2 = 10, .y3 = 10},
          group::Stream{},
          group::StreamPoint{.x = 10, .vx = 1},
          group::MovePath{.path = square},
          group::MovePathSynchronized{.path = square, .master = Name::Of("a3")},
          group::SyncAxis{.axis = Name::Of("a4")},
          group::Stop{},
          group::Halt{},
          group::Interrupt{},
          group::SetPosition{.a1 = 10},
          group::SetOverride{},
          group::SetCartesianTransform{},
          group::SetCoordinateTransform{},
          group::SetTool{.z = -50, .c = 90},
          group::SetDynCoordTransform{.carrier = Name::Of("belt")},
          group::TrackConveyorBelt{.belt = Name::Of("belt")},
          group::TrackRotaryTable{.table = Name::Of("table")}};
}

// GR-02, EN-22
TEST(GroupBadInput, IsRefusedAsTextWithASentence) {
  const Machine machine = PortalMachine();
  int refused = 0;
  for (const group::Command& good : GoodGroupCommands()) {
    const CommandText fine = ToText(machine, ToGroup(machine, good));
    ASSERT_EQ(ParseCommand(machine, fine.target, fine.verb, fine.arguments).sentence, "") << fine.verb;
    for (const Wrong<group::Command>& wrong : WrongVersionsOf(good)) {
      const CommandText text = ToText(machine, ToGroup(machine, wrong.command));
      const ParsedCommand parsed = ParseCommand(machine, text.target, text.verb, text.arguments);
      EXPECT_EQ(parsed.error, ErrorId::kParameter) << wrong.what;
      EXPECT_THAT(parsed.sentence, HasSubstr(std::string(wrong.field) + ": expected ")) << wrong.what;
      EXPECT_THAT(group::Diagnose(wrong.command), HasSubstr(std::string(wrong.field) + ": expected ")) << wrong.what;
      ++refused;
    }
  }
  EXPECT_GT(refused, 1100);
}

// GR-02, GR-20, EN-22: inconsistent numbers, whole numbers, names, misspelt arguments.
TEST(GroupBadInput, SaysWhatWasExpected) {
  const Machine machine = PortalMachine();
  const struct {
    const char* verb;
    const char* arguments;
    const char* sentence;
  } cases[] = {
      {"move_linear_absolute", "{x: 1, coordinate_system: acs}",
       "x: expected a1 to a8 only, with coordinate_system acs"},
      {"move_linear_absolute", "{velosity: 1}", "did you mean velocity?"},
      {"move_linear_absolute", "{x: 1, coordinate_system: tcs}", "expected one of acs, mcs, wcs, pcs, found 'tcs'"},
      {"move_linear_absolute", "{x: 1, pcs: 17}", "pcs: expected a whole number from 1 to 16, found 17"},
      {"move_linear_relative", "{x: 1, transition_mode: corner_distance}", "transition_parameter: expected mm above 0"},
      {"move_direct_absolute", "{c: 1, coordinate_system: acs}", "c: expected a1 to a8 only"},
      {"move_direct_absolute", "{a1: 1, velocity_factor: 1.5}", "velocity_factor: expected a number "},
      {"move_circular_absolute", "{x: 1, circ_mode: radius}", "path_choice: expected short or long"},
      {"move_circular_absolute", "{x: 1, circ_mode: center, path_choice: long}", "path_choice: expected counterclock"},
      {"move_circular_relative", "{x: 1, coordinate_system: acs}", "coordinate_system: expected mcs, wcs or pcs"},
      {"move_circular_relative", "{x: 1, turns: -1}", "turns: expected "},
      {"move_path", "{path: squar}", "path: expected the name of a path of the machine, found 'squar'; did you mean "},
      {"move_path", "{path: square, coordinate_system: acs}", "coordinate_system: expected mcs, wcs or pcs"},
      {"move_path", "{}", "path: "},
      {"move_path_synchronized", "{path: square, master: a9}", "master: expected the name of an axis, found 'a9'"},
      {"move_path_synchronized", "{path: square, master: a3, ratio: 0}", "ratio: expected a number other than 0"},
      {"sync_axis", "{axis: a9}", "axis: expected the name of an axis, found 'a9'"},
      {"sync_axis", "{axis: a3, ratio_denominator: 0}", "ratio_denominator: expected a number other than 0"},
      {"add_axis", "{axis: a9}", "axis: expected the name of an axis, found 'a9'"},
      {"add_axis", "{axis: a3, ident: 9}", "ident: expected a whole number from 1 to 8, found 9"},
      {"remove_axis", "{ident: 0}", "ident: expected a whole number from 1 to 8, found 0"},
      {"define_position", "{}", "x: expected at least one of x to c or a1 to a8"},
      {"define_position", "{x: 1}", "x: expected a1 to a8 only, with coordinate_system acs"},
      {"set_override", "{velocity_factor: -1}", "velocity_factor: expected a number "},
      {"set_cartesian_transform", "{pcs: 0}", "pcs: expected a whole number from 1 to 16, found 0"},
      {"set_coordinate_transform", "{reference: acs}", "reference: expected mcs, wcs or pcs, found acs"},
      {"set_coordinate_transform", "{pcs: 2, reference: pcs, reference_pcs: 2}", "reference_pcs: expected another"},
      {"move_arch", "{x: 1, coordinate_system: acs}", "coordinate_system: expected mcs, wcs or pcs"},
      {"move_arch", "{x: 1, height: -1}", "height: expected a number "},
      {"jog", "{c: 1, coordinate_system: acs}", "c: expected a1 to a8 only, with coordinate_system acs"},
      {"jog", "{x: 1, coordinate_system: hand}", "expected one of acs, mcs, wcs, pcs, tool, found 'hand'"},
      {"jog", "{x: 1, pcs: 17}", "pcs: expected a whole number from 1 to 16, found 17"},
      {"calibrate", "{x1: 0, y1: 0, z1: 0, x2: 9, y2: 0, z2: 0, x3: 0, y3: 9, z3: 0, x4: 1}",
       "x4: expected x4, y4 and z4 together"},
      {"calibrate", "{x1: 0, y1: 0, z1: 0, x2: 9, y2: 0, z2: 0, x3: 0, y3: 9, z3: 0, seen_x1: 1}",
       "seen_x1: expected the numbers of all places in the system, or none"},
      {"calibrate", "{x1: 0}", "y1: "},
      {"stream", "{delay: -1}", "delay: expected a number in s from 0 to 10, found -1"},
      {"stream", "{timeout: 0}", "timeout: expected a number in s from 0.001 to 60, found 0"},
      {"stream_point", "{time: 1}", "x: expected at least one of x to c or a1 to a8"},
      {"stream_point", "{x: .nan}", "x: expected a finite number in mm"},
      {"stream_point", "{a1: 1, vx: 1, coordinate_system: acs}", "vx: expected v1 to v8 only"},
      {"stream_point", "{b: 1, coordinate_system: acs}", "b: expected a1 to a8 only, with coordinate_system acs"},
      {"jog", "{x: 1, deceleration: 0}", "deceleration: expected a number "},
      {"set_dyn_coord_transform", "{carrier: portal}", "carrier: expected the name of a belt, another group or a pose"},
      {"set_dyn_coord_transform", "{carrier: movr}", "found 'movr'; did you mean mover?"},
      {"set_dyn_coord_transform", "{}", "carrier: "},
      {"track_conveyor_belt", "{belt: bell}",
       "belt: expected the name of a belt that goes straight, found 'bell'; did"},
      {"track_conveyor_belt", "{belt: table}", "belt: expected the name of a belt that goes straight, found 'table'"},
      {"track_conveyor_belt", "{belt: belt, execution_mode: now}", "expected one of immediately, delayed, queued"},
      {"track_rotary_table", "{table: belt}", "table: expected the name of a belt that turns, found 'belt'"},
      {"track_rotary_table", "{table: table, sync_in_angle: -1}", "sync_in_angle: expected a number "},
      {"power", "{enable: 2}", "enable: expected true or false"},
      {"enable", "{now: true}", "now"},
  };
  for (const auto& c : cases) {
    const ParsedCommand parsed = ParseCommand(machine, "portal", c.verb, c.arguments);
    EXPECT_EQ(parsed.error, ErrorId::kParameter) << c.verb << " " << c.arguments;
    EXPECT_THAT(parsed.sentence, HasSubstr(c.sentence)) << c.verb << " " << c.arguments;
  }
  EXPECT_EQ(ParseCommand(machine, "portal", "halted", "").error, ErrorId::kUnknownVerb);
  EXPECT_THAT(ParseCommand(machine, "portal", "halted", "").sentence,
              HasSubstr("expected a command of a group of axes"));
  EXPECT_THAT(ParseCommand(machine, "portl", "halt", "").sentence, HasSubstr("did you mean portal?"));
}

// CV-13: each with its own id, the same as in the cycle.
TEST(GroupBadInput, KnowsDistancesThatDoNotFit) {
  Portal portal;
  const Name belt = Name::Of("belt"), table = Name::Of("table");
  const struct {
    group::Command command;
    ErrorId error;
    const char* sentence;
  } cases[] = {
      {group::TrackConveyorBelt{.belt = belt, .start_distance = 9, .end_distance = 8}, ErrorId::kTrackOrder,
       "end_distance: expected at least 9 mm, start_distance"},
      {group::TrackConveyorBelt{
           .belt = belt, .start_distance = 9, .end_distance = 11.5, .sync_in_conveyor_distance = 3},
       ErrorId::kTrackShort, "end_distance: expected at least 12 mm, start_distance and sync_in_conveyor_distance"},
      {group::TrackRotaryTable{.table = table, .end_angle = -10}, ErrorId::kTrackOrder,
       "end_angle: expected at least 0 deg, start_angle"},
      {group::TrackRotaryTable{.table = table, .end_angle = 20, .sync_in_angle = 30}, ErrorId::kTrackShort,
       "end_angle: expected at least 30 deg, start_angle and sync_in_angle"},
      {group::TrackConveyorBelt{.belt = belt, .start_distance = 9, .end_distance = 12, .sync_in_conveyor_distance = 3},
       ErrorId::kNone, ""}};
  for (const auto& c : cases) {
    const CommandText text = ToText(portal.machine, ToGroup(portal.machine, c.command));
    const ParsedCommand parsed = ParseCommand(portal.machine, text.target, text.verb, text.arguments);
    EXPECT_EQ(parsed.error, c.error) << text.arguments;
    EXPECT_EQ(parsed.sentence, c.sentence);
    const Ticket ticket = portal.Tell(c.command);
    portal.Step();
    EXPECT_EQ(portal.last[ticket].error, c.error) << text.arguments;
  }
}

struct GroupSituation {
  const char* name;
  group::GroupState state;
  void (*bring)(Portal&);
};

const GroupSituation kGroupSituations[] = {
    {"disabled", group::GroupState::kDisabled,
     [](Portal& p) {
       p.Tell(group::Disable{});
       p.Run(5);
     }},
    {"standby", group::GroupState::kStandby, [](Portal&) {}},
    {"moving", group::GroupState::kMoving,
     [](Portal& p) {
       p.Tell(group::MoveLinearAbsolute{.x = 200, .velocity = 0.01});
       p.Tell(group::MoveLinearAbsolute{.x = 100, .y = 100, .buffer_mode = axis::BufferMode::kBuffered});
       p.Run(100);
     }},
    {"streaming", group::GroupState::kMoving,
     [](Portal& p) {
       p.Tell(group::Stream{.timeout = 60});
       p.Tell(group::StreamPoint{.x = 20, .vx = 1, .time = 0.0});
       p.Run(100);
     }},
    {"stopping", group::GroupState::kStopping,
     [](Portal& p) {
       p.Tell(group::MoveLinearAbsolute{.x = 200});
       p.Run(200);
       p.Tell(group::Stop{.hold = true});
       p.Run(50);
     }},
    {"error_stop", group::GroupState::kErrorStop, [](Portal& p) {
       p.Tell(group::MoveLinearAbsolute{.x = 200});
       p.Run(100);
       p.engine.faults(0).drive_fault = true;
       p.Run(50);
     }}};

class GroupBadInputIn : public testing::TestWithParam<GroupSituation> {};

// GR-02, GR-12
TEST_P(GroupBadInputIn, IsRefusedAndLeavesTheMachineLikeItsTwin) {
  Portal asked, twin;
  for (Portal* portal : {&asked, &twin}) GetParam().bring(*portal);
  ASSERT_EQ(asked.group().state, GetParam().state);
  ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash());
  for (const group::Command& good : GoodGroupCommands()) {
    for (const Wrong<group::Command>& wrong : WrongVersionsOf(good)) {
      const Ticket ticket = asked.Tell(wrong.command);
      asked.Step();
      twin.Step();
      ASSERT_EQ(asked.last[ticket].state, FeedbackState::kError) << wrong.what;
      ASSERT_NE(asked.last[ticket].error, ErrorId::kNone) << wrong.what;
      ASSERT_EQ(asked.engine.StateHash(), twin.engine.StateHash()) << wrong.what;
    }
  }
  EXPECT_EQ(asked.group().state, GetParam().state);  // the state was kept to the end
}

INSTANTIATE_TEST_SUITE_P(AllStates, GroupBadInputIn, testing::ValuesIn(kGroupSituations),
                         [](const auto& info) { return std::string(info.param.name); });

// Every command is among those that are made invalid, or has no real number.
TEST(GroupBadInput, KnowsEveryCommand) {
  std::set<std::size_t> known;
  for (const group::Command& good : GoodGroupCommands()) known.insert(good.index());
  for (const group::Command& plain : std::vector<group::Command>{
           group::Continue{}, group::AddAxis{}, group::RemoveAxis{}, group::UngroupAllAxes{}, group::Enable{},
           group::Disable{}, group::Reset{}, group::Power{}, group::Home{}, group::SetKinTransform{},
           group::PathChecked{}, group::PathPlanned{}}) {  // not given by users
    known.insert(plain.index());
  }
  EXPECT_EQ(known.size(), std::variant_size_v<group::Command>);
}

}  // namespace
}  // namespace takt::engine
