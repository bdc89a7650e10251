// PL-32, PL-33: parts of the surface in a machine: loading, references, positions that movers may reach, obstacles to
// the motion of a part, the states that parts and movers force on each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "parts_rig.h"
#include "takt/core/describe.h"

namespace takt::engine {
namespace {

using planar::ObjectState;
using testing::HasSubstr;

TEST(Parts, SayWhatWasExpected) {
  const auto problem = [](const std::string& what, const std::string& instead) {
    return ProblemOf(kLift, what, instead);
  };
  EXPECT_THAT(problem("name: two,", "name: one,"), HasSubstr("expected each name once"));
  EXPECT_THAT(problem("name: two,", "name: lower,"), HasSubstr("expected a name that nothing else has"));
  EXPECT_THAT(
      problem("{coordinate_system: upper}]", "{coordinate_system: uper}]"),
      HasSubstr("parts[1].positions[0].coordinate_system: expected the name of a coordinate system, found 'uper'; "
                "did you mean upper?"));
  EXPECT_THAT(problem("initial_position: 2", "initial_position: 3"), HasSubstr("one of its 2 positions"));
  EXPECT_THAT(problem("positions: [{coordinate_system: upper}]", "positions: []"),
              HasSubstr("expected at least one position"));
  EXPECT_THAT(problem("{name: one,", "{name: one, stators: [{x: 0, y: 0}, {x: 240, y: 240}],"),
              HasSubstr("expected stators that hang together"));
  EXPECT_THAT(problem("{name: one,", "{name: one, stators: [{x: 0, y: 0}, {x: 239, y: 0}],"),
              HasSubstr("two stators overlap"));
  EXPECT_THAT(problem("lower, y: 240", "lower, y: 239"),
              HasSubstr("expected a place beside other parts, found one on"));
  EXPECT_THAT(problem("upper, y: 240", "upper, y: 239"),
              HasSubstr("expected a place beside other parts, found one on"));
  EXPECT_THAT(problem("reference: one, ", ""), HasSubstr("expected the name of the part or coordinate system"));
  EXPECT_THAT(problem("reference: one", "reference: oen"), HasSubstr("did you mean one?"));
  EXPECT_THAT(problem("x: 120, y: 120", "x: 56, y: 120"), HasSubstr("all of the mover is on stators"));
  EXPECT_THAT(problem("movers:", "tracks: [{name: track}]\nmovers:"), HasSubstr("expected the name of a part"));
  EXPECT_THAT(problem("movers:",
                      "tracks: [{name: track, part: one, elements: [{from: {x: 0, y: 0}, to: {x: 250, y: 0}}]}]"
                      "\nmovers:"),
              HasSubstr("the track leaves its part"));
}

TEST(Parts, TheLiftOfTheManual) {
  PartsRig rig(kLift);
  rig.Run();
  EXPECT_EQ(rig.Part("one").state, ObjectState::kDisabled);
  rig.Do("mover", "enable");
  rig.Run(3);
  // All parts of its coordinate system, and no others.
  EXPECT_EQ(rig.Part("one").state, ObjectState::kEnabled);
  EXPECT_EQ(rig.Part("two").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kDisabled);
  // It is on the upper level: not reachable from here.
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 120, y: 120, reference: three}"), ErrorId::kReference);
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 120, y: 360, reference: lower}"), ErrorId::kOffStators);
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 120, y: 120}"), ErrorId::kReference);

  EXPECT_EQ(rig.Do("three", "activate_position", "{index: 1}").state, FeedbackState::kDone);
  EXPECT_EQ(rig.Part("three").position_index, 1u);
  EXPECT_EQ(rig.Part("three").coordinate_system, 1u);
  EXPECT_EQ(rig.Do("mover", "move_to_position", "{x: 120, y: 120, reference: three}").state, FeedbackState::kDone);
  EXPECT_NEAR(rig.Mover("mover").y, 360, 1e-9);
  EXPECT_EQ(rig.Mover("mover").coordinate_system, 1u);
  EXPECT_EQ(rig.Mover("mover").part, 3u);

  EXPECT_EQ(rig.Do("three", "activate_position", "{index: 2}").state, FeedbackState::kDone);
  EXPECT_EQ(rig.Mover("mover").coordinate_system, 2u);
  EXPECT_NEAR(rig.Mover("mover").y, 360, 1e-9);
  // As in the manual's program: at once.
  EXPECT_EQ(rig.Do("mover", "move_to_position", "{x: 120, y: 120, reference: two}").state, FeedbackState::kDone);
  EXPECT_NEAR(rig.Mover("mover").x, 120, 1e-9);
  EXPECT_NEAR(rig.Mover("mover").y, 120, 1e-9);
  EXPECT_EQ(rig.Mover("mover").coordinate_system, 2u);
  EXPECT_EQ(rig.Mover("mover").part, 2u);
  // Parts are enabled in the mover's coordinate system.
  EXPECT_EQ(rig.Part("one").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.Part("two").state, ObjectState::kEnabled);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kEnabled);
  rig.Do("mover", "disable");
  rig.Run(4);
  EXPECT_EQ(rig.Part("two").state, ObjectState::kDisabled);
}

