// A motion on top of another: what each of both still is, and what the axis does with their sum. AX-35.
#include "takt/axis/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../core/trials.h"
#include "rig.h"
#include "takt/cam/build.h"

namespace takt::axis {
namespace {

AxisParams Params(double jerk = 0) {
  AxisParams p = LinearParams();
  p.limits = {.velocity = 500, .acceleration = 5000, .deceleration = 5000, .jerk = jerk, .lower = {}, .upper = {}};
  return p;
}

class Overlay : public testing::Test {
 protected:
  explicit Overlay(AxisParams p = Params()) : rig(std::move(p)) { EXPECT_TRUE(rig.PowerOn()); }

  // Whether every set point so far keeps the axis' limits and continues the one before.
  void ExpectLimits() {
    const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), rig.cycle.period_s);
    EXPECT_LE(worst.velocity, 1 + 1e-9);
    EXPECT_LE(worst.acceleration, 1 + 1e-9);
    EXPECT_LE(worst.jerk, 1 + 1e-6);
    EXPECT_LE(worst.position_step, 1 + 1e-6);
  }
  double Seconds(Ticket ticket) {
    return static_cast<double>(rig.lives[ticket].final_cycle - rig.lives[ticket].active_cycle + 1) * rig.cycle.period_s;
  }

  Rig rig;
};

// Without a jerk limit, by hand. The base: 200 u at 100 u/s and 1000 u/s² takes 200/100 + 100/1000 = 2.1 s. On top of
// it 30 u at 50 u/s and 500 u/s²: 30/50 + 50/500 = 0.7 s.
TEST_F(Overlay, AddsItsDistanceInItsOwnTimeAndLeavesTheMotionBeneathItsTime) {
  const Ticket base =
      rig.Give(MoveAbsolute{.position = 200, .velocity = 100, .acceleration = 1000, .deceleration = 1000});
  rig.Run(1);
  EXPECT_NEAR(rig.position(), 95, 1e-9);  // 100 (1 - 0.1 / 2)
  const Ticket top =
      rig.Give(MoveSuperimposed{.distance = 30, .velocity_difference = 50, .acceleration = 500, .deceleration = 500});
  rig.Run(0.3);
  EXPECT_NEAR(rig.out.set_velocity, 150, 1e-9);
  EXPECT_NEAR(rig.position(), 125 + 50 * (0.3 - 0.05), 1e-9);
  EXPECT_NEAR(rig.out.covered_distance, 12.5, 1e-9);
  EXPECT_TRUE(rig.out.superimposed);
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_TRUE(rig.lives[top].done);
  EXPECT_NEAR(Seconds(top), 0.7, 1e-9);
  EXPECT_NEAR(rig.lives[top].events.back().value, 30, 1e-9);
  EXPECT_FALSE(rig.lives[base].done);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  EXPECT_EQ(rig.out.active_command, base);
  EXPECT_TRUE(rig.RunToEnd(base));
  EXPECT_NEAR(Seconds(base), 2.1, 1e-9);
  EXPECT_EQ(rig.position(), 230);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  ExpectLimits();
}

// In Standstill it acts like MC_MoveRelative: 10 u at 100 u/s and 1000 u/s² take 0.2 s.
TEST_F(Overlay, MovesAStandingAxis) {
  const Ticket top = rig.Give(
      MoveSuperimposed{.distance = -10, .velocity_difference = 100, .acceleration = 1000, .deceleration = 1000});
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_NEAR(Seconds(top), 0.2, 1e-9);
  EXPECT_EQ(rig.position(), -10);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_FALSE(rig.out.superimposed);
}

