// Invariants for any cam, any master and any clutch (CAM-37, CAM-39).
#include <gtest/gtest.h>

#include "random.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

Settings RandomSettings(Dice& dice) {
  Settings s;
  s.sync_mode = static_cast<ClutchMode>(dice.Upto(4));
  s.slave_absolute = dice.Coin();
  s.master_absolute = dice.Coin();
  s.sync_direction = static_cast<ClutchDirection>(dice.Upto(2));
  s.master_sync_in_distance = dice.Between(5, 500);
  s.master_sync_in_position = dice.Between(0, 359);
  s.master_sync_out_distance = dice.Between(5, 500);
  s.slave_sync_out_position = dice.Between(-30, 30);
  s.sync_in_time_s = dice.Between(0.05, 1);
  s.sync_out_time_s = dice.Between(0.05, 1);
  s.offset_mode_master = static_cast<OffsetMode>(dice.Upto(2));
  s.offset_mode_slave = static_cast<OffsetMode>(dice.Upto(2));
  s.scaling_mode_master = static_cast<ScalingMode>(dice.Upto(4));
  s.scaling_mode_slave = static_cast<ScalingMode>(dice.Upto(4));
  s.position_control = static_cast<PositionControl>(dice.Upto(1));
  return s;
}

Configure AsCommand(const Settings& s) {
  Configure c;
  c.sync_mode = s.sync_mode;
  c.slave_absolute = s.slave_absolute;
  c.master_absolute = s.master_absolute;
  c.sync_direction = s.sync_direction;
  c.master_sync_in_distance = s.master_sync_in_distance;
  c.master_sync_in_position = s.master_sync_in_position;
  c.master_sync_out_distance = s.master_sync_out_distance;
  c.slave_sync_out_position = s.slave_sync_out_position;
  c.sync_in_time_s = s.sync_in_time_s;
  c.sync_out_time_s = s.sync_out_time_s;
  c.offset_mode_master = s.offset_mode_master;
  c.offset_mode_slave = s.offset_mode_slave;
  c.scaling_mode_master = s.scaling_mode_master;
  c.scaling_mode_slave = s.scaling_mode_slave;
  c.position_control = s.position_control;
  return c;
}

// Any request at any time: the slave's limits hold, and it never jumps (CAM-39).
TEST(Property, TheSlaveNeverJumpsAndKeepsItsLimits) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Dice dice(seed);
    Machine m = MachineOf({RandomCam(dice, "a", false), RandomCam(dice, "b", false), RandomCam(dice, "c", true)},
                          RandomSettings(dice), axis::AxisKind::kRotary,
                          dice.Coin() ? axis::AxisKind::kLinear : axis::AxisKind::kRotary);
    m.axes[Bench::kKnife].limits.velocity = dice.Between(100, 3000);
    m.axes[Bench::kKnife].limits.acceleration = dice.Between(2000, 60000);
    m.axes[Bench::kKnife].limits.jerk = dice.Between(1e5, 5e6);
    Bench b(m);
    Watch watch(b);
    for (int i = 0; i < 40; ++i) {
      if (dice.Upto(2) == 0) Drive(dice, b);
      switch (dice.Upto(11)) {
        case 0:
        case 1:
        case 2:
          b.Tell(Control{.sync_cam = true});
          break;
        case 3:
          b.Tell(Control{.sync_cam = false});
          break;
        case 4:
          b.Tell(Control{.offset_master = dice.Between(-100, 100)});
          break;
        case 5:
          b.Tell(Control{.scaling_master = dice.Between(0.2, 3)});
          break;
        case 6:
          b.Tell(Control{.offset_slave = dice.Between(-20, 20)});
          break;
        case 7:
          b.Tell(Control{.scaling_slave = dice.Between(0, 2)});
          break;
        case 8:
          b.Tell(Control{.cam_table = static_cast<std::uint32_t>(1 + dice.Upto(2))});
          break;
        case 9:
          b.Tell(ChangeCam{static_cast<std::uint32_t>(1 + dice.Upto(2)), static_cast<ChangeWhen>(dice.Upto(4)),
                           dice.Between(0, 359), static_cast<ChangeAlign>(dice.Upto(2))});
          break;
        case 10:
          b.Tell(AsCommand(RandomSettings(dice)));
          break;
        default:
          b.Tell(Control{.sync_out_instant = dice.Coin()});
          break;
      }
      b.Run(dice.Upto(400));
      ASSERT_EQ(b.Module().error, ErrorId::kNone) << "seed " << seed;
    }
    watch.ExpectSmooth();
    ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
  }
}

