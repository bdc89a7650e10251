// Late clutch commands, ramps at every speed, lost masters, sequences backwards: the reports of the module, and its
// invariants (CAM-81 to CAM-87).
#include <gtest/gtest.h>

#include "bench.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

using axis::AxisKind;

Settings Over(double distance, double position, PassedSync passed) {
  Settings s;
  s.slave_absolute = true;
  s.sync_mode = ClutchMode::kRampPos;
  s.master_sync_in_distance = distance;
  s.master_sync_in_position = position;
  s.sync_in_passed = passed;
  return s;
}

struct Late {
  double at;
  PassedSync passed;
  double closes_at;  // 0: refused
};
class GivenLate : public testing::TestWithParam<Late> {};

// CAM-81, CAM-82: a linear web that has passed the begin of the curve.
TEST_P(GivenLate, IsRefusedOrClosesAtTheNextPositionThatLeavesRoom) {
  const Late& p = GetParam();
  Machine m = MachineOf({UpAndDown("hill", 40, 300)}, Over(120, 600, p.passed), AxisKind::kLinear);
  m.axes[Bench::kKnife].limits = {
      .velocity = 1000, .acceleration = 20000, .deceleration = {}, .jerk = 2e6, .lower = {}, .upper = {}};
  Bench b(m);
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 35});
  b.Web(400);
  ASSERT_TRUE(b.Until([&] { return b.TheWeb().set_position >= p.at; }));
  Watch watch(b);
  const Ticket ticket = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  if (p.closes_at == 0) {
    EXPECT_EQ(b.ErrorOf(ticket), ErrorId::kSyncPassed);
    EXPECT_EQ(b.Module().warning, ErrorId::kSyncPassed);
    b.Run(500);
    EXPECT_EQ(b.Module().state, ModuleState::kReady);
    EXPECT_EQ(b.Knife().set_position, 35);
    return;
  }
  const double closes_at = p.passed == PassedSync::kHere ? b.Module().clutch_position : p.closes_at;
  EXPECT_NEAR(b.Module().clutch_position, closes_at, 1e-9);
  EXPECT_NEAR(b.Module().clutch_distance, closes_at - b.TheWeb().set_position, 1e-9);
  ASSERT_TRUE(b.Until([&] { return b.Module().clutch == ClutchPhase::kClosed; }, 4000));
  EXPECT_GE(b.TheWeb().set_position, closes_at - 1e-6);
  EXPECT_LE(b.TheWeb().set_position, closes_at + 0.4 + 1e-6);
  EXPECT_NEAR(b.Knife().set_position, Hill(b.TheWeb().set_position, 40, 300), 1e-6);
  b.Run(1);
  EXPECT_EQ(b.Of(ticket), FeedbackState::kDone);
  EXPECT_EQ(b.Module().warning, ErrorId::kNone);
  EXPECT_LE(watch.acceleration, 5.7736 * 36 * std::pow(400.0 / 120, 2) + 40 * 5.78 * 4 * std::pow(400.0 / 300, 2));
  watch.ExpectSmooth();
}
INSTANTIATE_TEST_SUITE_P(Cases, GivenLate,
                         testing::Values(Late{300, PassedSync::kRefuse, 600}, Late{479, PassedSync::kRefuse, 600},
                                         Late{485, PassedSync::kRefuse, 0}, Late{599, PassedSync::kRefuse, 0},
                                         Late{700, PassedSync::kRefuse, 0}, Late{485, PassedSync::kNextCycle, 900},
                                         Late{1000, PassedSync::kNextCycle, 1200}, Late{599, PassedSync::kHere, 1},
                                         Late{2000, PassedSync::kHere, 1}));

// CAM-81: a curve that the slave cannot follow at the master's speed is refused, and the possible speed is published.
TEST(GivenLate, ACurveBeyondTheSlavesLimitsIsRefused) {
  Machine m = MachineOf({UpAndDown("hill", 40)}, Over(30, 200, PassedSync::kRefuse));
  m.axes[Bench::kKnife].limits = {
      .velocity = 1000, .acceleration = 20000, .deceleration = {}, .jerk = 2e7, .lower = {}, .upper = {}};
  Bench b(m);
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = -45});
  b.Web(1500);
  b.Run(500);
  Watch watch(b);
  const Ticket ticket = b.Tell(Control{.sync_cam = true});
  b.Run(3);
  EXPECT_EQ(b.ErrorOf(ticket), ErrorId::kSlaveLimits);
  EXPECT_EQ(b.Module().warning, ErrorId::kSlaveLimits);
  b.Web(100);
  b.Run(1000);
  b.Tell(Control{.sync_cam = false});
  b.Run(2);
  EXPECT_TRUE(b.Sync());
  watch.ExpectSmooth();
}