TEST_F(Overlay, GoesOnAfterTheMotionBeneathHasEnded) {
  const Ticket base =
      rig.Give(MoveAbsolute{.position = 50, .velocity = 100, .acceleration = 1000, .deceleration = 1000});
  const Ticket top =
      rig.Give(MoveSuperimposed{.distance = 20, .velocity_difference = 10, .acceleration = 100, .deceleration = 100});
  EXPECT_TRUE(rig.RunToEnd(base));
  EXPECT_NEAR(Seconds(base), 0.6, 1e-9);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  EXPECT_EQ(rig.out.active_command, 0u);
  EXPECT_NEAR(rig.out.set_velocity, 10, 1e-9);
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_NEAR(Seconds(top), 2.1, 1e-9);
  EXPECT_EQ(rig.position(), 70);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

TEST_F(Overlay, AbsoluteMovesAfterItEndWhereTheySay) {
  rig.RunToEnd(rig.Give(MoveSuperimposed{.distance = 20}));
  rig.RunToEnd(rig.Give(MoveAbsolute{.position = 50}));
  EXPECT_EQ(rig.position(), 50);
}

// A buffered command does not abort it, and ends so much further on if it began meanwhile.
TEST_F(Overlay, StaysOnTopOfABufferedMove) {
  const Ticket base =
      rig.Give(MoveAbsolute{.position = 50, .velocity = 100, .acceleration = 1000, .deceleration = 1000});
  const Ticket next = rig.Give(MoveAbsolute{.position = 100,
                                            .velocity = 100,
                                            .acceleration = 1000,
                                            .deceleration = 1000,
                                            .buffer_mode = BufferMode::kBuffered});
  rig.Run(0.3);
  const Ticket top =
      rig.Give(MoveSuperimposed{.distance = 20, .velocity_difference = 40, .acceleration = 1000, .deceleration = 1000});
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_TRUE(rig.lives[top].done);
  EXPECT_TRUE(rig.RunToEnd(next));
  EXPECT_EQ(rig.lives[next].final_cycle - rig.lives[base].final_cycle, 600u);
  EXPECT_EQ(rig.position(), 120);
  ExpectLimits();
}

// A buffered command begins when nothing is in control beneath, whenever it was given.
TEST_F(Overlay, KeepsNoOneWaiting) {
  for (const bool late : {false, true}) {
    SCOPED_TRACE(late);
    const double begin = rig.position();
    const Ticket base = rig.Give(MoveRelative{.distance = 50});
    const Ticket top = rig.Give(MoveSuperimposed{.distance = 20, .velocity_difference = 1});
    rig.Step();
    if (late) {
      ASSERT_TRUE(rig.RunToEnd(base));
    }
    const Ticket next = rig.Give(MoveRelative{.distance = -50, .buffer_mode = BufferMode::kBuffered});
    rig.Run(3);
    EXPECT_TRUE(rig.lives[next].done);
    EXPECT_FALSE(rig.Ended(top));
    EXPECT_TRUE(rig.RunToEnd(top, 30));
    EXPECT_NEAR(rig.position(), begin + 20, 1e-9);
    ExpectLimits();
  }
}

// An aborting one aborts both; what was covered stays.
TEST_F(Overlay, IsAbortedWithTheMotionBeneath) {
  const Ticket base = rig.Give(MoveAbsolute{.position = 200, .velocity = 100});
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 50, .velocity_difference = 50});
  rig.Run(0.5);
  const Ticket next = rig.Give(MoveAbsolute{.position = 150, .velocity = 100});
  rig.Step();
  EXPECT_TRUE(rig.lives[base].aborted);
  EXPECT_TRUE(rig.lives[top].aborted);
  EXPECT_GT(rig.lives[top].events.back().value, 20);
  EXPECT_TRUE(rig.RunToEnd(next));
  EXPECT_EQ(rig.position(), 150);
  ExpectLimits();
}

// A second one takes over from the first alone: what the first had covered stays.
TEST_F(Overlay, IsReplacedByASecondOne) {
  const Ticket base =
      rig.Give(MoveAbsolute{.position = 200, .velocity = 100, .acceleration = 1000, .deceleration = 1000});
  rig.Run(0.5);
  const Ticket first =
      rig.Give(MoveSuperimposed{.distance = 50, .velocity_difference = 50, .acceleration = 500, .deceleration = 500});
  rig.Run(0.3);
  const double covered = rig.out.covered_distance;
  EXPECT_NEAR(covered, 12.5, 1e-9);
  const Ticket second =
      rig.Give(MoveSuperimposed{.distance = -5, .velocity_difference = 50, .acceleration = 500, .deceleration = 500});
  rig.Step();
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_NEAR(rig.lives[first].events.back().value, covered, 1e-9);
  EXPECT_FALSE(rig.lives[base].aborted);
  EXPECT_LT(rig.out.covered_distance, 0.1);
  EXPECT_TRUE(rig.RunToEnd(second));
  EXPECT_TRUE(rig.lives[second].done);
  EXPECT_TRUE(rig.RunToEnd(base));
  EXPECT_NEAR(Seconds(base), 2.1, 1e-9);
  EXPECT_NEAR(rig.position(), 200 + covered - 5, 1e-9);
  ExpectLimits();
}

