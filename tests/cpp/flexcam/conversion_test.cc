#include "takt/flexcam/conversion.h"

#include <gtest/gtest.h>

#include "bench.h"

namespace takt::flexcam {
namespace {

// One of the manual's arithmetic tables (3.17.1, 3.17.2): factor 1, 2, 1 in three cycles, the input at 100, 101, 102
// with a velocity of 1000.
struct Row {
  ScalingMode mode;
  double out_at_start;
  double absolute_zero;
  double second, third;
};

class Tables : public testing::TestWithParam<Row> {};

// CAM-40: value by value.
TEST_P(Tables, AreThoseOfTheManual) {
  const Row& row = GetParam();
  trajectory::Planner planner;
  Conversion c;
  c.in_zero = 100;
  c.out_zero = row.out_at_start;
  EXPECT_EQ(Convert(c, {}, {100, 1000, 0}), (KinematicState{row.out_at_start, 1000, 0}));
  ConversionTarget target;
  target.scaling_mode = row.mode;
  target.absolute_zero = row.absolute_zero;
  target.factor = 2;
  Approach(target, {1, 0.001}, {{100, 1000, 0}, {100, 1000, 0}}, planner, c);
  EXPECT_EQ(Convert(c, {}, {101, 1000, 0}), (KinematicState{row.second, 2000, 0}));
  target.factor = 1;
  Approach(target, {2, 0.001}, {{101, 1000, 0}, {101, 1000, 0}}, planner, c);
  EXPECT_EQ(Convert(c, {}, {102, 1000, 0}), (KinematicState{row.third, 1000, 0}));
}

INSTANTIATE_TEST_SUITE_P(Master, Tables,
                         testing::Values(Row{ScalingMode::kAbsolute, 100, 0, 202, 102},
                                         Row{ScalingMode::kRelative, 100, 0, 102, 103},
                                         // X is 0 where the master is at 47.
                                         Row{ScalingMode::kAbsolute, 53, 47, 108, 55},
                                         Row{ScalingMode::kRelative, 53, 47, 55, 56}));
INSTANTIATE_TEST_SUITE_P(Slave, Tables,
                         testing::Values(Row{ScalingMode::kAbsolute, 100, 0, 202, 102},
                                         Row{ScalingMode::kRelative, 100, 0, 102, 103},
                                         // Y's zero counts, wherever that puts the slave.
                                         Row{ScalingMode::kAbsolute, 50, 0, 152, 52},
                                         Row{ScalingMode::kRelative, 50, 0, 52, 53}));

// The same values on a whole module: a straight cam, so that Y is X.
struct Placed {
  double master, x, slave;
};

std::vector<Placed> ThreeCycles(const Settings& settings, double offset, bool master) {
  cam::CamParams straight = Straight("straight", 1, 2000);
  Bench b(MachineOf({straight}, settings, axis::AxisKind::kLinear, axis::AxisKind::kLinear));
  b.Give(Bench::kWeb, axis::MoveAbsolute{.position = offset});
  b.Until([&] { return b.TheWeb().set_position == offset; });
  b.Give(Bench::kKnife, axis::MoveAbsolute{.position = 0});
  b.Run(20);
  EXPECT_TRUE(b.Sync());
  b.Web(1000);
  b.Run(400);
  std::vector<Placed> rows;
  for (const double factor : {1.0, 2.0, 1.0}) {
    b.Tell(master ? Control{.scaling_master = factor} : Control{.scaling_slave = factor});
    b.Step();
    rows.push_back(
        {b.TheWeb().set_position, b.Module().mp03_master_to_x_position, b.Module().mp06_y_to_slave_position});
  }
  return rows;
}

// CAM-40, CAM-42
TEST(Scaling, OfTheMasterOnAModule) {
  Settings s;
  s.scaling_mode_master = ScalingMode::kAbsolute;
  std::vector<Placed> rows = ThreeCycles(s, 0, true);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rows[i].x, (i == 1 ? 2 : 1) * rows[i].master, 1e-9) << i;
  s.scaling_mode_master = ScalingMode::kRelative;
  rows = ThreeCycles(s, 0, true);
  EXPECT_NEAR(rows[1].x - rows[0].x, 2 * (rows[1].master - rows[0].master), 1e-9);
  EXPECT_NEAR(rows[2].x - rows[1].x, rows[2].master - rows[1].master, 1e-9);
  s.master_absolute = false;
  s.scaling_mode_master = ScalingMode::kAbsolute;
  rows = ThreeCycles(s, 47, true);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rows[i].x, (i == 1 ? 2 : 1) * (rows[i].master - 47), 1e-9) << i;
}

// CAM-40
TEST(Scaling, OfTheSlaveOnAModule) {
  Settings s;
  s.scaling_mode_slave = ScalingMode::kAbsolute;
  s.slave_absolute = true;
  std::vector<Placed> rows = ThreeCycles(s, 0, false);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rows[i].slave, (i == 1 ? 2 : 1) * rows[i].x, 1e-9) << i;
  // The slave was at 0 when Y was 50: it stays 50 behind.
  s.slave_absolute = false;
  rows = ThreeCycles(s, 50, false);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rows[i].slave, (i == 1 ? 2 : 1) * rows[i].x - 50, 1e-9) << i;
}

}  // namespace
}  // namespace takt::flexcam
