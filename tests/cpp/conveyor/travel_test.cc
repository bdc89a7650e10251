// The travel of a belt: by the set position of its axis or by the measured one, over all turns and wraps.
#include "rig.h"

namespace takt::conveyor {
namespace {

constexpr auto kActual = axis::MasterSource::kActualValue;
constexpr double kPi = std::numbers::pi;

// CV-01
TEST(Travel, IsTheSetPositionBitForBit) {
  Rig rig(Straight());
  rig.params.ratio = -2.5;
  rig.axis.origin = 1000;
  rig.Step({12.5, -3, 7});
  EXPECT_EQ(rig.state.travel, (KinematicState{-2531.25, 7.5, -17.5}));
  EXPECT_EQ(rig.Out().position, -2531.25);
  EXPECT_TRUE(rig.Out().known);
}

// CV-01: measured values are a cycle older than the set points; a dead time is added.
TEST(Travel, HasNoLagAtConstantSpeed) {
  for (const double period : {0.00025, 0.001, 0.02}) {
    for (const double filter : {0.0, 0.005, 0.2}) {
      for (const double dead_time : {0.0, 0.013}) {
        for (const double speed : {1000.0, -333.3}) {
          BeltParams p = Straight(kActual);
          p.filter_s = filter;
          p.dead_time_s = dead_time;
          Rig rig(p, period);
          for (int k = 0; k < 3000; ++k) {
            const double seen = speed * (k * period - dead_time);
            rig.Step({seen, speed, 0});
            const double now = speed * (k + 1) * period;
            ASSERT_NEAR(rig.state.travel.position, now, 1e-9 + 1e-14 * std::abs(now)) << k;
            ASSERT_NEAR(rig.state.travel.velocity, speed, 1e-5);
          }
        }
      }
    }
  }
}

// CV-01: from rest to speed the filter settles; position, velocity and acceleration are consistent.
TEST(Travel, FindsASpeedAndIsSmooth) {
  BeltParams p = Straight(kActual);
  p.filter_s = 0.01;
  Rig rig(p);
  KinematicState before;
  for (int k = 0; k < 500; ++k) {
    const double speed = k < 100 ? 0 : 500;
    rig.Step({k < 100 ? 0 : 0.5 * (k - 100), speed, 0});
    const KinematicState& now = rig.state.travel;
    EXPECT_NEAR(now.position - before.position, 0.0005 * (now.velocity + before.velocity), 0.003);
    EXPECT_NEAR(now.velocity - before.velocity, 0.0005 * (now.acceleration + before.acceleration), 1e-9);
    before = now;
  }
  EXPECT_NEAR(rig.state.travel.position, 0.5 * 400, 1e-6);
  EXPECT_NEAR(rig.state.travel.velocity, 500, 1e-5);
}

// CV-01, CV-20: a belt at 1 m/s +-10 %: the error stays below half the acceleration times the square of the dead time.
// The true belt in closed form: x = v t - A cos(w t).
TEST(Travel, ChangingSpeedsAreWrongByLessThanTheDeadTimeAllows) {
  for (const double hertz : {0.5, 1.0, 2.0}) {
    const double w = 2 * kPi * hertz, amplitude = 100 / w;
    const auto at = [&](double t) {
      return KinematicState{1000 * t - amplitude * std::cos(w * t), 1000 + amplitude * w * std::sin(w * t), 0};
    };
    BeltParams p = Straight(kActual);
    p.dead_time_s = 0.02;
    Rig rig(p);
    double worst = 0;
    for (int k = 0; k < 4000; ++k) {
      rig.Step(at(k * 0.001 - 0.02));
      if (k > 500) worst = std::max(worst, std::abs(rig.state.travel.position - at((k + 1) * 0.001).position));
    }
    EXPECT_LT(worst, amplitude * w * w * 0.02 * 0.02 / 2) << hertz;
    EXPECT_GT(worst, 1e-4) << "a test that cannot fail";
  }
}

// CV-20, PP-64: a constant acceleration causes no lag, though the velocity is measured as the mean over a cycle.
TEST(Travel, AConstantAccelerationLeavesNothingBehind) {
  for (const double filter : {0.004, 0.01, 0.05}) {
    BeltParams p = Straight(kActual);
    p.filter_s = filter;
    Rig rig(p);
    const double a = 1000;
    for (int k = 0; k < 4000; ++k) {
      const double t = k * 0.001;
      rig.Step({a * t * t / 2, a * (t - 0.0005), 0});
    }
    const double t = 4;
    EXPECT_NEAR(rig.state.travel.position, a * t * t / 2, 1e-6);
    EXPECT_NEAR(rig.state.travel.acceleration, a, 1e-3);
  }
}

// CV-01: a counter of 32 bits wraps several times a second; the travel continues.
TEST(Travel, GoesOnOverWrapsOfTheEncoder) {
  Cell cell(R"(
name: m
axes:
  - name: drive
    limits: {velocity: 2000, acceleration: 20000, jerk: 400000}
    encoder: {increments_per_unit: 10000000}
belts:
  - {name: measured, axis: drive, source: actual_value, filter_s: 0.01}
  - {name: set, axis: drive}
)");
  cell.Give("drive", "power");
  cell.Run(200);
  cell.Give("drive", "move_velocity", "{velocity: 1500}");
  cell.Run(400);
  double before = cell.Belt(0).position;
  cell.each = [&] {
    ASSERT_NEAR(cell.Belt(0).position - before, 1.5, 1e-4);
    ASSERT_NEAR(cell.Belt(0).position, cell.Belt(1).position, 1e-3);
    before = cell.Belt(0).position;
  };
  cell.Run(3000);  // 4500 mm: ten wraps
  EXPECT_GT(before * 1e7, 10 * 4294967296.0);
}

// CV-01: an axis with a modulus removes whole turns from its positions; the belt counts them all, in both directions.
TEST(Travel, GoesOnOverWholeTurns) {
  Cell cell(R"(
name: m
axes:
  - name: drive
    kind: rotary
    modulus: 4
    limits: {velocity: 20000, acceleration: 400000, jerk: 20000000}
    encoder: {increments_per_unit: 10000}
belts:
  - {name: measured, axis: drive, source: actual_value}
  - {name: set, axis: drive, ratio: 0.5}
)");
  cell.Give("drive", "power");
  cell.Run(200);
  for (const char* direction : {"positive", "negative"}) {
    cell.Give("drive", "move_velocity", "{velocity: 10000, direction: " + std::string(direction) + "}");
    cell.Run(300);
    const double speed = cell.Belt(1).velocity;
    EXPECT_NEAR(std::abs(speed), 5000, 1e-6);
    double before = cell.Belt(1).position;
    cell.each = [&] {
      ASSERT_NEAR(cell.Belt(1).position - before, speed * 0.001, 1e-6);
      ASSERT_NEAR(cell.Belt(0).position, 2 * cell.Belt(1).position, 1e-2);
      before = cell.Belt(1).position;
    };
    cell.Run(2000);  // 5000 turns
    cell.each = nullptr;
  }
}

// CV-01: a new position value for the axis (set_position) does not move the belt.
TEST(Travel, DoesNotNoticeOtherNumbers) {
  Cell cell(R"(
name: m
axes: [{name: drive, limits: {velocity: 500, acceleration: 5000, jerk: 100000}}]
belts: [{name: belt, axis: drive}]
)");
  cell.Give("drive", "power");
  cell.Run(200);
  cell.Give("drive", "move_relative", "{distance: 100}");
  cell.Run(1000);
  cell.Give("drive", "define_position", "{position: -7}");
  cell.Run(10);
  EXPECT_NEAR(cell.engine.outputs(0).set_position, -7, 1e-9);
  EXPECT_NEAR(cell.Belt().position, 100, 1e-9);
}

// CV-01: while the encoder has an error the belt continues at its velocity; then it is at the measured position.
TEST(Travel, GoesOnWhileTheEncoderIsLost) {
  Rig rig(Straight(kActual));
  for (int k = 0; k < 100; ++k) rig.Step({0.5 * k, 500, 0});
  EXPECT_TRUE(rig.Out().known);
  rig.axis.encoder_error = true;
  for (int k = 100; k < 120; ++k) {
    rig.Step({0.5 * 99, 500, 0});
    EXPECT_NEAR(rig.state.travel.position, 0.5 * (k + 1), 1e-6);
    EXPECT_FALSE(rig.Out().known);
  }
  rig.axis.encoder_error = false;
  rig.Step({1000, 500, 0});  // it was moved in between
  EXPECT_NEAR(rig.state.travel.position, 1000.5, 1e-9);
  EXPECT_TRUE(rig.Out().known);
}

// CV-01: set points may be filtered, too, if configured.
TEST(Travel, FiltersSetPointsOnlyIfAsked) {
  Rig plain(Straight()), filtered(Straight());
  filtered.params.filter_s = 0.02;
  for (int k = 0; k < 10; ++k) {
    plain.Step({k < 5 ? 0.0 : 1.0, 0, 0});
    filtered.Step({k < 5 ? 0.0 : 1.0, 0, 0});
  }
  EXPECT_EQ(plain.state.travel.position, 1);
  EXPECT_LT(filtered.state.travel.position, 0.5);
}

// CV-02: a touch probe reports a position of the axis as users see it; of an axis with a modulus the last pass counts.
TEST(Travel, AtARecordedPosition) {
  Rig linear(Straight());
  linear.params.ratio = 2;
  linear.axis.origin = 10;
  linear.Step({100, 5, 0});
  EXPECT_EQ(TravelAt(linear.context(), linear.state, 90), 200);

  Rig rotary(Straight());
  rotary.axis_params.kind = axis::AxisKind::kRotary;
  rotary.axis_params.modulus = 360;
  rotary.axis.origin = 3600;
  rotary.Step({30, 100, 0});
  EXPECT_NEAR(TravelAt(rotary.context(), rotary.state, 20), 3620, 1e-9);
  EXPECT_NEAR(TravelAt(rotary.context(), rotary.state, 350), 3590, 1e-9);
  EXPECT_NEAR(TravelAt(rotary.context(), rotary.state, 31), 3271, 1e-9);
  EXPECT_NEAR(TravelAt(rotary.context(), rotary.state, 30.1), 3630.1, 1e-9) << "measured later than the belt is known";
  rotary.Step({30, -100, 0});  // going back
  EXPECT_NEAR(TravelAt(rotary.context(), rotary.state, 40), 3640, 1e-9);
  EXPECT_NEAR(TravelAt(rotary.context(), rotary.state, 20), 3980, 1e-9);
}

}  // namespace
}  // namespace takt::conveyor
