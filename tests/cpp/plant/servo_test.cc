// AX-85: the simulated servo axis against closed forms and tables; AX-81: its drive.
#include "takt/plant/servo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "takt/core/hash.h"
#include "takt/core/verify.h"

namespace takt::plant {
namespace {

// A servo with its signals. Ready from the first cycle, brake released, unless a test says otherwise.
struct Bench {
  ServoParams params;
  double period = 0.001;
  ServoOutputs commanded;
  ServoState state;
  ServoInputs measured;

  explicit Bench(const ServoParams& p, DriveMode mode = DriveMode::kCyclicVelocity, double period_s = 0.001)
      : params(p), period(period_s), state(MakeServoState(p)) {
    commanded.mode = mode;
    commanded.enable = true;
    commanded.release_brake = true;
  }
  void Run(double seconds) {
    const auto cycles = std::lround(seconds / period);
    for (long k = 0; k < cycles; ++k) Step(params, commanded, period, state, measured);
  }
  void Speed(double velocity) { commanded.velocity_counts_s = velocity * params.encoder.increments_per_unit; }
  // Sets the axis in motion without the drive.
  void Push(double velocity) {
    commanded.enable = false;
    state.velocity = velocity;
  }
};

ServoParams Ideal() {
  ServoParams p;
  p.drive.power_up_s = 0;
  p.drive.velocity_time_constant_s = 0.02;
  p.drive.load_compensation_s = 0;
  p.drive.max_torque = 1e6;
  return p;
}

TEST(Servo, SpeedStepIsFirstOrder) {  // AX-85: v = V (1 - e^(-t/T)), x = V (t - T (1 - e^(-t/T)))
  for (const double period : {0.00025, 0.001, 0.02}) {
    for (const double compensation : {0.0, 0.01}) {
      ServoParams p = Ideal();
      p.drive.load_compensation_s = compensation;
      Bench bench(p, DriveMode::kCyclicVelocity, period);
      bench.Speed(300);
      for (double t = period; t < 0.2; t += period) {
        bench.Run(period);
        const double rest = std::exp(-t / 0.02);
        ASSERT_NEAR(bench.state.velocity, 300 * (1 - rest), 1e-8);
        ASSERT_NEAR(bench.state.motor_position, 300 * (t - 0.02 * (1 - rest)), 1e-9);
      }
    }
  }
}

TEST(Servo, LimitedTorqueGivesConstantAcceleration) {  // AX-85: inertia, largest torque
  ServoParams p = Ideal();
  p.mechanics.inertia = 0.002;
  p.drive.max_torque = 4;  // 2000 u/s²
  p.drive.velocity_time_constant_s = 0.001;
  Bench bench(p);
  bench.Speed(500);
  bench.Run(0.2);
  EXPECT_NEAR(bench.state.velocity, 400, 1e-9);
  EXPECT_NEAR(bench.state.motor_position, 40, 1e-9);
  EXPECT_DOUBLE_EQ(bench.measured.torque_nm, 4);
  // Up to 498 u/s at full torque, then with the time constant: 2 u/s (1 - e^-1) more after another 1 ms.
  bench.Run(0.049);
  EXPECT_NEAR(bench.state.velocity, 498, 1e-9);
  bench.Run(0.001);
  EXPECT_NEAR(bench.state.velocity, 498 + 2 * (1 - std::exp(-1.0)), 1e-9);
}

TEST(Servo, TorqueLimitIsLeftInsideACycle) {  // AX-85: the same, in one cycle of 20 ms
  ServoParams p = Ideal();
  p.mechanics.inertia = 0.002;
  p.drive.max_torque = 4;
  p.drive.velocity_time_constant_s = 0.001;
  Bench bench(p, DriveMode::kCyclicVelocity, 0.02);
  bench.Speed(22);  // full torque to 20 u/s in 10 ms, then 10 ms to approach
  bench.Run(0.02);
  EXPECT_NEAR(bench.state.velocity, 22 - 2 * std::exp(-10.0), 1e-9);
  EXPECT_NEAR(bench.state.motor_position, 0.1 + 22 * 0.01 - 2 * 0.001 * (1 - std::exp(-10.0)), 1e-9);
}

TEST(Servo, CoulombFrictionStopsAtTheClosedFormDistance) {  // AX-85: v² / 2a
  for (const double sign : {1.0, -1.0}) {
    ServoParams p = Ideal();
    p.mechanics.inertia = 0.001;
    p.mechanics.coulomb_friction = 0.5;  // 500 u/s²
    Bench bench(p);
    bench.Push(sign * 123.4);
    bench.Run(1);
    EXPECT_NEAR(bench.state.motor_position, sign * 123.4 * 123.4 / 1000, 1e-9);
    EXPECT_EQ(bench.state.velocity, 0);
    EXPECT_EQ(bench.measured.torque_nm, 0);
  }
}

TEST(Servo, ViscousFrictionStopsAtTheClosedFormDistance) {  // AX-85: v J / B
  ServoParams p = Ideal();
  p.mechanics.inertia = 0.001;
  p.mechanics.viscous_friction = 0.01;
  Bench bench(p);
  bench.Push(50);
  bench.Run(0.1);
  EXPECT_NEAR(bench.state.velocity, 50 * std::exp(-1.0), 1e-9);
  bench.Run(5);
  EXPECT_NEAR(bench.state.motor_position, 5, 1e-9);
}

TEST(Servo, CoastsWithoutFrictionAndFallsUnderLoad) {  // AX-85: drive off, no brake
  ServoParams p = Ideal();
  p.mechanics.brake_torque = 0;
  Bench bench(p);
  bench.commanded.release_brake = false;
  bench.Push(10);
  bench.Run(1);
  EXPECT_NEAR(bench.state.motor_position, 10, 1e-9);

  p.mechanics.inertia = 0.001;
  p.mechanics.load_torque = 2;  // 2000 u/s² downwards
  Bench falling(p);
  falling.Push(0);
  falling.Run(0.5);
  EXPECT_NEAR(falling.state.motor_position, -250, 1e-8);
}

TEST(Servo, StandsStillWhileFrictionExceedsLoad) {  // AX-85
  ServoParams p = Ideal();
  p.mechanics.coulomb_friction = 1;
  p.mechanics.load_torque = 0.999;
  Bench bench(p);
  bench.Push(0);
  bench.Run(1);
  EXPECT_EQ(bench.state.motor_position, 0);
  bench.state.faults.extra_load = 0.002;
  bench.Run(0.01);
  EXPECT_LT(bench.state.motor_position, 0);
}

TEST(Servo, BrakeHoldsAgainstLoadUnlessReleasedOrTooWeak) {  // AX-82, AX-85
  ServoParams p = Ideal();
  p.mechanics.load_torque = 9;
  p.mechanics.brake_torque = 10;
  Bench bench(p);
  bench.Push(0);
  bench.commanded.release_brake = false;
  bench.Run(1);
  EXPECT_EQ(bench.state.motor_position, 0);
  bench.state.faults.extra_load = 2;
  bench.Run(0.01);
  EXPECT_LT(bench.state.motor_position, 0);
  bench.state.faults.extra_load = 0;
  bench.Run(1);
  EXPECT_EQ(bench.state.velocity, 0) << "caught again";
  const double held = bench.state.motor_position;
  bench.commanded.release_brake = true;
  bench.Run(0.01);
  EXPECT_LT(bench.state.motor_position, held);
}

TEST(Servo, LoadDroopsTheSpeedWithoutCompensation) {  // AX-85: M T / J
  ServoParams p = Ideal();
  p.mechanics.inertia = 0.001;
  p.mechanics.load_torque = 2;
  Bench bench(p);
  bench.Speed(100);
  bench.Run(2);
  EXPECT_NEAR(bench.state.velocity, 100 - 2 * 0.02 / 0.001, 1e-9);
  bench.params.drive.load_compensation_s = 0.01;
  bench.Run(2);
  EXPECT_NEAR(bench.state.velocity, 100, 1e-9);
  EXPECT_NEAR(bench.measured.torque_nm, 2, 1e-9);
  // The compensation learns with its own time constant, independent of the velocity.
  bench.state.faults.extra_load = 1;
  bench.Run(0.01);
  EXPECT_NEAR(bench.state.compensation, 2000 + 1000 * (1 - std::exp(-1.0)), 20);
}

TEST(Servo, BacklashIsAGapBetweenMotorAndLoad) {  // AX-85
  ServoParams p = Ideal();
  p.mechanics.backlash = 0.4;
  p.encoder.place = ServoEncoderPlace::kLoad;
  Bench bench(p);
  bench.commanded.enable = false;
  const auto move_motor_to = [&](double position) {
    bench.state.motor_position = position;
    bench.Run(0.001);
    return bench.state.load_position;
  };
  EXPECT_EQ(move_motor_to(0.15), 0) << "starts in the middle";
  EXPECT_DOUBLE_EQ(move_motor_to(1), 0.8);
  EXPECT_DOUBLE_EQ(move_motor_to(0.7), 0.8) << "turned round: inside the gap";
  EXPECT_DOUBLE_EQ(move_motor_to(0.61), 0.8);
  EXPECT_DOUBLE_EQ(move_motor_to(0.5), 0.7);
  EXPECT_EQ(bench.measured.counts, 700U) << "encoder on the load";
}

TEST(Servo, EndStopsAreInelastic) {  // AX-85
  for (const double sign : {1.0, -1.0}) {
    ServoParams p = Ideal();
    p.mechanics.lower_stop = -5;
    p.mechanics.upper_stop = 5;
    p.drive.max_torque = 3;
    Bench bench(p);
    bench.Speed(sign * 100);
    bench.Run(1);
    EXPECT_EQ(bench.state.load_position, sign * 5);
    EXPECT_EQ(bench.state.velocity, 0);
    EXPECT_DOUBLE_EQ(bench.measured.torque_nm, sign * 0.5) << "still pushing: J / T v";
    bench.Speed(-sign * 100);
    bench.Run(0.05);
    EXPECT_LT(sign * bench.state.load_position, 5);
    bench.Push(sign * 1e5);
    bench.Run(0.01);
    EXPECT_EQ(bench.state.load_position, sign * 5);
    EXPECT_EQ(bench.state.velocity, 0) << "no bounce";
  }
}

TEST(Servo, AnImpactTeachesTheDriveNothing) {  // AX-85: only load is learnt
  ServoParams p;
  p.drive.power_up_s = 0;
  p.mechanics.upper_stop = 5;
  Bench bench(p);
  bench.Speed(1000);
  while (bench.state.load_position < 5) bench.Run(0.001);
  bench.Speed(-50);
  bench.Run(0.003);
  EXPECT_LT(bench.state.load_position, 4.95) << "leaves as if it had stood there";
}

TEST(Servo, CyclicPositionLagsByTheVelocityLoopWhileAccelerating) {  // AX-81: time constant * a / gain
  ServoParams p;
  p.drive.power_up_s = 0;
  p.drive.velocity_time_constant_s = 0.002;
  Bench bench(p, DriveMode::kCyclicPosition);
  for (int k = 0; k <= 500; ++k) {
    const double t = 0.001 * k;
    bench.commanded.position_counts = 1000 * 0.5 * 2000 * t * t;
    bench.commanded.velocity_counts_s = 1000 * 2000 * t;
    bench.Run(0.001);
  }
  EXPECT_NEAR(250 - bench.state.motor_position, 0.002 * 2000 / 200, 0.0005);
}

TEST(Servo, CyclicPositionReachesTheSetPointAndTracks) {  // AX-81: csp
  ServoParams p;                                          // as in a machine file with `plant: {}`
  Bench bench(p, DriveMode::kCyclicPosition);
  bench.commanded.position_counts = 0;
  bench.Run(0.2);
  for (int k = 1; k <= 1000; ++k) {  // 200 u/s for 1 s
    bench.commanded.position_counts = 200.0 * k;
    bench.commanded.velocity_counts_s = 200000;
    bench.Run(0.001);
  }
  EXPECT_NEAR(bench.state.motor_position, 200, 1e-9) << "reached at the end of its cycle";
  bench.commanded.velocity_counts_s = 0;
  bench.Run(0.5);
  EXPECT_NEAR(bench.state.motor_position, 200, 1e-9);
  EXPECT_EQ(bench.measured.counts, 200000U);
}

TEST(Servo, CyclicPositionHoldsUnderLoadAndFriction) {  // AX-81, AX-85
  ServoParams p;
  p.mechanics.load_torque = 3;
  p.mechanics.coulomb_friction = 0.2;
  p.mechanics.viscous_friction = 0.001;
  Bench bench(p, DriveMode::kCyclicPosition);
  bench.commanded.release_brake = false;
  bench.Run(0.2);
  bench.commanded.release_brake = true;
  bench.commanded.position_counts = 1000;
  bench.Run(1);
  EXPECT_NEAR(bench.state.motor_position, 1, 0.001);
  EXPECT_EQ(bench.measured.counts, 1000U);
}

TEST(Servo, CyclicPositionCountsWrapWithTheCounter) {  // AX-81, AX-04
  ServoParams p = Ideal();
  p.drive.velocity_time_constant_s = 0.001;
  for (const double turns : {-1.0, 0.0, 1.0, 5.0}) {
    Bench bench(p, DriveMode::kCyclicPosition);
    bench.commanded.position_counts = 2500 + turns * 4294967296.0;
    bench.Run(1);
    EXPECT_NEAR(bench.state.motor_position, 2.5, 1e-6) << turns;
  }
}

TEST(Servo, AnalogueInput) {  // AX-81: ±10 V with offset and dead band
  ServoParams p = Ideal();
  p.drive.velocity_at_10v = 500;
  p.drive.offset_mv = 20;
  p.drive.dead_band_plus_mv = 50;
  p.drive.dead_band_minus_mv = 100;
  const auto speed = [&](double volts) {
    Bench bench(p, DriveMode::kAnalog);
    bench.commanded.voltage_v = volts;
    bench.Run(2);
    return bench.state.velocity;
  };
  EXPECT_NEAR(speed(4), 500 * (4 + 0.02 - 0.05) / 10, 1e-9);
  EXPECT_NEAR(speed(-4), 500 * (-4 + 0.02 + 0.1) / 10, 1e-9);
  EXPECT_EQ(speed(0.03), 0);
  EXPECT_EQ(speed(-0.12), 0);
  p.drive.inverted = true;
  EXPECT_LT(speed(4), 0);
}

TEST(Servo, PowersUpAfterItsDelay) {  // AX-81
  ServoParams p = Ideal();
  p.drive.power_up_s = 0.05;
  Bench bench(p);
  bench.Speed(100);
  bench.Run(0.05);
  EXPECT_FALSE(bench.measured.drive_ready);
  EXPECT_EQ(bench.state.motor_position, 0);
  bench.Run(0.001);
  EXPECT_TRUE(bench.measured.drive_ready);
  EXPECT_GT(bench.state.motor_position, 0);
  bench.commanded.enable = false;
  bench.Run(0.001);
  EXPECT_FALSE(bench.measured.drive_ready);
  EXPECT_EQ(bench.measured.torque_nm, 0);
}

TEST(Servo, CounterWrapsBothWays) {  // AX-04: 32 bits
  ServoParams p = Ideal();
  p.encoder.offset_counts = -3;
  Bench bench(p);
  EXPECT_EQ(bench.state.counts, 0xFFFFFFFDU);
  bench.Push(1);  // 1 count a cycle
  const auto read = [&] {
    bench.Run(0.001);
    return bench.measured.counts;
  };
  EXPECT_EQ(read(), 0xFFFFFFFEU);
  EXPECT_EQ(read(), 0xFFFFFFFFU);
  EXPECT_EQ(read(), 0U);
  EXPECT_EQ(read(), 1U);
  bench.Push(-1);
  for (const std::uint32_t expected : {0U, 0xFFFFFFFFU, 0xFFFFFFFEU, 0xFFFFFFFDU, 0xFFFFFFFCU})
    EXPECT_EQ(read(), expected);
}

TEST(Servo, CounterIsExactFarOut) {  // AX-04
  ServoParams p = Ideal();
  p.mechanics.start_position = 4e6;  // 4e9 counts
  p.encoder.type = ServoEncoderType::kAbsolute;
  p.encoder.ssi_bits = 32;
  Bench bench(p);
  bench.Push(0);
  bench.Run(0.001);
  EXPECT_EQ(bench.measured.counts, 4'000'000'000U);
}

TEST(Servo, IncrementalCounterBeginsWhereItIsToldWhereverTheAxisStands) {  // AX-04
  ServoParams p;
  p.mechanics.start_position = 123.456;
  p.encoder.offset_counts = 7;
  EXPECT_EQ(MakeServoState(p).counts, 7U);
  EXPECT_EQ(MakeServoState(p).load_position, 123.456);
  p.encoder.inverted = true;
  Bench bench(p);
  bench.Push(1000);
  bench.Run(0.001);
  EXPECT_EQ(bench.measured.counts, 7U - 1000U);
}

TEST(Servo, AbsoluteWordsInBinaryAndGray) {  // AX-04: table of the reflected code
  constexpr std::uint32_t kGray[16] = {0b0000, 0b0001, 0b0011, 0b0010, 0b0110, 0b0111, 0b0101, 0b0100,
                                       0b1100, 0b1101, 0b1111, 0b1110, 0b1010, 0b1011, 0b1001, 0b1000};
  ServoParams p = Ideal();
  p.encoder.type = ServoEncoderType::kAbsolute;
  p.encoder.increments_per_unit = 1;
  p.encoder.ssi_bits = 8;
  for (int k = 0; k < 16; ++k) {
    p.mechanics.start_position = k;
    p.encoder.coding = ServoEncoderCoding::kGray;
    EXPECT_EQ(MakeServoState(p).counts, kGray[k]);
    p.encoder.coding = ServoEncoderCoding::kBinary;
    EXPECT_EQ(MakeServoState(p).counts, static_cast<std::uint32_t>(k));
  }
  p.mechanics.start_position = 256 + 3;
  EXPECT_EQ(MakeServoState(p).counts, 3U) << "single turn: the word wraps";
  p.mechanics.start_position = -1;
  EXPECT_EQ(MakeServoState(p).counts, 255U);
  p.encoder.offset_counts = 11;
  EXPECT_EQ(MakeServoState(p).counts, 10U);
}

TEST(Servo, IndexPulsesOncePerDistanceBothWays) {  // AX-04: NI
  ServoParams p = Ideal();
  p.encoder.index_distance = 2;
  p.encoder.index_offset = 0.5;
  Bench bench(p);
  bench.Push(10);  // 0 -> 10.3 meets 0.5, 2.5, 4.5, 6.5, 8.5
  std::vector<std::uint32_t> latched;
  const auto collect = [&](double seconds) {
    latched.clear();
    std::uint32_t pulses = bench.measured.index_pulses;
    for (double t = 0; t < seconds - 1e-6; t += 0.001) {
      bench.Run(0.001);
      if (bench.measured.index_pulses != pulses) latched.push_back(bench.measured.index_counts);
      pulses = bench.measured.index_pulses;
    }
  };
  collect(1.03);
  EXPECT_THAT(latched, testing::ElementsAre(500, 2500, 4500, 6500, 8500));
  EXPECT_EQ(bench.measured.index_pulses, 5U);
  bench.Push(-10);
  collect(1.03);
  EXPECT_THAT(latched, testing::ElementsAre(8500, 6500, 4500, 2500, 500));
  EXPECT_EQ(bench.measured.index_pulses, 10U);
  bench.Push(4800);  // several in one cycle: all counted, the last one latched
  collect(0.001);
  EXPECT_EQ(bench.measured.index_pulses, 13U);
  EXPECT_EQ(bench.measured.index_counts, 4500U);
}

TEST(Servo, NoiseIsNormalAndTheSameForTheSameSeed) {  // AX-85
  ServoParams p = Ideal();
  p.encoder.noise_counts = 5;
  p.encoder.noise_seed = 42;
  const auto record = [&] {
    Bench bench(p);
    bench.Push(0);
    std::vector<std::int32_t> counts;
    for (int k = 0; k < 100000; ++k) {
      bench.Run(0.001);
      counts.push_back(static_cast<std::int32_t>(bench.measured.counts));
    }
    return counts;
  };
  const auto noise = record();
  EXPECT_EQ(noise, record());
  double mean = 0, square = 0;
  int within = 0;
  for (const double x : noise) {
    mean += x / 1e5;
    square += x * x / 1e5;
    within += std::abs(x) <= 5;  // rounded: below 5.5
  }
  EXPECT_NEAR(mean, 0, 5 * 5 / std::sqrt(1e5));
  EXPECT_NEAR(std::sqrt(square), std::sqrt(25 + 1 / 12.0), 0.06) << "with the rounding's own share";
  EXPECT_NEAR(within / 1e5, std::erf(5.5 / 5 / std::sqrt(2.0)), 0.007);
  p.encoder.noise_seed = 43;
  EXPECT_NE(noise, record());
}

TEST(Servo, SwitchesAreOnInTheirRanges) {  // AX-85
  ServoParams p = Ideal();
  p.switches.limit_positive.from = 10;
  p.switches.limit_negative.to = -10;
  p.switches.reference = {.from = 1, .to = 2};
  p.switches.touch_probe = {.from = 3, .to = 4, .normally_closed = true};
  const auto at = [&](double position) {
    p.mechanics.start_position = position;
    Bench bench(p);
    bench.Push(0);
    bench.Run(0.001);
    const ServoInputs& m = bench.measured;
    return std::vector<bool>{m.limit_negative, m.reference, m.touch_probe, m.limit_positive};
  };
  using Wires = std::vector<bool>;
  EXPECT_EQ(at(0), (Wires{0, 0, 1, 0}));
  EXPECT_EQ(at(1), (Wires{0, 1, 1, 0}));
  EXPECT_EQ(at(2.001), (Wires{0, 0, 1, 0}));
  EXPECT_EQ(at(3.5), (Wires{0, 0, 0, 0}));
  EXPECT_EQ(at(10), (Wires{0, 0, 1, 1}));
  EXPECT_EQ(at(-10), (Wires{1, 0, 1, 0}));
  p.switches.revolution = 5;
  EXPECT_EQ(at(-8.5), (Wires{0, 1, 1, 0})) << "1.5 two turns before";
  EXPECT_EQ(at(6.5), (Wires{0, 1, 1, 0}));
  EXPECT_EQ(at(8.5), (Wires{0, 0, 0, 0}));
  p.switches = {};
  EXPECT_EQ(at(0), (Wires{0, 0, 0, 0})) << "none given: never on";
}

TEST(Servo, Faults) {  // AX-85
  Bench bench(Ideal());
  bench.Speed(100);
  bench.Run(0.5);
  bench.state.faults.encoder_error = true;
  bench.Run(0.001);
  EXPECT_TRUE(bench.measured.encoder_error);
  bench.state.faults = {.encoder_frozen = true};
  const auto before = bench.measured;
  bench.Run(0.5);
  EXPECT_EQ(bench.measured.counts, before.counts);
  EXPECT_EQ(bench.measured.index_pulses, before.index_pulses);
  EXPECT_GT(bench.state.motor_position, 90);
  bench.state.faults = {.stuck = true};
  bench.Run(0.1);
  EXPECT_EQ(bench.state.velocity, 0);
  EXPECT_GT(bench.measured.torque_nm, 0) << "the drive tries";
  bench.state.faults = {};
  bench.Run(0.5);
  EXPECT_NEAR(bench.state.velocity, 100, 1e-6);
  bench.state.faults = {.drive_fault = true};
  bench.Run(0.001);
  EXPECT_TRUE(bench.measured.drive_fault);
  EXPECT_FALSE(bench.measured.drive_ready);
  EXPECT_EQ(bench.measured.torque_nm, 0);
}

TEST(Servo, NotFiniteSetPointsAreNoSetPoints) {  // AX-82
  for (const DriveMode mode : {DriveMode::kCyclicPosition, DriveMode::kCyclicVelocity, DriveMode::kAnalog}) {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      Bench bench(Ideal(), mode);
      bench.commanded.position_counts = bench.commanded.velocity_counts_s = bench.commanded.voltage_v = bad;
      bench.Run(0.1);
      EXPECT_EQ(bench.state.motor_position, 0);
      EXPECT_EQ(bench.state.velocity, 0);
    }
  }
}

// AX-85: for any parameters and period, the state stays finite and an axis that is commanded to stop comes to rest. Run
// twice: the same bits.
TEST(Servo, StableAndTheSameOverAllParameters) {
  const auto run = [](unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    const auto log = [&](double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); };
    const auto often = [&] { return random() % 2 == 0; };
    ServoParams p;
    p.drive.power_up_s = 0;
    p.drive.position_gain = log(1, 1000);
    p.drive.velocity_feed_forward = uniform(0, 2);
    p.drive.loop_period_s = log(0.00005, 0.001);
    p.drive.velocity_time_constant_s = log(0.00001, 0.1);
    p.drive.load_compensation_s = often() ? 0 : log(0.0001, 1);
    p.mechanics.inertia = log(1e-6, 10);
    p.drive.max_torque = p.mechanics.inertia * log(1e4, 1e7);
    p.mechanics.viscous_friction = often() ? 0 : p.mechanics.inertia * log(1e-3, 10);
    p.mechanics.coulomb_friction = often() ? 0 : p.drive.max_torque * uniform(0, 0.4);
    p.mechanics.load_torque = often() ? 0 : p.drive.max_torque * uniform(-0.4, 0.4);
    const double period = log(0.00025, 0.02);
    const DriveMode mode = often() ? DriveMode::kCyclicPosition : DriveMode::kCyclicVelocity;
    Bench bench(p, mode, period);
    for (int k = 0; k < 200; ++k) {
      bench.commanded.position_counts = 1000 * uniform(-10, 10);
      bench.commanded.velocity_counts_s = 1000 * uniform(-100, 100);
      bench.Run(period);
    }
    bench.commanded.position_counts = 0;
    bench.commanded.velocity_counts_s = 0;
    bench.Run(15);
    EXPECT_TRUE(std::isfinite(bench.state.motor_position)) << seed;
    // Without compensation, the droop of the load remains.
    const double droop = (std::abs(p.mechanics.load_torque) + p.mechanics.coulomb_friction) / p.mechanics.inertia *
                         p.drive.velocity_time_constant_s;
    const bool slow = mode == DriveMode::kCyclicPosition;
    const double allowed = p.drive.load_compensation_s > 0 || slow ? 0 : droop;
    EXPECT_NEAR(bench.state.velocity, 0, allowed + 1e-3) << seed << (slow ? " csp" : " csv");
    return HashOf(bench.state);
  };
  for (unsigned seed = 0; seed < 200; ++seed) EXPECT_EQ(run(seed), run(seed));
}

TEST(Servo, IsDescribed) {  // EN-11
  for (const Type* type : {&TypeOf<ServoParams>(), &TypeOf<ServoState>()})
    EXPECT_THAT(Verify(*type), testing::IsEmpty());
}

}  // namespace
}  // namespace takt::plant