// CAM-81: an opening beyond the limits waits, reports it, and is refused in the end; the slave stays on its cam.
TEST(GivenLate, AnOpeningBeyondTheSlavesLimitsWaits) {
  Settings s = Quick();
  Bench b(MachineOf({Straight("gear", 1)}, s));
  b.Web(1000);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  b.Tell(Configure{.sync_mode = ClutchMode::kRampPos, .master_sync_out_distance = 3.0});
  const Ticket ticket = b.Tell(Control{.sync_cam = false});
  b.Run(3);
  EXPECT_EQ(b.Module().clutch, ClutchPhase::kWaitingOut);
  EXPECT_EQ(b.Module().clutch_waits, ClutchWait::kLimits);
  b.Run(600);
  EXPECT_EQ(b.ErrorOf(ticket), ErrorId::kSlaveLimits);
  EXPECT_TRUE(b.Module().cam_synchronised);
}

// CAM-81: a linear web that reverses within the curve closes when it returns, and the module reports its wait.
TEST(GivenLate, AWebThatTurnsAwayIsWaitedForAloud) {
  Bench b(MachineOf({UpAndDown("hill", 40, 300)}, Over(100, 500, PassedSync::kRefuse), AxisKind::kLinear));
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = -30});
  b.Web(400);
  b.Run(500);
  Watch watch(b);
  const Ticket ticket = b.Tell(Control{.sync_cam = true});
  ASSERT_TRUE(b.Until([&] { return b.TheWeb().set_position > 450; }));
  EXPECT_EQ(b.Module().clutch, ClutchPhase::kClosing);
  b.Web(-400);
  b.Run(1000);
  EXPECT_EQ(b.Module().clutch_waits, ClutchWait::kAway);
  EXPECT_EQ(b.Module().warning, ErrorId::kSyncPassed);
  EXPECT_NEAR(b.Knife().set_position, -30, 1e-9);
  b.Web(400);
  ASSERT_TRUE(b.Until([&] { return b.Module().cam_synchronised; }, 3000));
  EXPECT_NEAR(b.TheWeb().set_position, 500, 0.4 + 1e-6);
  EXPECT_EQ(b.Of(ticket), FeedbackState::kDone);
  watch.ExpectSmooth();
}

// CAM-82: each reason for waiting is reported.
TEST(Waits, AreNamed) {
  Settings s = Over(100, 200, PassedSync::kRefuse);
  s.offset_mode_master = OffsetMode::kRampIn;
  s.sync_direction = ClutchDirection::kPositive;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.Module().clutch_waits, ClutchWait::kMasterStands);
  b.Web(-50);
  b.Run(200);
  EXPECT_EQ(b.Module().clutch_waits, ClutchWait::kDirection);
  b.Web(50);
  b.Run(200);
  EXPECT_EQ(b.Module().clutch_waits, ClutchWait::kPosition);
  b.Tell(Control{.offset_master = 50.0});
  b.Run(20);
  EXPECT_EQ(b.Module().clutch_waits, ClutchWait::kRamps);
}

// --- CAM-83 ---

struct RampCase {
  PositionControl control;
  double slow, fast;
  int begins_after;  // cycles before the master accelerates
};
class RampLimits : public testing::TestWithParam<RampCase> {};