// PL-20, PL-33: a part that leaves while a linked track is built does not change the start of the track.
TEST(Parts, LeaveWhileALinkIsMade) {
  PartsRig rig(R"(
name: side by side
axes: []
coordinate_systems: [{name: plane}]
parts:
  - {name: left, positions: [{coordinate_system: plane}]}
  - name: right
    positions: [{coordinate_system: plane, x: 240}, {coordinate_system: plane, y: 500}]
    travel_time_s: 0.1
tracks:
  - {name: from, part: left, elements: [{from: {x: 40, y: 120}, to: {x: 240, y: 120}}]}
  - {name: own, part: right}
)");
  rig.Run();
  const Ticket link = rig.Give("own", "start_from_track", "{track: from}");
  rig.engine.RunCycle();
  const Ticket leaving = rig.Give("right", "activate_position", "{index: 2}");
  for (int i = 0; i < 3; ++i) rig.engine.RunCycle();
  EXPECT_EQ(rig.Part("right").position_index, 0u);
  rig.engine.MakeTracks();  // delayed until now
  EXPECT_EQ(rig.End(link).state, FeedbackState::kDone);
  rig.End(leaving);
  EXPECT_EQ(rig.Do("right", "activate_position", "{index: 1}").state, FeedbackState::kDone);
  EXPECT_EQ(rig.Do("own", "append_line", "{start_x: 0, start_y: 120, end_x: 200, end_y: 120, reference: right}").state,
            FeedbackState::kDone);
  EXPECT_NEAR(rig.engine.tracks().outputs[1].length, 200, 1e-9);
}

// The position of a simulated lift is unknown while it moves.
TEST(Parts, ALiftTakesItsTime) {
  PartsRig rig(With(kLift, "initial_position: 2", "initial_position: 2\n    travel_time_s: 0.05"));
  rig.Run();
  const Ticket going = rig.Give("three", "activate_position", "{index: 1}");
  rig.Run(50);
  EXPECT_EQ(rig.Part("three").position_index, 0u);
  EXPECT_NE(rig.answers[going].state, FeedbackState::kDone);
  rig.Run(2);
  EXPECT_EQ(rig.answers[going].state, FeedbackState::kDone);
  EXPECT_EQ(rig.Part("three").position_index, 1u);
  EXPECT_EQ(rig.Part("three").error, ErrorId::kNone);
}

