// PL-32, PL-33: parts of the surface in a machine: loading, references, where movers may go, what keeps a part from
// going, the states that parts and movers force on each other, tracks of several parts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "parts_rig.h"
#include "takt/core/describe.h"

namespace takt::engine {
namespace {

using planar::ObjectState;
using testing::HasSubstr;

// Example 6.6.1 of the manual: two levels, a lift between them.
const std::string kLift = R"(
name: lift
axes: []
coordinate_systems: [{name: lower}, {name: upper}]
parts:
  - {name: one, positions: [{coordinate_system: lower}]}
  - {name: two, positions: [{coordinate_system: upper}]}
  - name: three
    positions: [{coordinate_system: lower, y: 240}, {coordinate_system: upper, y: 240}]
    initial_position: 2
movers:
  - {name: mover, reference: one, initial: {x: 120, y: 120}}
)";

std::string With(std::string text, const std::string& what, const std::string& instead) {
  const auto at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("not in the text: " + what);
  return text.replace(at, what.size(), instead);
}

TEST(Parts, SayWhatWasExpected) {
  const auto problem = [](const std::string& what, const std::string& instead) {
    return FirstProblemOf(With(kLift, what, instead));
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
  // It is upstairs: nobody gets there from here.
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
  // As the manual's program does: at once.
  EXPECT_EQ(rig.Do("mover", "move_to_position", "{x: 120, y: 120, reference: two}").state, FeedbackState::kDone);
  EXPECT_NEAR(rig.Mover("mover").x, 120, 1e-9);
  EXPECT_NEAR(rig.Mover("mover").y, 120, 1e-9);
  EXPECT_EQ(rig.Mover("mover").coordinate_system, 2u);
  EXPECT_EQ(rig.Mover("mover").part, 2u);
  // Parts are enabled where the mover is.
  EXPECT_EQ(rig.Part("one").state, ObjectState::kDisabled);
  EXPECT_EQ(rig.Part("two").state, ObjectState::kEnabled);
  EXPECT_EQ(rig.Part("three").state, ObjectState::kEnabled);
  rig.Do("mover", "disable");
  rig.Run(4);
  EXPECT_EQ(rig.Part("two").state, ObjectState::kDisabled);
}

// A simulated lift is nowhere for as long as it takes.
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

// Refused with what is in the way, and nothing has changed then.
TEST(Parts, GoOnlyWhenThatIsSafe) {
  const std::string text =
      With(kLift, "movers:",
           R"(  - {name: four, positions: [{coordinate_system: upper, x: 240}, {coordinate_system: lower, y: 240}]}
movers:
  - {name: other, reference: two, initial: {x: 120, y: 120}})");
  PartsRig rig(text);
  rig.Run();
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 3}"), ErrorId::kParameter);
  EXPECT_EQ(rig.Do("three", "activate_position", "{index: 2}").state, FeedbackState::kDone);  // it is there
  EXPECT_EQ(rig.Do("four", "activate_position", "{index: 2}").state, FeedbackState::kDone);
  FeedbackEvent refused = rig.Do("three", "activate_position", "{index: 1}");
  EXPECT_EQ(refused.error, ErrorId::kPartPlace);
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kPart, 4}));
  rig.Do("four", "activate_position", "{index: 1}");
  rig.Do("three", "activate_position", "{index: 1}");

  rig.Do("mover", "enable");
  rig.Run(3);
  // On its way over the border, and standing across it.
  const Ticket crossing = rig.Give("mover", "move_to_position", "{x: 120, y: 0, reference: three}");
  rig.Run();
  refused = rig.Do("three", "activate_position", "{index: 2}");
  EXPECT_EQ(refused.error, ErrorId::kPartMover);
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kMover, 2}));
  rig.End(crossing);
  EXPECT_NEAR(rig.Mover("mover").y, 240, 1e-9);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kPartMover);
  EXPECT_EQ(rig.Part("three").position_index, 1u);
  // Flush with the border it is on one side.
  rig.Do("mover", "move_to_position", "{x: 120, y: 56.5, reference: three}");
  // Moving on it, be it only up and down.
  rig.Give("mover", "move_z", "{position: 3}");
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kPartMover);
  rig.Run(2000);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kNone);
  EXPECT_NEAR(rig.Mover("mover").y, 296.5, 1e-9);
}