// CAM-83: ramps keep their own velocity and acceleration while the master accelerates, and at every speed.
TEST_P(RampLimits, HoldAtEverySpeedOfTheMaster) {
  const RampCase& p = GetParam();
  Settings s = Quick();
  s.position_control = p.control;
  s.offset_mode_master = OffsetMode::kRampIn;
  s.offset_scaling_master_velocity = 80;
  s.offset_scaling_master_acceleration = 900;
  s.offset_scaling_master_deceleration = 900;
  s.jerk = 60000;
  Machine m = MachineOf({Straight("line", 1)}, s, AxisKind::kLinear);
  m.axes[Bench::kWeb].limits = {
      .velocity = 2000, .acceleration = 15000, .deceleration = {}, .jerk = 1e6, .lower = {}, .upper = {}};
  Bench b(m);
  b.Web(p.slow);
  b.Run(100);
  ASSERT_TRUE(b.Sync());
  b.Tell(Configure{.master_max_velocity = 3.0});  // for the extreme values; it does not affect ramps
  const Ticket ticket = b.Tell(Control{.offset_master = 150.0});
  double velocity = 0, acceleration = 0, least = 1e9;
  b.each = [&] {
    const Outputs& o = b.Module();
    velocity = std::max(velocity, std::abs(o.set_x_velocity - b.TheWeb().set_velocity));
    acceleration = std::max(acceleration, std::abs(o.set_x_acceleration - b.TheWeb().set_acceleration));
    least = std::min(least, o.set_x_velocity);
    EXPECT_NEAR(o.set_offset_master, o.mp03_master_to_x_position - o.mp01_set_master_position, 1e-6);
    EXPECT_NE(o.offset_master_busy, o.offset_master_done);
  };
  b.Run(p.begins_after);
  EXPECT_TRUE(b.Module().offset_master_busy);
  EXPECT_FALSE(IsFinal(b.Of(ticket)));
  b.Web(p.fast);
  ASSERT_TRUE(b.Until([&] { return b.Of(ticket) == FeedbackState::kDone; }, 30000));
  EXPECT_TRUE(b.Module().offset_master_done);
  EXPECT_EQ(b.Module().set_offset_master, 150);
  EXPECT_LE(velocity, 80 * (1 + 1e-6));
  EXPECT_LE(acceleration, 900 * (1 + 1e-3));
  EXPECT_GE(least, -1e-9);
  if (p.fast >= 200) {
    EXPECT_GE(velocity, 70);
  }
}
INSTANTIATE_TEST_SUITE_P(Cases, RampLimits,
                         testing::Values(RampCase{PositionControl::kBoth, 10, 1400, 20},
                                         RampCase{PositionControl::kMasterDirection, 10, 1400, 20},
                                         RampCase{PositionControl::kMasterDirection, 10, 1400, 900},
                                         RampCase{PositionControl::kMasterDirection, 60, 300, 300},
                                         RampCase{PositionControl::kMasterDirection, 300, 1900, 200},
                                         RampCase{PositionControl::kMasterDirection, 30, 30, 300}));