// 50 u/s at 250 u/s²: 0.2 s and 5 u.
TEST_F(Overlay, IsHaltedAlone) {
  const Ticket base = rig.Give(MoveVelocity{.velocity = 100, .acceleration = 1000, .deceleration = 1000});
  rig.Run(0.5);
  const Ticket top =
      rig.Give(MoveSuperimposed{.distance = 50, .velocity_difference = 50, .acceleration = 500, .deceleration = 500});
  rig.Run(0.3);
  const double begin = rig.position();
  const Ticket halt = rig.Give(HaltSuperimposed{.deceleration = 250});
  EXPECT_TRUE(rig.RunToEnd(halt));
  EXPECT_TRUE(rig.lives[top].aborted);
  EXPECT_TRUE(rig.lives[halt].done);
  EXPECT_NEAR(Seconds(halt), 0.2, 1e-9);
  EXPECT_NEAR(rig.lives[halt].events.back().value, 5, 1e-9);
  EXPECT_NEAR(rig.position(), begin + 0.2 * 100 + 5, 1e-9);
  EXPECT_NEAR(rig.out.set_velocity, 100, 1e-9);
  EXPECT_EQ(rig.out.active_command, base);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
}

TEST_F(Overlay, WithoutOneThereIsNothingToHalt) {
  const Ticket halt = rig.Give(HaltSuperimposed{});
  rig.Step();
  EXPECT_TRUE(rig.lives[halt].done);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

TEST_F(Overlay, IsRefusedWhereNothingMayMove) {
  const auto refused = [&](const Command& command) {
    const Ticket ticket = rig.Give(command);
    rig.Step();
    return rig.lives[ticket].error_id;
  };
  const Ticket stop = rig.Give(Stop{.hold = true});
  EXPECT_EQ(refused(MoveSuperimposed{.distance = 1}), ErrorId::kAxisStopping);
  EXPECT_EQ(refused(HaltSuperimposed{}), ErrorId::kAxisStopping);
  rig.Let(stop);
  rig.Run(0.1);
  rig.Give(StepRefPulse{.velocity = 1});
  EXPECT_EQ(refused(MoveSuperimposed{.distance = 1}), ErrorId::kState);
  rig.inputs.drive_fault = true;
  rig.Step();
  EXPECT_EQ(refused(MoveSuperimposed{.distance = 1}), ErrorId::kErrorStop);
  rig.inputs.drive_fault = false;
  rig.RunToEnd(rig.Give(Reset{}));
  EXPECT_EQ(refused(MoveSuperimposed{.distance = 1}), ErrorId::kPowerOff);
}

TEST_F(Overlay, IsRefusedWhereItsEndLiesBehindALimit) {
  rig.params.limits.upper = 100;
  const Ticket base = rig.Give(MoveAbsolute{.position = 90, .velocity = 50});
  rig.Run(0.2);
  const Ticket too_far = rig.Give(MoveSuperimposed{.distance = 10.1});
  rig.Step();
  EXPECT_EQ(rig.lives[too_far].error_id, ErrorId::kTargetBehindLimit);
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 10});
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_TRUE(rig.RunToEnd(base));
  EXPECT_EQ(rig.position(), 100);
}

// The velocity that the axis has beside that of the motion beneath is all there is.
TEST_F(Overlay, TakesNoMoreVelocityThanIsLeft) {
  rig.Give(MoveVelocity{.velocity = 480});
  rig.Run(1);
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 10});
  rig.Run(0.1);
  EXPECT_NEAR(rig.out.set_velocity, 500, 1e-9);
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_NEAR(Seconds(top), 10.0 / 20 + 20.0 / 5000, 1e-3 + 1e-9);
  ExpectLimits();
}

