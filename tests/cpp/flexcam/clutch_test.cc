#include "takt/flexcam/clutch.h"

#include <gtest/gtest.h>

#include "bench.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

using axis::AxisKind;

// Returns the position of the slave by the cam, from the published X alone.
double YAt(double x, double height) {
  return height * engine::Polynomial345::Y(x < 180 ? x / 180 : (360 - x) / 180);
}

Settings Absolute(ClutchMode mode) {
  Settings s;
  s.slave_absolute = true;
  s.sync_mode = mode;
  return s;
}

void ExpectOnCam(Bench& b, double height, int cycles = 1000) {
  for (int i = 0; i < cycles; ++i) {
    b.Step();
    ASSERT_TRUE(b.Module().cam_synchronised);
    ASSERT_NEAR(b.Knife().set_position, YAt(b.Module().set_x_position, height), 1e-9);
  }
}

// CAM-30
TEST(Absolute, PutsASlaveThatIsThereOnTheCam) {
  Bench b(MachineOf({UpAndDown("hill", 50)}, Absolute(ClutchMode::kAbsolute)));
  b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 90});
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = YAt(90, 50)});
  b.Run(500);
  Watch watch(b);
  ASSERT_TRUE(b.Sync(5));
  EXPECT_LT(watch.velocity, 1e-9);  // it was there already
  b.Web(720);
  ExpectOnCam(b, 50);
  watch.ExpectSmooth();
}

// CAM-30: a slave elsewhere approaches as fast as its limits allow, without a jump.
TEST(Absolute, ChasesWhatIsElsewhere) {
  Bench b(MachineOf({UpAndDown("hill", 50)}, Absolute(ClutchMode::kAbsolute)));
  b.Web(360);
  b.Run(250);
  Watch watch(b);
  ASSERT_TRUE(b.Sync(400));
  ExpectOnCam(b, 50);
  watch.ExpectSmooth();
  EXPECT_GT(watch.acceleration, 1000);
}

// CAM-31
TEST(Relative, KeepsWhatLiesBetween) {
  Settings s = Absolute(ClutchMode::kRelative);
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 123});
  b.Run(500);
  ASSERT_TRUE(b.Sync(5));
  b.Web(720);
  for (int i = 0; i < 1000; ++i) {
    b.Step();
    ASSERT_NEAR(b.Knife().set_position, 123 + YAt(b.Module().set_x_position, 50), 1e-9);
  }
}

struct PathCase {
  double velocity;
  double distance;
  double position;
};
class RampPos : public testing::TestWithParam<PathCase> {};

// CAM-32: closed exactly when the master is at the sync position, over the requested distance, even over several turns.
TEST_P(RampPos, IsClosedAtTheSyncPosition) {
  const PathCase& p = GetParam();
  Settings s = Absolute(ClutchMode::kRampPos);
  s.master_sync_in_distance = p.distance;
  s.master_sync_in_position = p.position;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = -20});
  b.Run(500);
  Watch watch(b);
  b.Tell(Control{.sync_cam = true});
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kSync);
  EXPECT_FALSE(b.Module().acc_dec_sync);  // it only proceeds while the master moves
  b.Web(p.velocity);
  double way = 0, begun = 0;
  const double sense = p.velocity > 0 ? 1 : -1;
  ASSERT_TRUE(b.Until([&] {
    way += b.TheWeb().set_velocity * 0.001;
    if (b.Module().acc_dec_sync && begun == 0) begun = way;
    return b.Module().cam_synchronised;
  }));
  const double beyond = sense * (b.TheWeb().set_position - p.position);
  const double turn = beyond - 360 * std::round(beyond / 360);
  EXPECT_GE(turn, -1e-9);
  EXPECT_LE(turn, std::abs(p.velocity) * 0.001 + 1e-9);
  EXPECT_NEAR(std::abs(way - begun), p.distance, 2 * std::abs(p.velocity) * 0.001);
  ExpectOnCam(b, 50);
  watch.ExpectSmooth();
}

