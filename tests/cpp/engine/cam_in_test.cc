// Cams between axes: AX-48, AX-55.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "cam_rig.h"

namespace takt::engine {
namespace {

using axis::PlcState;

// AX-48: at a constant speed of the master, position, velocity and acceleration are those of the polynomial.
TEST(CamIn, IsTheClosedForm) {
  Line line(WithCams(LineOf(2)));
  const Ticket cam = line.Give(1, Cam("a0", "lift"));
  line.Run(2);
  EXPECT_TRUE(line.reached[cam]);  // both are at 0
  EXPECT_EQ(line.At(1).state, PlcState::kSynchronizedMotion);
  EXPECT_EQ(line.At(1).master1, 1u);
  line.Give(0, axis::MoveAbsolute{.position = 120, .velocity = 80});
  bool constant = false;
  for (int i = 0; i < 2500; ++i) {
    line.Step();
    const double m = line.At(0).set_position;
    const double v = line.At(0).set_velocity;
    const double a = line.At(0).set_acceleration;
    const double s = std::min(m / 100, 1.0);
    const double inside = m <= 100 ? 1 : 0;
    constant |= a == 0 && v == 80;
    ASSERT_TRUE(line.At(1).in_step);
    ASSERT_NEAR(line.At(1).set_position, 20 * Polynomial345::Y(s), 1e-9);
    ASSERT_NEAR(line.At(1).set_velocity, inside * 0.2 * Polynomial345::Dy(s) * v, 1e-9);
    ASSERT_NEAR(line.At(1).set_acceleration,
                inside * (0.002 * Polynomial345::Ddy(s) * v * v + 0.2 * Polynomial345::Dy(s) * a), 1e-9);
  }
  EXPECT_TRUE(constant);
  EXPECT_EQ(line.At(1).set_position, 20);
}

// AX-48: absolute and relative, on both sides, in both directions, scaled and shifted.
class CamInAbsoluteRelative : public testing::TestWithParam<std::tuple<bool, bool, bool, axis::CamStart>> {};

TEST_P(CamInAbsoluteRelative, LiesWhereItIsSaidTo) {
  const auto [master_absolute, slave_absolute, up, start] = GetParam();
  Line line(WithCams(LineOf(2)));
  line.Give(0, axis::MoveAbsolute{.position = 30});
  line.Give(1, axis::MoveAbsolute{.position = 7});
  line.Run(1000);
  axis::CamIn cam = Cam("a0", "feed");
  cam.master_absolute = master_absolute;
  cam.slave_absolute = slave_absolute;
  cam.start_mode = start;
  cam.master_scaling = 2;
  cam.slave_scaling = 0.5;
  cam.master_offset = 5;
  cam.slave_offset = 1;
  const Ticket ticket = line.Give(1, cam);
  line.Run(500);
  EXPECT_TRUE(line.reached[ticket]);
  const double m0 = master_absolute ? 0 : 30;
  const double x0 = 2 * (30 - m0) + 5;  // begin of the cam
  const bool shifted = !slave_absolute || start == axis::CamStart::kRelative;
  const double y0 = shifted ? 7 + 1 - 0.5 * FeedAt(x0) : 1;
  EXPECT_NEAR(line.At(1).set_position, y0 + 0.5 * FeedAt(x0), 1e-9);
  line.Give(0, axis::MoveAbsolute{.position = up ? 330.0 : -270.0, .velocity = 100});
  for (int i = 0; i < 4000; ++i) {
    line.Step();
    ASSERT_TRUE(line.At(1).in_step);
    ASSERT_NEAR(line.At(1).set_position, y0 + 0.5 * FeedAt(2 * (line.At(0).set_position - m0) + 5), 1e-9);
  }
  EXPECT_EQ(line.At(0).set_position, up ? 330 : -270);
  EXPECT_EQ(line.At(1).profile_ends, 6u);
}
INSTANTIATE_TEST_SUITE_P(All, CamInAbsoluteRelative,
                         testing::Combine(testing::Bool(), testing::Bool(), testing::Bool(),
                                          testing::Values(axis::CamStart::kAbsolute, axis::CamStart::kRelative,
                                                          axis::CamStart::kRampIn)));

// AX-48: with the cam placed for a master at a large position, an absolute slave is in the cam's first cycle.
TEST(CamIn, BeginsInItsFirstCycle) {
  Line line(WithCams(LineOf(2)));
  line.Give(0, axis::MoveAbsolute{.position = -930});
  line.Run(3000);
  line.Give(1, Cam("a0", "feed"));
  line.Run(500);
  EXPECT_NEAR(line.At(1).set_position, FeedAt(70), 1e-9);
}

// AX-48: true for exactly one cycle when the end is reached, or moving backwards the beginning; not when it is left.
TEST(CamIn, SaysWhenItsEndIsPassed) {
  Line line(WithCams(LineOf(2)));
  line.Give(1, Cam("a0", "stroke"));
  const auto ends = [&](double to) {
    const Ticket move = line.Give(0, axis::MoveAbsolute{.position = to, .velocity = 200});
    std::vector<double> where;
    for (int i = 0; i < 3000; ++i) {
      const double before = line.At(0).set_position;
      line.Step();
      if (!line.At(1).end_of_profile) continue;
      where.push_back(line.At(0).set_position);
      EXPECT_LT(std::abs(line.At(0).set_position - before), 0.21);
      EXPECT_LE(std::abs(where.back() - 100 * std::round(where.back() / 100)), 0.2);
    }
    EXPECT_EQ(line.last[move].state, FeedbackState::kDone);
    return where.size();
  };
  EXPECT_EQ(ends(200), 2u);  // the second one exactly at its target
  EXPECT_EQ(ends(230), 0u);  // left, not reached
  EXPECT_EQ(ends(170), 1u);  // the beginning, moving down
  EXPECT_EQ(ends(100), 1u);
  EXPECT_EQ(ends(150), 0u);
  EXPECT_EQ(ends(-100), 3u);  // 100, 0, -100
  EXPECT_EQ(line.At(1).profile_ends, 7u);
}

// AX-48: once, with its end positions held on both sides.
TEST(CamIn, HoldsItsEndsIfItIsNotPeriodic) {
  Line line(WithCams(LineOf(2)));
  axis::CamIn cam = Cam("a0", "feed");
  cam.periodic = false;
  line.Give(1, cam);
  const auto go = [&](double to) {
    line.Give(0, axis::MoveAbsolute{.position = to, .velocity = 200});
    line.Run(3000);
    EXPECT_TRUE(line.At(1).in_step);
    return line.At(1).set_position;
  };
  EXPECT_EQ(go(250), 20);
  EXPECT_EQ(line.At(1).profile_ends, 1u);
  EXPECT_NEAR(go(50), 10, 1e-9);
  EXPECT_EQ(go(-50), 0);
  EXPECT_EQ(line.At(1).profile_ends, 2u);
}

// AX-48, AX-13: a slave at another position approaches a moving cam within the limits of the command.
TEST(CamIn, RampsIn) {
  Line line(WithCams(LineOf(2)));
  line.Give(0, axis::MoveVelocity{.velocity = 50});
  line.Give(1, axis::MoveAbsolute{.position = -60});
  line.Run(1000);
  axis::CamIn cam = Cam("a0", "stroke");
  cam.velocity = 80;
  cam.acceleration = 900;
  cam.deceleration = 1000;
  cam.jerk = 30000;
  const Ticket ticket = line.Give(1, cam);
  double fastest = 0;
  double strongest = 0;
  axis::Outputs before = line.At(1);
  int cycles = 0;
  while (!line.reached[ticket] && cycles < 5000) {
    line.Step();
    ++cycles;
    fastest = std::max(fastest, std::abs(line.At(1).set_velocity));
    strongest = std::max(strongest, std::abs(line.At(1).set_acceleration));
    ASSERT_LE(std::abs(line.At(1).set_acceleration - before.set_acceleration), 100000 * 0.001 + 1e-6);
    before = line.At(1);
  }
  EXPECT_TRUE(line.reached[ticket]);
  EXPECT_LE(fastest, 81);  // the cam's own acceleration meanwhile is not known in advance
  EXPECT_LE(strongest, 1000 + 1e-6);
  EXPECT_GT(cycles, 700);  // 60 u at 80 u/s
  for (int i = 0; i < 3000; ++i) {
    line.Step();
    ASSERT_NEAR(line.At(1).set_position, StrokeAt(line.At(0).set_position), 1e-9);
  }
}

// AX-48: synchronisation begins master_start_distance before master_sync_position, and ends there.
TEST(CamIn, IsInStepAtTheSyncPosition) {
  for (const bool absolute : {true, false}) {
    Line line(WithCams(LineOf(2)));
    line.Give(1, axis::MoveAbsolute{.position = 3});
    line.Run(500);
    axis::CamIn cam = Cam("a0", "feed");
    cam.master_absolute = absolute;
    cam.master_sync_position = 230;
    cam.master_start_distance = 60;
    const Ticket ticket = line.Give(1, cam);
    line.Give(0, axis::MoveVelocity{.velocity = 100});
    while (line.At(0).set_position < 229.9) {
      line.Step();
      ASSERT_FALSE(line.reached[ticket]);
      ASSERT_TRUE(line.At(0).set_position > 169.9 || line.At(1).set_position == 3);
    }
    line.Run(3);
    EXPECT_TRUE(line.reached[ticket]);
    const double zero = absolute ? 200 : 230;  // of the cycle in which it begins
    for (int i = 0; i < 4000; ++i) {
      line.Step();
      ASSERT_TRUE(line.At(1).in_step);
      ASSERT_NEAR(line.At(1).set_position, FeedAt(line.At(0).set_position - zero), 1e-9);
    }
  }
}

// AX-48: without a sync position the cam's next beginning counts.
TEST(CamIn, IsInStepAtItsBeginning) {
  Line line(WithCams(LineOf(2)));
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  line.Run(1500);
  axis::CamIn cam = Cam("a0", "feed");
  cam.slave_absolute = false;
  cam.master_start_distance = 30;
  cam.master_offset = -10;
  line.Give(1, axis::MoveAbsolute{.position = -5});
  line.Run(200);
  const double from = line.At(0).set_position;
  const Ticket ticket = line.Give(1, cam);
  while (!line.reached[ticket] && line.At(0).set_position < 1000) line.Step();
  const double begin = 10 + 100 * std::ceil((from + 30 - 10) / 100);
  EXPECT_NEAR(line.At(0).set_position, begin, 0.21);
  line.Run(1234);
  EXPECT_NEAR(line.At(1).set_position, -5 + FeedAt(line.At(0).set_position - begin), 1e-9);
}

// AX-48: the next cam begins exactly at the end of the previous one, without another synchronisation.
TEST(CamIn, IsFollowedByAnotherAtItsEnd) {
  for (const double sense : {1.0, -1.0}) {
    Line line(WithCams(LineOf(2)));
    const Ticket first = line.Give(1, Cam("a0", "stroke"));
    axis::CamIn next = Cam("a0", "feed");
    next.master_absolute = false;
    next.slave_absolute = false;
    next.buffer_mode = axis::BufferMode::kBuffered;
    axis::CamIn last = next;
    last.cam = Name::Of("stroke");
    last.slave_scaling = 2;
    line.Run(5);
    line.Give(0, axis::MoveVelocity{.velocity = 77,
                                    .direction = sense > 0 ? axis::Direction::kPositive : axis::Direction::kNegative});
    line.Run(100);
    const Ticket second = line.Give(1, next);
    const Ticket third = line.Give(1, last);
    line.Run(2);
    EXPECT_EQ(line.last[second].state, FeedbackState::kBusy);
    while (sense * line.At(0).set_position < 350) {
      line.Step();
      const double m = line.At(0).set_position;
      const double end = std::abs(m);
      ASSERT_TRUE(line.At(1).in_step) << m;
      const double expected = end < 100   ? StrokeAt(m)
                              : end < 200 ? FeedAt(m - sense * 100)
                                          : sense * 20 + 2 * StrokeAt(m - sense * 200);
      ASSERT_NEAR(line.At(1).set_position, expected, 1e-9) << m;
      ASSERT_EQ(line.At(1).end_of_profile, std::floor(end / 100) > std::floor((end - 0.077 - 1e-9) / 100)) << m;
    }
    EXPECT_EQ(line.last[first].state, FeedbackState::kAborted);
    EXPECT_EQ(line.last[second].state, FeedbackState::kAborted);
    EXPECT_EQ(line.last[third].state, FeedbackState::kActive);
    EXPECT_TRUE(line.reached[second]);
  }
}

// A buffered command begins at the end of a cam, whatever it is; after a cam that is over, at once.
TEST(CamIn, IsFollowedByAMove) {
  Line line(WithCams(LineOf(2)));
  line.Give(1, Cam("a0", "lift"));
  line.Give(0, axis::MoveVelocity{.velocity = 200});
  line.Run(200);
  const Ticket move = line.Give(1, axis::MoveRelative{.distance = 5, .buffer_mode = axis::BufferMode::kBuffered});
  while (line.At(0).set_position < 99) {
    line.Step();
    ASSERT_EQ(line.last[move].state, FeedbackState::kBusy);
  }
  line.Run(500);
  EXPECT_EQ(line.last[move].state, FeedbackState::kDone);
  EXPECT_NEAR(line.At(1).set_position, 25, 1e-9);
  EXPECT_EQ(line.At(1).master1, 0u);
  EXPECT_EQ(line.At(1).state, PlcState::kStandstill);

  line.Give(0, axis::MoveAbsolute{.position = 0});
  line.Run(3000);
  line.Give(1, Cam("a0", "lift"));
  line.Run(500);
  line.Give(0, axis::MoveVelocity{.velocity = 200});
  line.Run(1500);
  const Ticket late = line.Give(1, axis::MoveAbsolute{.position = 1, .buffer_mode = axis::BufferMode::kBuffered});
  line.Run(500);
  EXPECT_EQ(line.last[late].state, FeedbackState::kDone);
}

// AX-48: another CamIn takes over without a step.
TEST(CamIn, ChangesAtOnce) {
  Line line(WithCams(LineOf(2)));
  line.Give(0, axis::MoveVelocity{.velocity = 60});
  const Ticket first = line.Give(1, Cam("a0", "stroke"));
  line.Run(1500);
  axis::CamIn other = Cam("a0", "stroke");
  other.slave_scaling = -1.5;
  const Ticket second = line.Give(1, other);
  line.Run(1000);
  EXPECT_EQ(line.last[first].state, FeedbackState::kAborted);
  EXPECT_TRUE(line.reached[second]);
  EXPECT_NEAR(line.At(1).set_position, -1.5 * StrokeAt(line.At(0).set_position), 1e-9);
}

// AX-48: rotary axes: the nearest turn is used, whatever the cam's cycle.
TEST(CamIn, TakesTheNearestTurn) {
  Line line(WithCams(WithStrong(LineOf(2, axis::AxisKind::kRotary), 1, 4)));
  line.Give(0, axis::MoveVelocity{.velocity = 300});
  line.Give(1, axis::MoveVelocity{.velocity = 250});
  line.Run(5000);
  axis::CamIn cam = Cam("a0", "feed");
  cam.master_scaling = 100.0 / 360;
  cam.slave_scaling = 18;  // one turn per turn
  const Ticket ticket = line.Give(1, cam);
  line.Run(3000);
  EXPECT_TRUE(line.reached[ticket]);
  for (int i = 0; i < 3000; ++i) {
    line.Step();
    const double share = line.At(0).set_position / 360;
    const double away = line.At(1).set_position - 360 * Polynomial345::Y(share);
    ASSERT_NEAR(away - 360 * std::round(away / 360), 0, 1e-7);
  }
}

// AX-48: no drift after a million cycles of the cam. (CAM-21: 1e-6 of a cycle.)
TEST(CamIn, DoesNotDrift) {
  Machine machine = WithCams(LineOf(2, axis::AxisKind::kRotary));
  for (axis::AxisParams& a : machine.axes) {
    a.limits.velocity = 1e5;
    a.limits.acceleration = 1e8;
    a.limits.jerk = 1e12;
  }
  Line line(machine);
  axis::CamIn cam = Cam("a0", "stroke");
  cam.master_scaling = 100 / 36.7;  // a cycle of which no turn is a multiple
  cam.slave_scaling = 0.01;
  line.Give(1, cam);
  line.Give(0, axis::MoveVelocity{.velocity = 36000});
  double first = 0;  // the master's displacement
  double before = line.At(0).set_position;
  for (int i = 0; i < 1100; ++i) {
    line.Step();
    const double step = line.At(0).set_position - before;
    first += step - 360 * std::round(step / 360);
    before = line.At(0).set_position;
  }
  // From there on 36 degrees per cycle of the engine: 360/367 of the cam.
  const std::uint64_t cycles = 1020000;
  for (std::uint64_t i = 1; i <= cycles; ++i) {
    line.engine.RunCycle();
    const double share = first / 36.7 + static_cast<double>(i * 360 % 367) / 367;
    ASSERT_TRUE(line.At(1).in_step) << i;
    ASSERT_NEAR(line.At(1).set_position, 0.01 * StrokeAt(100 * share), 1e-6 * 0.75) << i;  // slope: 0.75 a cycle
  }
  EXPECT_GT(line.At(1).profile_ends, 1000000u);
}

// AX-48, AX-44: continues at its present velocity.
TEST(CamOut, LetsGo) {
  Line line(WithCams(LineOf(2)));
  line.Give(1, Cam("a0", "feed"));
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  line.Run(500);
  const double speed = line.At(1).set_velocity;
  const Ticket out = line.Give(1, axis::CamOut{});
  line.Run(400);
  EXPECT_EQ(line.last[out].state, FeedbackState::kDone);
  EXPECT_EQ(line.At(1).state, PlcState::kContinuousMotion);
  EXPECT_EQ(line.At(1).master1, 0u);
  EXPECT_NEAR(line.At(1).set_velocity, speed, 0.2 * speed);
  EXPECT_EQ(line.At(1).set_acceleration, 0);
  const Ticket again = line.Give(1, axis::CamOut{});
  line.Run(2);
  EXPECT_EQ(line.last[again].error, ErrorId::kState);
}

// AX-06, AX-48, AX-71: invalid commands are refused, and motions continue.
TEST(CamIn, IsRefused) {
  Machine machine = WithCams(LineOf(3));
  machine.axes[2].requires_reference = true;
  Line line(machine);
  line.Give(1, axis::MoveVelocity{.velocity = 10});
  line.Run(500);
  const auto error = [&](std::size_t who, const axis::Command& command) {
    const Ticket ticket = line.Give(who, command);
    line.Run(2);
    return line.last[ticket].error;
  };
  EXPECT_EQ(error(1, Cam("a0", "other")), ErrorId::kUnknownTarget);
  EXPECT_EQ(error(1, Cam("b", "feed")), ErrorId::kUnknownTarget);
  EXPECT_EQ(error(1, Cam("a1", "feed")), ErrorId::kParameter);
  axis::CamIn cam = Cam("a0", "feed");
  cam.master_scaling = 0;
  EXPECT_EQ(error(1, cam), ErrorId::kParameter);
  cam = Cam("a0", "feed");
  cam.velocity = 501;
  EXPECT_EQ(error(1, cam), ErrorId::kParameter);
  EXPECT_EQ(error(2, Cam("a0", "feed")), ErrorId::kNoReference);
  EXPECT_EQ(line.At(1).state, PlcState::kContinuousMotion);
  EXPECT_EQ(line.At(1).set_velocity, 10);
  EXPECT_EQ(error(0, axis::CamTableSelect{Name::Of("feed")}), ErrorId::kNone);
  EXPECT_EQ(error(0, axis::CamTableSelect{Name::Of("food")}), ErrorId::kUnknownTarget);
  cam = Cam("a0", "feed");
  cam.slave_absolute = false;
  EXPECT_EQ(error(2, cam), ErrorId::kNone);
}

// AX-55: cam on gear on cam, against the order of the axes, without lag; no loop; all stop together.
TEST(CamChain, HasNoLagAndStopsTogether) {
  for (std::size_t failing = 0; failing < 4; ++failing) {
    SCOPED_TRACE(failing);
    Line line(WithCams(LineOf(4)));
    line.Give(0, Cam("a1", "stroke"));
    line.Give(1, Gear("a2", 3));
    line.Give(2, Cam("a3", "stroke"));
    const Ticket loop = line.Give(3, Cam("a0", "stroke"));
    line.Run(3);
    EXPECT_EQ(line.last[loop].error, ErrorId::kCouplingLoop);
    line.Give(3, axis::MoveVelocity{.velocity = 40});
    for (int i = 0; i < 3000; ++i) {
      line.Step();
      ASSERT_NEAR(line.At(2).set_position, StrokeAt(line.At(3).set_position), 1e-9);
      ASSERT_NEAR(line.At(1).set_position, 3 * StrokeAt(line.At(3).set_position), 1e-9);
      ASSERT_NEAR(line.At(0).set_position, StrokeAt(line.At(1).set_position), 1e-9);
    }
    line.engine.faults(failing).drive_fault = true;
    line.Run(500);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(line.At(i).set_velocity, 0) << i;
    EXPECT_EQ(line.At(failing).state, PlcState::kErrorStop);
  }
}

// AX-46: the phase of a cam.
TEST(CamIn, HasAPhase) {
  Line line(WithCams(LineOf(2)));
  line.Give(1, Cam("a0", "stroke"));
  line.Give(0, axis::MoveVelocity{.velocity = 30});
  line.Run(300);
  const Ticket shift = line.Give(1, axis::PhasingRelative{.phase_shift = 12, .velocity = 20});
  line.Run(1500);
  EXPECT_EQ(line.last[shift].state, FeedbackState::kDone);
  for (int i = 0; i < 1000; ++i) {
    line.Step();
    ASSERT_NEAR(line.At(1).set_position, StrokeAt(line.At(0).set_position + 12), 1e-9);
  }
}

// AX-13: a cam that would lead beyond the SW limits stops within them.
TEST(CamIn, StaysInsideTheSoftLimits) {
  Machine machine = WithCams(LineOf(2));
  machine.axes[1].limits.upper = 15;
  Line line(machine);
  line.Give(1, Cam("a0", "lift"));
  line.Give(0, axis::MoveVelocity{.velocity = 100});
  double highest = 0;
  for (int i = 0; i < 2000; ++i) {
    line.Step();
    highest = std::max(highest, line.At(1).set_position);
  }
  EXPECT_LE(highest, 15 + 1e-9);
  EXPECT_GT(highest, 13);
  EXPECT_EQ(line.At(1).error, ErrorId::kSoftLimitPositive);
  EXPECT_EQ(line.At(0).set_velocity, 0);  // AX-55
}

}  // namespace
}  // namespace takt::engine