// Refused with the obstacle, and without any change.
TEST(Parts, GoOnlyWhenThatIsSafe) {
  const std::string text =
      With(kLift, "movers:",
           R"(  - {name: four, positions: [{coordinate_system: upper, x: 240}, {coordinate_system: lower, y: 240}]}
movers:
  - {name: other, reference: two, initial: {x: 120, y: 120}})");
  PartsRig rig(text);
  rig.Run();
  EXPECT_THROW(rig.Give("three", "activate_position", "{index: 3}"), std::runtime_error);
  EXPECT_EQ(rig.Do("three", "activate_position", "{index: 2}").state, FeedbackState::kDone);  // it is there already
  EXPECT_EQ(rig.Do("four", "activate_position", "{index: 2}").state, FeedbackState::kDone);
  FeedbackEvent refused = rig.Do("three", "activate_position", "{index: 1}");
  EXPECT_EQ(refused.error, ErrorId::kPartPlace);
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kPart, 4}));
  rig.Do("four", "activate_position", "{index: 1}");
  rig.Do("three", "activate_position", "{index: 1}");

  rig.Do("mover", "enable");
  rig.Run(3);
  // Moving over the border, and at rest across it.
  const Ticket crossing = rig.Give("mover", "move_to_position", "{x: 120, y: 0, reference: three}");
  rig.Run();
  refused = rig.Do("three", "activate_position", "{index: 2}");
  EXPECT_EQ(refused.error, ErrorId::kPartMover);
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kMover, 2}));
  rig.End(crossing);
  EXPECT_NEAR(rig.Mover("mover").y, 240, 1e-9);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kPartMover);
  EXPECT_EQ(rig.Part("three").position_index, 1u);
  // Adjacent to the border it is on one side.
  rig.Do("mover", "move_to_position", "{x: 120, y: 56.5, reference: three}");
  // Moving on it, even if only vertically.
  rig.Give("mover", "move_z", "{position: 3}");
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kPartMover);
  rig.Run(2000);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kNone);
  EXPECT_NEAR(rig.Mover("mover").y, 296.5, 1e-9);
}

// Behaviour of a real part: it takes time, does not arrive, or is lost.
TEST(Parts, TakeTheirTime) {
  PartsRig rig(kLift);
  rig.Run();
  rig.engine.part_faults(2).stuck = true;
  const Ticket going = rig.Give("three", "activate_position", "{index: 1}");
  rig.Run(100);
  EXPECT_EQ(rig.answers[going].state, FeedbackState::kActive);
  EXPECT_EQ(rig.Part("three").position_index, 0u);
  EXPECT_EQ(rig.Part("three").commanded_index, 1u);
  rig.Do("mover", "enable");
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 120, y: 360, reference: lower}"), ErrorId::kOffStators);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kPartDisabled);
  rig.engine.part_faults(2).stuck = false;
  rig.Run(3);
  EXPECT_EQ(rig.answers[going].state, FeedbackState::kDone);
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 120, y: 360, reference: lower}"), ErrorId::kNone);
  rig.engine.part_faults(2).lost = true;
  rig.Run(10);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kError);
  EXPECT_EQ(rig.Part("three").error, ErrorId::kPartPosition);
  EXPECT_EQ(rig.Mover("mover").error, ErrorId::kPartPosition);
}

// 6.6: forced off, its movers enter the error state; it is enabled again only after allow_enable.
TEST(Parts, AreForcedOff) {
  PartsRig rig(kLift);
  rig.Do("three", "activate_position", "{index: 1}");
  rig.Do("mover", "enable");
  rig.Run(3);
  const Ticket move = rig.Give("mover", "move_to_position", "{x: 120, y: 360, reference: lower, velocity: 100}");
  rig.Run(900);
  const Ticket off = rig.Give("three", "force_disable");
  rig.Run();
  EXPECT_EQ(rig.answers[move].error, ErrorId::kPartDisabled);
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kErrorPending);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kDisabling);  // while the mover brakes
  rig.End(off);
  rig.Run();
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kError);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kDisabled);
  EXPECT_TRUE(rig.Part("three").disable_forced);
  rig.Run(5);
  EXPECT_EQ(rig.Part("one").state, ObjectState::kDisabled);  // there is no other mover
  rig.Do("mover", "reset");
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kDisabled);
  rig.Do("mover", "enable");
  rig.Run(5);
  EXPECT_EQ(rig.Part("one").state, ObjectState::kEnabled);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 120, y: 360, reference: lower}"), ErrorId::kPartDisabled);
  rig.Do("three", "allow_enable");
  rig.Run(5);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kEnabled);
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 120, y: 360, reference: lower}"), ErrorId::kNone);
  rig.Do("mover", "disable");
  rig.Do("three", "force_disable");
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kError);  // disabled or not
  rig.Do("mover", "reset");
  EXPECT_EQ(rig.ErrorOf("mover", "enable"), ErrorId::kPartDisabled);
}