INSTANTIATE_TEST_SUITE_P(Cases, RampPos,
                         testing::Values(PathCase{360, 100, 200}, PathCase{-360, 100, 200}, PathCase{720, 800, 0},
                                         PathCase{100, 30, 359}, PathCase{-500, 1000, 10}));

// CAM-32: the condition on the master's direction.
TEST(RampPos, WaitsForTheDirectionAskedFor) {
  Settings s = Absolute(ClutchMode::kRampPos);
  s.sync_direction = ClutchDirection::kPositive;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Tell(Control{.sync_cam = true});
  b.Web(-360);
  b.Run(3000);
  EXPECT_FALSE(b.Module().cam_synchronised);
  EXPECT_EQ(b.Knife().set_position, 0);
  b.Web(360);
  EXPECT_TRUE(b.Until([&] { return b.Module().cam_synchronised; }, 3000));
}

// CAM-32: a master that stops on the curve holds the slave, one that reverses takes it back.
TEST(RampPos, GoesWithTheMasterAlone) {
  Settings s = Absolute(ClutchMode::kRampPos);
  s.master_sync_in_position = 200;
  s.master_sync_in_distance = 150;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = -30});
  b.Run(300);
  Watch watch(b);
  b.Tell(Control{.sync_cam = true});
  b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 150, .velocity = 300});
  b.Run(1500);
  const double there = b.Knife().set_position;
  EXPECT_GT(there, -20);
  b.Run(500);
  EXPECT_EQ(b.Knife().set_position, there);
  b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 20, .velocity = 300, .direction = axis::Direction::kNegative});
  b.Run(1500);
  EXPECT_NEAR(b.Knife().set_position, -30, 1e-6);  // before the begin it is at its initial position
  b.Web(360);
  EXPECT_TRUE(b.Until([&] { return b.Module().cam_synchronised; }, 3000));
  ExpectOnCam(b, 50);
  watch.ExpectSmooth();
}

// CAM-33: after exactly the requested time, with the master at rest or moving in any direction.
TEST(RampTime, TakesItsTimeWhateverTheMasterDoes) {
  for (const double velocity : {0.0, 360.0, -1000.0}) {
    Settings s = Absolute(ClutchMode::kRampTime);
    s.sync_in_time_s = 0.4;
    Bench b(MachineOf({UpAndDown("hill", 50)}, s));
    b.Give(Bench::kKnife, axis::MoveAbsolute{.position = -40});
    if (velocity != 0) b.Web(velocity);
    b.Run(500);
    Watch watch(b);
    const std::uint64_t begin = b.engine.cycle().count;
    ASSERT_TRUE(b.Sync());
    EXPECT_NEAR(static_cast<double>(b.engine.cycle().count - begin), 400, 2) << velocity;
    ExpectOnCam(b, 50);
    watch.ExpectSmooth();
    if (velocity == 0) {  // rest to rest: 1.875 h / T
      EXPECT_NEAR(watch.velocity, 1.875 * 40 / 0.4, 0.01);
      EXPECT_NEAR(watch.acceleration, 10 / std::sqrt(3.0) * 40 / 0.16, 1);
    }
  }
}

// CAM-34: the shift between slave and cam is ramped with its own velocity and ramps, on top of the cam.
TEST(RampVelAcc, IsOnTopOfTheCam) {
  Settings s = Absolute(ClutchMode::kRampVelAcc);
  s.sync_velocity = 80;
  s.sync_acceleration = 500;
  s.sync_deceleration = 500;
  s.sync_jerk = 20000;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = -60});
  b.Web(700);
  b.Run(700);
  Watch watch(b);
  double relative = 0;
  b.each = [&] {
    watch.Look();
    if (b.Module().acc_dec_sync)
      relative = std::max(relative, std::abs(b.Knife().set_velocity - b.Module().set_y_velocity));
  };
  ASSERT_TRUE(b.Sync());
  ExpectOnCam(b, 50);
  watch.ExpectSmooth();
  EXPECT_LE(relative, 300 + 80);  // initially the cam's own velocity
  Bench still(MachineOf({UpAndDown("hill", 50)}, s));
  still.Give(Bench::kKnife, axis::MoveAbsolute{.position = -60});
  still.Run(700);
  Watch rest(still);
  ASSERT_TRUE(still.Sync());
  EXPECT_NEAR(rest.velocity, 80, 1e-6);
  EXPECT_NEAR(rest.acceleration, 500, 1);
}

