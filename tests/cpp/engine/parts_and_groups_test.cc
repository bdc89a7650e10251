// PL-30, PL-32, PL-33, PL-71: groups of movers on a surface made of parts, and blended corners on its stators.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "parts_rig.h"

namespace takt::engine {
namespace {

// Example 6.6.1 of the manual, with one mover on each level and both in a group.
const std::string kLevels = R"(
name: levels
axes: []
coordinate_systems: [{name: lower}, {name: upper}]
parts:
  - {name: one, positions: [{coordinate_system: lower}]}
  - {name: two, positions: [{coordinate_system: upper}]}
  - {name: three, positions: [{coordinate_system: lower, y: 240}, {coordinate_system: upper, y: 240}]}
movers:
  - {name: below, reference: one, initial: {x: 120, y: 120}}
  - {name: above, reference: two, initial: {x: 120, y: 120}}
tracks:
  - {name: line, part: two, elements: [{from: {x: 120, y: 60}, to: {x: 120, y: 240}}]}
planar_groups:
  - {name: cell, movers: [below, above], tracks: [line]}
)";

constexpr ObjectInfo kBelow{ObjectKind::kMover, 1};
constexpr ObjectInfo kLine{ObjectKind::kTrack, 1};

// Both are enabled, and in the group.
void EnableAll(PartsRig& rig) {
  rig.Run();
  EXPECT_EQ(rig.ErrorOf("cell", "enable"), ErrorId::kNone);  // at one place in two coordinate systems
  EXPECT_EQ(rig.ErrorOf("below", "enable"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("above", "enable"), ErrorId::kNone);
}

TEST(PartsAndGroups, MoversMeetOnlyInOneCoordinateSystem) {
  PartsRig rig(kLevels);
  EnableAll(rig);
  const ErrorId free = rig.ErrorOf("above", "move_to_position", "{x: 120, y: 60, reference: upper}");
  EXPECT_EQ(free, ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("below", "move_to_position", "{x: 120, y: 60, reference: three}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kNone);
  // It has taken its place along.
  FeedbackEvent refused = rig.Do("above", "move_to_position", "{x: 120, y: 190, reference: upper}");
  EXPECT_EQ(refused.error, ErrorId::kCollision);
  EXPECT_EQ(refused.object, kBelow);
  EXPECT_EQ(rig.ErrorOf("above", "move_to_position", "{x: 120, y: 180, reference: upper}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 1}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("below", "disable"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("below", "set_position", "{x: 120, y: 190, reference: lower}"), ErrorId::kNone);
  refused = rig.Do("above", "disable");
  refused = rig.Do("above", "set_position", "{x: 120, y: 190, reference: lower}");
  EXPECT_EQ(refused.error, ErrorId::kCollision);
  EXPECT_EQ(refused.object, kBelow);
  EXPECT_EQ(rig.Mover("above").coordinate_system, 2u);
}

TEST(PartsAndGroups, PartsGoWhereNothingIsReserved) {
  PartsRig rig(kLevels);
  EnableAll(rig);
  rig.Do("below", "move_to_position", "{x: 120, y: 60, reference: three}");
  rig.Do("line", "enable");
  EXPECT_EQ(rig.ErrorOf("above", "join_track", "{track: line}"), ErrorId::kNone);
  // Where the lift goes the track ends, and one on it is about to come there.
  const Ticket along = rig.Give("above", "move_on_track", "{position: 100}");
  rig.Run();
  const FeedbackEvent refused = rig.Do("three", "activate_position", "{index: 2}");
  EXPECT_EQ(refused.error, ErrorId::kPartTrack);
  EXPECT_EQ(refused.object, kLine);
  EXPECT_EQ(rig.Mover("below").coordinate_system, 1u);
  EXPECT_EQ(rig.End(along).error, ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("above", "move_on_track", "{position: 60}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kNone);
  const FeedbackEvent meets = rig.Do("above", "move_on_track", "{position: 100}");
  EXPECT_EQ(meets.error, ErrorId::kCollision);
  EXPECT_EQ(meets.object, kBelow);
}

// However early it may leave the line before a corner, it does not cut across what is no stator: if need be it stops.
TEST(PartsAndGroups, BlendedCornersStayOnStators) {
  double quickest = 1e9;
  for (const double blending : {0.0, 30.0, 80.0, 150.0, 200.0, 240.0}) {
    PartsRig rig(R"(
name: corner
axes: []
coordinate_systems: [{name: plane}]
parts:
  - name: corner
    stators: [{x: 0, y: 0}, {x: 240, y: 0}, {x: 240, y: 240}]
    positions: [{coordinate_system: plane}]
movers:
  - {name: mover, initial: {x: 60, y: 140}}
)");
    rig.Run();
    rig.Do("mover", "enable");
    int cycles = 0;
    rig.each_cycle = [&] {
      ++cycles;
      const mover::Outputs& o = rig.Mover("mover");
      const double half = 56.5 - 1e-6;
      EXPECT_GT(o.x - half, 0);
      EXPECT_GT(o.y - half, 0);
      EXPECT_LT(o.x + half, 480);
      EXPECT_LT(o.y + half, 480);
      EXPECT_FALSE(o.x - half < 240 && o.y + half > 240) << blending;
    };
    const Ticket first = rig.Give("mover", "move_to_position", "{x: 340, y: 140}");
    const Ticket second =
        rig.Give("mover", "move_to_position",
                 "{x: 340, y: 400, buffer_mode: buffered, blending: " + std::to_string(blending) + "}");
    EXPECT_EQ(rig.End(second).error, ErrorId::kNone) << blending;
    EXPECT_EQ(rig.answers[first].state, FeedbackState::kDone);
    EXPECT_NEAR(rig.Mover("mover").x, 340, 1e-9);
    EXPECT_NEAR(rig.Mover("mover").y, 400, 1e-9);
    if (blending == 0) quickest = cycles;
    if (blending == 30) {
      EXPECT_LT(cycles, quickest - 3);
    }
  }
}

}  // namespace
}  // namespace takt::engine
