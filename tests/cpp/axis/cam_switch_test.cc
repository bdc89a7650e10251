#include "takt/axis/cam_switch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "rig.h"

namespace takt::axis {
namespace {

// A way of travelling: position and velocity at a time.
using Way = std::function<KinematicState(double)>;

// The outputs in each cycle of a way, cycle 0 first.
std::vector<std::uint32_t> Outputs(const CamSwitches& list, const Way& way, int cycles, double modulus = 0,
                                   double period_s = 0.001) {
  CamSwitchState state;
  std::vector<std::uint32_t> outputs;
  for (int k = 0; k < cycles; ++k) {
    const KinematicState now = way(k * period_s);
    const KinematicState before = way((k - 1) * period_s);
    outputs.push_back(Step(list,
                           {.position = now.position,
                            .step = now.position - before.position,
                            .velocity = now.velocity,
                            .sense = now.velocity < 0 ? -1 : 1,
                            .modulus = modulus,
                            .cycle = static_cast<std::uint64_t>(k),
                            .period_s = period_s},
                           state));
  }
  return outputs;
}

Way Constant(double start, double velocity) {
  return [=](double t) { return KinematicState{start + velocity * t, velocity, 0}; };
}

bool Bit(std::uint32_t outputs, int track) {
  return (outputs >> (track - 1) & 1) != 0;
}

double Modulo(double x, double modulus) {
  return x - modulus * std::floor(x / modulus);
}

// The example of PLCopen Part 1: tracks 1 and 2, modulo 5000 u.
CamSwitches Example() {
  return {.name = "example",
          .tracks = {},
          .switches = {{1, 2000, 3000, CamDirection::kPositive},
                       {1, 2500, 3000, CamDirection::kNegative},
                       {1, 4000, 1000, CamDirection::kBoth},
                       {2, 3000, {}, CamDirection::kBoth, CamSwitchMode::kTime, 1.35}}};
}

TEST(CamSwitch, ExampleOfTheStandardUpwards) {  // AX-50
  const double speed = 800;
  const auto outputs = Outputs(Example(), Constant(0.3, speed), 20000, 5000);
  for (int k = 0; k < 20000; ++k) {
    const double at = Modulo(0.3 + speed * k * 0.001, 5000);
    const bool first = (at >= 2000 && at <= 3000) || at >= 4000 || at <= 1000;
    ASSERT_EQ(Bit(outputs[k], 1), first) << at;
    // On from the first cycle at or past 3000 on, for 1350 cycles: 1080 u.
    const double past = Modulo(at - 3000, 5000);
    const int since = static_cast<int>(std::floor(past / (speed * 0.001)));
    const bool met = 0.3 + speed * k * 0.001 >= 3000;
    ASSERT_EQ(Bit(outputs[k], 2), met && since < 1350) << at;
  }
}

TEST(CamSwitch, ExampleOfTheStandardDownwards) {  // AX-50
  const double speed = 800;
  const auto outputs = Outputs(Example(), Constant(4999.7, -speed), 20000, 5000);
  for (int k = 0; k < 20000; ++k) {
    const double at = Modulo(4999.7 - speed * k * 0.001, 5000);
    const bool first = (at >= 2500 && at <= 3000) || at >= 4000 || at <= 1000;
    ASSERT_EQ(Bit(outputs[k], 1), first) << at;
    const int since = static_cast<int>(std::floor(Modulo(3000 - at, 5000) / (speed * 0.001)));
    ASSERT_EQ(Bit(outputs[k], 2), 4999.7 - speed * k * 0.001 <= 3000 && since < 1350) << at;
  }
}

TEST(CamSwitch, LeadTimesCompareWithWhereTheAxisWillBe) {  // AX-50
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int run = 0; run < 300; ++run) {
    const double velocity = between(20, 500) * (run % 2 == 0 ? 1 : -1);
    const double first = between(100, 200);
    const double last = first + between(30, 100);
    const double on_lead = between(-0.02, 0.05);
    const double off_lead = between(-0.02, 0.05);
    const bool rotary = run % 3 == 0;
    const double start = velocity > 0 ? 0 : 359.9;
    const CamSwitches list{.name = "l", .tracks = {{3, on_lead, off_lead, 0}}, .switches = {{3, first, last}}};
    const int cycles = static_cast<int>(340 / std::abs(velocity) / 0.001);
    const auto outputs = Outputs(list, Constant(start, velocity), cycles, rotary ? 360 : 0);
    // Where the range begins and ends, as times.
    const double enter = ((velocity > 0 ? first : last) - start) / velocity - on_lead;
    const double leave = ((velocity > 0 ? last : first) - start) / velocity - off_lead;
    for (int k = 0; k < cycles; ++k) {
      const double t = k * 0.001;
      const bool on = t >= enter && t <= leave;
      const bool jumped_over = leave >= enter && t >= enter && t < enter + 0.001;
      ASSERT_EQ(Bit(outputs[k], 3), on || jumped_over) << run << " at " << start + velocity * t << " of " << first;
    }
  }
}

TEST(CamSwitch, RangeAcrossZeroIsOneRange) {  // AX-50
  const CamSwitches list{.name = "l", .tracks = {{1, 0.01, 0.01, 0}}, .switches = {{1, 350, 10}}};
  for (const double velocity : {300.0, -300.0}) {
    const auto outputs = Outputs(list, Constant(180, velocity), 5000, 360);
    for (int k = 0; k < 5000; ++k) {
      const double seen = Modulo(180 + velocity * (k * 0.001 + 0.01), 360);
      if (std::min(std::abs(seen - 350), std::abs(seen - 10)) < 1e-6) continue;
      ASSERT_EQ(Bit(outputs[k], 1), seen > 350 || seen < 10) << seen;
    }
  }
}

TEST(CamSwitch, RangeJumpedOverIsOnForOneCycle) {  // AX-50
  const CamSwitches list{.name = "l", .tracks = {}, .switches = {{1, 100.2, 100.3}}};
  for (const double velocity : {500.0, -500.0}) {
    const auto outputs = Outputs(list, Constant(velocity > 0 ? 90 : 110, velocity), 60);
    EXPECT_EQ(std::count(outputs.begin(), outputs.end(), 1U), 1);
  }
}

TEST(CamSwitch, TimeIsCountedFromEachEntryWhateverTheSpeed) {  // AX-50
  // Lead time under acceleration: x + v * lead moves on in each cycle, and meets the edge in one of them only.
  const Way way = [](double t) { return KinematicState{500 * t * t, 1000 * t, 1000}; };
  for (double edge = 31; edge < 100; edge += 0.37) {
    const CamSwitches list{.name = "l",
                           .tracks = {{1, 0.03, 0, 0}},
                           .switches = {{1, edge, {}, CamDirection::kBoth, CamSwitchMode::kTime, 0.02}}};
    const auto outputs = Outputs(list, way, 500);
    // 500 t² + 1000 t lead = edge
    const double met = -0.03 + std::sqrt(0.03 * 0.03 + edge / 500);
    const auto first = static_cast<std::size_t>(std::ceil(met / 0.001));
    EXPECT_EQ(std::count(outputs.begin(), outputs.end(), 1U), 20) << edge;
    EXPECT_EQ(outputs[first - 1], 0U) << edge;
    EXPECT_EQ(outputs[first], 1U) << edge;
    EXPECT_EQ(outputs[first + 19], 1U) << edge;
  }
}

TEST(CamSwitch, HysteresisKeepsATremblingAxisFromSwitching) {  // AX-50
  const auto changes = [](double hysteresis) {
    const CamSwitches list{.name = "l", .tracks = {{1, 0, 0, hysteresis}}, .switches = {{1, 10, 20}}};
    const Way way = [](double t) {
      return KinematicState{10 * t + 5 + 0.05 * std::sin(700 * t), 10 + 35 * std::cos(700 * t), 0};
    };
    const auto outputs = Outputs(list, way, 2000);
    int count = 0;
    for (std::size_t k = 1; k < outputs.size(); ++k) count += outputs[k] != outputs[k - 1];
    return count;
  };
  EXPECT_GT(changes(0), 2);
  EXPECT_EQ(changes(0.2), 2);
}

std::vector<CamSwitches> Lists() {
  return {{.name = "a", .tracks = {}, .switches = {{1, 10, 20}, {32, 15, 40}}}};
}

TEST(CamSwitch, AxisSwitchesBySetPointOrByWhatIsMeasured) {  // AX-50
  for (const MasterSource source : {MasterSource::kSetValue, MasterSource::kActualValue}) {
    Rig rig(LinearParams());
    rig.cam_switches = Lists();
    ASSERT_TRUE(rig.PowerOn());
    const Ticket cams = rig.Give(DigitalCamSwitch{.switches = Name::Of("a"), .source = source});
    const Ticket move = rig.Give(MoveAbsolute{.position = 50, .velocity = 100});
    while (!rig.Ended(move)) {
      rig.Step();
      const double x = source == MasterSource::kSetValue ? rig.out.set_position : rig.out.actual_position;
      const std::uint32_t expected = (x >= 10 && x <= 20 ? 1U : 0U) | (x >= 15 && x <= 40 ? 1U << 31 : 0U);
      ASSERT_EQ(rig.out.cam_outputs, expected) << x;
    }
    EXPECT_FALSE(rig.Ended(cams));
    EXPECT_TRUE(rig.lives[cams].active);
  }
}

TEST(CamSwitch, MaskAndEnableAndUnknownLists) {  // AX-50
  Rig rig(LinearParams());
  rig.cam_switches = Lists();
  ASSERT_TRUE(rig.PowerOn());
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 17}));
  const Ticket all = rig.Give(DigitalCamSwitch{.switches = Name::Of("a")});
  rig.Step();
  EXPECT_EQ(rig.out.cam_outputs, 0x80000001U);
  const Ticket masked = rig.Give(DigitalCamSwitch{.switches = Name::Of("a"), .enable_mask = 2});
  rig.Step();
  EXPECT_EQ(rig.out.cam_outputs, 0U);
  EXPECT_TRUE(rig.lives[all].aborted);
  const Ticket unknown = rig.Give(DigitalCamSwitch{.switches = Name::Of("b")});
  rig.Step();
  EXPECT_EQ(rig.lives[unknown].error_id, ErrorId::kUnknownTarget);
  EXPECT_FALSE(rig.Ended(masked));
  const Ticket off = rig.Give(DigitalCamSwitch{.switches = Name::Of("a"), .enable = false});
  rig.Step();
  EXPECT_TRUE(rig.lives[off].done);
  EXPECT_TRUE(rig.lives[masked].aborted);
  EXPECT_EQ(rig.out.cam_outputs, 0U);
}

}  // namespace
}  // namespace takt::axis