class Opening : public testing::TestWithParam<ClutchMode> {};

// CAM-35
TEST_P(Opening, EndsWhereItIsToEnd) {
  const ClutchMode mode = GetParam();
  const bool frozen = mode == ClutchMode::kAbsolute || mode == ClutchMode::kRelative;
  for (const double velocity : {360.0, -500.0}) {
    Settings s = Absolute(ClutchMode::kRampTime);
    s.sync_in_time_s = 0.1;
    Bench b(MachineOf({UpAndDown("hill", 50)}, s));
    b.Web(velocity);
    b.Run(200);
    ASSERT_TRUE(b.Sync());
    b.Run(130);
    b.Tell(Configure{.sync_mode = mode,
                     .master_sync_out_distance = 120.0,
                     .slave_sync_out_position = -25.0,
                     .sync_out_time_s = 0.3});
    b.Run(1);
    Watch watch(b);
    double way = 0;
    b.each = [&] {
      watch.Look();
      way += b.TheWeb().set_velocity * 0.001;
    };
    const double from = b.Knife().set_position;
    const std::uint64_t begin = b.engine.cycle().count;
    const Ticket ticket = b.Tell(Control{.sync_cam = false});
    b.Run(2);
    EXPECT_TRUE(b.Module().acc_dec_sync);
    EXPECT_FALSE(b.Module().cam_synchronised);
    ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kReady; }));
    EXPECT_EQ(b.Of(ticket), FeedbackState::kDone);
    EXPECT_NEAR(b.Knife().set_position, frozen ? from : -25, 1e-9);
    EXPECT_EQ(b.Knife().set_velocity, 0);
    if (mode == ClutchMode::kRampTime) {
      EXPECT_NEAR(static_cast<double>(b.engine.cycle().count - begin), 300, 3);
    }
    if (mode == ClutchMode::kRampPos) {
      EXPECT_NEAR(std::abs(way), 120, 3 * std::abs(velocity) * 0.001);
    }
    watch.ExpectSmooth();
    EXPECT_EQ(b.Knife().state, axis::PlcState::kStandstill);
  }
}

INSTANTIATE_TEST_SUITE_P(Modes, Opening,
                         testing::Values(ClutchMode::kAbsolute, ClutchMode::kRelative, ClutchMode::kRampPos,
                                         ClutchMode::kRampTime, ClutchMode::kRampVelAcc));

// CAM-36
TEST(ImmediateOpening, StopsWithItsOwnDecelerationAndKeepsOpen) {
  Settings s = Absolute(ClutchMode::kRampTime);
  s.sync_in_time_s = 0.1;
  s.sync_out_instant_deceleration = 2000;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Web(720);
  b.Run(200);
  ASSERT_TRUE(b.Sync());
  ASSERT_TRUE(b.Until([&] { return b.Knife().set_velocity > 180; }));
  Watch watch(b);
  b.Tell(Control{.sync_out_instant = true});
  b.Run(75);
  EXPECT_NEAR(b.Knife().set_acceleration, -2000, 1e-6);
  ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kReady; }, 300));
  watch.ExpectSmooth();
  const Ticket again = b.Tell(Control{.sync_cam = false});
  b.Run(2);
  const Ticket refused = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.Of(again), FeedbackState::kDone);
  EXPECT_EQ(b.ErrorOf(refused), ErrorId::kState);  // refused while the input is set
  EXPECT_EQ(b.Module().warning, ErrorId::kState);
  b.Tell(Control{.sync_out_instant = false});
  b.Run(500);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);  // earlier requests are dropped
  b.Tell(Control{.sync_cam = false});
  b.Run(2);
  EXPECT_TRUE(b.Sync());
}

