// The masters of a module (CAM-50, CAM-51).
#include <gtest/gtest.h>

#include "bench.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

// CAM-50: a virtual master, which has no axis.
TEST(Masters, Virtual) {
  Machine m = OneHill();
  m.flex_cams[0].master.reset();
  Bench b(m);
  b.Tell(Control{.virtual_velocity = 360.0});
  b.Run(600);
  ASSERT_TRUE(b.Sync());
  double before = b.Module().set_x_position;
  for (int i = 0; i < 2000; ++i) {
    b.Step();
    const double way = b.Module().set_x_position - before;
    ASSERT_NEAR(way - 360 * std::round(way / 360), 0.36, 1e-9);
    ASSERT_TRUE(b.Module().cam_synchronised);
    before = b.Module().set_x_position;
  }
}

// CAM-50: the measured position of the master, with filter and dead time: without lag at constant speed.
TEST(Masters, MeasuredWithAFilterAndDeadTime) {
  Settings s = QuickBothWays();
  s.master_filter_s = 0.05;
  s.master_dead_time_s = 0.005;
  Machine m = OneHill(s);
  m.flex_cams[0].source = axis::MasterSource::kActualValue;
  m.axes[Bench::kWeb].encoder.increments_per_unit = 20;  // a coarse encoder
  Bench b(m);
  b.Web(360);
  b.Run(1000);  // the filter settles within about 15 time constants
  ASSERT_TRUE(b.Sync());
  Watch watch(b);
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    b.Step();
    const double measured = b.TheWeb().actual_position + 360 * 0.005;
    const double away = b.Module().mp01_set_master_position - measured;
    worst = std::max(worst, std::abs(away - 360 * std::round(away / 360)));
  }
  EXPECT_LE(worst, 3 * 1.0 / 20);  // no lag, and no more than a few increments of noise
  watch.ExpectSmooth();
  EXPECT_LE(watch.acceleration, 3000);  // of the cam alone: 1155; unfiltered it would be that of the increments
}

// CAM-50: an encoder without a drive is a master, too.
TEST(Masters, AnEncoderAlone) {
  Machine m = OneHill();
  m.flex_cams[0].source = axis::MasterSource::kActualValue;
  Bench b(m);
  b.Give(Bench::kWeb, axis::Power{.enable = false});
  b.Run(100);
  EXPECT_TRUE(b.Sync());
}

// CAM-51
TEST(Masters, AFaultStopsTheSlave) {
  Bench b(OneHill());
  b.Web(360);
  b.Run(200);
  ASSERT_TRUE(b.Sync());
  Watch watch(b);
  b.engine.faults(Bench::kWeb).drive_fault = true;
  b.Run(300);
  EXPECT_EQ(b.Module().state, ModuleState::kError);
  EXPECT_EQ(b.Module().error, ErrorId::kMasterOff);
  EXPECT_EQ(b.Knife().set_velocity, 0);
  watch.ExpectSmooth();
}

// CAM-51
TEST(Masters, OrTheSlaveGoesOn) {
  Settings s = QuickBothWays();
  s.on_master_fault = MasterFault::kCoast;
  Bench b(OneHill(s));
  b.Web(360);
  b.Run(400);
  ASSERT_TRUE(b.Sync());
  Watch watch(b);
  b.engine.faults(Bench::kWeb).drive_fault = true;
  b.Run(10);
  const double x = b.Module().set_x_position;
  b.Run(1000);
  EXPECT_EQ(b.Module().state, ModuleState::kSync);
  EXPECT_TRUE(b.Module().cam_synchronised);
  EXPECT_NEAR(b.Module().set_x_velocity, 360, 1e-9);
  EXPECT_NEAR(b.Module().set_x_position, x, 1e-6);  // a turn later
  b.Tell(Control{.sync_cam = false});
  ASSERT_TRUE(b.Until([&] { return b.Module().state == ModuleState::kReady; }, 3000));
  watch.ExpectSmooth();
}

TEST(Masters, OneThatIsOffIsNotFollowed) {
  Bench b(OneHill());
  b.Give(Bench::kWeb, axis::Power{.enable = false});
  b.Run(50);
  const Ticket sync = b.Tell(Control{.sync_cam = true});
  b.Run(2);
  EXPECT_EQ(b.ErrorOf(sync), ErrorId::kMasterOff);
  EXPECT_EQ(b.Module().state, ModuleState::kReady);
}

}  // namespace
}  // namespace takt::flexcam
