// Superimposed motion on an axis that follows masters: AX-35.
#include <gtest/gtest.h>

#include <cmath>

#include "cam_rig.h"

namespace takt::engine {
namespace {

using axis::PlcState;

constexpr axis::MoveSuperimposed kCorrection = {
    .distance = 3, .velocity_difference = 30, .acceleration = 1000, .deceleration = 1000, .jerk = 50000};

bool IsDone(Line& line, Ticket ticket) {
  for (int i = 0; i < 5000 && !IsFinal(line.last[ticket].state); ++i) line.Step();
  return line.last[ticket].state == FeedbackState::kDone;
}

// The gear is unchanged: as fast as its master, with the added displacement.
TEST(Overlay, ShiftsAGearedAxis) {
  Line line(WithStrong(LineOf(2), 1, 3));
  const Ticket gear = line.Give(1, Gear("a0", 2));
  line.Run(10);
  const double begin = line.At(1).set_position - 2 * line.At(0).set_position;
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  line.Run(300);
  const Ticket top = line.Give(1, kCorrection);
  line.Run(60);
  EXPECT_NEAR(line.At(1).set_velocity, 2 * 100 + 30, 1e-9);
  EXPECT_EQ(line.At(1).state, PlcState::kSynchronizedMotion);
  ASSERT_TRUE(IsDone(line, top));
  EXPECT_NEAR(line.last[top].value, 3, 1e-9);
  for (const double velocity : {40.0, 300.0, 0.0}) {
    line.Give(0, axis::MoveVelocity{.velocity = velocity});
    line.Run(1000);
    EXPECT_NEAR(line.At(1).set_position - 2 * line.At(0).set_position, begin + 3, 1e-9);
    EXPECT_TRUE(line.At(1).in_step);
  }
  EXPECT_EQ(line.last[gear].state, FeedbackState::kActive);
}

// Neither the known position nor the next phase is lost with the superimposed motion.
TEST(Overlay, LeavesThePhaseAlone) {
  Line line(WithStrong(LineOf(2), 1, 3));
  line.Give(1, Gear("a0"));
  line.Give(0, axis::MoveVelocity{.velocity = 50});
  line.Run(500);
  const double begin = line.At(1).set_position - line.At(0).set_position;
  const Ticket phase = line.Give(1, axis::PhasingRelative{.phase_shift = 10, .velocity = 50});
  line.Run(50);
  ASSERT_TRUE(IsDone(line, line.Give(1, kCorrection)));
  ASSERT_TRUE(IsDone(line, phase));
  EXPECT_NEAR(line.At(1).set_position - line.At(0).set_position, begin + 13, 1e-9);
}

// On the strokes of a cam, too: the whole cam is shifted.
TEST(Overlay, RaisesACam) {
  Line line(WithCams(WithStrong(LineOf(2), 1, 3)));
  line.Give(1, Cam("a0", "stroke"));
  line.Run(10);
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  line.Run(700);
  ASSERT_TRUE(IsDone(line, line.Give(1, kCorrection)));
  for (int i = 0; i < 1500; ++i) {
    line.Step();
    ASSERT_NEAR(line.At(1).set_position, 3 + StrokeAt(line.At(0).set_position), 1e-9) << i;
  }
  EXPECT_TRUE(line.At(1).in_step);
}

// A slave that waits for its master is displaced, and synchronises with that displacement.
TEST(Overlay, MovesASlaveThatWaits) {
  Line line(WithCams(WithStrong(LineOf(2), 1, 3)));
  axis::GearInPos gear;
  gear.master = Name::Of("a0");
  gear.master_sync_position = 100;
  gear.slave_sync_position = 20;
  gear.master_start_distance = 50;
  line.Give(1, gear);
  ASSERT_TRUE(IsDone(line, line.Give(1, kCorrection)));
  line.Run(200);
  EXPECT_NEAR(line.At(1).set_position, 3, 1e-9);
  EXPECT_EQ(line.At(1).set_velocity, 0);
  line.Give(0, axis::MoveVelocity{.velocity = 50});
  for (int i = 0; i < 3000; ++i) {
    const double before = line.At(1).set_position;
    line.Step();
    ASSERT_LE(std::abs(line.At(1).set_position - before), 0.1);
    if (line.At(0).set_position > 100) {
      ASSERT_NEAR(line.At(1).set_position, 23 + line.At(0).set_position - 100, 1e-9);
    }
  }
  EXPECT_TRUE(line.At(1).in_step);
}

// Followers of the axis see the sum.
TEST(Overlay, IsSeenByFollowers) {
  Line line(WithStrong(LineOf(3), 2, 3));
  line.Give(2, Gear("a1"));
  line.Run(10);
  line.Give(1, axis::MoveAbsolute{.position = 50});
  ASSERT_TRUE(IsDone(line, line.Give(1, kCorrection)));
  line.Run(1000);
  EXPECT_EQ(line.At(1).set_position, 53);
  EXPECT_NEAR(line.At(2).set_position, 53, 1e-9);
}

// On a fault of the master the slave stops, and the superimposed motion ends.
TEST(Overlay, EndsWithTheCoupling) {
  Line line(LineOf(2));
  line.Give(1, Gear("a0"));
  line.Give(0, axis::MoveVelocity{.velocity = 50});
  line.Run(500);
  const Ticket top = line.Give(1, axis::MoveSuperimposed{.distance = 500, .velocity_difference = 20});
  line.Run(100);
  line.engine.faults(0).drive_fault = true;
  line.Run(500);
  EXPECT_EQ(line.last[top].state, FeedbackState::kError);
  EXPECT_EQ(line.At(1).set_velocity, 0);
  EXPECT_FALSE(line.At(1).superimposed);
}

}  // namespace
}  // namespace takt::engine