// What a real part does: it takes its time, does not get there, or is lost.
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

// 6.6: forced off, its movers have a fault; on again only after allow_enable.
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
  EXPECT_EQ(rig.Part("three").state, ObjectState::kDisabling);  // as long as it has to brake
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

// 6.6: the movers' errors come first; a mover's reset resets its part, which is first then.
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
  // The part's own reset leaves the mover's error.
  rig.each_cycle = nullptr;
  rig.engine.part_faults(0).fault = true;
  rig.Run(100);
  rig.engine.part_faults(0).fault = false;
  rig.Run();
  rig.Do("one", "reset");
  EXPECT_EQ(rig.Part("one").error, ErrorId::kNone);
  EXPECT_EQ(rig.Mover("mover").state, ObjectState::kError);
}

// A mover that is reset waits for its part, which waits for the last of its movers.
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

// Set points from outside: part or coordinate system, and no further than the stators.
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

// Example 6.2.11: a track on a part with two positions, linked with one end or the other.
const std::string kNetwork = R"(
name: network
axes: []
coordinate_systems: [{name: plane}]
parts:
  - {name: one, columns: 2, rows: 4, positions: [{coordinate_system: plane}]}
  - {name: two, stators: [{x: 0, y: 0}, {x: 0, y: 240}], 
     positions: [{coordinate_system: plane, x: 480, y: 0}, {coordinate_system: plane, x: 480, y: 480}]}
tracks:
  - {name: track_one, part: one}
  - {name: track_two, part: one}
  - {name: track_three, part: two}
movers:
  - {name: mover, reference: two, initial: {x: 120, y: 240}}
)";

void MakeNetwork(PartsRig& rig) {
  const auto line = [&](const std::string& track, const std::string& part, const std::string& ends) {
    EXPECT_EQ(rig.ErrorOf(track, "append_line", "{" + ends + ", reference: " + part + "}"), ErrorId::kNone);
  };
  line("track_three", "two", "start_x: 0, start_y: 360, end_x: 80, end_y: 360");
  line("track_three", "two", "start_x: 120, start_y: 320, end_x: 120, end_y: 160");
  line("track_three", "two", "start_x: 80, start_y: 120, end_x: 0, end_y: 120");
  const auto link = [&](const std::string& track, const std::string& verb, int other) {
    EXPECT_EQ(rig.ErrorOf(
                  track, verb,
                  "{track: track_three, this_position_index: 1, other_position_index: " + std::to_string(other) + "}"),
              ErrorId::kNone);
  };
  link("track_two", "start_from_track", 2);
  line("track_two", "one", "start_x: 440, start_y: 600, end_x: 400, end_y: 600");
  line("track_two", "one", "start_x: 360, start_y: 560, end_x: 360, end_y: 400");
  line("track_two", "one", "start_x: 400, start_y: 360, end_x: 440, end_y: 360");
  link("track_two", "end_at_track", 1);
  link("track_one", "start_from_track", 1);
  line("track_one", "one", "start_x: 440, start_y: 120, end_x: 160, end_y: 120");
  line("track_one", "one", "start_x: 120, start_y: 160, end_x: 120, end_y: 800");
  line("track_one", "one", "start_x: 160, start_y: 840, end_x: 440, end_y: 840");
  link("track_one", "end_at_track", 2);
}

