#include "takt/axis/cam_switch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cam_switch_ways.h"
#include "rig.h"

namespace takt::axis {
namespace {

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
    const CamSwitches list = ListOf({{3, first, last}}, {3, on_lead, off_lead, 0});
    const int cycles = static_cast<int>(340 / std::abs(velocity) / 0.001);
    const auto outputs = OutputsOn(list, Constant(start, velocity), cycles, rotary ? 360 : 0);
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
  const CamSwitches list = ListOf({{1, 350, 10}}, {1, 0.01, 0.01, 0});
  for (const double velocity : {300.0, -300.0}) {
    const auto outputs = OutputsOn(list, Constant(180, velocity), 5000, 360);
    for (int k = 0; k < 5000; ++k) {
      const double seen = Modulo(180 + velocity * (k * 0.001 + 0.01), 360);
      if (std::min(std::abs(seen - 350), std::abs(seen - 10)) < 1e-6) continue;
      ASSERT_EQ(Bit(outputs[k], 1), seen > 350 || seen < 10) << seen;
    }
  }
}

TEST(CamSwitch, RangeJumpedOverIsOnForOneCycle) {  // AX-50
  const CamSwitches list = ListOf({{1, 100.2, 100.3}});
  for (const double velocity : {500.0, -500.0}) {
    const auto outputs = OutputsOn(list, Constant(velocity > 0 ? 90 : 110, velocity), 60);
    EXPECT_EQ(std::count(outputs.begin(), outputs.end(), 1U), 1);
  }
}

TEST(CamSwitch, TimeIsCountedFromEachEntryWhateverTheSpeed) {  // AX-50
  // Lead time under acceleration: x + v * lead moves on in each cycle, and meets the edge in one of them only.
  const Way way = [](double t) { return KinematicState{500 * t * t, 1000 * t, 1000}; };
  for (double edge = 31; edge < 100; edge += 0.37) {
    const CamSwitches list = ListOf({{1, edge, {}, CamDirection::kBoth, CamSwitchMode::kTime, 0.02}}, {1, 0.03, 0, 0});
    const auto outputs = OutputsOn(list, way, 500);
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
    const CamSwitches list = ListOf({{1, 10, 20}}, {1, 0, 0, hysteresis});
    const Way way = [](double t) {
      return KinematicState{10 * t + 5 + 0.05 * std::sin(700 * t), 10 + 35 * std::cos(700 * t), 0};
    };
    const auto outputs = OutputsOn(list, way, 2000);
    int count = 0;
    for (std::size_t k = 1; k < outputs.size(); ++k) count += outputs[k] != outputs[k - 1];
    return count;
  };
  EXPECT_GT(changes(0), 2);
  EXPECT_EQ(changes(0.2), 2);
}

// The outputs on the way over these places, in steps of 0.25.
std::vector<std::uint32_t> OutputsOver(const CamSwitches& list, const std::vector<double>& places, double modulus = 0) {
  CamSwitchState state;
  std::vector<std::uint32_t> outputs;
  int k = 0;
  double x = places.front();
  for (const double to : places) {
    for (; x != to; x += to > x ? 0.25 : -0.25) outputs.push_back(Step(list, At({x, 0, 0}, modulus, k++), state));
  }
  outputs.push_back(Step(list, At({x, 0, 0}, modulus, k), state));
  return outputs;
}
int Changes(const std::vector<std::uint32_t>& outputs) {
  int count = 0;
  for (std::size_t k = 1; k < outputs.size(); ++k) count += outputs[k] != outputs[k - 1];
  return count;
}

// The area round a switching point in which nothing switches again (PLCopen Part 1, MC_TRACK_REF's hysteresis).
TEST(CamSwitch, HysteresisEndsWhereTheAxisHasLeftTheAreaRoundTheSwitchingPoint) {  // CAM-72
  const CamSwitches list = ListOf({{1, 20, 200}}, {1, 0, 0, 10});
  EXPECT_EQ(OutputsOver(list, {0, 25, 15, 25, 12}).back(), 1U);  // within 10 of 20
  EXPECT_EQ(OutputsOver(list, {0, 25, 10}).back(), 0U);          // left
  EXPECT_EQ(Changes(OutputsOver(list, {0, 25, 15, 25, 15, 50})), 1);
  const auto there_and_back = OutputsOver(list, {0, 40, 0});  // left upwards: off at 20 as without hysteresis
  EXPECT_EQ(there_and_back[(40 + 20) * 4], 1U);
  EXPECT_EQ(there_and_back[(40 + 20) * 4 + 1], 0U);
}

TEST(CamSwitch, HysteresisDoesNotWidenWhatTheAxisPassesStraight) {  // CAM-72
  const CamSwitches list = ListOf({{1, 10, 12}, {1, 14, 15}}, {1, 0, 0, 30});
  EXPECT_EQ(OutputsOver(list, {0, 40}), OutputsOver(ListOf({{1, 10, 12}, {1, 14, 15}}), {0, 40}));
  // On a turn shorter than the hysteresis, too.
  const std::vector<double> turns = {0, 100};
  EXPECT_EQ(OutputsOver(ListOf({{1, 10, 12}}, {1, 0, 0, 30}), turns, 20),
            OutputsOver(ListOf({{1, 10, 12}}), turns, 20));
}

TEST(CamSwitch, HysteresisKeepsATimeFromBeginningAgain) {  // CAM-72
  const CamSwitch timed{1, 10, {}, CamDirection::kBoth, CamSwitchMode::kTime, 0.004};
  const std::vector<double> trembling = {0, 11, 9.5, 10.5, 9.75, 13};
  EXPECT_GT(Changes(OutputsOver(ListOf({timed}), trembling)), 2);
  EXPECT_EQ(Changes(OutputsOver(ListOf({timed}, {1, 0, 0, 2}), trembling)), 2);
  EXPECT_EQ(Changes(OutputsOver(ListOf({timed}, {1, 0, 0, 2}), {0, 13, 7, 13})), 6);
}

TEST(CamSwitch, DirectionOfATremblingAxisTurnsOnceWithHysteresis) {  // CAM-72
  const CamSwitch upwards{1, 10, 100, CamDirection::kPositive};
  const std::vector<double> trembling = {0, 50, 49.5, 50, 49.5, 50, 49.5};
  EXPECT_EQ(Changes(OutputsOver(ListOf({upwards}), trembling)), 6);
  EXPECT_EQ(Changes(OutputsOver(ListOf({upwards}, {1, 0, 0, 1}), trembling)), 2);
}

TEST(CamSwitch, ModulusOfTheListRepeatsOnALinearAxis) {  // CAM-72
  Rig rig(LinearParams());
  CamSwitches list = ListOf({{1, 80, 20}, {2, 50, {}, CamDirection::kBoth, CamSwitchMode::kTime, 0.001}});
  list.modulus = 100;
  rig.cam_switches = {list};
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(DigitalCamSwitch{.switches = Name::Of("list")});
  const Ticket move = rig.Give(MoveAbsolute{.position = -1030, .velocity = 333});
  int ticks = 0;
  while (!rig.Ended(move)) {
    rig.Step();
    const double x = Modulo(rig.out.set_position, 100);
    if (std::min(std::abs(x - 80), std::abs(x - 20)) < 1e-6) continue;
    ASSERT_EQ(Bit(rig.out.cam_outputs, 1), x > 80 || x < 20) << x;
    ticks += Bit(rig.out.cam_outputs, 2);
  }
  EXPECT_EQ(ticks, 10);
}

TEST(CamSwitch, ListsThatAnAxisCannotHaveAreRefused) {  // CAM-72
  AxisParams linear = LinearParams();
  AxisParams rotary = RotaryParams();
  CamSwitches list = ListOf({{1, 10, 20}, {1, 350, 10}});
  EXPECT_EQ(DiagnoseCamSwitches(list, rotary), "");
  EXPECT_EQ(DiagnoseCamSwitches(list, linear),
            "expected last_on_position not below first_on_position, as axis x is linear and the list has no modulus, "
            "found 10 below 350");
  list.modulus = 90;
  EXPECT_EQ(DiagnoseCamSwitches(list, linear), "");
  EXPECT_EQ(DiagnoseCamSwitches(list, rotary), "");
  list.modulus = 100;
  EXPECT_EQ(DiagnoseCamSwitches(list, rotary),
            "expected a modulus that a turn of axis c (360) is a whole number of, found 100");
  list.modulus = 720;
  EXPECT_NE(DiagnoseCamSwitches(list, rotary), "");
  // The cycle refuses them too: function blocks in C++ do not ask before.
  Rig rig(rotary);
  rig.cam_switches = {list};
  const Ticket ticket = rig.Give(DigitalCamSwitch{.switches = Name::Of("list")});
  rig.Step();
  EXPECT_EQ(rig.lives[ticket].error_id, ErrorId::kParameter);
}

std::vector<CamSwitches> Lists() {
  CamSwitches list = ListOf({{1, 10, 20}, {32, 15, 40}});
  list.name = "a";
  return {list};
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
