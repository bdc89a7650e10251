// AX-80: the position loop of the axis, each stage by hand calculation.
#include "takt/axis/control_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "takt/core/verify.h"

namespace takt::axis {
namespace {

// One part at a time: whatever a test does not switch on is off.
ControlLoop Silent() {
  ControlLoop p;
  p.kp = p.ki = p.kd = p.kc = p.ff = 0;
  p.velocity_at_10v = 1000;
  return p;
}

struct Loop {
  ControlLoop params;
  ControlLoopInputs in;
  ControlLoopState state;
  ControlLoopOutputs out;

  explicit Loop(const ControlLoop& p, DriveMode mode = DriveMode::kAnalog) : params(p) {
    in.mode = mode;
    in.closed = true;
  }
  double Volts(double model, double feedback, double model_velocity = 0) {
    Run(model, feedback, model_velocity);
    return out.voltage_v;
  }
  double Speed(double model, double feedback, double model_velocity = 0) {
    Run(model, feedback, model_velocity);
    return out.velocity;
  }
  void Run(double model, double feedback, double model_velocity) {
    in.model_position = model;
    in.model_velocity = model_velocity;
    in.feedback = feedback;
    Step(params, in, Cycle{.count = 0, .period_s = 0.001}, state, out);
  }
};

TEST(ControlLoop, ProportionalTermAlone) {  // AX-80
  ControlLoop p = Silent();
  p.kp = 0.05;
  Loop loop(p);
  // e = 2 u, P = 0.1 u in a cycle of 1 ms = 100 u/s = 1 V of 10 V at 1000 u/s: 409.6 steps of the converter, so 410.
  EXPECT_DOUBLE_EQ(loop.Volts(12, 10), 410 * 20.0 / 8192);
  EXPECT_DOUBLE_EQ(loop.state.error, 2);
  EXPECT_DOUBLE_EQ(loop.state.p, 0.1);
  EXPECT_DOUBLE_EQ(loop.state.converted, 1);
  EXPECT_EQ(loop.state.i, 0);
  EXPECT_EQ(loop.state.d, 0);
  EXPECT_DOUBLE_EQ(loop.Volts(10, 12), -410 * 20.0 / 8192);
}

TEST(ControlLoop, IntegralTermAddsKiTimesErrorEachCycle) {  // AX-80: Ki = T / Ti
  ControlLoop p = Silent();
  p.ki = 0.001 / 0.1;  // T = 1 ms, Ti = 100 ms
  Loop loop(p, DriveMode::kCyclicVelocity);
  for (int k = 1; k <= 10; ++k) {
    // 0.01 of e = 0.5 u in each cycle: 0.005 u = 5 u/s more.
    EXPECT_NEAR(loop.Speed(0.5, 0), 5.0 * k, 1e-9);
  }
  EXPECT_NEAR(loop.Speed(0, 0), 50, 1e-9) << "without an error the integral stays";
  EXPECT_NEAR(loop.Speed(0, 0.5), 45, 1e-9);
}

TEST(ControlLoop, IntegralTimeIsWhenIntegralEqualsTheErrorItself) {  // AX-80: what Ti means
  ControlLoop p = Silent();
  p.ki = 0.001 / 0.1;
  Loop loop(p, DriveMode::kCyclicVelocity);
  for (int k = 0; k < 100; ++k) loop.Run(0.25, 0, 0);
  EXPECT_NEAR(loop.state.i, 0.25, 1e-12);
}

TEST(ControlLoop, DerivativeTermIsKdTimesChangeOfError) {  // AX-80: Kd = Td / T
  ControlLoop p = Silent();
  p.kd = 0.004 / 0.001;  // Td = 4 ms
  Loop loop(p, DriveMode::kCyclicVelocity);
  EXPECT_EQ(loop.Speed(1, 0), 0) << "no kick when the loop closes";
  EXPECT_NEAR(loop.Speed(1.01, 0), 4 * 0.01 / 0.001, 1e-9);
  EXPECT_EQ(loop.Speed(1.01, 0), 0);
  EXPECT_NEAR(loop.Speed(1.01, 0.02), -4 * 0.02 / 0.001, 1e-9);
}

TEST(ControlLoop, TermsAreParallel) {  // AX-80: tuning begins with Kd alone, Kp = 0
  ControlLoop p = Silent();
  p.kp = 0.1;
  p.ki = 0.01;
  p.kd = 0.5;
  Loop loop(p);
  loop.Run(0.2, 0, 0);
  loop.Run(0.3, 0, 0);
  EXPECT_DOUBLE_EQ(loop.state.p, 0.03);
  EXPECT_DOUBLE_EQ(loop.state.i, 0.01 * 0.2 + 0.01 * 0.3);
  EXPECT_DOUBLE_EQ(loop.state.d, 0.05);
  EXPECT_DOUBLE_EQ(loop.state.sum, loop.state.p + loop.state.i + loop.state.d);
}

TEST(ControlLoop, GainsArePerCycle) {  // AX-80: the same numbers at another period are another speed gain
  ControlLoop p = Silent();
  p.kp = 0.05;
  ControlLoopInputs in{.mode = DriveMode::kCyclicVelocity, .closed = true, .model_position = 1};
  ControlLoopState s;
  ControlLoopOutputs out;
  Step(p, in, {.count = 0, .period_s = 0.004}, s, out);
  EXPECT_DOUBLE_EQ(out.velocity, 0.05 / 0.004);
}

TEST(ControlLoop, FeedForwardIsSetSpeedInVolts) {  // AX-80
  ControlLoop p = Silent();
  p.ff = 1;
  p.velocity_at_10v = 500;
  Loop loop(p);
  EXPECT_DOUBLE_EQ(loop.Volts(7, 7, 125), 2.5);  // 1024 steps
  EXPECT_DOUBLE_EQ(loop.Volts(7, 7, -250), -5);
  loop.params.ff = 0.5;
  EXPECT_DOUBLE_EQ(loop.Volts(7, 7, 250), 2.5);
}

TEST(ControlLoop, FeedForwardIsAddedBehindTheLimiter) {  // AX-80: a loop at its limit still takes the set speed off
  ControlLoop p = Silent();
  p.kp = 1;
  p.ff = 1;
  Loop loop(p);
  EXPECT_DOUBLE_EQ(loop.Volts(100, 0, -500), 5);
  EXPECT_DOUBLE_EQ(loop.state.limited, 1) << "1000 u/s for 1 ms";
  EXPECT_DOUBLE_EQ(loop.state.converted, 10);
  EXPECT_DOUBLE_EQ(loop.state.feed_forward, -5);
}

TEST(ControlLoop, FeedForwardTracksConstantSpeedWithoutError) {  // AX-80
  ControlLoop p = Silent();
  p.kp = 0.05;
  p.ff = 1;
  Loop loop(p, DriveMode::kCyclicVelocity);
  double x = 0;  // an axis that has at once the speed it is told
  for (int k = 0; k < 1000; ++k) x += loop.Speed(0.3 * k, x, 300) * 0.001;
  EXPECT_NEAR(loop.state.p, 0, 1e-12);

  // Without it the axis lags by v / Kv = 300 / 50.
  loop = Loop(p, DriveMode::kCyclicVelocity);
  loop.params.ff = 0;
  x = 0;
  for (int k = 0; k < 1000; ++k) x += loop.Speed(0.3 * k, x, 300) * 0.001;
  EXPECT_NEAR(loop.state.error, 6, 1e-6);
}

TEST(ControlLoop, ConverterHas8192StepsOver20Volts) {  // AX-80: 13 bits
  ControlLoop p = Silent();
  p.ff = 1;
  p.velocity_at_10v = 10;  // 1 u/s is 1 V
  Loop loop(p);
  const double step = 0.00244140625;
  EXPECT_EQ(loop.Volts(0, 0, 0.49 * step), 0);
  EXPECT_EQ(loop.Volts(0, 0, 0.51 * step), step);
  EXPECT_EQ(loop.Volts(0, 0, -0.51 * step), -step);
  EXPECT_EQ(loop.Volts(0, 0, 1.49 * step), step);
  EXPECT_EQ(loop.Volts(0, 0, 11), 10 - step);
  EXPECT_EQ(loop.Volts(0, 0, -11), -10);
  int levels = 1;
  double last = loop.Volts(0, 0, -10);
  for (int k = -100000; k <= 100000; ++k) {
    const double volts = loop.Volts(0, 0, k / 10000.0);
    EXPECT_EQ(std::remainder(volts, step), 0);
    EXPECT_NEAR(volts, k / 10000.0, k < 99988 ? step / 2 : step);
    levels += volts != last;
    last = volts;
  }
  EXPECT_EQ(levels, 8192);
}

TEST(ControlLoop, OffsetIsAddedAlsoAtRest) {  // AX-80
  ControlLoop p = Silent();
  p.offset_mv = -100;
  Loop loop(p);
  EXPECT_DOUBLE_EQ(loop.Volts(0, 0), -41 * 20.0 / 8192);  // 40.96 steps
}

TEST(ControlLoop, DeadBandIsMadeUpForPerDirection) {  // AX-80
  ControlLoop p = Silent();
  p.ff = 1;
  p.velocity_at_10v = 10;
  p.dead_band_plus_mv = 50;
  p.dead_band_minus_mv = 80;
  Loop loop(p);
  loop.Run(0, 0, 1);
  EXPECT_DOUBLE_EQ(loop.state.compensated, 1.05);
  loop.Run(0, 0, -1);
  EXPECT_DOUBLE_EQ(loop.state.compensated, -1.08);
  EXPECT_EQ(loop.Volts(0, 0, 0), 0);
  EXPECT_EQ(loop.Volts(0, 0, 1e-6), 0) << "nothing to send: no jump over the dead band";
  loop.params.offset_mv = 20;
  loop.Run(0, 0, -1);
  EXPECT_DOUBLE_EQ(loop.state.compensated, -1.06);
}

TEST(ControlLoop, InvertTurnsTheOutputRound) {  // AX-03: control sense
  ControlLoop p;
  p.dead_band_minus_mv = 80;
  Loop loop(p);
  loop.in.invert = true;
  loop.Run(2, 0, 100);
  EXPECT_DOUBLE_EQ(loop.state.converted, -1);
  EXPECT_DOUBLE_EQ(loop.state.feed_forward, -1);
  EXPECT_DOUBLE_EQ(loop.state.compensated, -2.08);
  EXPECT_LT(loop.out.voltage_v, 0);
}

// A wall: the axis does not move, whatever the loop asks for. How many cycles the output needs to leave the limit once
// the set point lies on the other side.
int CyclesToUnwind(double kc, double* integral = nullptr) {
  ControlLoop p = Silent();
  p.kp = 0.05;
  p.ki = 0.01;
  p.kc = kc;
  Loop loop(p, DriveMode::kCyclicVelocity);
  for (int k = 0; k < 5000; ++k) loop.Run(10, 0, 0);
  if (integral) *integral = loop.state.integral;
  int cycles = 0;
  while (loop.Speed(-10, 0) > 0) ++cycles;
  return cycles;
}

TEST(ControlLoop, AntiWindupBoundsTheIntegral) {  // AX-80: Kc
  double with = 0;
  double without = 0;
  EXPECT_LE(CyclesToUnwind(0.9, &with), 10);
  EXPECT_GT(CyclesToUnwind(0, &without), 4000);
  EXPECT_LE(with, 1) << "never more than the limiter lets through: 1000 u/s for 1 ms";
  EXPECT_NEAR(without, 5000 * 0.01 * 10, 1e-6);
}

TEST(ControlLoop, AntiWindupSeesTheOutputLimiterToo) {  // AX-80
  ControlLoop p = Silent();
  p.ki = 0.01;
  p.kc = 0.9;
  p.ff = 1;
  Loop loop(p);
  for (int k = 0; k < 5000; ++k) loop.Run(1, 0, 900);  // feed-forward takes 9 of the 10 V
  EXPECT_LT(loop.state.integral, 0.12);
}

TEST(ControlLoop, AntiWindupLeavesAnEmptyIntegratorEmpty) {  // AX-80: Ki = 0 means no integration
  ControlLoop p = Silent();
  p.kp = 1;
  p.kc = 1;
  Loop loop(p);
  for (int k = 0; k < 100; ++k) loop.Run(100, 0, 0);
  EXPECT_EQ(loop.state.integral, 0);
  EXPECT_EQ(loop.Volts(0, 0), 0);
}

TEST(ControlLoop, WithoutIntegrationNothingOfItStays) {  // AX-80, AX-27: Ki set to 0 at run time
  ControlLoop p = Silent();
  p.ki = 0.01;
  Loop loop(p);
  for (int k = 0; k < 100; ++k) loop.Run(1, 0, 0);
  EXPECT_GT(loop.state.integral, 0.5);
  loop.params.ki = 0;
  EXPECT_EQ(loop.Volts(0, 0), 0);
  EXPECT_EQ(loop.state.integral, 0);
}

TEST(ControlLoop, OpenLoopGivesNothingAndForgets) {  // AX-80, AX-82: outputs 0 V while the loop is open
  ControlLoop p;
  p.ki = 0.01;
  p.kd = 1;
  p.offset_mv = 500;
  Loop loop(p);
  for (int k = 0; k < 10; ++k) loop.Run(5, 0, 10);
  loop.in.closed = false;
  EXPECT_EQ(loop.Volts(5, 0, 100), 0);
  EXPECT_EQ(loop.state, ControlLoopState{});
  loop.in.closed = true;
  loop.params.offset_mv = 0;
  EXPECT_EQ(loop.Volts(3, 3), 0) << "closing where the axis stands moves nothing";
}

TEST(ControlLoop, ClosingStartsFromAGivenIntegral) {  // AX-80: taking over an axis that hangs on its drive
  ControlLoop p;
  p.ki = 0.01;
  Loop loop(p);
  loop.state.integral = 0.2;
  EXPECT_DOUBLE_EQ(loop.Volts(3, 3), 819 * 20.0 / 8192);  // 200 u/s: 2 V, 819.2 steps
}

TEST(ControlLoop, CyclicVelocityIsLimitedToVmax) {  // AX-81
  ControlLoop p;
  p.velocity_at_10v = 400;
  p.offset_mv = 300;
  p.dead_band_plus_mv = 300;
  Loop loop(p, DriveMode::kCyclicVelocity);
  EXPECT_DOUBLE_EQ(loop.Speed(2, 0, 50), 2 * 50 + 50) << "kp e + ff v; offset and dead band are the analogue output's";
  EXPECT_EQ(loop.Speed(2, 0, 1000), 400);
  EXPECT_EQ(loop.Speed(-2, 0, -1000), -400);
  EXPECT_EQ(loop.out.voltage_v, 0);
}

TEST(ControlLoop, NotFiniteInNotFiniteOut) {  // AX-82: the caller can see that something is wrong
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Loop loop{ControlLoop{}};
    loop.Run(0, std::isnan(bad) ? bad : 0, bad);
    EXPECT_FALSE(std::isfinite(loop.state.feed_forward));
  }
  Loop loop{ControlLoop{}};
  EXPECT_TRUE(std::isnan(loop.Volts(0, std::numeric_limits<double>::quiet_NaN())));
}

TEST(ControlLoop, IsDescribed) {  // EN-11
  for (const Type* type : {&TypeOf<ControlLoop>(), &TypeOf<ControlLoopState>()})
    EXPECT_THAT(Verify(*type), testing::IsEmpty());
}

}  // namespace
}  // namespace takt::axis