TEST(PartTracks, TheNetworkOfTheManual) {
  PartsRig rig(kNetwork);
  MakeNetwork(rig);
  const track::Tracks& tracks = rig.engine.tracks();
  EXPECT_NEAR(tracks.outputs[1].length, tracks.outputs[2].length, 1e-9);
  EXPECT_GT(tracks.outputs[1].length, 320);
  const auto goes_into = [&](std::size_t a, std::size_t b) { return tracks.end_nodes[a] == tracks.start_nodes[b]; };
  EXPECT_TRUE(goes_into(1, 2) && goes_into(2, 0));
  EXPECT_FALSE(goes_into(0, 2) || goes_into(2, 1));
  EXPECT_EQ(rig.ErrorOf("two", "activate_position", "{index: 2}"), ErrorId::kNone);
  EXPECT_TRUE(goes_into(0, 2) && goes_into(2, 1));
  EXPECT_FALSE(goes_into(1, 2) || goes_into(2, 0));

  // A mover goes round: down by track two, and with the part up again.
  for (const char* name : {"track_one", "track_two", "track_three"}) rig.Do(name, "enable");
  rig.Do("mover", "enable");
  rig.Run(3);
  EXPECT_EQ(rig.Do("mover", "join_track", "{track: track_three}").error, ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("mover", "move_on_track", "{track: track_two, position: 100}"), ErrorId::kNone);
  EXPECT_EQ(rig.Mover("mover").part, 1u);
  EXPECT_EQ(rig.ErrorOf("mover", "move_on_track", "{track: track_three, position: 160}"), ErrorId::kNoRoute);
  EXPECT_EQ(rig.ErrorOf("two", "activate_position", "{index: 1}"), ErrorId::kNone);
  const Ticket over = rig.Give("mover", "move_on_track", "{track: track_three, position: 160}");
  rig.Run();
  const FeedbackEvent refused = rig.Do("two", "activate_position", "{index: 2}");
  EXPECT_EQ(refused.error, ErrorId::kPartTrack);
  EXPECT_EQ(refused.object, (ObjectInfo{ObjectKind::kTrack, 3}));
  EXPECT_EQ(rig.End(over).error, ErrorId::kNone);
  EXPECT_NEAR(rig.Mover("mover").track_position, 160, 1e-9);
  EXPECT_EQ(rig.Mover("mover").part, 2u);
  const double y = rig.Mover("mover").y;
  EXPECT_EQ(rig.ErrorOf("two", "activate_position", "{index: 2}"), ErrorId::kNone);
  EXPECT_NEAR(rig.Mover("mover").y, y + 480, 1e-9);
  EXPECT_NEAR(rig.Mover("mover").track_position, 160, 1e-9);
  EXPECT_EQ(rig.ErrorOf("mover", "move_on_track", "{track: track_two, position: 100}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("mover", "leave_track", "{x: 300, y: 480, reference: plane}"), ErrorId::kNone);
}

// Both in one cycle: whoever comes second is refused, in whichever order they come.
TEST(PartTracks, AMoverAndItsPartDoNotMissEachOther) {
  const std::string text = With(kLift, "movers:", R"(tracks:
  - {name: below, part: one, elements: [{from: {x: 120, y: 60}, to: {x: 120, y: 240}}]}
  - name: above
    part: three
    starts_from_positions: [{track: below, this_position_index: 1, other_position_index: 1}]
    elements: [{from: {x: 120, y: 0}, to: {x: 120, y: 180}}]
movers:)");
  PartsRig rig(text);
  rig.Do("three", "activate_position", "{index: 1}");
  for (const char* track : {"below", "above"}) rig.Do(track, "enable");
  rig.Do("mover", "enable");
  rig.Do("mover", "join_track", "{track: below}");

  Ticket goes = rig.Give("three", "activate_position", "{index: 2}");
  Ticket moves = rig.Give("mover", "move_on_track", "{track: above, position: 100}");
  EXPECT_EQ(rig.End(goes).error, ErrorId::kNone);
  EXPECT_EQ(rig.End(moves).error, ErrorId::kNoRoute);
  rig.Do("three", "activate_position", "{index: 1}");

  moves = rig.Give("mover", "move_on_track", "{track: above, position: 100}");
  goes = rig.Give("three", "activate_position", "{index: 2}");
  const FeedbackEvent refused = rig.End(goes);
  EXPECT_TRUE(refused.error == ErrorId::kPartMover || refused.error == ErrorId::kPartTrack);
  EXPECT_EQ(rig.End(moves).error, ErrorId::kNone);
  EXPECT_EQ(rig.Mover("mover").part, 3u);
}

// The same network from the machine file.
TEST(PartTracks, TheNetworkInTheFile) {
  const std::string tracks = R"(tracks:
  - name: track_one
    part: one
    starts_from_positions: [{track: track_three, this_position_index: 1, other_position_index: 1}]
    elements:
      - {from: {x: 440, y: 120}, to: {x: 160, y: 120}}
      - {from: {x: 120, y: 160}, to: {x: 120, y: 800}}
      - {from: {x: 160, y: 840}, to: {x: 440, y: 840}}
    ends_at_positions: [{track: track_three, this_position_index: 1, other_position_index: 2}]
  - name: track_two
    part: one
    starts_from_positions: [{track: track_three, this_position_index: 1, other_position_index: 2, only_there: true}]
    elements:
      - {from: {x: 440, y: 600}, to: {x: 400, y: 600}}
      - {from: {x: 360, y: 560}, to: {x: 360, y: 400}}
      - {from: {x: 400, y: 360}, to: {x: 440, y: 360}}
    ends_at_positions: [{track: track_three, this_position_index: 1, other_position_index: 1}]
  - name: track_three
    part: two
    elements:
      - {from: {x: 0, y: 360}, to: {x: 80, y: 360}}
      - {from: {x: 120, y: 320}, to: {x: 120, y: 160}}
      - {from: {x: 80, y: 120}, to: {x: 0, y: 120}}
movers:)";
  const std::string before = kNetwork.substr(0, kNetwork.find("tracks:"));
  const std::string text = before + tracks + kNetwork.substr(kNetwork.find("movers:") + 7);
  PartsRig by_file(text), by_commands(kNetwork);
  MakeNetwork(by_commands);
  by_file.Run();
  for (int position = 1; position <= 2; ++position) {
    const std::string index = "{index: " + std::to_string(position) + "}";
    by_file.Do("two", "activate_position", index);
    by_commands.Do("two", "activate_position", index);
    const track::Tracks& a = by_file.engine.tracks();
    const track::Tracks& b = by_commands.engine.tracks();
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_DOUBLE_EQ(a.outputs[i].length, b.outputs[i].length);
      EXPECT_EQ(a.start_nodes[i], b.start_nodes[i]);
      EXPECT_EQ(a.end_nodes[i], b.end_nodes[i]);
    }
  }
  const auto problem = [&](const std::string& what, const std::string& instead) {
    return FirstProblemOf(With(text, what, instead));
  };
  EXPECT_THAT(problem("other_position_index: 2, only", "other_position_index: 3, only"),
              HasSubstr("tracks[1].starts_from_positions[0].track: the parts of the tracks are not in one"));
  EXPECT_THAT(problem("{from: {x: 0, y: 360}", "{from: {x: 10, y: 360}"), HasSubstr("on the border of both"));
}

