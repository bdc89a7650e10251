// Running cams: cycles, lengths, ends, scaling and offsets (CAM-20 to CAM-22, CAM-24, CAM-40 to CAM-42).
#include <gtest/gtest.h>

#include "bench.h"
#include "takt/cam/build.h"
#include "takt/flexcam/profiler.h"
#include "watch.h"

namespace takt::flexcam {
namespace {

using axis::AxisKind;

// CAM-20
TEST(Cyclic, BothWaysAndOverMasterTurns) {
  Bench b(MachineOf({UpAndDown("hill", 50)}, Quick()));
  b.Web(720);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  Watch watch(b);
  for (const double velocity : {720.0, -720.0, 100.0}) {
    b.Web(velocity);
    for (int i = 0; i < 3000; ++i) {
      b.Step();
      ASSERT_NEAR(b.Knife().set_position, Hill(b.TheWeb().set_position), 1e-8);
    }
  }
  watch.ExpectSmooth();
}

// CAM-20: outside a cam that is run once its end is held, and X leaves it where it entered.
TEST(Once, HoldsItsEnds) {
  Settings s = Quick();
  s.cam_cyclic = false;
  cam::CamParams lift = Onward("lift", 40, 100);
  lift.cyclic = false;
  Bench b(MachineOf({lift}, s, AxisKind::kLinear));
  ASSERT_TRUE(b.Sync());
  const auto at = [&](double position) {
    b.Give(Bench::kWeb, axis::MoveAbsolute{.position = position, .velocity = 400});
    b.Run(3000);
    return b.Knife().set_position;
  };
  Watch watch(b);
  EXPECT_NEAR(at(300), 40, 1e-9);
  EXPECT_NEAR(at(50), 20, 1e-9);
  EXPECT_NEAR(at(-200), 0, 1e-9);
  EXPECT_NEAR(at(75), 40 * engine::Polynomial345::Y(0.75), 1e-9);
  watch.ExpectSmooth();
}

// CAM-21: a cam shorter than the master's turn loses its position relative to the master after the first cycle ...
TEST(Lengths, ShorterThanTheMastersTurn) {
  Bench b(MachineOf({UpAndDown("hill", 50, 250)}, Quick()));
  b.Web(500);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  double total = b.Module().set_x_position;
  double before = b.TheWeb().set_position;
  for (int i = 0; i < 5000; ++i) {
    b.Step();
    const double way = b.TheWeb().set_position - before;
    total += way - 360 * std::round(way / 360);
    before = b.TheWeb().set_position;
    ASSERT_LT(Apart(b.Module().set_x_position, total, 250), 1e-6);
    ASSERT_NEAR(b.Knife().set_position, Hill(b.Module().set_x_position, 50, 250), 1e-8);
  }
}

// CAM-21: ... one as long as the turn keeps it, and a relative one begins at the master's position.
TEST(Lengths, AsLongAsTheMastersTurn) {
  for (const bool absolute : {true, false}) {
    Settings s = Quick();
    s.master_absolute = absolute;
    Bench b(MachineOf({UpAndDown("hill", 50)}, s));
    b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 100});
    b.Run(1000);
    ASSERT_TRUE(b.Sync());
    b.Web(2000);
    b.Run(20000);
    EXPECT_LT(Apart(b.Module().set_x_position, b.TheWeb().set_position - (absolute ? 0 : 100)), 1e-6);
  }
}

// CAM-21: a slave whose turn is the stroke keeps its position; another one advances from cycle to cycle.
TEST(Lengths, OfTheSlave) {
  for (const double stroke : {360.0, 100.0}) {
    Bench b(MachineOf({Onward("index", stroke)}, Quick(), AxisKind::kRotary, AxisKind::kRotary));
    b.Web(720);
    b.Run(300);
    ASSERT_TRUE(b.Sync());
    const std::uint32_t ends = b.Module().cam_ends;
    b.Run(5000);
    const double cycles = b.Module().cam_ends - ends;
    EXPECT_NEAR(cycles, 10, 1);
    const double in_cycle = stroke * engine::Polynomial345::Y(b.Module().set_x_position / 360);
    EXPECT_LT(Apart(b.Knife().set_position, b.Module().cam_ends * stroke + in_cycle), 1e-6);
  }
}