// 6.6: the movers' errors are handled first; a mover's reset resets its part, which then comes first.
TEST(Parts, FailWithTheirMovers) {
  PartsRig rig(kLift);
  rig.Do("mover", "enable");
  rig.Run(3);
  rig.Give("mover", "move_c", "{position: 5}");
  rig.Run(20);
  rig.engine.part_faults(0).fault = true;
  std::vector<ObjectState> of_part, of_mover;
  rig.each_cycle = [&] {
    if (of_part.empty() || of_part.back() != rig.Part("one").state) of_part.push_back(rig.Part("one").state);
    if (of_mover.empty() || of_mover.back() != rig.Mover("mover").state) of_mover.push_back(rig.Mover("mover").state);
    if (rig.Part("one").state == ObjectState::kError) {
      EXPECT_EQ(rig.Mover("mover").state, ObjectState::kError);
    }
  };
  rig.Run(100);
  EXPECT_EQ(rig.Part("one").state, ObjectState::kError);
  EXPECT_EQ(rig.Part("one").error, ErrorId::kPartFault);
  EXPECT_EQ(rig.Mover("mover").error, ErrorId::kPartFault);
  EXPECT_EQ(rig.Part("two").state, ObjectState::kDisabled);
  rig.engine.part_faults(0).fault = false;
  rig.Run();
  rig.each_cycle = [&] {
    if (rig.Mover("mover").state == ObjectState::kDisabled) {
      EXPECT_EQ(rig.Part("one").error, ErrorId::kNone);
    }
  };
  rig.Do("mover", "reset");
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.Part("one").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.Do("mover", "enable").state, FeedbackState::kDone);
  // The part's own reset does not clear the mover's error.
  rig.each_cycle = nullptr;
  rig.engine.part_faults(0).fault = true;
  rig.Run(100);
  rig.engine.part_faults(0).fault = false;
  rig.Run();
  rig.Do("one", "reset");
  EXPECT_EQ(rig.Part("one").error, ErrorId::kNone);
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kError);
}

// A mover that is being reset waits for its part, which waits for the last of its movers.
TEST(Parts, AreResetBeforeTheirMovers) {
  PartsRig rig(With(kLift, "{name: one, positions", "{name: one, columns: 8, positions") +
               "  - {name: other, reference: one, initial: {x: 400, y: 120}}\n");
  rig.Do("mover", "enable");
  rig.Do("other", "enable");
  rig.Run(3);
  rig.Give("other", "move_to_position", "{x: 1800, y: 120, reference: one}");
  rig.Run(400);
  rig.engine.part_faults(0).fault = true;
  rig.Run(3);
  rig.engine.part_faults(0).fault = false;
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kError);
  EXPECT_EQ(rig.Mover("other").state, ObjectState::kErrorPending);
  const Ticket reset = rig.Give("mover", "reset");
  rig.Run(20);
  EXPECT_EQ(rig.Mover("other").state, ObjectState::kErrorPending);
  EXPECT_EQ(rig.Part("one").state, ObjectState::kErrorPending);
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kResetting);
  EXPECT_EQ(rig.End(reset).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Part("one").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.Mover("other").state, ObjectState::kError);
}

// External set points: in a part or a coordinate system, and only on stators.
TEST(Parts, HoldSetPointsFromOutside) {
  PartsRig rig(With(kLift, "initial_position: 2", "initial_position: 1"));
  rig.Do("mover", "enable");
  rig.Run(3);
  const Ticket external = rig.Give("mover", "start_external_setpoint_generation");
  double v = 0, y = 120;
  const auto give = [&](const std::string& reference, double at) {
    char text[200];
    std::snprintf(text, sizeof text, "{x: 120, y: %.12g, velocity_y: %.12g, acceleration_y: 0, reference: %s}", at, v,
                  reference.c_str());
    rig.Give("mover", "set_external_setpoint", text);
    rig.Run();
  };
  for (int i = 0; i < 100; ++i, v += 2, y += v * 0.001) give("lower", y);
  for (; y < 245; y += v * 0.001) give("lower", y);
  for (; y < 330; y += v * 0.001) give("three", y - 240);
  EXPECT_EQ(rig.answers[external].state, FeedbackState::kActive);
  EXPECT_EQ(rig.Mover("mover").part, 3u);
  for (; y < 480 && rig.answers[external].state == FeedbackState::kActive; y += v * 0.001) give("three", y - 240);
  EXPECT_EQ(rig.answers[external].error, ErrorId::kOffStators);
  rig.Run(500);
  EXPECT_LE(rig.Mover("mover").y, 480 - 56.5);
  EXPECT_GT(rig.Mover("mover").y, 480 - 56.5 - 10);
}

