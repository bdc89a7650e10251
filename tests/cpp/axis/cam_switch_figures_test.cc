// The example of PLCopen Part 1, MC_DigitalCamSwitch: its table of four switches on an axis of 5000 u a turn, and what
// its figures show of both tracks upwards, with compensation, and downwards.
#include <gtest/gtest.h>

#include <utility>

#include "cam_switch_ways.h"
#include "rig.h"

namespace takt::axis {
namespace {

constexpr double kTurn = 5000;  // u
constexpr double kSpeed = 800;  // u/s; the figures do not say
constexpr int kDuration = 1350;

//                  Switch01  Switch02  Switch03  Switch04
// TrackNumber      1         1         1         2
// FirstOnPosition  2000      2500      4000      3000
// LastOnPosition   3000      3000      1000      -
// AxisDirection    positive  negative  both      both
// CamSwitchMode    position  position  position  time
// Duration         -         -         -         1350 ms
CamSwitches Table() {
  CamSwitches list;
  list.name = "table";
  list.switches = {{1, 2000, 3000, CamDirection::kPositive},
                   {1, 2500, 3000, CamDirection::kNegative},
                   {1, 4000, 1000, CamDirection::kBoth},
                   {2, 3000, {}, CamDirection::kBoth, CamSwitchMode::kTime, 1.35}};
  return list;
}

// An axis that has come to its speed and seen the time switch once.
Rig Travelling(const CamSwitches& list, double velocity) {
  AxisParams params = RotaryParams();
  params.modulus = kTurn;
  params.limits.velocity = 1000;
  Rig rig(params);
  rig.cam_switches = {list};
  EXPECT_TRUE(rig.PowerOn());
  rig.Give(DigitalCamSwitch{.switches = Name::Of("table")});
  const Direction direction = velocity > 0 ? Direction::kPositive : Direction::kNegative;
  rig.Give(MoveVelocity{.velocity = std::abs(velocity), .direction = direction});
  rig.Run(8);
  EXPECT_EQ(rig.out.set_velocity, velocity);
  return rig;
}

// `from` and `to` in the sense of travel, as positions of a turn; on at both ends.
bool Between(double x, double from, double to, double sense) {
  return Modulo(sense * (x - from), kTurn) <= Modulo(sense * (to - from), kTurn);
}

// Whether the moment that switches lies within rounding of a cycle.
bool AtAnEdge(double x, std::initializer_list<double> edges) {
  return std::ranges::any_of(edges, [&](double edge) { return std::abs(std::remainder(x - edge, kTurn)) < 1e-6; });
}

// Cycles since the axis was last at `edge` or just past it.
int CyclesSince(double edge, double x, double sense) {
  return static_cast<int>(std::floor(Modulo(sense * (x - edge), kTurn) / (kSpeed * 0.001)));
}

TEST(CamSwitchFigures, Upwards) {  // AX-50, CAM-72
  Rig rig = Travelling(Table(), kSpeed);
  for (int k = 0; k < 20000; ++k) {
    rig.Step();
    const double x = rig.out.set_position;
    if (AtAnEdge(x, {2000, 3000, 4000, 1000, 3000 + kSpeed * 1.35})) continue;
    ASSERT_EQ(Bit(rig.out.cam_outputs, 1), Between(x, 2000, 3000, 1) || Between(x, 4000, 1000, 1)) << x;
    ASSERT_EQ(Bit(rig.out.cam_outputs, 2), CyclesSince(3000, x, 1) < kDuration) << x;
  }
}

TEST(CamSwitchFigures, Downwards) {  // AX-50, CAM-72
  Rig rig = Travelling(Table(), -kSpeed);
  for (int k = 0; k < 20000; ++k) {
    rig.Step();
    const double x = rig.out.set_position;
    if (AtAnEdge(x, {2500, 3000, 4000, 1000, 3000 - kSpeed * 1.35})) continue;
    ASSERT_EQ(Bit(rig.out.cam_outputs, 1), Between(x, 3000, 2500, -1) || Between(x, 1000, 4000, -1)) << x;
    ASSERT_EQ(Bit(rig.out.cam_outputs, 2), CyclesSince(3000, x, -1) < kDuration) << x;
  }
}

// OnCompensation -125 ms, OffCompensation +250 ms: on that much earlier, off that much later, in either sense of
// travel.
TEST(CamSwitchFigures, Compensated) {  // AX-50, CAM-72
  CamSwitches list = Table();
  list.tracks = {{1, 0.125, -0.25, 0}};
  for (const double sense : {1.0, -1.0}) {
    const double early = sense * 0.125 * kSpeed;
    const double late = sense * 0.25 * kSpeed;
    const auto [first, last] = sense > 0 ? std::pair(2000, 3000) : std::pair(3000, 2500);  // Switch01, Switch02
    const auto [from, to] = sense > 0 ? std::pair(4000, 1000) : std::pair(1000, 4000);     // Switch03
    Rig rig = Travelling(list, sense * kSpeed);
    for (int k = 0; k < 20000; ++k) {
      rig.Step();
      const double x = rig.out.set_position;
      if (AtAnEdge(x, {first - early, last + late, from - early, to + late})) continue;
      const bool on = Between(x, first - early, last + late, sense) || Between(x, from - early, to + late, sense);
      ASSERT_EQ(Bit(rig.out.cam_outputs, 1), on) << x;
    }
  }
}

}  // namespace
}  // namespace takt::axis