// CAM-21: after a million cycles the error is below a millionth of a cycle, with lengths that are no exact doubles.
TEST(Lengths, NoDriftInAMillionCycles) {
  const double length = 360.0 / 7, stroke = 100.0 / 3;
  const cam::Table table = cam::Build(Onward("index", stroke, length)).table.value();
  ProfilerState p;
  Lay(table, 0.1, 0.1, false, p);
  const double velocity = 0.37;  // of a cycle per step
  std::int64_t ends = 0;
  double x = 0;
  for (std::int64_t i = 1; ends < 1'000'000; ++i) {
    x = 0.1 + static_cast<double>(i) * velocity * length;
    if (PassedEnd(table, p, x)) ++ends;
    GoOn(table, x, p);
  }
  EXPECT_EQ(p.cycle, 1'000'000);
  const ProfilerValue at = ValueAt(table, p, x);
  const long double cycles = static_cast<long double>(x) / static_cast<long double>(length);
  const auto share = static_cast<double>(cycles - std::floor(cycles));
  EXPECT_NEAR(at.x / length, share, 1e-6);
  EXPECT_NEAR(at.y / stroke, 1e6 + engine::Polynomial345::Y(share), 1e-6);
}

// CAM-22: true for exactly one cycle, the last one of the cam, at any speed and in both directions.
TEST(EndOfProfile, IsSeenForOneCycle) {
  for (const double velocity : {100.0, 1234.5, -700.0}) {
    Bench b(MachineOf({UpAndDown("hill", 50)}, Quick()));
    b.Web(velocity);
    b.Run(400);
    ASSERT_TRUE(b.Sync());
    int seen = 0, ends = 0;
    std::uint32_t before = b.Module().cam_ends;
    for (int i = 0; i < 20000; ++i) {
      const bool announced = b.Module().end_of_profile;
      b.Step();
      const bool passed = b.Module().cam_ends != before;
      before = b.Module().cam_ends;
      EXPECT_EQ(announced, passed) << velocity;
      seen += announced;
      ends += passed;
    }
    EXPECT_GE(ends, 5);
    EXPECT_EQ(seen, ends);
  }
}

// CAM-22: a master that reverses in the last cycle causes no second end.
TEST(EndOfProfile, OnceForEachEndWhateverTheMasterDoes) {
  for (int turn = 0; turn < 60; ++turn) {
    Bench b(MachineOf({UpAndDown("hill", 50)}, Quick()));
    b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 300});
    b.Run(600);
    ASSERT_TRUE(b.Sync());
    int seen = 0;
    const std::uint32_t before = b.Module().cam_ends;
    b.each = [&] { seen += b.Module().end_of_profile; };
    b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 359.5 + 0.02 * turn - (turn > 25 ? 360 : 0),
                                           .velocity = 500,
                                           .direction = axis::Direction::kPositive});
    b.Run(800);
    b.Give(Bench::kWeb, axis::MoveAbsolute{.position = 200, .velocity = 500, .direction = axis::Direction::kNegative});
    b.Run(800);
    EXPECT_GE(seen, static_cast<int>(b.Module().cam_ends - before));
    EXPECT_LE(seen, static_cast<int>(b.Module().cam_ends - before) + 1);
  }
}