// CAM-83: in master_direction offsets and factors of neither side move X or the slave against the master, in any mode,
// also while the master brakes hard, reverses and continues in the other direction.
TEST(MasterDirection, NothingGoesAgainstIt) {
  struct Change {
    Control control;
    const char* name;
  };
  const std::vector<Change> changes = {
      {{.offset_master = -120.0}, "offset_master"}, {{.offset_slave = -90.0}, "offset_slave"},
      {{.scaling_master = 0.3}, "scaling_master"},  {{.scaling_slave = 0.2}, "scaling_slave"},
      {{.offset_slave = 70.0}, "offset_slave up"},  {{.scaling_slave = 2.5}, "scaling_slave up"}};
  for (const Change& change : changes) {
    for (int mode = 0; mode < 5; ++mode) {
      SCOPED_TRACE(std::string(change.name) + " mode " + std::to_string(mode));
      Settings s = Quick();
      s.position_control = PositionControl::kMasterDirection;
      s.offset_mode_master = s.offset_mode_slave = static_cast<OffsetMode>(std::min(mode, 2));
      s.scaling_mode_master = s.scaling_mode_slave = static_cast<ScalingMode>(mode);
      s.offset_scaling_slave_velocity = s.offset_scaling_master_velocity = 500;
      s.offset_scaling_slave_acceleration = s.offset_scaling_master_acceleration = 8000;
      s.offset_scaling_slave_deceleration = s.offset_scaling_master_deceleration = 8000;
      s.jerk = 1e6;
      Machine m = MachineOf({Straight("turn", 1)}, s, AxisKind::kLinear);
      m.axes[Bench::kKnife].limits = {
          .velocity = 1e5, .acceleration = 1e8, .deceleration = {}, .jerk = 1e11, .lower = {}, .upper = {}};
      Bench b(m);
      b.Web(360);
      b.Run(200);
      ASSERT_TRUE(b.Sync());
      b.Run(500);
      double knife = b.Knife().set_position, web = b.TheWeb().set_position;
      double x = b.Module().mp03_master_to_x_position;
      double worst = 0, worst_x = 0;
      b.each = [&] {
        const double moved = b.TheWeb().set_position - web;
        const double sense = moved > 0 ? 1 : moved < 0 ? -1 : 0;
        const double by = b.Knife().set_position - knife, x_by = b.Module().mp03_master_to_x_position - x;
        worst = std::min(worst, sense == 0 ? -std::abs(by) : sense * by);
        worst_x = std::min(worst_x, sense == 0 ? -std::abs(x_by) : sense * x_by);
        knife = b.Knife().set_position;
        web = b.TheWeb().set_position;
        x = b.Module().mp03_master_to_x_position;
      };
      b.Tell(change.control);
      b.Run(150);
      b.Web(1000);
      b.Run(300);
      b.Give(Bench::kWeb, axis::Halt{.deceleration = 90000.0, .jerk = 5e6});
      b.Run(200);
      b.Web(-300);
      b.Run(400);
      b.Web(500);
      b.Run(6000);
      EXPECT_GE(worst, -1e-6);
      EXPECT_GE(worst_x, -1e-6);
      EXPECT_TRUE(b.Module().offset_slave_done && b.Module().offset_master_done);
      EXPECT_TRUE(b.Module().scaling_slave_done && b.Module().scaling_master_done);
    }
  }
}

// CAM-83: a slave factor of 0 could only be reached by reversing.
TEST(MasterDirection, AFactorOfNothingIsRefused) {
  Settings s = Quick();
  s.position_control = PositionControl::kMasterDirection;
  Bench b(MachineOf({Straight("turn", 1)}, s, AxisKind::kLinear));
  b.Web(360);
  b.Run(200);
  ASSERT_TRUE(b.Sync());
  const Ticket ticket = b.Tell(Control{.scaling_slave = 0.0});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(ticket), ErrorId::kWouldReverse);
}

// --- CAM-84 ---

// CAM-84: published values are in force, and each feedback ends with its ramp.
TEST(InForce, FactorsAreTheActualOnes) {
  Settings s = Quick();
  s.scaling_mode_slave = ScalingMode::kRampAbsolute;
  s.offset_mode_slave = OffsetMode::kRampIn;
  Bench b(MachineOf({Straight("line", 1, 1000)}, s, AxisKind::kLinear));
  b.Web(100);
  b.Run(100);
  ASSERT_TRUE(b.Sync());
  b.Run(1500);
  const Ticket first = b.Tell(Control{.scaling_slave = 1.5});
  b.Run(100);
  EXPECT_TRUE(b.Module().scaling_slave_busy);
  EXPECT_FALSE(b.Module().offset_slave_busy);
  for (int i = 0; i < 200; ++i) {
    b.Step();
    EXPECT_NEAR(b.Module().set_scaling_slave * b.Module().mp05_set_y_position, b.Knife().set_position, 1e-6);
  }
  const Ticket second = b.Tell(Control{.scaling_slave = 1.2});
  b.Run(2);
  EXPECT_EQ(b.Of(first), FeedbackState::kAborted);
  ASSERT_TRUE(b.Until([&] { return b.Of(second) == FeedbackState::kDone; }));
  EXPECT_EQ(b.Module().set_scaling_slave, 1.2);
  const Ticket third = b.Tell(Control{.offset_slave = 5.0, .scaling_slave = 1.0});
  b.Run(50);
  EXPECT_FALSE(IsFinal(b.Of(third)));
  ASSERT_TRUE(b.Until([&] { return b.Of(third) == FeedbackState::kDone; }));
  EXPECT_TRUE(b.Module().offset_slave_done && b.Module().scaling_slave_done);
  const Ticket fourth = b.Tell(Control{.offset_slave = 15.0});
  b.Run(5);
  b.Tell(Control{.stop = true});
  b.Run(5);
  EXPECT_EQ(b.Of(fourth), FeedbackState::kAborted);
}

