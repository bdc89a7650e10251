// PL-80, PL-81: commands that are refused in advance, and motions that wait.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parts_rig.h"

namespace takt::engine {
namespace {

using ::testing::HasSubstr;

// Without a group, in the plane: a mover brakes before another one, reports it, and continues once that has left.
TEST(MoversWait, InThePlane) {
  PartsRig rig("name: plane\naxes: []\nmovers: [{name: one}, {name: two, initial: {x: 500, y: 20}}]\n");
  for (const char* mover : {"one", "two"}) rig.Do(mover, "enable");
  const Ticket move = rig.Give("one", "move_to_position", "{x: 900, y: 0}");
  rig.Run(2000);
  EXPECT_EQ(rig.answers[move].state, FeedbackState::kActive);
  EXPECT_EQ(rig.Mover("one").waits_for, 2u);
  EXPECT_EQ(rig.Mover("one").delay, mover::Delay::kMover);
  EXPECT_EQ(rig.Mover("one").velocity_x, 0);
  EXPECT_LE(rig.Mover("one").x, 500 - 113);
  EXPECT_GT(rig.Mover("one").x, 500 - 113 - 10);  // no earlier than necessary
  EXPECT_EQ(rig.ErrorOf("two", "move_to_position", "{x: 500, y: 200}"), ErrorId::kNone);
  EXPECT_EQ(rig.End(move).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Mover("one").waits_for, 0u);
  EXPECT_EQ(rig.Mover("one").x, 900);
}

// Moving towards each other: both brake, and stop apart.
TEST(MoversWait, HeadOn) {
  PartsRig rig("name: plane\naxes: []\nmovers: [{name: one}, {name: two, initial: {x: 800}}]\n");
  for (const char* mover : {"one", "two"}) rig.Do(mover, "enable");
  rig.Give("one", "move_to_position", "{x: 800, y: 0}");
  rig.Give("two", "move_to_position", "{x: 0, y: 0}");
  rig.Run(3000);
  EXPECT_EQ(rig.Mover("one").waits_for, 2u);
  EXPECT_EQ(rig.Mover("two").waits_for, 1u);
  EXPECT_GE(rig.Mover("two").x - rig.Mover("one").x, 113 - 1e-6);
  EXPECT_LE(rig.Mover("two").x - rig.Mover("one").x, 113 + 20);
  // A halt ends the command, and with it the reported reason.
  rig.Do("one", "halt");
  EXPECT_EQ(rig.Mover("one").waits_for, 0u);
}

// A rotation beside another mover is refused, with its name.
TEST(MoversWait, NotForATurn) {
  PartsRig rig("name: plane\naxes: []\nmovers: [{name: one}, {name: two, initial: {x: 115}}]\n");
  for (const char* mover : {"one", "two"}) rig.Do(mover, "enable");
  const FeedbackEvent turn = rig.Do("one", "move_c", "{position: 12}");
  EXPECT_EQ(turn.error, ErrorId::kCollision);
  EXPECT_EQ(turn.object, ObjectAt(ObjectKind::kMover, 1));
  EXPECT_EQ(rig.ErrorOf("two", "move_to_position", "{x: 150, y: 0}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("one", "move_c", "{position: 12}"), ErrorId::kNone);
}

// External set points end before another mover.
TEST(MoversWait, NotForSetPointsFromOutside) {
  PartsRig rig("name: plane\naxes: []\nmovers: [{name: one}, {name: two, initial: {x: 160, y: 30}}]\n");
  for (const char* mover : {"one", "two"}) rig.Do(mover, "enable");
  const Ticket led = rig.Give("one", "start_external_setpoint_generation", "{mode: absolute}");
  for (int i = 1; i < 2000 && !IsFinal(rig.answers[led].state); ++i) {
    const double t = 0.001 * i, a = 1000;
    const double v = std::min(a * t, 100.0), x = t < 0.1 ? a * t * t / 2 : 5 + 100 * (t - 0.1);
    char text[200];
    std::snprintf(text, sizeof text, "{x: %.12g, velocity_x: %.12g, acceleration_x: %.12g}", x, v, t < 0.1 ? a : 0.0);
    rig.Give("one", "set_external_setpoint", text);
    rig.Run();
  }
  EXPECT_EQ(rig.answers[led].error, ErrorId::kCollision);
  EXPECT_EQ(rig.answers[led].object, ObjectAt(ObjectKind::kMover, 1));
  rig.Run(500);
  EXPECT_LE(rig.Mover("one").x, 160 - 113 + 1e-6);
  EXPECT_GT(rig.Mover("one").x, 160 - 113 - 5);
}

// Where tracks cross without a node the second mover waits, and reports the other mover.
TEST(MoversWait, WhereTracksCross) {
  PartsRig rig(R"(
name: cross
axes: []
movers: [{name: one, initial: {x: 0, y: 0}}, {name: two, initial: {x: 500, y: -400}}]
tracks:
  - {name: along, elements: [{from: {x: 0, y: 0}, to: {x: 1000, y: 0}}]}
  - {name: across, elements: [{from: {x: 500, y: -400}, to: {x: 500, y: 400}}]}
)");
  for (const char* name : {"along", "across", "one", "two"}) rig.Do(name, "enable");
  rig.Do("one", "join_track", "{track: along}");
  rig.Do("two", "join_track", "{track: across}");
  rig.Do("two", "move_on_track", "{position: 400}");  // onto the crossing
  const Ticket move = rig.Give("one", "move_on_track", "{position: 1000}");
  rig.Run(3000);
  EXPECT_EQ(rig.answers[move].state, FeedbackState::kActive);
  EXPECT_EQ(rig.Mover("one").waits_for, 2u);
  EXPECT_LE(rig.Mover("one").x, 500 - 113 + 1e-6);
  EXPECT_GT(rig.Mover("one").x, 500 - 113 - 10);
  rig.Give("two", "move_on_track", "{position: 800}");
  EXPECT_EQ(rig.End(move).state, FeedbackState::kDone);
  EXPECT_EQ(rig.Mover("one").x, 1000);
}

const char* const kHall = R"(
name: hall
axes: []
coordinate_systems: [{name: floor}, {name: up}]
parts:
  - {name: left, columns: 4, positions: [{coordinate_system: floor}]}
  - {name: lift, positions: [{coordinate_system: floor, x: 960}, {coordinate_system: up}], travel_time_s: 0.3}
movers: [{name: one, reference: left, initial: {x: 120, y: 120}}, {name: two, reference: lift, initial: {x: 160, y: 120}}]
tracks: [{name: line, part: left, elements: [{from: {x: 60, y: 120}, to: {x: 960, y: 120}}]}]
)";

// PL-80: the whole mover counts on a track, not its centre: at a part that is away, and before a part may leave.
TEST(MoversWait, ForTheWholeMoverOnParts) {
  PartsRig rig(kHall);
  for (const char* name : {"line", "one", "two"}) rig.Do(name, "enable");
  ASSERT_EQ(rig.ErrorOf("one", "join_track", "{track: line}"), ErrorId::kNone);
  // Its route leads over the border of the lift, which must stay until it has passed.
  const Ticket move = rig.Give("one", "move_on_track", "{position: 850, velocity: 200}");
  rig.Run(50);
  const FeedbackEvent leaves = rig.Do("lift", "activate_position", "{index: 2}");
  EXPECT_EQ(leaves.error, ErrorId::kPartMover);
  EXPECT_EQ(leaves.object, ObjectAt(ObjectKind::kMover, 0));
  EXPECT_EQ(rig.End(move).state, FeedbackState::kDone);
  EXPECT_EQ(rig.ErrorOf("lift", "activate_position", "{index: 2}"), ErrorId::kPartMover);
  rig.Do("one", "move_on_track", "{position: 300}");
  ASSERT_EQ(rig.ErrorOf("lift", "activate_position", "{index: 2}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("one", "move_on_track", "{position: 850}"), ErrorId::kOffStators);
  EXPECT_EQ(rig.ErrorOf("one", "move_on_track", "{position: 843.5}"), ErrorId::kNone);  // flush with the border
  // A rotation there would extend beyond it.
  EXPECT_EQ(rig.ErrorOf("one", "move_c", "{position: 10}"), ErrorId::kOffStators);
}

// PL-81: a collision range shorter than the movers of the track need is an error with the smallest sufficient range.
TEST(MoversWait, WithinRangesThatAreLongEnough) {
  const auto problem = [](const std::string& range) {
    const LoadResult loaded = LoadMachine(R"(
name: fork
axes: []
movers: [{name: one}]
tracks:
  - {name: in, elements: [{from: {x: 0, y: 0}, to: {x: 300, y: 0}}]}
  - {name: left, starts_from: [in], elements: [{from: {x: 600, y: 150}, to: {x: 900, y: 150}}],
     collision_range_mode: manual, collision_range_at_start: )" +
                                              range + R"(}
  - {name: right, starts_from: [in], elements: [{from: {x: 600, y: -150}, to: {x: 900, y: -150}}]}
)",
                                          "fork.yaml");
    return loaded.problems.empty() ? std::string() : loaded.problems.front();
  };
  EXPECT_EQ(problem("600"), "");
  EXPECT_THAT(problem("60"), HasSubstr("tracks[1].collision_range_at_start: expected at least "));
  EXPECT_THAT(problem("60"),
              HasSubstr("movers of 155.0 mm by 155.0 mm on tracks that meet there can touch, found 60.0 mm"));
}

// PL-87: a mover off the stators of the environment of its group is an error, with the area that it covers.
TEST(MoversWait, NotOffTheirEnvironment) {
  const auto problem = [](const std::string& place) {
    const LoadResult loaded = LoadMachine("name: x\naxes: []\nmovers:\n  - {name: a, initial: {" + place +
                                              "}}\nenvironments: [{name: floor, stators: [{x: 0, y: 0}]}]\n" +
                                              "planar_groups: [{name: g, movers: [a], environment: floor}]\n",
                                          "x.yaml");
    return loaded.problems.empty() ? std::string() : loaded.problems.front();
  };
  EXPECT_EQ(problem("x: 120, y: 120"), "");
  EXPECT_EQ(problem("x: 56.5, y: 120"), "");
  EXPECT_THAT(problem("x: 50, y: 120"),
              HasSubstr("movers[0].initial: expected a place where all of the mover is on stators of "
                        "environment 'floor', found 'a' on X from -6.5 to 106.5 mm, Y from 63.5 to 176.5 mm"));
}

}  // namespace
}  // namespace takt::engine