// CAM-24: of the selected cam, and of a whole sequence, as found by dense sampling, scaling included.
TEST(Bounds, AreThoseOfDenseSampling) {
  for (const bool sequence : {false, true}) {
    Settings s = Quick();
    s.calculate_bounds = true;
    s.master_max_velocity = 700;
    s.master_max_acceleration = 4000;
    s.cam_sequence_mode = SequenceMode::kCam1Cam3;
    Machine m = MachineOf({UpAndDown("a", 10), UpAndDown("b", 99), UpAndDown("c", -30)}, s);
    Bench b(m);
    b.Tell(Control{.cam_sequencer = sequence, .scaling_master = 1.5, .scaling_slave = 2.0});
    b.Run(50);
    ASSERT_TRUE(b.Module().bounds_valid);
    double high = -1e9, low = 1e9, velocity = 0, acceleration = 0;
    for (const char* name : {"a", "c"}) {
      if (!sequence && *name == 'c') continue;
      const cam::Table table = cam::Build(UpAndDown(name, *name == 'a' ? 10 : -30)).table.value();
      for (double x = 0; x <= 360; x += 0.001) {
        const cam::Value at = table.At(x);
        high = std::max(high, 2 * at.y);
        low = std::min(low, 2 * at.y);
        velocity = std::max(velocity, 2 * std::abs(at.dy) * 1.5 * 700);
        acceleration =
            std::max(acceleration, 2 * (std::abs(at.ddy) * std::pow(1.5 * 700, 2) + std::abs(at.dy) * 1.5 * 4000));
      }
    }
    EXPECT_NEAR(b.Module().slave_max_position, high, 1e-6);
    EXPECT_NEAR(b.Module().slave_min_position, low, 1e-6);
    EXPECT_NEAR(b.Module().slave_max_velocity, velocity, 1e-4 * velocity);
    EXPECT_NEAR(b.Module().slave_max_acceleration, acceleration, 1e-4 * acceleration);
  }
}

// CAM-40, CAM-41: x_zero takes effect at the begin of the cam, moving backwards at its end.
TEST(XZero, TakesEffectAtTheBeginning) {
  for (const double velocity : {400.0, -400.0}) {
    Bench b(MachineOf({UpAndDown("hill", 50)}, Quick()));
    b.Web(velocity);
    b.Run(300);
    ASSERT_TRUE(b.Sync());
    b.Tell(Control{.offset_slave = 4.0, .scaling_slave = 0.5});
    b.Step();
    const std::uint32_t ends = b.Module().cam_ends;
    double last = 0;
    while (b.Module().cam_ends == ends) {
      ASSERT_EQ(b.Module().set_scaling_slave, 1);
      ASSERT_EQ(b.Module().set_offset_slave, 0);
      last = b.Module().set_x_position;
      b.Step();
    }
    EXPECT_NEAR(last, velocity > 0 ? 360 : 0, 0.41);
    EXPECT_EQ(b.Module().set_scaling_slave, 0.5);
    EXPECT_EQ(b.Module().set_offset_slave, 4);
  }
}

// CAM-40: with the ramp's velocity, and without a jump; CAM-41: with a new target during the ramp, and not ended by a
// change of cam.
TEST(Ramps, GoToTheNewOffsetWithTheirOwnLimits) {
  Settings s = Quick();
  s.offset_mode_slave = OffsetMode::kRampIn;
  s.offset_scaling_slave_velocity = 40;
  s.offset_scaling_slave_acceleration = s.offset_scaling_slave_deceleration = 400;
  s.jerk = 40000;
  Bench b(MachineOf({UpAndDown("hill", 50), UpAndDown("dip", -30)}, s));
  b.Web(720);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  Watch watch(b);
  double fastest = 0;
  b.each = [&] {
    watch.Look();
    fastest = std::max(fastest, std::abs(b.Knife().set_velocity - b.Module().set_y_velocity));
  };
  b.Tell(Control{.offset_slave = 60.0});
  b.Run(300);
  b.Tell(Control{.cam_table = std::uint32_t{2}});  // in the middle of the ramp
  b.Run(700);
  EXPECT_EQ(b.Module().cam_table, 2u);
  const auto away = [&] { return b.Knife().set_position + Hill(b.Module().set_x_position, 30); };
  EXPECT_LT(away(), 50);  // still in progress
  b.Tell(Control{.offset_slave = 20.0});
  b.Run(2500);
  EXPECT_NEAR(away(), 20, 1e-8);
  EXPECT_NEAR(fastest, 40, 1e-3);
  watch.ExpectSmooth();
}

