// PL-22, PL-23, PL-24: movers and the tracks under them, as the machine has both.
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

// PL-22: a track that is on a mover's way stays as it is, whether it has got there yet, waits, or only just set off.
TEST(TracksInUse, ArePutAwayUnderNobody) {
  for (const int cycles : {0, 1, 300, 800}) {
    Fork rig;
    const Ticket going = rig.Give("a", "move_on_track", "{track: up, position: 800}");
    if (cycles > 0) rig.Run(cycles);
    const Ticket disable = rig.Give("up", "disable"), clear = rig.Give("up", "clear");
    EXPECT_EQ(rig.End(disable).error, ErrorId::kTrackMode) << cycles;
    EXPECT_EQ(rig.End(clear).error, ErrorId::kTrackGeometry);
    EXPECT_EQ(rig.End(going).error, ErrorId::kNone);
    EXPECT_EQ(rig.Mover("a").track, 2u);
  }
  // The other way round in one cycle.
  Fork rig;
  const Ticket disable = rig.Give("up", "disable"),
               going = rig.Give("a", "move_on_track", "{track: up, position: 800}");
  EXPECT_EQ(rig.End(disable).error, ErrorId::kNone);
  EXPECT_EQ(rig.End(going).error, ErrorId::kTrackMode);
  // Where a mover has been halted on its way there it is free.
  rig.Do("up", "enable");
  rig.Give("a", "move_on_track", "{track: up, position: 800}");
  rig.Run(200);
  rig.Do("a", "halt");
  EXPECT_EQ(rig.ErrorOf("up", "disable"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("up", "clear"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("a", "move_on_track", "{position: 1500}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("a", "move_on_track", "{track: up, position: 0}"), ErrorId::kNoRoute);
}

// So does one that somebody joins or leaves.
TEST(TracksInUse, AreNotPutAwayWhileSomebodyJoins) {
  Fork rig;
  const Ticket join = rig.Give("b", "join_track", "{track: up}"), disable = rig.Give("up", "disable");
  EXPECT_EQ(rig.End(disable).error, ErrorId::kTrackMode);
  EXPECT_EQ(rig.End(join).error, ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("up", "disable"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("b", "move_on_track", "{position: 300}"), ErrorId::kTrackMode);
  EXPECT_EQ(rig.ErrorOf("up", "clear"), ErrorId::kTrackMode);
  EXPECT_EQ(rig.ErrorOf("b", "leave_track", "{x: 1600, y: 300}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("up", "clear"), ErrorId::kNone);
}

}  // namespace
}  // namespace takt::engine