// Nothing is left: it waits, says so, and is done as soon as there is room.
TEST_F(Overlay, WaitsWhereNothingIsLeft) {
  rig.Give(MoveVelocity{.velocity = 500});
  rig.Run(1);
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 10});
  rig.Run(1);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kVelocity);
  EXPECT_NEAR(rig.out.covered_distance, 0, 1e-9);
  rig.Give(HaltSuperimposed{});
  rig.Run(0.1);
  EXPECT_TRUE(rig.lives[top].aborted);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
  rig.Give(MoveSuperimposed{.distance = -10, .velocity_difference = 100});
  rig.Run(1);
  EXPECT_FALSE(rig.out.superimposed);
  ExpectLimits();
}

// Tables over time are shifted as a whole: of positions, and what velocities add up to.
TEST_F(Overlay, ShiftsATableOverTime) {
  cam::CamParams bump;
  bump.name = "bump";
  bump.points = {{0, 0, 0.0, 0.0}, {1, 1, 0.0, 0.0}, {2, 0, 0.0, 0.0}};
  rig.cams = {cam::Build(bump).table.value()};
  const MoveSuperimposed shift = {.distance = -7, .velocity_difference = 50, .acceleration = 500, .deceleration = 500};
  const Ticket positions = rig.Give(PositionProfile{.profile = Name::Of("bump"), .position_scale = 40});
  rig.Run(0.3);
  const Ticket top = rig.Give(shift);
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_NEAR(Seconds(top), 7.0 / 50 + 50.0 / 500, 1e-3 + 1e-9);
  rig.Run(0.3);
  const double t = static_cast<double>(rig.cycle.count - rig.lives[positions].active_cycle) * rig.cycle.period_s;
  EXPECT_NEAR(rig.position(), 40 * rig.cams[0].At(t).y - 7, 1e-9);
  EXPECT_TRUE(rig.RunToEnd(positions));
  EXPECT_TRUE(rig.lives[positions].done);
  EXPECT_NEAR(rig.position(), -7, 1e-9);
  const Ticket velocities = rig.Give(VelocityProfile{.profile = Name::Of("bump"), .velocity_scale = 40});
  rig.Run(0.5);
  EXPECT_TRUE(rig.RunToEnd(rig.Give(shift)));
  EXPECT_TRUE(rig.RunToEnd(velocities));
  EXPECT_NEAR(rig.position(), -7 - 7 + 40 * 1, 1e-9);  // the mean of the table is 1/2, over 2 s
  ExpectLimits();
}

// A move that passes its velocity on must be able to stop inside the SW limits wherever that happens: what is on top
// stays there until that is so.
TEST_F(Overlay, StaysOnTopUntilTheNextMoveFits) {
  rig.params.limits.upper = 130;
  const Ticket base = rig.Give(MoveAbsolute{.position = 100, .velocity = 200});
  const Ticket next = rig.Give(MoveAbsolute{.position = 110, .velocity = 200, .buffer_mode = BufferMode::kBlendingLow});
  rig.Step();
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 15});
  EXPECT_TRUE(rig.RunToEnd(base));
  EXPECT_TRUE(rig.RunToEnd(next));
  EXPECT_TRUE(rig.RunToEnd(top));
  EXPECT_TRUE(rig.lives[next].done);
  EXPECT_TRUE(rig.lives[top].done);
  EXPECT_LE(rig.position(), 130);
  ExpectLimits();
}

// AX-51: both are held, and go on to where they went; what moves anew while they are waits, too.
TEST_F(Overlay, IsHeldByAnOverride) {
  const Ticket base = rig.Give(MoveAbsolute{.position = 100, .velocity = 100});
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 50, .velocity_difference = 50});
  rig.Run(0.2);
  rig.Give(SetOverride{.velocity_factor = 0});
  rig.Run(2);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  EXPECT_TRUE(rig.out.superimposed);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kOverride);
  EXPECT_FALSE(rig.Ended(base) || rig.Ended(top));
  const double held = rig.position();
  const Ticket other = rig.Give(MoveSuperimposed{.distance = -20, .velocity_difference = 50});
  rig.Run(1);
  EXPECT_EQ(rig.position(), held);
  EXPECT_TRUE(rig.lives[top].aborted);
  rig.Give(SetOverride{.velocity_factor = 1});
  EXPECT_TRUE(rig.RunToEnd(base));
  EXPECT_TRUE(rig.RunToEnd(other));
  EXPECT_TRUE(rig.lives[base].done && rig.lives[other].done);
  EXPECT_NEAR(rig.position(), 100 + rig.lives[top].events.back().value - 20, 1e-9);
  ExpectLimits();
}