// --- CAM-85 ---

// CAM-85: SW limit, the slave's own switch and the module's input all brake with the module's ramp.
TEST(FaultRamp, IsTheModulesWhateverStopsTheSlave) {
  for (const int what : {0, 1, 2}) {
    SCOPED_TRACE(what);
    Settings s = Quick();
    s.stop_deceleration = 1200;
    s.stop_jerk = 40000;
    Machine m = MachineOf({Straight("line", 1)}, s, AxisKind::kLinear);
    m.axes[Bench::kKnife].limits = {
        .velocity = 1000, .acceleration = 20000, .deceleration = {}, .jerk = 2e6, .lower = {}, .upper = {}};
    m.axes[Bench::kWeb].limits.acceleration = 4000;
    if (what == 0) m.axes[Bench::kKnife].limits.upper = 400;
    if (what == 1) {
      engine::SimulatedServo servo;
      servo.axis = "knife";
      servo.switches.limit_positive.from = 250;
      servo.switches.limit_positive.to = 5000;
      m.simulation.servos.push_back(servo);
    }
    Bench b(m);
    ASSERT_TRUE(b.Sync());
    b.Web(320);
    ASSERT_TRUE(b.Until([&] { return b.Knife().set_velocity > 319.9; }));
    b.Run(100);
    if (what == 2) b.Tell(Control{.enable_hw_limit = true, .hw_limit_positive = true});
    Watch watch(b);
    ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kError; }, 2000));
    ASSERT_TRUE(b.Until([&] { return b.Knife().set_velocity == 0; }, 2000));
    EXPECT_EQ(b.Module().error, what == 0 ? ErrorId::kModuleSoftLimitPositive : ErrorId::kModuleLimitSwitchPositive);
    EXPECT_LE(watch.acceleration, 1200 * (1 + 1e-6));
    EXPECT_GE(watch.acceleration, 1100);
    EXPECT_LE(watch.jerk, 40000 * (1 + 1e-3));
    if (what == 0) {
      EXPECT_LE(b.Knife().set_position, 400 + 1e-9);
    }
  }
}

// CAM-85: a cam that reverses before the SW limit is not stopped there, even with a weak ramp of the module.
TEST(FaultRamp, DoesNotStopACamThatStaysInside) {
  Settings s = Quick();
  s.stop_deceleration = 200;
  s.stop_jerk = 2000;
  Machine m = OneHill(s);
  m.axes[Bench::kKnife].limits.upper = 50.5;
  m.axes[Bench::kKnife].limits.lower = -0.5;
  Bench b(m);
  b.Web(1500);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  b.Run(2000);
  EXPECT_EQ(b.Module().state, ModuleState::kSync);
}

// --- CAM-86 ---

struct Mirror {
  double start;
  double sense;
};
class SequenceMirrored : public testing::TestWithParam<Mirror> {};

// CAM-86: backwards, a sequence runs the cams in the same order as forwards.
TEST_P(SequenceMirrored, RunsTheSameCams) {
  const Mirror& p = GetParam();
  Settings s;
  s.slave_absolute = true;
  s.cam_sequence_mode = SequenceMode::kCam1Cam2Cam3;
  Bench b(MachineOf({UpAndDown("one", 10), UpAndDown("two", 20), UpAndDown("three", 30), UpAndDown("four", 40)}, s,
                    AxisKind::kLinear));
  b.Give(Bench::kWeb, axis::MoveAbsolute{.position = p.start});
  b.Run(1000);
  b.Tell(Control{.cam_sequencer = true});
  ASSERT_TRUE(b.Sync());
  std::vector<std::uint32_t> slots;
  std::vector<double> at;
  b.each = [&] {
    if (slots.empty() || slots.back() != b.Module().cam_table) {
      slots.push_back(b.Module().cam_table);
      at.push_back(p.sense * b.TheWeb().set_position);
    }
  };
  b.Web(p.sense * 400);
  b.Run(4000);
  ASSERT_EQ(slots, (std::vector<std::uint32_t>{1, 2, 3}));
  const double first = p.sense > 0 ? 360 : p.start == 0 ? 360 : 0;
  EXPECT_NEAR(at[1], first, 1);
  EXPECT_NEAR(at[2], first + 360, 1);
}
INSTANTIATE_TEST_SUITE_P(Cases, SequenceMirrored,
                         testing::Values(Mirror{0, 1}, Mirror{0, -1}, Mirror{90, 1}, Mirror{90, -1}, Mirror{200, -1}));

