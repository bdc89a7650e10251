// PL-22, PL-23, PL-24, PL-30: movers and the tracks under them, in a machine.
#include "parts_rig.h"

namespace takt::engine {
namespace {

constexpr const char* kFork = R"(
name: fork
axes: []
movers:
  - {name: a, initial: {x: 100, y: 0}}
  - {name: b, initial: {x: 1600, y: 300}}
tracks:
  - {name: main, elements: [{from: {x: 0, y: 0}, to: {x: 1500, y: 0}}]}
  - {name: up, starts_from: [main], elements: [{from: {x: 2000, y: 300}, to: {x: 2500, y: 500}}]}
)";

struct Fork : PartsRig {
  Fork() : PartsRig(kFork) {
    for (const char* one : {"main", "up", "a", "b"}) Do(one, "enable");
    Do("a", "join_track", "{track: main}");
  }
};

// PL-22: a track on a mover's route is not changed, whether the mover is on it, waits, or has only just started.
TEST(TracksInUse, ArePutAwayUnderNobody) {
  for (const int cycles : {0, 1, 300, 800}) {
    Fork rig;
    const Ticket going = rig.Give("a", "move_on_track", "{track: up, position: 800}");
    if (cycles > 0) rig.Run(cycles);
    const Ticket disable = rig.Give("up", "disable"), clear = rig.Give("up", "clear");
    const FeedbackEvent why = rig.End(disable);
    EXPECT_EQ(why.error, ErrorId::kTrackMode) << cycles;
    EXPECT_EQ(why.object, ObjectAt(ObjectKind::kMover, 0));
    EXPECT_EQ(rig.End(clear).error, ErrorId::kTrackGeometry);
    EXPECT_EQ(rig.End(going).error, ErrorId::kNone);
    EXPECT_EQ(rig.Mover("a").track, 2u);
  }
  // In the opposite order in one cycle.
  Fork rig;
  const Ticket disable = rig.Give("up", "disable"),
               going = rig.Give("a", "move_on_track", "{track: up, position: 800}");
  EXPECT_EQ(rig.End(disable).error, ErrorId::kNone);
  EXPECT_EQ(rig.End(going).error, ErrorId::kTrackDisabled);
  // If the mover has been halted before it, it is free.
  rig.Do("up", "enable");
  rig.Give("a", "move_on_track", "{track: up, position: 800}");
  rig.Run(200);
  rig.Do("a", "halt");
  EXPECT_EQ(rig.ErrorOf("up", "disable"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("up", "clear"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("a", "move_on_track", "{position: 1500}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("a", "move_on_track", "{track: up, position: 0}"), ErrorId::kTrackGeometry);
}

// Likewise a track that a mover is joining or leaving.
TEST(TracksInUse, AreNotPutAwayWhileSomebodyJoins) {
  Fork rig;
  const Ticket join = rig.Give("b", "join_track", "{track: up}"), disable = rig.Give("up", "disable");
  EXPECT_EQ(rig.End(disable).error, ErrorId::kTrackMode);
  EXPECT_EQ(rig.End(join).error, ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("up", "disable"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("b", "move_on_track", "{position: 300}"), ErrorId::kTrackDisabled);
  const FeedbackEvent clear = rig.End(rig.Give("up", "clear"));
  EXPECT_EQ(clear.error, ErrorId::kTrackMode);
  EXPECT_EQ(clear.object, ObjectAt(ObjectKind::kMover, 1));
  EXPECT_EQ(rig.ErrorOf("b", "leave_track", "{x: 1600, y: 300}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("up", "clear"), ErrorId::kNone);
}

// PL-30: the distance of movers on one network is governed by their gap. A group in which they are that close is
// enabled again.
TEST(TracksInGroups, HaveMoversAsNearAsTheirGapsLetThem) {
  PartsRig rig(R"(
name: near
axes: []
movers:
  - {name: a, initial: {x: 300}, gap: 117}
  - {name: b, initial: {x: 900}, gap: 117}
  - {name: beside, initial: {x: 450, y: 200}}
tracks: [{name: main, elements: [{from: {x: 0, y: 0}, to: {x: 1500, y: 0}}]}]
planar_groups: [{name: cell, movers: [a, b, beside], tracks: [main]}]
)");
  for (const char* one : {"main", "a", "b", "beside", "cell"}) rig.Do(one, "enable");
  for (const char* one : {"a", "b"}) {
    EXPECT_EQ(rig.ErrorOf(one, "join_track", "{track: main}"), ErrorId::kNone);
    EXPECT_EQ(rig.ErrorOf(one, "move_c", "{position: 15}"), ErrorId::kNone);
  }
  // Its corners come beside those of the other.
  EXPECT_EQ(rig.ErrorOf("b", "move_on_track", "{position: 417}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("cell", "disable"), ErrorId::kNone);
  EXPECT_EQ(rig.Do("cell", "enable").error, ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("b", "remove_from_group"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("b", "add_to_group", "{group: cell}"), ErrorId::kNone);
  // No other mover may come that close.
  EXPECT_EQ(rig.ErrorOf("beside", "move_to_position", "{x: 450, y: 100}"), ErrorId::kCollision);
  EXPECT_EQ(rig.ErrorOf("cell", "disable"), ErrorId::kNone);
  rig.Give("beside", "move_to_position", "{x: 450, y: 100}");
  rig.Run(1000);
  EXPECT_NE(rig.Mover("beside").waits_for, 0u);
  EXPECT_GE(rig.Mover("beside").y, 113);
  EXPECT_EQ(rig.ErrorOf("beside", "halt"), ErrorId::kNone);
  EXPECT_EQ(rig.Do("cell", "enable").error, ErrorId::kNone);
}

TEST(TracksInGroups, HaveNobodyOnSomebodyElseWhereTheyCross) {
  // One network: the second track begins at the end of the first, and returns over it.
  PartsRig rig(R"(
name: crossing
axes: []
movers:
  - {name: one, initial: {x: 500}}
  - {name: two, initial: {x: 500, y: 120}}
tracks:
  - {name: there, elements: [{from: {x: 0, y: 0}, to: {x: 2000, y: 0}}]}
  - name: back
    starts_from: [there]
    elements:
      - {from: {x: 2200, y: 200}, to: {x: 2200, y: 600}}
      - {from: {x: 1500, y: 900}, to: {x: 900, y: 900}}
      - {from: {x: 500, y: 500}, to: {x: 500, y: -500}}
planar_groups: [{name: cell, movers: [one, two], tracks: [there, back]}]
)");
  for (const char* one : {"there", "back", "one", "two"}) rig.Do(one, "enable");
  EXPECT_EQ(rig.ErrorOf("one", "join_track", "{track: there}"), ErrorId::kNone);
  rig.Give("two", "move_to_position", "{x: 500, y: 60}");
  rig.Run(1000);
  EXPECT_EQ(rig.Mover("two").waits_for, 1u);
  EXPECT_GE(rig.Mover("two").y, 113);
  EXPECT_EQ(rig.ErrorOf("two", "halt"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("two", "join_track", "{track: back}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("two", "move_on_track", "{position: 2000}"), ErrorId::kNone);
  EXPECT_EQ(rig.Do("cell", "enable").error, ErrorId::kNone);
}

}  // namespace
}  // namespace takt::engine