// AX-51, AX-97: half as fast at once, with weak ramps no further than before. Also on top of what is not overridden.
TEST_F(Overlay, IsOverriddenOnTopOfAGoingMotion) {
  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(0.5);
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 60, .velocity_difference = 80});
  rig.Run(0.5);
  EXPECT_NEAR(rig.out.set_velocity, 180, 1e-9);
  rig.Give(SetOverride{.velocity_factor = 0.5});
  rig.Run(0.2);
  EXPECT_NEAR(rig.out.set_velocity, 50 + 40, 1e-9);
  rig.Run(0.2);
  rig.Give(SetOverride{.velocity_factor = 0.5, .acceleration_factor = 1e-3});
  double furthest = 0;
  while (!rig.Ended(top)) {
    rig.Step();
    furthest = std::max(furthest, rig.out.covered_distance);
  }
  EXPECT_TRUE(rig.lives[top].done);
  EXPECT_LE(furthest, 60 + 1e-6);
  ExpectLimits();
}

// Other numbers for where the axis is change neither motion.
TEST_F(Overlay, KeepsItsWayUnderOtherNumbers) {
  rig.Give(MoveAbsolute{.position = 100, .velocity = 100});
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 10, .velocity_difference = 20});
  rig.Run(0.3);
  const double before = rig.position();
  rig.Give(SetPosition{.position = 1000, .relative = true});
  rig.Step();
  EXPECT_NEAR(rig.position(), before + 1000 + 0.12, 1e-9);
  EXPECT_TRUE(rig.RunToEnd(top));
  rig.Run(2);
  EXPECT_NEAR(rig.position(), 1110, 1e-9);
}

TEST_F(Overlay, EndsWithAFault) {
  rig.Give(MoveAbsolute{.position = 100, .velocity = 100});
  const Ticket top = rig.Give(MoveSuperimposed{.distance = 10, .velocity_difference = 20});
  rig.Run(0.3);
  rig.inputs.limit_positive = true;
  rig.Run(0.3);
  EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
  EXPECT_EQ(rig.lives[top].error_id, ErrorId::kLimitSwitchPositive);
  EXPECT_EQ(rig.out.set_velocity, 0);
  ExpectLimits();
}

// Random motions with an end, one after the other, and random ones on top of them.
class OverlayProperty : public testing::TestWithParam<unsigned> {
 protected:
  double Between(double low, double high) { return std::uniform_real_distribution(low, high)(random); }
  bool Chance(double share) { return Between(0, 1) < share; }

  AxisParams Drawn() {
    AxisParams p = LinearParams();
    p.limits = {.velocity = Between(50, 800),
                .acceleration = Between(500, 20000),
                .deceleration = {},
                .jerk = 0,
                .lower = {},
                .upper = {}};
    p.limits.deceleration = Chance(0.5) ? p.limits.acceleration : Between(500, 20000);
    if (Chance(0.7)) p.limits.jerk = Between(1e4, 1e6);
    return p;
  }
  // A share of each of the axis' limits; nothing: all of it.
  std::optional<double> Part(double own) {
    if (Chance(0.3)) return {};
    return own > 0 ? Between(0.05, 1) * own : Between(1e4, 1e6);
  }
  template <typename T>
  T WithRamps(T command, const AxisParams& p) {
    command.acceleration = Part(p.limits.acceleration);
    command.deceleration = Part(*p.limits.deceleration);
    command.jerk = Part(p.limits.jerk);
    return command;
  }

  std::mt19937_64 random{GetParam()};
};

