// PL-32, PL-33: tracks on moving parts of the surface.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "parts_rig.h"
#include "takt/core/describe.h"

namespace takt::engine {
namespace {

using testing::HasSubstr;

// Example 6.2.11: a track on a part with two positions, linked at one end or the other.
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

  // A mover travels around: down by track two, and up again with the part.
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

// Both in one cycle: the second command is refused, in either order.
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
    return ProblemOf(text, what, instead);
  };
  EXPECT_THAT(problem("other_position_index: 2, only", "other_position_index: 3, only"),
              HasSubstr("tracks[1].starts_from_positions[0].track: the parts of the tracks are not in one"));
  EXPECT_THAT(problem("{from: {x: 0, y: 360}", "{from: {x: 10, y: 360}"), HasSubstr("on the border of both"));
}

// The gap holds over the border, too, and no mover comes too close when a part arrives.
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
  EXPECT_EQ(refused.error, ErrorId::kPartTrack);  // a mover waits to enter
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

// A part carries a mover in front of one that approaches: it is waited for, or the part does not move.
TEST(PartTracks, WhoIsBroughtIsWaitedFor) {
  int went = 0, refused = 0;
  for (const double travel_s : {0.0, 0.3}) {
    for (const bool grouped : {false, true}) {
      for (const int at : {57, 80, 100}) {
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
          const Ticket comes = rig.Give("two", "move_on_track", "{position: 880}");
          rig.Run(later);
          const Ticket goes = rig.Give("a", "activate_position", "{index: 2}");
          rig.Run();
          // While the part moves nothing enters it.
          if (travel_s > 0 && rig.answers[goes].error == ErrorId::kNone) {
            EXPECT_EQ(rig.ErrorOf("two", "move_on_track", "{track: on_a, position: 100}"), ErrorId::kPartDisabled);
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
          EXPECT_NEAR(two.x, 900, 1e-9);
        }
      }
    }
  }
  std::printf("parts that went %d, that did not %d\n", went, refused);
  EXPECT_GT(went, 30);
  EXPECT_GT(refused, 10);
}

// Linked only at the border of both parts, and only while both are at the positions of the link.
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
