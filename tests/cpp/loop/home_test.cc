// MC_Home on a simulated axis: what the axis' parameters say, in one command.
#include <cmath>
#include <optional>

#include "homing_bench.h"

namespace takt::axis {
namespace {

// REF on from 10 to 30, NI every 10 mm at ...3, from where the axis starts at -40.
struct HomeBench : Bench {
  explicit HomeBench(const HomingParams& homing) : Bench(-40) { params.homing = homing; }
  Ticket Home(double position) {
    On();
    const Ticket ticket = Give(axis::Home{.position = position});
    Step();
    EXPECT_EQ(state.plc, homes_at_once ? PlcState::kStandstill : PlcState::kHoming);
    EXPECT_TRUE(RunToEnd(ticket));
    Run(0.2);  // until the plant is at rest, too
    return ticket;
  }
  // Where in the plant the axis takes itself to be at `position`.
  double PlaceOf(double position) const { return place() + position - state.actual.position; }
  bool homes_at_once = false;
};

constexpr HomingParams kSwitch = {
    .method = HomingMethod::kSwitch, .direction = HomingDirection::kPositive, .velocity = 40};

TEST(Home, FindsTheSwitch) {
  HomeBench bench(kSwitch);
  const Ticket ticket = bench.Home(500);
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
  EXPECT_TRUE(bench.seen.homed);
  EXPECT_NEAR(bench.PlaceOf(500), 10, 0.1);  // to a cycle of the search
  EXPECT_NEAR(bench.place(), 10, 0.1);       // returned there
}

// The switch, fast, and the index pulse behind it, slowly: exact to the encoder's increments.
TEST(Home, GoesOnToTheIndexPulse) {
  HomingParams homing = kSwitch;
  homing.pulse_velocity = 5;
  for (const bool up : {true, false}) {
    homing.pulse_direction = up ? HomingDirection::kPositive : HomingDirection::kNegative;
    HomeBench bench(homing);
    const Ticket ticket = bench.Home(-7);
    EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
    EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
    EXPECT_TRUE(bench.seen.homed);
    EXPECT_NEAR(bench.PlaceOf(-7), up ? 13 : 3, 2e-4);
  }
}

TEST(Home, FindsALimitSwitch) {
  HomeBench bench({.method = HomingMethod::kLimitSwitch, .direction = HomingDirection::kNegative, .velocity = 40});
  EXPECT_EQ(bench.last[bench.Home(0)].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.PlaceOf(0), -100, 0.1);
  EXPECT_EQ(bench.seen.error, ErrorId::kNone);
}

TEST(Home, FindsAnEndStop) {
  HomeBench bench(
      {.method = HomingMethod::kBlock, .direction = HomingDirection::kNegative, .velocity = 20, .deviation = 0.5});
  bench.servo.mechanics.lower_stop = -60;
  EXPECT_EQ(bench.last[bench.Home(-3)].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.PlaceOf(-3), -60, 0.1);
}

TEST(Home, FindsAnIndexPulse) {
  HomeBench bench({.method = HomingMethod::kPulse, .direction = HomingDirection::kNegative, .velocity = 5});
  EXPECT_EQ(bench.last[bench.Home(1)].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.PlaceOf(1), -47, 2e-4);
}

TEST(Home, TakesWhereTheAxisStands) {
  HomeBench bench({});
  bench.homes_at_once = true;
  EXPECT_EQ(bench.last[bench.Home(12)].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.PlaceOf(12), -40, 1e-3);
  EXPECT_TRUE(bench.seen.homed);
}

// AX-70: the limits are those of all of it.
TEST(Home, GivesUp) {
  HomingParams homing = kSwitch;
  homing.time_limit = 0.5;
  {
    HomeBench bench(homing);
    EXPECT_EQ(bench.last[bench.Home(0)].error, ErrorId::kTimeLimit);
    EXPECT_FALSE(bench.seen.homed);
  }
  homing.time_limit = 0;
  homing.pulse_velocity = 5;
  homing.distance_limit = 53;  // 50 to the switch, and 3 before the pulse
  HomeBench bench(homing);
  EXPECT_EQ(bench.last[bench.Home(0)].error, ErrorId::kDistanceLimit);
  bench.Run(0.5);
  EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
  EXPECT_FALSE(bench.seen.homed);
}

// From Standstill only; aborted by a stop, and followed by what waits behind it.
TEST(Home, IsACommandLikeOthers) {
  HomeBench bench(kSwitch);
  bench.On();
  const Ticket home = bench.Give(Home{.position = 0});
  const Ticket move = bench.Give(MoveAbsolute{.position = 20, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(bench.RunToEnd(move));
  EXPECT_EQ(bench.last[home].state, FeedbackState::kDone);
  EXPECT_EQ(bench.last[move].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.place(), 30, 0.1);
  bench.Give(MoveVelocity{.velocity = 10});
  const Ticket refused = bench.Give(Home{.position = 0});
  bench.Run(0.1);
  EXPECT_EQ(bench.last[refused].error, ErrorId::kState);
  ASSERT_TRUE(bench.RunToEnd(bench.Give(Halt{})));
  const Ticket again = bench.Give(Home{.position = 0});
  bench.Run(0.5);
  ASSERT_TRUE(bench.RunToEnd(bench.Give(Stop{})));
  EXPECT_EQ(bench.last[again].state, FeedbackState::kAborted);
  EXPECT_FALSE(bench.seen.homed);
}

}  // namespace
}  // namespace takt::axis