// Within wide limits, the demands of the clutch have no step: the slave's set points are those of the clutch, bit for
// bit, from the begin of its closing to the end of its opening (CAM-39, modes 2 to 4).
TEST(Property, TheClutchAsksForNoStep) {
  for (unsigned seed = 100; seed < 160; ++seed) {
    Dice dice(seed);
    Settings s = RandomSettings(dice);
    s.sync_mode = static_cast<ClutchMode>(2 + dice.Upto(2));
    s.sync_direction = ClutchDirection::kCurrent;
    s.position_control = PositionControl::kBoth;
    s.master_sync_in_distance = dice.Between(100, 600);
    s.master_sync_out_distance = dice.Between(100, 600);
    s.sync_in_time_s = dice.Between(0.3, 1);
    s.sync_out_time_s = dice.Between(0.3, 1);
    Machine m = MachineOf({RandomCam(dice, "a", dice.Coin())}, s, axis::AxisKind::kRotary,
                          dice.Coin() ? axis::AxisKind::kLinear : axis::AxisKind::kRotary);
    m.axes[Bench::kKnife].limits = {
        .velocity = 1e5, .acceleration = 1e6, .deceleration = {}, .jerk = 2e7, .lower = {}, .upper = {}};
    Bench b(m);
    Drive(dice, b);
    b.Run(dice.Upto(600));
    b.Tell(Control{.sync_cam = true});
    b.Step();
    int stepped = 0;
    b.each = [&] { stepped += b.Module().state == ModuleState::kSync && !b.Knife().in_step ? 1 : 0; };
    for (int i = 0; i < 8; ++i) {
      if (dice.Coin()) Drive(dice, b);
      b.Run(300);
    }
    b.Tell(Control{.sync_cam = false});
    for (int i = 0; i < 8; ++i) {
      if (dice.Coin()) Drive(dice, b);
      b.Run(300);
    }
    EXPECT_EQ(stepped, 0) << "seed " << seed << " mode " << int(s.sync_mode);
  }
}

// CAM-37: on a cam that never falls, nothing moves the slave against its master.
TEST(Property, NothingReversesTheSlave) {
  for (unsigned seed = 200; seed < 280; ++seed) {
    Dice dice(seed);
    Settings s = RandomSettings(dice);
    s.sync_mode = ClutchMode::kRampPos;
    s.slave_absolute = true;
    s.position_control = PositionControl::kMasterDirection;
    s.scaling_mode_master = dice.Coin() ? ScalingMode::kRampAbsolute : ScalingMode::kRampRelative;
    s.offset_mode_master = OffsetMode::kRampIn;
    Machine m = MachineOf({RandomCam(dice, "a", true)}, s, axis::AxisKind::kRotary, axis::AxisKind::kRotary);
    m.axes[Bench::kKnife].limits = {
        .velocity = 1e5, .acceleration = 1e8, .deceleration = {}, .jerk = 1e10, .lower = {}, .upper = {}};
    Bench b(m);
    axis::Outputs web = b.TheWeb(), knife = b.Knife();
    double x = b.Module().mp03_master_to_x_position;
    bool synced = false;
    double worst = 0, worst_x = 0;
    b.each = [&] {
      const auto way = [](double now, double before) { return now - before - 360 * std::round((now - before) / 360); };
      const double master = way(b.TheWeb().set_position, web.set_position);
      const double slave = way(b.Knife().set_position, knife.set_position);
      const double shift = b.Module().mp03_master_to_x_position - x;
      const bool sync = b.Module().state == ModuleState::kSync;
      const double sense = master > 0 ? 1 : master < 0 ? -1 : 0;
      if (sync && synced) {
        worst = std::min(worst, sense == 0 ? -std::abs(slave) : sense * slave);
        worst_x = std::min(worst_x, sense == 0 ? -std::abs(shift) : sense * shift);
      }
      synced = sync;
      web = b.TheWeb();
      knife = b.Knife();
      x = b.Module().mp03_master_to_x_position;
    };
    for (int i = 0; i < 30; ++i) {
      if (dice.Upto(2) != 0) Drive(dice, b);
      if (dice.Upto(3) == 0) b.Tell(Control{.sync_cam = true});
      if (dice.Upto(9) == 0) b.Tell(Control{.sync_cam = false});
      if (dice.Upto(3) == 0) b.Tell(Control{.offset_master = dice.Between(-200, 200)});
      if (dice.Upto(3) == 0) b.Tell(Control{.scaling_master = dice.Between(0.2, 3)});
      b.Run(dice.Upto(500));
    }
    EXPECT_GE(worst_x, -1e-6) << "seed " << seed;
    EXPECT_GE(worst, -1e-6) << "seed " << seed;
  }
}

}  // namespace
}  // namespace takt::flexcam