// A gap counts over the border, too, and none comes too near by a part that arrives.
TEST(PartTracks, KeepTheGapOverTheBorder) {
  const std::string text = With(With(kNetwork, "  - {name: track_one, part: one}\n", R"(  - name: track_one
    part: one
    elements: [{from: {x: 40, y: 120}, to: {x: 480, y: 120}}]
)"),
                                "  - {name: track_three, part: two}\n", R"(  - name: track_three
    part: two
    starts_from: [track_one]
    elements: [{from: {x: 20, y: 120}, to: {x: 200, y: 120}}]
)");
  PartsRig rig(text + "  - {name: other, reference: one, initial: {x: 300, y: 120}}\n");
  rig.Do("track_one", "enable");
  rig.Do("track_three", "enable");
  rig.Do("mover", "enable");
  rig.Do("other", "enable");
  EXPECT_EQ(rig.ErrorOf("mover", "join_track", "{track: track_three}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("other", "join_track", "{track: track_one}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("mover", "move_on_track", "{position: 80}"), ErrorId::kNone);
  const Ticket behind = rig.Give("other", "move_on_track", "{track: track_three, position: 150}");
  rig.Run(3000);
  EXPECT_NEAR(rig.Mover("other").x, 480 + 80 - 200, 0.1);
  EXPECT_EQ(rig.Mover("other").waits_for, 1u);
  const FeedbackEvent refused = rig.Do("two", "activate_position", "{index: 2}");
  EXPECT_EQ(refused.error, ErrorId::kPartTrack);  // one waits to come
  rig.Do("other", "halt");
  EXPECT_EQ(rig.ErrorOf("two", "activate_position", "{index: 2}"), ErrorId::kNone);
  EXPECT_EQ(rig.answers[behind].state, FeedbackState::kAborted);
  EXPECT_EQ(rig.ErrorOf("other", "move_on_track", "{track: track_three, position: 150}"), ErrorId::kNoRoute);
  EXPECT_EQ(rig.ErrorOf("other", "move_on_track", "{position: 380}"), ErrorId::kNone);
  const FeedbackEvent near = rig.Do("two", "activate_position", "{index: 1}");
  EXPECT_EQ(near.error, ErrorId::kPartMover);
  EXPECT_EQ(near.object, (ObjectInfo{ObjectKind::kMover, 2}));
  EXPECT_EQ(rig.ErrorOf("other", "move_on_track", "{position: 300}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("two", "activate_position", "{index: 1}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("mover", "move_on_track", "{position: 170}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("other", "move_on_track", "{position: 400}"), ErrorId::kNone);
}

// A part brings a mover in front of one that comes along: it is waited for, or the part does not go.
TEST(PartTracks, WhoIsBroughtIsWaitedFor) {
  int went = 0, refused = 0;
  for (const double travel_s : {0.0, 0.3}) {
    for (const bool grouped : {false, true}) {
      for (const int at : {0, 100, 190}) {
        for (const int later : {0, 1, 300, 400, 450, 500, 550, 600, 650}) {
          PartsRig rig(R"(
name: line
axes: []
coordinate_systems: [{name: plane}, {name: other}]
parts:
  - {name: a, columns: 2, positions: [{coordinate_system: other}, {coordinate_system: plane, x: 960}],
     travel_time_s: )" +
                       std::to_string(travel_s) + R"(}
  - {name: b, columns: 4, positions: [{coordinate_system: plane}]}
movers:
  - {name: one, reference: a, initial: {x: 120, y: 120}}
  - {name: two, reference: b, initial: {x: 120, y: 120}}
tracks:
  - {name: on_a, part: a, elements: [{from: {x: 0, y: 120}, to: {x: 460, y: 120}}],
     starts_from_positions: [{track: on_b, this_position_index: 2, other_position_index: 1}]}
  - {name: on_b, part: b, elements: [{from: {x: 20, y: 120}, to: {x: 960, y: 120}}]}
planar_groups: [{name: cell, movers: [one, two], tracks: [on_a, on_b]}]
)");
          rig.Run();
          for (const char* name : {"one", "two"}) rig.Do(name, "enable");
          rig.Run(20);
          for (const char* name : {"on_a", "on_b"}) rig.Do(name, "enable");
          if (grouped) rig.Do("cell", "enable");
          rig.Do("one", "join_track", "{track: on_a}");
          rig.Do("two", "join_track", "{track: on_b}");
          rig.Do("one", "move_on_track", "{position: " + std::to_string(at) + "}");
          const mover::Outputs &one = rig.Mover("one"), &two = rig.Mover("two");
          double last = two.velocity_x;
          rig.each_cycle = [&] {
            if (one.coordinate_system == two.coordinate_system) {
              ASSERT_GE(one.x - two.x, 200 - 1e-3);
            }
            // It brakes, no harder than it can.
            ASSERT_LE(std::abs(two.velocity_x - last), 10000 * 0.001 * 1.000001);
            last = two.velocity_x;
          };
          const Ticket comes = rig.Give("two", "move_on_track", "{position: 940}");
          rig.Run(later);
          const Ticket goes = rig.Give("a", "activate_position", "{index: 2}");
          rig.Run();
          // On its way nothing gets onto it.
          if (travel_s > 0 && rig.answers[goes].error == ErrorId::kNone) {
            EXPECT_EQ(rig.ErrorOf("two", "move_on_track", "{track: on_a, position: 100}"), ErrorId::kTrackMode);
          }
          const FeedbackEvent gone = rig.End(goes);
          rig.Run(1500);
          SCOPED_TRACE(std::to_string(at) + " " + std::to_string(later));
          if (gone.error == ErrorId::kNone) {
            ++went;
            EXPECT_EQ(one.coordinate_system, 1u);
            EXPECT_EQ(two.waits_for, 1u);
            EXPECT_NEAR(one.x - two.x, 200, 0.1);
            EXPECT_EQ(rig.ErrorOf("one", "move_on_track", "{position: 300}"), ErrorId::kNone);
          } else {
            ++refused;
            EXPECT_EQ(gone.error, ErrorId::kPartMover);
            EXPECT_EQ(gone.object, (ObjectInfo{ObjectKind::kMover, 2}));
            EXPECT_GE(later, 300);
          }
          EXPECT_EQ(rig.End(comes).error, ErrorId::kNone);
          EXPECT_NEAR(two.x, 960, 1e-9);
        }
      }
    }
  }
  std::printf("parts that went %d, that did not %d\n", went, refused);
  EXPECT_GT(went, 30);
  EXPECT_GT(refused, 10);
}

// Linked only on the border of both parts, and only while they are where that was meant.
TEST(PartTracks, AreLinkedOnTheBorderAlone) {
  PartsRig rig(kNetwork);
  const auto problem = [&](const FeedbackEvent& event) {
    return event.error == ErrorId::kTrackGeometry ? track::ProblemOf(event.value) : planar::Problem::kNone;
  };
  rig.Do("track_three", "append_line", "{start_x: 10, start_y: 120, end_x: 100, end_y: 120, reference: two}");
  EXPECT_EQ(problem(rig.Do("track_one", "end_at_track", "{track: track_three}")), planar::Problem::kNotOnBorder);
  rig.Do("track_three", "clear");
  rig.Do("track_three", "append_line", "{start_x: 0, start_y: 120, end_x: 100, end_y: 120, reference: two}");
  EXPECT_EQ(problem(rig.Do("track_three", "append_line",
                           "{start_x: 120, start_y: 120, end_x: 300, end_y: 120, reference: two}")),
            planar::Problem::kOffPart);
  rig.Do("track_one", "append_line", "{start_x: 100, start_y: 120, end_x: 440, end_y: 120, reference: plane}");
  EXPECT_EQ(problem(rig.Do("track_one", "end_at_track",
                           "{track: track_three, this_position_index: 1, other_position_index: 7}")),
            planar::Problem::kApart);
  EXPECT_EQ(rig.ErrorOf("track_one", "end_at_track", "{track: track_three}"), ErrorId::kNone);
  const track::Tracks& tracks = rig.engine.tracks();
  EXPECT_NEAR(tracks.At(0, tracks.outputs[0].length).place.x, 480, 1e-9);
  EXPECT_EQ(tracks.end_nodes[0], tracks.start_nodes[2]);
  rig.Do("two", "activate_position", "{index: 2}");
  EXPECT_NE(tracks.end_nodes[0], tracks.start_nodes[2]);
  EXPECT_NEAR(tracks.At(2, 0).place.y, 600, 1e-9);
  EXPECT_EQ(rig.ErrorOf("track_one", "append_line", "{start_x: 0, start_y: 0, end_x: 10, end_y: 0}"),
            ErrorId::kReference);
}

}  // namespace
}  // namespace takt::engine