// CAM-86: a master that oscillates at the end of a cam does not advance the sequence.
TEST(Sequence, DoesNotGoOnByTrembling) {
  Settings s;
  s.slave_absolute = true;
  s.cam_sequence_mode = SequenceMode::kCam1Cam2Cam3;
  Bench b(MachineOf({UpAndDown("one", 10), UpAndDown("two", 20), UpAndDown("three", 30), UpAndDown("four", 40)}, s,
                    AxisKind::kLinear));
  b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 300});
  b.Run(1000);
  b.Tell(Control{.cam_sequencer = true});
  ASSERT_TRUE(b.Sync());
  for (int i = 0; i < 6; ++i) {
    b.Give(Bench::kWeb, axis::MoveAbsolute{.position = i % 2 == 0 ? 361.0 : 359.0});
    b.Run(300);
    EXPECT_EQ(b.Module().cam_table, i % 2 == 0 ? 2u : 1u);
  }
}

// CAM-86
TEST(Sequence, WithAnEmptySlotIsRefused) {
  Settings s = Quick();
  Bench b(MachineOf({UpAndDown("one", 10), UpAndDown("two", 20)}, s));
  b.Tell(Configure{.cam_sequence_mode = SequenceMode::kCam1Cam2Cam3});
  const Ticket on = b.Tell(Control{.cam_sequencer = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(on), ErrorId::kEmptySlot);
  EXPECT_EQ(b.Module().warning, ErrorId::kEmptySlot);
  b.Tell(Configure{.cam_sequence_mode = SequenceMode::kCam1});
  const Ticket good = b.Tell(Control{.cam_sequencer = true});
  b.Run(2);
  EXPECT_EQ(b.Of(good), FeedbackState::kDone);
  const Ticket other = b.Tell(Configure{.cam_sequence_mode = SequenceMode::kCam3});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(other), ErrorId::kEmptySlot);
}

// --- CAM-87, and edges ---

// CAM-87: a master that was decelerating when it was lost comes to rest; this is reported.
TEST(Coasting, EndsAtStandstill) {
  Settings s = Quick();
  s.on_master_fault = MasterFault::kCoast;
  Bench b(OneHill(s));
  b.Web(250);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  EXPECT_FALSE(b.Module().master_lost);
  b.Give(Bench::kWeb, axis::Power{.enable = false});
  ASSERT_TRUE(b.Until([&] { return b.Module().master_lost; }, 2000));
  b.Run(3);
  EXPECT_EQ(b.Module().warning, ErrorId::kMasterOff);
  b.Run(2000);
  const double at = b.Module().mp03_master_to_x_position;
  b.Run(1000);
  EXPECT_EQ(b.Module().mp03_master_to_x_position, at);
  EXPECT_EQ(b.Module().state, ModuleState::kSync);
}

// CAM-10: an edge that rises and falls within one cycle counts.
TEST(Edges, WithinOneCycleAreTaken) {
  Bench b(OneHill());
  b.Tell(Control{.enable_hw_limit = true, .hw_limit_negative = true});
  b.Run(3);
  ASSERT_EQ(b.Module().state, ModuleState::kError);
  b.Tell(Control{.reset_error = true, .hw_limit_negative = false});
  b.Run(100);
  ASSERT_EQ(b.Module().state, ModuleState::kReady);
  b.Tell(Control{.hw_limit_negative = true});
  b.Run(100);
  ASSERT_EQ(b.Module().state, ModuleState::kError);
  b.Tell(Control{.hw_limit_negative = false});
  b.Run(2);
  b.Tell(Control{.reset_error = false});
  b.Tell(Control{.reset_error = true});
  b.Run(100);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  b.Tell(Control{.hw_limit_positive = true});
  b.Tell(Control{.hw_limit_positive = false});
  b.Run(2);
  EXPECT_EQ(b.Module().error, ErrorId::kModuleLimitSwitchPositive);
}

}  // namespace
}  // namespace takt::flexcam
