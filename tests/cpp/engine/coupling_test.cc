// Gears between axes, made at run time: AX-43 to AX-47.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cam_rig.h"

namespace takt::engine {
namespace {

using axis::PlcState;

// AX-43: the velocity is locked; the displacement lost until then is not recovered, and nothing is lost from then on.
TEST(Gear, LocksTheVelocityAndKeepsWhatWasLost) {
  Line line(WithStrong(LineOf(2), 1, 2));
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  line.Run(200);
  axis::GearIn weak = Gear("a0", 2);
  weak.acceleration = 5000;
  weak.deceleration = 5000;
  weak.jerk = 100000;
  const Ticket gear = line.Give(1, weak);
  const double begin = line.At(0).set_position;
  line.Step();
  EXPECT_EQ(line.At(1).state, PlcState::kSynchronizedMotion);
  int cycles = 1;
  while (!line.reached[gear] && cycles < 1000) {
    line.Step();
    ++cycles;
  }
  // Closed form: from 0 to 200 u/s with 5000 u/s2 and 100000 u/s3 takes v/a + a/j.
  EXPECT_NEAR(cycles * 0.001, 200.0 / 5000 + 5000.0 / 100000, 0.003);
  EXPECT_TRUE(line.At(1).in_step);
  EXPECT_EQ(line.At(1).master1, 1u);
  const double offset = line.At(1).set_position - 2 * line.At(0).set_position;
  EXPECT_LT(line.At(1).set_position, 2 * (line.At(0).set_position - begin) - 5);
  line.Give(0, axis::MoveVelocity{.velocity = 40});
  for (int i = 0; i < 2000; ++i) {
    line.Step();
    ASSERT_NEAR(line.At(1).set_position - 2 * line.At(0).set_position, offset, 1e-9);
    ASSERT_DOUBLE_EQ(line.At(1).set_velocity, 2 * line.At(0).set_velocity);
  }
}

// AX-43: another ratio in motion takes over without a step.
TEST(Gear, ChangesItsRatioOnTheFly) {
  Line line(LineOf(2));
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  const Ticket first = line.Give(1, Gear("a0", 1));
  line.Run(500);
  const Ticket second = line.Give(1, Gear("a0", -0.5));
  line.Run(1000);
  EXPECT_EQ(line.last[first].state, FeedbackState::kAborted);
  EXPECT_TRUE(line.reached[second]);
  EXPECT_NEAR(line.At(1).set_velocity, -50, 1e-9);
}

// AX-43: a master beyond the slave's limits: the slave moves as fast as it can, and synchronises again, at its
// position.
TEST(Gear, FallsOutOfStepWithinItsLimitsOnly) {
  Line line(LineOf(2));
  line.Give(1, Gear("a0", 2));
  line.Run(5);
  line.Give(0, axis::MoveVelocity{.velocity = 400});
  line.Run(1000);
  EXPECT_NEAR(line.At(1).set_velocity, 500, 1e-6);
  EXPECT_FALSE(line.At(1).in_step);
  EXPECT_EQ(line.At(1).limited_by, LimitedBy::kVelocity);
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  line.Run(3000);
  EXPECT_NEAR(line.At(1).set_velocity, 200, 1e-9);
  EXPECT_NEAR(line.At(1).set_position, 2 * line.At(0).set_position, 1e-9);
  EXPECT_TRUE(line.At(1).in_step);
  EXPECT_EQ(line.At(1).limited_by, LimitedBy::kNothing);
}

// The ramps are those of the command, each in its own direction, also if they differ.
TEST(Gear, KeepsEachOfItsRamps) {
  Line line(LineOf(2));
  line.Give(0, axis::MoveVelocity{.velocity = 200});
  line.Run(200);
  axis::GearIn gear = Gear("a0");
  gear.acceleration = 2000;
  gear.deceleration = 200;
  double largest = 0, smallest = 0;
  const auto until_reached = [&](Ticket ticket) {
    int cycles = 0;
    largest = smallest = 0;
    for (; !line.reached[ticket] && cycles < 5000; ++cycles) {
      line.Step();
      largest = std::max(largest, line.At(1).set_acceleration);
      smallest = std::min(smallest, line.At(1).set_acceleration);
    }
    return cycles * 0.001;
  };
  EXPECT_NEAR(until_reached(line.Give(1, gear)), 200.0 / 2000 + 2000.0 / 100000, 0.003);
  EXPECT_NEAR(largest, 2000, 1e-6);
  gear.ratio_numerator = 0.25;
  EXPECT_NEAR(until_reached(line.Give(1, gear)), 150.0 / 200 + 200.0 / 100000, 0.003);
  EXPECT_NEAR(smallest, -200, 1e-6);
}

// AX-43, AX-47: nothing is lost to a measured master with irregular motion. With coarse increments its velocity must be
// filtered.
TEST(Gear, KeepsItsPlaceBehindAMeasuredMaster) {
  for (const double coarse : {10000.0, 1000.0, 100.0}) {
    SCOPED_TRACE(coarse);
    Machine machine = LineOf(2);
    machine.axes[0].encoder.increments_per_unit = coarse;
    if (coarse < 1000) machine.axes[0].encoder.velocity_filter_s = 0.02;
    Line line(machine);
    line.Give(0, axis::MoveVelocity{.velocity = 33.3});
    line.Run(300);
    axis::GearIn gear = Gear("a0");
    gear.source = axis::MasterSource::kActualValue;
    const Ticket ticket = line.Give(1, gear);
    line.Run(300);
    EXPECT_TRUE(line.reached[ticket]);
    const double lead = line.At(1).set_position - line.At(0).actual_position;
    int in_step = 0;
    for (int i = 0; i < 5000; ++i) {
      if (i % 1000 == 500) line.Give(0, axis::MoveVelocity{.velocity = i % 2000 == 500 ? 5.0 : 120.0});
      line.Step();
      in_step += line.At(1).in_step;
      ASSERT_LE(std::abs(line.At(1).set_velocity), 500);
      ASSERT_LE(std::abs(line.At(1).set_acceleration), 5000 * (1 + 1e-9));
    }
    EXPECT_NEAR(line.At(1).set_position - line.At(0).actual_position, lead, 16 / coarse);
    EXPECT_GT(in_step, 4000);
  }
}

// AX-55: the measured position of a master with a fault is invalid, until it is reset and a new coupling is made.
TEST(Gear, LeavesAMeasuredMasterThatFails) {
  for (const bool powered : {true, false}) {
    SCOPED_TRACE(powered);
    Line line(LineOf(2));
    axis::GearIn gear = Gear("a0");
    gear.source = axis::MasterSource::kActualValue;
    const Ticket ticket = line.Give(1, gear);
    line.Run(5);
    line.Give(0, axis::MoveVelocity{.velocity = 100});
    line.Run(500);
    ASSERT_TRUE(line.At(1).in_step);
    if (!powered) {
      line.Give(0, axis::Power{.enable = false});
      line.Run(500);
      ASSERT_EQ(line.At(0).state, PlcState::kDisabled);
      ASSERT_EQ(line.At(1).state, PlcState::kSynchronizedMotion);  // a hand wheel
    }
    line.engine.faults(0).drive_fault = true;
    line.Run(3);
    EXPECT_EQ(line.last[ticket].state, FeedbackState::kError);
    EXPECT_EQ(line.last[ticket].error, ErrorId::kAxisFault);
    line.engine.faults(0).drive_fault = false;
    line.Run(500);
    EXPECT_EQ(line.At(1).state, PlcState::kStandstill);
    EXPECT_EQ(line.At(1).set_velocity, 0);
    const Ticket refused = line.Give(1, gear);
    line.Run(2);
    EXPECT_EQ(line.last[refused].error, ErrorId::kMasterOff);
    line.Give(0, axis::Reset{});
    line.Run(50);
    const Ticket good = line.Give(1, gear);
    line.Run(5);
    EXPECT_EQ(line.last[good].state, FeedbackState::kActive);
  }
}

// AX-43: a slave no faster than its measured master overshoots its stopping position by no more than necessary.
TEST(Gear, StopsWithAMeasuredMaster) {
  Line line(LineOf(2));
  axis::GearIn gear = Gear("a0");
  gear.source = axis::MasterSource::kActualValue;
  line.Give(1, gear);
  line.Run(100);
  line.Give(0, axis::MoveAbsolute{.position = 50, .velocity = 300});
  double furthest = 0;
  for (int i = 0; i < 1000; ++i) {
    line.Step();
    furthest = std::max(furthest, line.At(1).set_position);
  }
  EXPECT_LT(furthest, 50.3);
  EXPECT_NEAR(line.At(1).set_position, 50, 0.01);
  EXPECT_TRUE(line.At(1).in_step);
}

// A master without a valid set position is refused, and the motion of the axis continues.
TEST(Gear, NeedsAMasterThatIsOn) {
  Line line(LineOf(2));
  line.Give(0, axis::Power{.enable = false});
  const Ticket move = line.Give(1, axis::MoveVelocity{.velocity = 50});
  line.Run(100);
  const Ticket gear = line.Give(1, Gear("a0"));
  line.Run(2);
  EXPECT_EQ(line.last[gear].error, ErrorId::kMasterOff);
  EXPECT_EQ(line.last[move].state, FeedbackState::kActive);
  axis::GearIn measured = Gear("a0");
  measured.source = axis::MasterSource::kActualValue;
  const Ticket good = line.Give(1, measured);
  line.Run(2);
  EXPECT_EQ(line.last[good].state, FeedbackState::kActive);
}

// AX-44: the axis continues at its velocity, without a master.
TEST(Gear, LetsGo) {
  Line line(LineOf(2));
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  const Ticket gear = line.Give(1, Gear("a0"));
  line.Run(500);
  const Ticket out = line.Give(1, axis::GearOut{});
  line.Run(5);
  EXPECT_EQ(line.last[gear].state, FeedbackState::kAborted);
  EXPECT_EQ(line.last[out].state, FeedbackState::kDone);
  EXPECT_EQ(line.At(1).state, PlcState::kContinuousMotion);
  EXPECT_EQ(line.At(1).master1, 0u);
  line.Give(0, axis::Halt{});
  line.Run(500);
  EXPECT_NEAR(line.At(1).set_velocity, 100, 1e-9);
  EXPECT_EQ(line.At(0).set_velocity, 0);
}

TEST(Gear, CannotBeLetGoWhereThereIsNone) {
  Line line(LineOf(1));
  const Ticket out = line.Give(0, axis::GearOut{});
  line.Run(2);
  EXPECT_EQ(line.last[out].error, ErrorId::kState);
}

// AX-12: a buffered gear waits for its turn; nothing can be buffered after a gear, except after one with a sync
// position.
TEST(Gear, TakesItsTurn) {
  Line line(LineOf(2));
  line.Give(0, axis::MoveVelocity{.velocity = 50});
  const Ticket move = line.Give(1, axis::MoveAbsolute{.position = 10});
  axis::GearIn buffered = Gear("a0");
  buffered.buffer_mode = axis::BufferMode::kBuffered;
  const Ticket first = line.Give(1, buffered);
  const axis::MoveRelative next{.distance = 5, .buffer_mode = axis::BufferMode::kBuffered};
  const Ticket refused = line.Give(1, next);
  line.Run(2);
  EXPECT_EQ(line.last[first].state, FeedbackState::kBusy);
  EXPECT_EQ(line.last[refused].error, ErrorId::kState);
  line.Run(1000);
  EXPECT_EQ(line.last[move].state, FeedbackState::kDone);
  EXPECT_TRUE(line.reached[first]);
  axis::GearInPos place;
  place.master = Name::Of("a0");
  place.master_sync_position = 100;
  place.slave_sync_position = 100;
  const Ticket gear = line.Give(1, place);
  const Ticket last = line.Give(1, next);
  line.Run(3000);
  EXPECT_TRUE(line.reached[gear]);
  EXPECT_EQ(line.last[last].state, FeedbackState::kDone);
  EXPECT_EQ(line.At(1).state, PlcState::kStandstill);
}

// AX-45, the diagram of PLCopen Part 1 in numbers: the master passes 150 at 100 u/s; the slave begins at 150 - 100 and
// is at 40 with 50 u/s when the master is at 150, and in step from there.
TEST(GearInPos, IsInStepAtTheSyncPosition) {
  Line line(LineOf(2));
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  axis::GearInPos gear;
  gear.master = Name::Of("a0");
  gear.ratio_numerator = 1;
  gear.ratio_denominator = 2;
  gear.master_sync_position = 150;
  gear.slave_sync_position = 40;
  gear.master_start_distance = 100;
  const Ticket ticket = line.Give(1, gear);
  bool moved_early = false;
  while (line.At(0).set_velocity > 0 || line.At(0).set_position == 0) {
    if (line.At(0).set_position >= 149.9) break;
    line.Step();
    moved_early |= line.At(0).set_position < 49.9 && line.At(1).set_position != 0;
    ASSERT_FALSE(line.reached[ticket]) << line.At(0).set_position;
    ASSERT_FALSE(line.At(1).in_step);
  }
  EXPECT_FALSE(moved_early);
  line.Run(3);
  EXPECT_TRUE(line.reached[ticket]);
  for (int i = 0; i < 1000; ++i) {
    line.Step();
    ASSERT_TRUE(line.At(1).in_step);
    ASSERT_NEAR(line.At(1).set_position, 40 + 0.5 * (line.At(0).set_position - 150), 1e-9);
  }
}

// AX-45: on rotary axes the next turn ahead is used; the sync mode selects the turn of the slave, in both senses and
// with both signs of the ratio.
TEST(GearInPos, ChoosesTheTurn) {
  for (const axis::SyncMode mode : {axis::SyncMode::kShortest, axis::SyncMode::kCatchUp, axis::SyncMode::kSlowDown}) {
    for (const auto& [sense, ratio] : {std::pair{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}) {
      Line line(LineOf(2, axis::AxisKind::kRotary));
      const auto direction = [](int of) { return of > 0 ? axis::Direction::kPositive : axis::Direction::kNegative; };
      line.Give(0, axis::MoveVelocity{.velocity = 200, .direction = direction(sense)});
      line.Give(1, axis::MoveVelocity{.velocity = 200, .direction = direction(sense * ratio)});
      line.Run(1000);
      axis::GearInPos gear;
      gear.master = Name::Of("a0");
      gear.ratio_numerator = ratio;
      gear.master_sync_position = sense > 0 ? 30 : 330;
      gear.slave_sync_position = sense * ratio > 0 ? 100 : 260;
      gear.master_start_distance = 300;
      gear.sync_mode = mode;
      const Ticket ticket = line.Give(1, gear);
      double fastest = 0;
      double slowest = 1000;
      for (int i = 0; i < 4000; ++i) {
        line.Step();
        fastest = std::max(fastest, sense * ratio * line.At(1).set_velocity);
        slowest = std::min(slowest, sense * ratio * line.At(1).set_velocity);
      }
      EXPECT_TRUE(line.reached[ticket]);
      const double apart = sense * ratio * line.At(1).set_position - sense * line.At(0).set_position;
      EXPECT_NEAR(std::fmod(apart + 1080, 360), 70, 1e-6);
      // Both begin at the same position: 70 ahead is nearer than 290 behind.
      const bool ahead = mode != axis::SyncMode::kSlowDown;
      EXPECT_EQ(fastest > 210, ahead);
      EXPECT_EQ(slowest < 190, !ahead);
    }
  }
}

// AX-45: a master at rest between the begin and the sync position, or one that reverses on a circle.
TEST(GearInPos, BeginsWhereverTheMasterComesFrom) {
  axis::GearInPos gear;
  gear.master = Name::Of("a0");
  gear.master_sync_position = 100;
  gear.slave_sync_position = 50;
  gear.master_start_distance = 50;
  {
    Line line(LineOf(2));
    line.Give(0, axis::MoveAbsolute{.position = 70});
    line.Run(1000);
    const Ticket ticket = line.Give(1, gear);
    line.Give(0, axis::MoveAbsolute{.position = 200, .velocity = 50});
    line.Run(4000);
    EXPECT_TRUE(line.reached[ticket]);
    EXPECT_NEAR(line.At(1).set_position, 150, 1e-9);
  }
  {
    Line line(LineOf(2));  // it has passed the position: when it returns
    line.Give(0, axis::MoveAbsolute{.position = 180});
    line.Run(1500);
    const Ticket ticket = line.Give(1, gear);
    line.Give(0, axis::MoveAbsolute{.position = 250, .velocity = 50});
    line.Run(2000);
    EXPECT_FALSE(line.reached[ticket]);
    EXPECT_FALSE(line.At(1).synchronizing);
    EXPECT_EQ(line.At(1).set_position, 0);
    line.Give(0, axis::MoveAbsolute{.position = 20, .velocity = 50});
    line.Run(5000);
    EXPECT_TRUE(line.reached[ticket]);
    EXPECT_NEAR(line.At(1).set_position, 50 - 80, 1e-9);
  }
  {
    Line line(LineOf(2, axis::AxisKind::kRotary));
    line.Give(0, axis::MoveVelocity{.velocity = 20});
    line.Run(500);
    const Ticket ticket = line.Give(1, gear);
    line.Run(500);
    line.Give(0, axis::MoveVelocity{.velocity = 50, .direction = axis::Direction::kNegative});
    line.Run(7000);  // over 0, and from 360 down to 100
    EXPECT_TRUE(line.reached[ticket]);
    EXPECT_NEAR(std::remainder(line.At(1).set_position - line.At(0).set_position + 50, 360), 0, 1e-6);
  }
}

TEST(GearInPos, HasItsPlaceInsideTheLimits) {
  Machine machine = LineOf(2);
  machine.axes[1].limits.upper = 100;
  Line line(machine);
  axis::GearInPos gear;
  gear.master = Name::Of("a0");
  gear.slave_sync_position = 120;
  const Ticket ticket = line.Give(1, gear);
  line.Run(2);
  EXPECT_EQ(line.last[ticket].error, ErrorId::kTargetBehindLimit);
}

// AX-46: a shift that begins during the synchronisation counts in full, and only the shift.
TEST(Phasing, CountsInFullOnTheWayIntoStep) {
  double lead[2] = {0, 0};
  for (const bool shifts : {false, true}) {
    Line line(LineOf(2));
    line.Give(0, axis::MoveVelocity{.velocity = 200});
    line.Run(3000);
    line.Give(1, Gear("a0"));
    line.Run(10);
    const Ticket shift = shifts ? line.Give(1, axis::PhasingRelative{.phase_shift = 10}) : 0;
    line.Run(2000);
    if (shifts) {
      EXPECT_EQ(line.last[shift].state, FeedbackState::kDone);
    }
    EXPECT_TRUE(line.At(1).in_step);
    lead[shifts] = line.At(1).set_position - line.At(0).set_position;
  }
  EXPECT_NEAR(lead[1] - lead[0], 10, 1e-9);
}

// AX-46: the slave moves by the shift times the ratio, and keeps it.
TEST(Phasing, ShiftsTheSlaveByTheRatio) {
  Line line(WithStrong(LineOf(2), 1, 2));
  line.Give(0, axis::MoveVelocity{.velocity = 50});
  line.Give(1, Gear("a0", 2));
  line.Run(1000);
  const auto lead = [&] { return line.At(1).set_position - 2 * line.At(0).set_position; };
  const double before = lead();
  axis::PhasingRelative shift;
  shift.phase_shift = 7;
  shift.velocity = 20;
  const Ticket first = line.Give(1, shift);
  line.Run(2);
  EXPECT_EQ(line.last[first].state, FeedbackState::kActive);
  line.Run(1000);
  EXPECT_EQ(line.last[first].state, FeedbackState::kDone);
  EXPECT_NEAR(lead() - before, 14, 1e-9);
  line.Give(1, shift);
  line.Run(1000);
  EXPECT_NEAR(lead() - before, 28, 1e-9);
  axis::PhasingAbsolute back;
  back.phase_shift = -1;
  const Ticket last = line.Give(1, back);
  line.Run(1000);
  EXPECT_EQ(line.last[last].state, FeedbackState::kDone);
  EXPECT_NEAR(lead() - before, -2, 1e-9);
  EXPECT_TRUE(line.At(1).in_step);
}

TEST(Phasing, NeedsAMaster) {
  Line line(LineOf(1));
  const Ticket shift = line.Give(0, axis::PhasingRelative{.phase_shift = 1});
  line.Run(2);
  EXPECT_EQ(line.last[shift].error, ErrorId::kState);
}

// AX-47.
TEST(CombineAxes, AddsAndSubtracts) {
  for (const axis::CombineMode mode : {axis::CombineMode::kAdd, axis::CombineMode::kSubtract}) {
    Line line(WithStrong(LineOf(3), 2, 5));
    axis::CombineAxes combine;
    combine.master1 = Name::Of("a0");
    combine.master2 = Name::Of("a1");
    combine.mode = mode;
    combine.ratio_numerator2 = 3;
    const Ticket ticket = line.Give(2, combine);
    line.Run(5);
    EXPECT_TRUE(line.reached[ticket]);
    const double sign = mode == axis::CombineMode::kAdd ? 3 : -3;
    line.Give(0, axis::MoveAbsolute{.position = 30, .velocity = 100});
    line.Give(1, axis::MoveAbsolute{.position = 20, .velocity = 50, .acceleration = 500, .jerk = 10000});
    for (int i = 0; i < 1500; ++i) {
      line.Step();
      ASSERT_NEAR(line.At(2).set_position, line.At(0).set_position + sign * line.At(1).set_position, 1e-6);
    }
    EXPECT_NEAR(line.At(2).set_position, 30 + sign * 20, 1e-6);
    EXPECT_THAT((std::vector{line.At(2).master1, line.At(2).master2}), testing::ElementsAre(1u, 2u));
  }
}

}  // namespace
}  // namespace takt::engine