// CAM-38
TEST(Closing, FreezesTheSlavesOffsetAndFactor) {
  Settings s = Absolute(ClutchMode::kRampTime);
  s.sync_in_time_s = 0.3;
  s.offset_mode_slave = OffsetMode::kDirect;
  s.scaling_mode_slave = ScalingMode::kAbsolute;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Web(360);
  b.Run(200);
  b.Tell(Control{.sync_cam = true});
  b.Run(50);
  b.Tell(Control{.offset_slave = 5.0, .scaling_slave = 2.0});
  while (!b.Module().cam_synchronised) {
    b.Step();
    if (!b.Module().acc_dec_sync) break;
    ASSERT_EQ(b.Module().set_offset_slave, 0);
    ASSERT_EQ(b.Module().set_scaling_slave, 1);
  }
  b.Run(300);
  EXPECT_EQ(b.Module().set_offset_slave, 5);
  EXPECT_EQ(b.Module().set_scaling_slave, 2);
  for (int i = 0; i < 500; ++i) {
    b.Step();
    ASSERT_NEAR(b.Knife().set_position, 5 + 2 * YAt(b.Module().set_x_position, 50), 1e-9);
  }
}

// CAM-37
TEST(WithoutReversing, ATurnAheadIsTakenOnARotarySlave) {
  Settings s = Absolute(ClutchMode::kRampPos);
  s.position_control = PositionControl::kMasterDirection;
  s.master_sync_in_distance = 100;
  s.master_sync_in_position = 180;
  Bench b(MachineOf({Straight("gear", 1)}, s, AxisKind::kRotary, AxisKind::kRotary));
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 170, .direction = axis::Direction::kPositive});
  b.Run(1500);
  Watch watch(b);
  b.Tell(Control{.sync_cam = true});
  b.Run(1);
  b.Web(200);
  double least = 0;
  b.each = [&] {
    watch.Look();
    least = std::min(least, b.Knife().set_velocity);
  };
  ASSERT_TRUE(b.Until([&] { return b.Module().cam_synchronised; }));
  EXPECT_GE(least, -1e-6);
  EXPECT_NEAR(b.Knife().set_position, b.Module().set_x_position, 1e-9);
  watch.ExpectSmooth();
}

// CAM-37: a closing that would reverse the slave is refused at the request.
TEST(WithoutReversing, IsRefusedWhereItCannotBe) {
  Settings s = Absolute(ClutchMode::kRampPos);
  s.position_control = PositionControl::kMasterDirection;
  s.master_sync_in_position = 180;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 80});
  b.Web(200);
  b.Run(500);
  const Ticket ticket = b.Tell(Control{.sync_cam = true});
  b.Run(3);
  EXPECT_EQ(b.Of(ticket), FeedbackState::kError);
  EXPECT_EQ(b.ErrorOf(ticket), ErrorId::kWouldReverse);
  EXPECT_EQ(b.Module().warning, ErrorId::kWouldReverse);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
  EXPECT_EQ(b.Knife().set_position, 80);
}

// A slave that moves independently of its master has no slope over the master's displacement: no curve begins then.
TEST(RampPos, BeginsNoCurveFromAMotionThatTheMasterDoesNotGive) {
  for (const double velocity : {1.0, 5.0, 50.0}) {
    Bench b(MachineOf({UpAndDown("hill", 50)}, Absolute(ClutchMode::kAbsolute)));
    b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 170});
    b.Run(1500);
    b.Web(velocity);
    b.Run(200);
    Watch watch(b);
    double high = 0, low = 0;
    b.each = [&] {
      watch.Look();
      high = std::max(high, b.Knife().set_position);
      low = std::min(low, b.Knife().set_position);
    };
    b.Tell(Control{.sync_cam = true});
    b.Run(15);
    EXPECT_GT(b.Knife().set_velocity, 100);  // approaching the cam
    b.Tell(Configure{.sync_mode = ClutchMode::kRampPos});
    b.Tell(Control{.sync_cam = false});
    b.Run(1000);
    b.Tell(Control{.sync_cam = true});
    b.Run(20000);
    EXPECT_LE(high, 55);
    EXPECT_GE(low, -5);
    watch.ExpectSmooth();
  }
}

