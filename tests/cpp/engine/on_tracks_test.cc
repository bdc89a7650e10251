// Commands to movers on tracks, carried out by a machine: PL-11, PL-12, PL-15.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "parts_rig.h"

namespace takt::engine {
namespace {

constexpr char kLineText[] = R"(
name: line
axes: []
movers: [{name: one, initial: {x: 0, y: 0}}]
tracks:
  - {name: way, elements: [{from: {x: 0, y: 0}, to: {x: 3000, y: 0}}, {from: {x: 3200, y: 200}, to: {x: 3200, y: 2000}}]}
)";

struct OnTracks : ::testing::Test {
  OnTracks() : rig(kLineText) {
    rig.Do("way", "enable");
    rig.Do("one", "enable");
    EXPECT_EQ(rig.ErrorOf("one", "join_track", "{track: way}"), ErrorId::kNone);
  }
  // Returns the value of the feedback while the command is active.
  double Value(Ticket ticket) {
    rig.Run(2);
    EXPECT_EQ(rig.answers[ticket].state, FeedbackState::kActive);
    return rig.answers[ticket].value;
  }

  PartsRig rig;
};

// PL-11: in the plane as well as on a track.
TEST_F(OnTracks, AHaltTakesItsDynamics) {
  for (const double deceleration : {1000.0, 4000.0}) {
    rig.Do("one", "move_on_track", "{position: 0}");
    rig.Give("one", "move_on_track", "{position: 2900}");
    rig.Run(500);
    const double speed = rig.Mover("one").track_velocity, place = rig.Mover("one").track_position;
    ASSERT_GT(speed, 1000);
    double hardest = 0;
    rig.each_cycle = [&] { hardest = std::max(hardest, -rig.Mover("one").track_acceleration); };
    const Ticket halt = rig.Give("one", "halt", "{deceleration: " + std::to_string(deceleration) + ", jerk: 100000}");
    const double takes = Value(halt);
    EXPECT_EQ(rig.End(halt).error, ErrorId::kNone);
    rig.each_cycle = nullptr;
    EXPECT_NEAR(hardest, deceleration, 1);
    const double expected = speed / deceleration + deceleration / 100000;
    EXPECT_NEAR(takes, expected, 0.002);
    EXPECT_NEAR(rig.Mover("one").track_position - place, 0.5 * speed * expected, 0.003 * speed);
  }
}

// PL-15: the duration is known at the start.
TEST_F(OnTracks, TheTimeOfAMoveIsKnown) {
  for (const char* to : {"{position: 1000}", "{position: 4500}", "{position: 100, velocity: 300, jerk: 5000}"}) {
    const Ticket move = rig.Give("one", "move_on_track", to);
    const double takes = Value(move);
    const FeedbackEvent end = rig.End(move);
    EXPECT_EQ(end.error, ErrorId::kNone);
    EXPECT_NEAR(takes, end.value, 0.01 * end.value) << to;  // in bends its dynamics may be lower than planned
  }
  // In motion, with dynamics that are insufficient for it: approximately.
  rig.Give("one", "move_on_track", "{position: 2500}");
  rig.Run(200);
  const Ticket move = rig.Give("one", "move_on_track", "{position: 4500, deceleration: 500, jerk: 10000}");
  const double takes = Value(move);
  EXPECT_NEAR(takes, rig.End(move).value, 0.2 * takes);
}

}  // namespace
}  // namespace takt::engine
