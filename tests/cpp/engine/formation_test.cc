// PL-73: formations in a machine: on parts, through emergency stops and shutdowns, and the order of the cycle.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "parts_rig.h"

namespace takt::engine {
namespace {

using planar::ObjectState;

// A lift beside each of two levels; the planet is the first mover of the file, the star comes after it.
const std::string kLevelsText = R"(
name: levels
axes:
  - {name: x, limits: {velocity: 5000, acceleration: 100000, jerk: 5000000}}
coordinate_systems: [{name: lower}, {name: upper}]
parts:
  - {name: one, columns: 2, positions: [{coordinate_system: lower}]}
  - {name: two, columns: 2, positions: [{coordinate_system: upper}]}
  - name: three
    columns: 2
    positions: [{coordinate_system: lower, y: 240}, {coordinate_system: upper, y: 240}]
movers:
  - {name: planet, reference: one, initial: {x: 180, y: 60}, c: WIDE}
  - {name: star, reference: one, initial: {x: 60, y: 60}, c: WIDE}
  - {name: high, reference: two, initial: {x: 60, y: 60}, c: WIDE}
)";

constexpr ObjectInfo kPlanet{ObjectKind::kMover, 1};
constexpr ObjectInfo kStar{ObjectKind::kMover, 2};

// All movers may rotate without limit.
std::string Levels() {
  const std::string name = "WIDE",
                    window = "{maximum: {velocity: 360, acceleration: 3600, jerk: 72000}, lower: -90, upper: 90}";
  std::string text = kLevelsText;
  for (std::size_t at = 0; (at = text.find(name)) != std::string::npos;) text.replace(at, name.size(), window);
  return text;
}

void Form(PartsRig& rig) {
  rig.Run();
  for (const char* mover : {"planet", "star", "high"}) EXPECT_EQ(rig.ErrorOf(mover, "enable"), ErrorId::kNone);
  const Ticket join = rig.Give("planet", "join_formation", "{star: star}");
  rig.Run();
  EXPECT_EQ(rig.answers[join].state, FeedbackState::kActive);
}

double Apart(const PartsRig& rig) {
  return std::hypot(rig.Mover("planet").x - rig.Mover("star").x, rig.Mover("planet").y - rig.Mover("star").y);
}

TEST(Formations, GoOverThePartsAndWithThem) {
  PartsRig rig(Levels());
  Form(rig);
  rig.each_cycle = [&] { ASSERT_NEAR(Apart(rig), 120, 1e-9); };
  EXPECT_EQ(rig.ErrorOf("planet", "join_formation", "{star: high}"), ErrorId::kCommandMode);
  EXPECT_EQ(rig.ErrorOf("high", "join_formation", "{star: star}"), ErrorId::kReference);
  // The planet would leave the stators, the star would not; with translation and rotation.
  EXPECT_EQ(rig.ErrorOf("star", "move_to_position", "{x: 310, y: 60, reference: lower}"), ErrorId::kOffStators);
  EXPECT_EQ(rig.ErrorOf("star", "move_c", "{position: -45}"), ErrorId::kOffStators);
  EXPECT_EQ(rig.ErrorOf("star", "move_to_position", "{x: 180, y: 180, reference: lower}"), ErrorId::kNone);
  EXPECT_EQ(rig.ErrorOf("star", "move_c", "{position: 90}"), ErrorId::kNone);
  EXPECT_NEAR(rig.Mover("planet").y, 300, 1e-9);
  // The lift would carry the planet away from the star.
  EXPECT_EQ(rig.Mover("planet").part, 3u);
  EXPECT_EQ(rig.Mover("star").part, 1u);
  FeedbackEvent refused = rig.Do("three", "activate_position", "{index: 2}");
  EXPECT_EQ(refused.error, ErrorId::kPartMover);
  EXPECT_EQ(refused.object, kPlanet);
  EXPECT_EQ(rig.ErrorOf("star", "move_to_position", "{x: 180, y: 300, c: 90, reference: lower}"), ErrorId::kNone);
  EXPECT_EQ(rig.Mover("star").part, 3u);
  EXPECT_EQ(rig.ErrorOf("three", "activate_position", "{index: 2}"), ErrorId::kNone);
  EXPECT_EQ(rig.Mover("planet").coordinate_system, 2u);
  EXPECT_EQ(rig.Mover("star").coordinate_system, 2u);
  EXPECT_EQ(rig.Mover("planet").formation, 2u);
  EXPECT_EQ(rig.ErrorOf("star", "move_to_position", "{x: 180, y: 100, reference: upper}"), ErrorId::kNone);
  EXPECT_NEAR(rig.Mover("planet").y, 220, 1e-9);
}

// A part under a planet that fails stops the whole formation.
TEST(Formations, StopWhereAPartFails) {
  PartsRig rig(Levels());
  Form(rig);
  rig.ErrorOf("star", "move_to_position", "{x: 180, y: 180, reference: lower}");
  rig.ErrorOf("star", "move_c", "{position: 90}");
  const Ticket move = rig.Give("star", "move_to_position", "{x: 60, y: 180, reference: lower}");
  rig.Run(100);
  rig.Do("three", "force_disable");
  EXPECT_EQ(rig.End(move).error, ErrorId::kPlanetLost);
  rig.each_cycle = [&] { ASSERT_NEAR(Apart(rig), 120, 1e-9); };
  rig.Run(500);
  EXPECT_EQ(rig.Mover("star").state, ObjectState::kEnabled);
  EXPECT_EQ(rig.Mover("planet").state, ObjectState::kError);
  EXPECT_EQ(rig.Mover("planet").formation, 0u);
  EXPECT_GT(rig.Mover("star").x, 60);
}

// EN-22: whatever stops the machine stops formations as a whole.
TEST(Formations, StopWithTheMachine) {
  for (const char* how : {"emergency_stop", "stop_all"}) {
    PartsRig rig(Levels());
    Form(rig);
    rig.ErrorOf("star", "move_to_position", "{x: 200, y: 120, reference: lower}");
    rig.Give("star", "move_to_position", "{x: 200, y: 250, c: 60, use_orientation: true, reference: lower}");
    rig.Run(120);
    EXPECT_GT(rig.Mover("star").velocity_y, 50);
    rig.each_cycle = [&] { ASSERT_NEAR(Apart(rig), 120, 1e-9); };
    rig.Give("machine", how);
    rig.Run(500);
    EXPECT_EQ(rig.Mover("star").velocity_y, 0);
    EXPECT_LT(rig.Mover("star").y, 240);
    EXPECT_EQ(rig.Mover("planet").formation, std::string(how) == "stop_all" ? 2u : 0u);
  }
}

// An axis that follows a coordinate of a planet has its value of the same cycle, which depends on that of the star,
// though the planet is first in the file.
TEST(Formations, LeadAxesInTheSameCycle) {
  PartsRig rig(Levels());
  Form(rig);
  EXPECT_EQ(rig.ErrorOf("x", "power"), ErrorId::kNone);
  const Ticket gear =
      rig.Give("x", "gear_in_pos", "{master: planet.x, master_sync_position: 200, slave_sync_position: 0}");
  const Ticket move = rig.Give("star", "move_to_position", "{x: 300, y: 60, velocity: 300, reference: lower}");
  rig.End(move);
  EXPECT_EQ(rig.answers[gear].state, FeedbackState::kActive);
  EXPECT_NEAR(rig.engine.outputs(0).set_position, rig.Mover("planet").x - 200, 1e-9);
  EXPECT_NEAR(rig.Mover("planet").x, 420, 1e-9);
  EXPECT_EQ(kStar.number, rig.Mover("star").formation);
}

}  // namespace
}  // namespace takt::engine