TEST(Parts, SetPositionNamesTheCoordinateSystem) {
  PartsRig rig(kLift);
  rig.Run();
  EXPECT_EQ(rig.ErrorOf("mover", "set_position", "{x: 120, y: 120}"), ErrorId::kReference);
  EXPECT_EQ(rig.ErrorOf("mover", "set_position", "{x: 120, y: 430, reference: upper}"), ErrorId::kOffStators);
  EXPECT_EQ(rig.ErrorOf("mover", "set_position", "{x: 120, y: 130, reference: three}"), ErrorId::kNone);
  rig.Run();
  EXPECT_EQ(rig.Mover("mover").coordinate_system, 2u);
  EXPECT_EQ(rig.Mover("mover").part, 3u);
  EXPECT_NEAR(rig.Mover("mover").y, 370, 1e-9);
}

// PL-14, PL-32: for axes that follow a coordinate of a mover, the arrival of its part is no motion; later commands
// refer to the new coordinates.
TEST(PartsOfMasters, TakeNobodyAlong) {
  PartsRig rig(R"(
name: shuttle
axes:
  - {name: x, limits: {velocity: 5000, acceleration: 100000, jerk: 5000000}}
  - {name: z, limits: {velocity: 5000, acceleration: 100000, jerk: 5000000}}
coordinate_systems: [{name: lower}]
parts:
  - name: tray
    positions: [{coordinate_system: lower}, {coordinate_system: lower, x: 480, y: -240}]
movers:
  - {name: mover, reference: tray, initial: {x: 100, y: 120}}
)");
  rig.Do("mover", "enable");
  for (const char* axis : {"x", "z"}) rig.Do(axis, "power");
  const Ticket gear = rig.Give("x", "gear_in", "{master: mover.x}");
  const Ticket in_place =
      rig.Give("z", "gear_in_pos", "{master: mover.y, master_sync_position: 120, slave_sync_position: 30}");
  rig.Run(1000);
  const double z = rig.engine.outputs(1).set_position;
  rig.each_cycle = [&] {
    ASSERT_EQ(rig.engine.outputs(0).set_position, 0);
    ASSERT_EQ(rig.engine.outputs(1).set_position, z);
  };
  EXPECT_EQ(rig.ErrorOf("tray", "activate_position", "{index: 2}"), ErrorId::kNone);
  rig.Run(100);
  EXPECT_EQ(rig.Mover("mover").x, 580);
  EXPECT_EQ(rig.Mover("mover").y, -120);
  rig.each_cycle = nullptr;
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 590, y: -115, reference: lower}"), ErrorId::kNone);
  EXPECT_EQ(rig.answers[gear].state, FeedbackState::kActive);
  EXPECT_EQ(rig.answers[in_place].state, FeedbackState::kActive);
  EXPECT_NEAR(rig.engine.outputs(0).set_position, 10, 1e-9);
  EXPECT_NEAR(rig.engine.outputs(1).set_position, z + 5, 1e-9);
  // In coordinates of its present position.
  rig.Do("z", "move_absolute", "{position: 0, velocity: 100}");
  rig.Give("z", "gear_in_pos", "{master: mover.y, master_sync_position: -100, slave_sync_position: 50}");
  rig.Run(1000);
  EXPECT_EQ(rig.ErrorOf("mover", "move_to_position", "{x: 590, y: -70, reference: lower}"), ErrorId::kNone);
  EXPECT_NEAR(rig.engine.outputs(1).set_position, 50 + 30, 1e-9);
}

}  // namespace
}  // namespace takt::engine
