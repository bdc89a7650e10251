// PL-30, PL-32, PL-33, PL-71: groups of movers on a surface made of parts, and blended corners on its stators.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "parts_rig.h"

namespace takt::engine {
namespace {

// Example 6.6.1 of the manual, with one mover on each level and both in a group.
const std::string kGroupedLevels = R"(
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

// Enables both, and adds them to the group.
void EnableAll(PartsRig& rig) {
  rig.Run();
  EXPECT_EQ(rig.ErrorOf("cell", "enable"), ErrorId::kNone);  // at the same position in two coordinate systems
  EXPECT_EQ(rig.ErrorOf("below", "enable"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("above", "enable"), ErrorId::kNone);
}

TEST(PartsAndGroups, MoversMeetOnlyInOneCoordinateSystem) {
  PartsRig rig(kGroupedLevels);
  EnableAll(rig);
  const ErrorId free = rig.ErrorOf("above", "move_to_position", "{x: 120, y: 60, reference: upper}");
  EXPECT_EQ(free, ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("below", "move_to_position", "{x: 120, y: 60, reference: three}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kNone);
  // It has kept its position on the part.
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
  PartsRig rig(kGroupedLevels);
  EnableAll(rig);
  rig.Do("below", "move_to_position", "{x: 120, y: 60, reference: three}");
  rig.Do("line", "enable");
  EXPECT_EQ(rig.ErrorOf("above", "join_track", "{track: line}"), ErrorId::kNone);
  // At the lift's target the track ends, and a mover is about to reach that end.
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

// However early it leaves the line before a corner, it does not cut across a gap between stators: if necessary it
// stops.
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

// The same with coordinates relative to a part.
TEST(PartsAndGroups, BlendedCornersAreWhereTheReferenceSays) {
  std::array<int, 2> cycles{};
  for (const bool by_part : {false, true}) {
    PartsRig rig(R"(
name: halves
axes: []
coordinate_systems: [{name: plane}]
parts:
  - {name: left, columns: 4, rows: 4, positions: [{coordinate_system: plane}]}
  - {name: right, columns: 4, rows: 4, positions: [{coordinate_system: plane, x: 960}]}
movers:
  - {name: mover, reference: left, initial: {x: 120, y: 120}}
)");
    rig.Run();
    rig.Do("mover", "enable");
    double nearest = 1e9;
    rig.each_cycle = [&] {
      ++cycles[by_part];
      nearest = std::min(nearest, std::hypot(rig.Mover("mover").x - 1200, rig.Mover("mover").y - 120));
    };
    const std::string x = by_part ? "{x: 240, reference: right, " : "{x: 1200, reference: plane, ";
    rig.Give("mover", "move_to_position", x + "y: 120}");
    const Ticket second = rig.Give("mover", "move_to_position", x + "y: 800, buffer_mode: buffered, blending: 100}");
    EXPECT_EQ(rig.End(second).error, ErrorId::kNone);
    EXPECT_GT(nearest, 10);
    EXPECT_LT(nearest, 100);
    EXPECT_NEAR(rig.Mover("mover").x, 1200, 1e-9);
    EXPECT_NEAR(rig.Mover("mover").y, 800, 1e-9);
  }
  EXPECT_EQ(cycles[0], cycles[1]);
}

// Two lifts side by side, each with a mover on a track up to its border, and a hall.
std::string TwoLifts(double travel_s, bool grouped) {
  const std::string time = "travel_time_s: " + std::to_string(travel_s);
  return R"(
name: lifts
axes: []
coordinate_systems: [{name: plane}, {name: other}]
parts:
  - {name: a, positions: [{coordinate_system: other}, {coordinate_system: plane, x: 480}], )" +
         time + R"(}
  - {name: b, positions: [{coordinate_system: plane, x: 1000}, {coordinate_system: plane, x: 720}], )" +
         time + R"(}
  - {name: hall, columns: 2, positions: [{coordinate_system: plane}]}
movers:
  - {name: one, reference: a, initial: {x: 120, y: 120}}
  - {name: two, reference: b, initial: {x: 120, y: 120}}
  - {name: three, reference: hall, initial: {x: 120, y: 120}}
tracks:
  - {name: on_a, part: a, elements: [{from: {x: 10, y: 120}, to: {x: 230, y: 120}}]}
  - {name: on_b, part: b, elements: [{from: {x: 10, y: 120}, to: {x: 230, y: 120}}]}
  - {name: on_hall, part: hall, elements: [{from: {x: 20, y: 120}, to: {x: 470, y: 120}}]}
)" + (grouped ? "planar_groups: [{name: g, movers: [one, two, three], tracks: [on_a, on_b, on_hall]}]\n" : "");
}

class TwoLiftsRig : public PartsRig {
 public:
  TwoLiftsRig(double travel_s, bool grouped, int one, int two) : PartsRig(TwoLifts(travel_s, grouped)) {
    Run();
    for (const char* name : {"one", "two", "three"}) Do(name, "enable");
    Run(20);
    for (const char* name : {"on_a", "on_b", "on_hall"}) Do(name, "enable");
    if (grouped) {
      EXPECT_EQ(ErrorOf("g", "enable"), ErrorId::kNone);
    }
    EXPECT_EQ(ErrorOf("one", "join_track", "{track: on_a}"), ErrorId::kNone);
    EXPECT_EQ(ErrorOf("two", "join_track", "{track: on_b}"), ErrorId::kNone);
    EXPECT_EQ(ErrorOf("one", "move_on_track", "{position: " + std::to_string(one) + "}"), ErrorId::kNone);
    EXPECT_EQ(ErrorOf("two", "move_on_track", "{position: " + std::to_string(two) + "}"), ErrorId::kNone);
  }
};

// PL-80: on tracks, too, the whole mover is on stators that are present; so movers that two parts carry stay apart.
TEST(PartsAndGroups, WhatTwoPartsBringDoesNotMeet) {
  for (const bool grouped : {false, true}) {
    for (const int later : {0, 1, 100}) {
      for (const bool first_a : {false, true}) {
        TwoLiftsRig rig(0.2, grouped, 110, 110);
        EXPECT_EQ(rig.ErrorOf("one", "move_on_track", "{position: 220}"), ErrorId::kOffStators);
        const char *first = first_a ? "a" : "b", *second = first_a ? "b" : "a";
        const Ticket goes = rig.Give(first, "activate_position", "{index: 2}");
        rig.Run(later);
        EXPECT_EQ(rig.ErrorOf(second, "activate_position", "{index: 2}"), ErrorId::kNone);
        EXPECT_EQ(rig.End(goes).error, ErrorId::kNone);
        EXPECT_NEAR(rig.Mover("two").x - rig.Mover("one").x, 240, 1e-9);
      }
    }
  }
}

// The target position of a carried mover is reserved: before the arrival for lack of stators, and after it.
TEST(PartsAndGroups, WhatAPartBringsHasItsPlaceThere) {
  for (const int later : {0, 1, 100, 300}) {
    TwoLiftsRig rig(0.2, true, 47, 173);
    const Ticket goes = rig.Give("a", "activate_position", "{index: 2}");
    rig.Run(later);
    const FeedbackEvent refused = rig.Do("three", "move_to_position", "{x: 440, y: 120, reference: plane}");
    EXPECT_EQ(refused.error, later < 300 ? ErrorId::kOffStators : ErrorId::kCollision) << later;
    EXPECT_EQ(rig.End(goes).error, ErrorId::kNone);
    const FeedbackEvent then = rig.Do("three", "move_to_position", "{x: 440, y: 120, reference: plane}");
    EXPECT_EQ(then.error, ErrorId::kCollision);
    EXPECT_EQ(then.object, (ObjectInfo{ObjectKind::kMover, 1}));
    // Back on its level it blocks no other mover.
    EXPECT_EQ(rig.ErrorOf("a", "activate_position", "{index: 1}"), ErrorId::kNone);
    EXPECT_EQ(rig.ErrorOf("three", "move_to_position", "{x: 420, y: 120, reference: plane}"), ErrorId::kNone);
  }
}

// Relative set points cannot lead one mover into another: the area for stopping is reserved in every cycle, as for
// moves.
TEST(PartsAndGroups, RelativeSetPointsKeepClear) {
  for (const double top : {100.0, 500.0, 1500.0}) {
    PartsRig rig(R"(
name: pair
axes: []
movers: [{name: one}, {name: two, initial: {x: 1500}}, {name: three, initial: {x: 1500, y: 300}}]
planar_groups: [{name: cell, movers: [one, two, three]}]
)");
    rig.Run();
    for (const char* name : {"one", "two", "three"}) rig.Do(name, "enable");
    EXPECT_EQ(rig.ErrorOf("cell", "enable"), ErrorId::kNone);
    const Ticket led = rig.Give("one", "start_external_setpoint_generation", "{mode: relative}");
    double x = 0, v = 0, least = 1e9;
    rig.each_cycle = [&] { least = std::min(least, rig.Mover("two").x - rig.Mover("one").x); };
    Ticket into = 0;
    for (int i = 0; i < 20000 && !IsFinal(rig.answers[led].state); ++i) {
      const double a = v < top ? 1000 : 0;
      x += v * 0.001 + a * 0.5e-6;
      v += a * 0.001;
      char text[200];
      std::snprintf(text, sizeof text, "{x: %.12g, velocity_x: %.12g, acceleration_x: %.12g}", x, v, v < top ? a : 0);
      rig.Give("one", "set_external_setpoint", text);
      // Another mover does not get the area that this one needs to stop.
      if (into == 0 && x > 700) {
        into = rig.Give("three", "move_to_position", "{x: " + std::to_string(x + 113 + v * v / 40000) + ", y: 0}");
      }
      rig.Run();
    }
    EXPECT_EQ(rig.answers[led].error, ErrorId::kCollision);
    EXPECT_EQ(rig.answers[led].object, (ObjectInfo{ObjectKind::kMover, 2}));
    EXPECT_EQ(rig.answers[into].error, ErrorId::kCollision);
    EXPECT_EQ(rig.answers[into].object, (ObjectInfo{ObjectKind::kMover, 1}));
    rig.Run(1000);
    EXPECT_EQ(rig.Mover("one").state, planar::ObjectState::kError);
    EXPECT_GT(least, 113);
    EXPECT_LT(least, 113 + 6);
  }
}

}  // namespace
}  // namespace takt::engine