// CAM-40: after a ramp of the factor either the whole position is scaled, or the motion since then.
TEST(Ramps, OfFactorsAbsoluteAndRelative) {
  for (const ScalingMode mode : {ScalingMode::kRampAbsolute, ScalingMode::kRampRelative}) {
    Settings s = Quick();
    s.scaling_mode_slave = mode;
    Bench b(MachineOf({UpAndDown("hill", 50)}, s));
    b.Web(720);
    b.Run(300);
    ASSERT_TRUE(b.Sync());
    Watch watch(b);
    b.Tell(Control{.scaling_slave = 0.4});
    b.Run(3000);
    const double base = b.Knife().set_position - 0.4 * Hill(b.Module().set_x_position);
    if (mode == ScalingMode::kRampAbsolute) {
      EXPECT_NEAR(base, 0, 1e-8);
    }
    b.Run(333);
    EXPECT_NEAR(b.Knife().set_position - 0.4 * Hill(b.Module().set_x_position), base, 1e-8);
    watch.ExpectSmooth();
  }
}

// CAM-42
TEST(Factors, DoNotChangeTheCycleLength) {
  Settings s = Quick();
  s.scaling_mode_master = ScalingMode::kRampRelative;
  Bench b(MachineOf({UpAndDown("hill", 50)}, s));
  b.Web(720);
  b.Run(300);
  ASSERT_TRUE(b.Sync());
  b.Tell(Control{.scaling_master = 2.0, .scaling_slave = 3.0});
  b.Run(2000);
  const std::uint32_t ends = b.Module().cam_ends;
  b.Run(10000);
  EXPECT_NEAR(b.Module().cam_ends - ends, 40, 1);  // 2 * 720 x a second, 360 a cycle
  EXPECT_LE(b.Module().set_x_position, 360);
}

// CAM-40: at the begin of a cam with a stroke a factor causes no motion.
TEST(XZero, MovesNothingOnACamWithAStroke) {
  for (const double velocity : {400.0, -400.0}) {
    Bench b(MachineOf({Onward("index", 100)}, Quick()));
    b.Web(velocity);
    b.Run(300);
    ASSERT_TRUE(b.Sync());
    Watch watch(b);
    b.Run(2000);
    b.Tell(Control{.scaling_slave = 3.0});
    b.each = [&] {
      watch.Look();
      ASSERT_TRUE(b.Knife().in_step);
    };
    b.Run(3000);
    EXPECT_EQ(b.Module().set_scaling_slave, 3);
    watch.ExpectSmooth();
  }
}

// A held end of a cam is left as soon as another cam is requested.
TEST(Once, IsLeftByWhateverIsAskedFor) {
  Settings s = Quick();
  s.cam_cyclic = false;
  const auto held = [&](Bench& b) {
    ASSERT_TRUE(b.Sync());
    b.Web(360);
    ASSERT_TRUE(b.Until([&] { return b.Module().cam_ends == 1; }, 3000));
    b.Run(100);
    ASSERT_EQ(b.Module().set_y_velocity, 0);
  };
  const Command ways[] = {Configure{.cam_cyclic = true}, SetCam{1, Name::Of("dip")},
                          Control{.cam_table = std::uint32_t{2}}, ChangeCam{2}};
  for (const Command& way : ways) {
    Bench b(MachineOf({UpAndDown("hill", 50), UpAndDown("dip", -30)}, s));
    held(b);
    const Ticket ticket = b.Tell(way);
    b.Run(100);
    EXPECT_EQ(b.Of(ticket), FeedbackState::kDone) << way.index();
    EXPECT_NE(b.Module().set_y_velocity, 0) << way.index();
  }
}

}  // namespace
}  // namespace takt::flexcam