// CAM-37: an opening that finds no curve is reported, and the slave stays on its cam.
TEST(WithoutReversing, AnOpeningThatIsImpossibleSaysSo) {
  Settings s = Absolute(ClutchMode::kRampTime);
  s.sync_in_time_s = 0.1;
  s.position_control = PositionControl::kMasterDirection;
  Bench b(MachineOf({Straight("gear", 1)}, s));
  b.Web(200);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  b.Run(100);
  b.Tell(Configure{.sync_mode = ClutchMode::kRampPos, .slave_sync_out_position = 0.0});
  const Ticket ticket = b.Tell(Control{.sync_cam = false});
  b.Run(2200);  // more than a cycle of the cam
  EXPECT_EQ(b.ErrorOf(ticket), ErrorId::kWouldReverse);
  EXPECT_EQ(b.Module().warning, ErrorId::kWouldReverse);
  EXPECT_TRUE(b.Module().cam_synchronised);
  EXPECT_EQ(b.Module().state, ModuleState::kSync);
}

// CAM-37: a smaller factor waits for the end of a ramp that relies on the larger one.
TEST(WithoutReversing, AFactorWaitsForTheRampOfX) {
  Settings s = Absolute(ClutchMode::kRampTime);
  s.sync_in_time_s = 0.1;
  s.position_control = PositionControl::kMasterDirection;
  s.offset_mode_master = OffsetMode::kRampIn;
  s.scaling_mode_master = ScalingMode::kRelative;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Tell(Control{.scaling_master = 2.0});
  b.Web(200);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  b.Tell(Control{.offset_master = -300.0});
  b.Run(200);
  b.Tell(Control{.scaling_master = 0.5});
  double least = 1e9;
  b.each = [&] { least = std::min(least, b.Module().set_x_velocity); };
  b.Run(20000);
  EXPECT_GE(least, 0);
  EXPECT_EQ(b.Module().set_scaling_master, 0.5);
}

// CAM-39: zero distance for closing and opening: at once, as fast as the slave's limits allow, and without a jump.
TEST(RampPos, WithADistanceOfZero) {
  Settings s = Absolute(ClutchMode::kRampPos);
  s.master_sync_in_distance = 0;
  s.master_sync_out_distance = 0;
  s.slave_sync_out_position = -30;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Web(360);
  b.Run(400);
  Watch watch(b);
  ASSERT_TRUE(b.Sync(200));
  ExpectOnCam(b, 50);
  const Ticket out = b.Tell(Control{.sync_cam = false});
  ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kReady; }, 300));
  EXPECT_EQ(b.Of(out), FeedbackState::kDone);
  EXPECT_NEAR(b.Knife().set_position, -30, 1e-9);
  watch.ExpectSmooth();
}

// CAM-39: new position values of master and slave (set_position) cause no motion, and a master whose encoder is lost
// for a while does not jump either.
TEST(Closed, OtherNumbersMoveNothing) {
  Bench b(MachineOf({UpAndDown("hill", 50)}, Absolute(ClutchMode::kAbsolute)));
  b.Give(Bench::kWeb, axis::MoveVelocity{.velocity = 360});
  b.Run(400);
  ASSERT_TRUE(b.Sync(400));
  double jump = 0;
  double x = b.Module().set_x_position;
  b.each = [&] {
    const double way = b.Module().set_x_position - x;
    jump = std::max(jump, std::abs(way - 360 * std::round(way / 360)));
    x = b.Module().set_x_position;
    ASSERT_TRUE(b.Module().cam_synchronised);
  };
  b.Run(50);
  b.Give(Bench::kWeb, axis::SetPosition{.position = 17});
  b.Run(50);
  b.Give(Bench::kKnife, axis::SetPosition{.position = 1000});
  b.Run(2000);
  EXPECT_NEAR(jump, 0.36, 1e-6);
}

}  // namespace
}  // namespace takt::flexcam