// Limits hold at every set point, also where the end of everything lies just at a SW limit; the moves beneath are done
// in the cycle in which they are done alone; the axis ends at their end plus all that was covered.
TEST_P(OverlayProperty, LimitsHoldAndBothEndsAreReached) {
  const AxisParams p = Drawn();
  Rig alone(p);
  Rig both(p);
  for (Rig* rig : {&alone, &both}) ASSERT_TRUE(rig->PowerOn());
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    const double begin = both.position();
    const double shift = begin - alone.position();
    std::vector<Ticket> moves;
    std::vector<double> ends{begin};
    for (int i = Chance(0.3) ? 2 : 1; i > 0; --i) {
      MoveRelative move =
          WithRamps(MoveRelative{.distance = Between(-200, 200), .velocity = Part(p.limits.velocity)}, p);
      if (!moves.empty()) move.buffer_mode = static_cast<BufferMode>(random() % 5 + 1);
      const Ticket ticket = alone.Give(move);
      ASSERT_EQ(both.Give(move), ticket);
      moves.push_back(ticket);
      ends.push_back(ends.back() + move.distance);
    }
    // What is put on top, and when.
    double highest = *std::max_element(ends.begin(), ends.end());
    double lowest = *std::min_element(ends.begin(), ends.end());
    const int count = Chance(0.3) ? 2 : 1;
    std::vector<Ticket> tops;
    std::vector<double> distances;
    for (int i = 0; i < count; ++i) distances.push_back(Between(-30, 30));
    double reach_up = 0;
    double reach_down = 0;
    for (const double d : distances) (d > 0 ? reach_up : reach_down) += d;
    const bool tight = Chance(0.5);
    const bool halts = Chance(0.2);
    if (tight) {
      both.params.limits.upper = highest + reach_up + 1e-9 * std::abs(highest);
      both.params.limits.lower = lowest + reach_down - 1e-9 * std::abs(lowest);
    }
    for (const double d : distances) {
      const int wait = static_cast<int>(Between(0, 400));
      for (int i = 0; i < wait; ++i) {
        alone.Step();
        both.Step();
      }
      MoveSuperimposed top = WithRamps(MoveSuperimposed{.distance = d}, p);
      top.velocity_difference = Part(p.limits.velocity);
      alone.Give(ReadParameter{1});  // tickets stay the same
      tops.push_back(both.Give(top));
    }
    if (halts) {
      for (int i = static_cast<int>(Between(0, 200)); i > 0; --i) {
        alone.Step();
        both.Step();
      }
      HaltSuperimposed halt;
      halt.deceleration = Part(*p.limits.deceleration);
      halt.jerk = Part(p.limits.jerk);
      alone.Give(ReadParameter{1});
      tops.push_back(both.Give(halt));
    }
    for (int i = 0; i < 100000; ++i) {
      alone.Step();
      both.Step();
      if (both.out.state == PlcState::kStandstill && alone.out.state == PlcState::kStandstill) break;
    }
    const Worst worst = WorstOf(both.trace, p.planner_limits(), both.cycle.period_s);
    ASSERT_EQ(both.out.state, PlcState::kStandstill);
    // What is replaced or halted on its way may come to rest further on than it was to: too far for what comes after
    // it.
    const auto too_far = [&](Ticket ticket) { return both.lives[ticket].error_id == ErrorId::kTargetBehindLimit; };
    const bool refused = std::any_of(moves.begin(), moves.end(), too_far) || too_far(tops.back());
    EXPECT_TRUE(!refused || (tight && tops.size() > 1));
    if (!refused) {
      for (const Ticket ticket : moves) {
        EXPECT_TRUE(both.lives[ticket].done);
        EXPECT_EQ(both.lives[ticket].final_cycle, alone.lives[ticket].final_cycle);
      }
      EXPECT_TRUE(both.lives[tops.back()].done);
      double added = 0;
      for (const Ticket ticket : tops) added += both.lives[ticket].events.back().value;
      EXPECT_NEAR(both.position(), alone.position() + shift + added, 1e-8);
      if (tops.size() == 1) {
        EXPECT_NEAR(added, distances[0], 1e-8);
      }
    }
    EXPECT_LE(worst.velocity, 1 + 1e-8);
    EXPECT_LE(worst.acceleration, 1 + 1e-8);
    EXPECT_LE(worst.jerk, 1 + 1e-5);
    EXPECT_LE(worst.position_step, 1 + 1e-6);
    if (tight) {
      for (const Sample& sample : both.trace) {
        ASSERT_LE(sample.setpoint.position, *both.params.limits.upper + 1e-6);
        ASSERT_GE(sample.setpoint.position, *both.params.limits.lower - 1e-6);
      }
    }
    ASSERT_EQ(both.state.illegal_transitions, 0u);
    both.params.limits.upper.reset();
    both.params.limits.lower.reset();
    alone.trace.clear();
    both.trace.clear();
    if (HasFailure()) FAIL();
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, OverlayProperty, testing::Range(0u, static_cast<unsigned>(Trials(100, 50))));

}  // namespace
}  // namespace takt::axis
