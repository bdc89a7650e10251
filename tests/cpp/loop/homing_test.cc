// Homing on a simulated axis: AX-60 to AX-71. The expectations are those of tables 7.1 and 7.2 of the GT-775x manual,
// written down here anew.
#include <algorithm>
#include <random>

#include "homing_bench.h"

namespace takt::axis {
namespace {

constexpr double kUnset = 1e9;

// Where a search for a switch that is on from `low` to `high` ends by the tables, from `start`: an idealised axis that
// turns on the spot.
double Expected(HomingDirection direction, SwitchMode mode, double start, double low = 10, double high = 30) {
  const auto on = [=](double x) { return x >= low && x <= high; };
  double sense = 1;
  if (direction == HomingDirection::kNegative) sense = -1;
  if (direction == HomingDirection::kSwitchPositive) sense = on(start) ? -1 : 1;
  if (direction == HomingDirection::kSwitchNegative) sense = on(start) ? 1 : -1;
  if (sense > 0 ? start >= 100 : start <= -100) sense = -sense;
  if (mode == SwitchMode::kOn && on(start)) return start;
  if (mode == SwitchMode::kOff && !on(start)) return start;
  double x = start;
  for (int i = 0; i < 100000; ++i) {
    const double next = x + sense * 0.01;
    const bool rises = !on(x) && on(next);
    const bool falls = on(x) && !on(next);
    x = next;
    switch (mode) {
      case SwitchMode::kOn:
        if (on(x)) return x;
        break;
      case SwitchMode::kOff:
        if (!on(x)) return x;
        break;
      case SwitchMode::kEdgeOn:
        if (rises) return x;
        if (falls) sense = -sense;
        break;
      case SwitchMode::kEdgeOff:
        if (falls) return x;
        if (rises) sense = -sense;
        break;
      case SwitchMode::kEdgeSwitchPositive:
        if (sense > 0 ? rises : falls) return x;
        break;
      case SwitchMode::kEdgeSwitchNegative:
        if (sense < 0 ? rises : falls) return x;
        break;
    }
    if (sense > 0 ? x >= 100 : x <= -100) sense = -sense;
  }
  return kUnset;
}

struct Case {
  HomingDirection direction;
  SwitchMode mode;
  double start;
};

class AbsSwitch : public testing::TestWithParam<Case> {};

// AX-60, AX-69: from before, on and behind the switch and from both limits, in all directions and modes: found where
// the tables say, returned there, still in Homing.
TEST_P(AbsSwitch, IsFoundWhereTheTablesSay) {
  const Case& p = GetParam();
  Bench bench(p.start);
  bench.On();
  StepAbsSwitch step;
  step.direction = p.direction;
  step.switch_mode = p.mode;
  step.velocity = 40;
  step.set_position = 1000;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_EQ(bench.state.plc, PlcState::kHoming);
  EXPECT_FALSE(bench.seen.homed);
  // The switch is sampled once a cycle, and braking to turn round changes from where an edge is met by nothing.
  EXPECT_NEAR(bench.place(), Expected(p.direction, p.mode, p.start), 40 * 0.001 + 0.015);
  EXPECT_NEAR(bench.seen.set_position, 1000, 1e-9);
  const Ticket finish = bench.Give(FinishHoming{});
  ASSERT_TRUE(bench.RunToEnd(finish, 1));
  EXPECT_EQ(bench.last[finish].state, FeedbackState::kDone);
  EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
  EXPECT_TRUE(bench.seen.homed);
}

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  for (int direction = 0; direction < 4; ++direction) {
    for (int mode = 0; mode < 6; ++mode) {
      for (const double start : {-100.5, -50.0, 20.0, 60.0, 100.5}) {
        cases.push_back({static_cast<HomingDirection>(direction), static_cast<SwitchMode>(mode), start});
      }
    }
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Tables, AbsSwitch, testing::ValuesIn(AllCases()), [](const auto& info) {
  return "d" + std::to_string(static_cast<int>(info.param.direction)) + "m" +
         std::to_string(static_cast<int>(info.param.mode)) + "i" + std::to_string(info.index % 5);
});

class LimitSwitch : public testing::TestWithParam<Case> {};

// AX-61, AX-69: a limit switch, from anywhere between both and from on each, in all directions and modes, is no fault
// while it is searched; the axis ends where the tables say.
TEST_P(LimitSwitch, IsFoundWhereTheTablesSay) {
  const Case& p = GetParam();
  Bench bench(p.start);
  bench.On();
  StepLimitSwitch step;
  step.direction = p.direction;
  step.switch_mode = p.mode;
  step.velocity = 50;
  step.set_position = 0;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.seen.error, ErrorId::kNone);
  const bool upper = p.direction == HomingDirection::kPositive || p.direction == HomingDirection::kSwitchPositive;
  const double expected = Expected(p.direction, p.mode, p.start, upper ? 100 : -kUnset, upper ? kUnset : -100);
  if (expected == kUnset) {  // a limit switch has no edge of that kind: given up at its third end
    EXPECT_EQ(bench.last[ticket].error, ErrorId::kDistanceLimit);
    return;
  }
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_EQ(bench.state.plc, PlcState::kHoming);
  EXPECT_NEAR(bench.place(), expected, 50 * 0.001 + 0.015);
}

INSTANTIATE_TEST_SUITE_P(Tables, LimitSwitch, testing::ValuesIn(AllCases()), [](const auto& info) {
  return "d" + std::to_string(static_cast<int>(info.param.direction)) + "m" +
         std::to_string(static_cast<int>(info.param.mode)) + "i" + std::to_string(info.index % 5);
});

// AX-63: the position of the index edge itself, to a count; the axis stops behind it and does not return.
TEST(RefPulse, IsTheEdgeItself) {
  for (const double start : {-46.0, 0.5, 2.9}) {
    for (const HomingDirection direction : {HomingDirection::kPositive, HomingDirection::kNegative}) {
      Bench bench(start);
      bench.On();
      StepRefPulse step;
      step.direction = direction;
      step.velocity = 20;
      step.set_position = 500;
      const Ticket ticket = bench.Give(step);
      ASSERT_TRUE(bench.RunToEnd(ticket));
      EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
      EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
      EXPECT_TRUE(bench.seen.homed);
      bench.Run(0.1);
      const double up = 3 + 10 * std::ceil((start - 3) / 10);
      const double pulse = direction == HomingDirection::kPositive ? up : up - 10;
      EXPECT_NEAR(bench.seen.actual_position - 500, bench.place() - pulse, 0.0003);
      EXPECT_GT(std::abs(bench.place() - pulse), 0.01);
    }
  }
}

// AX-62: held up at an end stop; the set point goes back to where the axis stands.
TEST(Block, IsFoundByTheLag) {
  Bench bench(-40);
  bench.params.supervision.deviation_moving = 3;
  bench.servo.mechanics.lower_stop = -60;
  bench.servo.drive.max_torque = 2;
  bench.On();
  StepBlock step;
  step.velocity = 20;
  step.deviation = 1;
  step.set_position = -5;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone) << static_cast<int>(bench.last[ticket].error);
  bench.Run(0.2);
  EXPECT_NEAR(bench.place(), -60, 0.05);
  EXPECT_NEAR(bench.seen.actual_position, -5, 0.05);
  EXPECT_NEAR(bench.seen.following_error, 0, 0.05);
  step.deviation = 4;  // beyond what is supervised
  const Ticket too_much = bench.Give(step);
  bench.Run(0.01);
  EXPECT_EQ(bench.last[too_much].error, ErrorId::kParameter);
}

// AX-70: limits of time and way, of a search that finds nothing, too.
TEST(Search, EndsInTime) {
  for (const double time : {0.0, 0.5}) {
    Bench bench(-50);
    bench.servo.switches.reference = {};
    bench.On();
    StepAbsSwitch step;
    step.direction = HomingDirection::kPositive;
    step.velocity = 20;
    step.time_limit = time;
    step.distance_limit = time > 0 ? 0 : 12;
    const Ticket ticket = bench.Give(step);
    ASSERT_TRUE(bench.RunToEnd(ticket));
    EXPECT_EQ(bench.last[ticket].error, time > 0 ? ErrorId::kTimeLimit : ErrorId::kDistanceLimit);
    bench.Run(0.2);
    EXPECT_EQ(bench.state.plc, PlcState::kStandstill);
    EXPECT_FALSE(bench.seen.homed);
    EXPECT_NEAR(bench.place(), time > 0 ? -40 : -38, 0.6);
    step.time_limit = step.distance_limit = 0;
    step.velocity = 200;
    const Ticket nothing = bench.Give(step);
    ASSERT_TRUE(bench.RunToEnd(nothing));
    EXPECT_EQ(bench.last[nothing].error, ErrorId::kDistanceLimit);
  }
}

// Stop, power off and a fault in the middle; nothing else gets in.
TEST(Search, IsInterrupted) {
  for (int how = 0; how < 4; ++how) {
    SCOPED_TRACE(how);
    Bench bench(-50);
    bench.On();
    StepAbsSwitch step;
    step.velocity = 50;
    step.direction = HomingDirection::kPositive;
    const Ticket ticket = bench.Give(step);
    bench.Run(0.3);
    const Ticket move = bench.Give(MoveRelative{.distance = 1});
    const Ticket jog = bench.Give(Jog{.forward = true});
    const Ticket again = bench.Give(step);
    bench.Run(0.01);
    for (const Ticket other : {move, jog, again}) EXPECT_EQ(bench.last[other].error, ErrorId::kState);
    EXPECT_EQ(bench.last[ticket].state, FeedbackState::kActive);
    if (how == 0) bench.Give(Stop{});
    if (how == 1) bench.Give(Power{.enable = false});
    if (how == 2) bench.plant.faults.drive_fault = true;
    if (how == 3) bench.plant.faults.encoder_error = true;
    bench.Run(0.5);
    EXPECT_EQ(bench.last[ticket].state, how < 2 ? FeedbackState::kAborted : FeedbackState::kError);
    const PlcState expected[] = {PlcState::kStandstill, PlcState::kDisabled, PlcState::kErrorStop,
                                 PlcState::kErrorStop};
    EXPECT_EQ(bench.state.plc, expected[how]);
    EXPECT_FALSE(bench.seen.homed);
    EXPECT_EQ(bench.state.homing.stage, HomingStage::kNone);
  }
}

// AX-69: while a search turns round it stands still for a cycle; even then no other step gets in, which would call the
// axis homed.
TEST(Search, IsNotOverWhileItTurns) {
  Bench bench(20);
  bench.On();
  StepAbsSwitch step;
  step.direction = HomingDirection::kPositive;
  step.velocity = 50;
  const Ticket ticket = bench.Give(step);
  bench.Give(FinishHoming{});
  for (int k = 0; k < 20000 && !IsFinal(bench.last[ticket].state); ++k) {
    bench.Step();
    if (IsFinal(bench.last[ticket].state)) break;
    const Ticket early = bench.Give(FinishHoming{});
    bench.Step();
    if (bench.last[ticket].state != FeedbackState::kDone) {
      ASSERT_EQ(bench.last[early].error, ErrorId::kState);
    }
  }
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.place(), 30, 0.1);
}

// AX-70: behind a search nothing but a further step takes over; a buffered move does not lead out of Homing.
TEST(Search, IsNotEndedByABufferedMove) {
  Bench bench(0);
  bench.On();
  StepAbsSwitch step;
  step.direction = HomingDirection::kPositive;
  step.velocity = 50;
  const Ticket ticket = bench.Give(step);
  const Ticket move = bench.Give(MoveRelative{.distance = 5, .buffer_mode = BufferMode::kBuffered});
  const Ticket behind = bench.Give(MoveRelative{.distance = 5, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(bench.RunToEnd(move));
  bench.Run(0.5);
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_EQ(bench.last[move].error, ErrorId::kState);
  EXPECT_EQ(bench.last[behind].state, FeedbackState::kAborted);
  EXPECT_EQ(bench.state.plc, PlcState::kHoming);
  EXPECT_FALSE(bench.seen.homed);
  EXPECT_NEAR(bench.place(), 10, 0.1);
}

// AX-62: however fast the search, braking on the end stop is no deviation.
TEST(Block, MayLagAsLongAsItPushes) {
  Bench bench(-20);
  bench.params.supervision.deviation_moving = 1.5;
  bench.servo.mechanics.lower_stop = -60;
  bench.servo.drive.max_torque = 2;
  bench.On();
  StepBlock step;
  step.velocity = 200;  // brakes over more than 4 mm
  step.deviation = 1;
  const Ticket ticket = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(ticket));
  EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
  EXPECT_NEAR(bench.place(), -60, 0.1);
  EXPECT_EQ(bench.seen.error, ErrorId::kNone);
}

// AX-63, AX-83: the index is not searched into a limit switch that is on; away from it, it is.
TEST(RefPulse, IsSearchedAwayFromALimitSwitch) {
  Bench bench(-90);
  bench.On();
  StepLimitSwitch limit;
  limit.direction = HomingDirection::kNegative;
  limit.velocity = 5;
  ASSERT_TRUE(bench.RunToEnd(bench.Give(limit)));
  bench.Run(0.5);
  ASSERT_EQ(bench.state.plc, PlcState::kHoming);
  StepRefPulse step;
  step.velocity = 5;
  if (bench.seen.limit_negative) {
    step.direction = HomingDirection::kNegative;
    const Ticket into = bench.Give(step);
    bench.Run(0.01);
    EXPECT_EQ(bench.last[into].error, ErrorId::kAwayFromLimitOnly);
  }
  step.direction = HomingDirection::kPositive;
  const Ticket away = bench.Give(step);
  ASSERT_TRUE(bench.RunToEnd(away));
  EXPECT_EQ(bench.last[away].state, FeedbackState::kDone);
  bench.Run(0.1);
  EXPECT_NEAR(bench.seen.actual_position, bench.place() + 97, 0.0003);
}

// AX-60, AX-13: wherever the switch lies, the search ends on one of its edges within the limits (Step holds every cycle
// against them), at any velocity.
TEST(Search, FindsItWhereverItLies) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(k);
    Bench bench(between(-99, 99));
    const double from = between(-80, 40);
    const double to = from + between(20, 40);
    bench.servo.switches.reference.from = from;
    bench.servo.switches.reference.to = to;
    bench.On();
    StepAbsSwitch step;
    step.direction = static_cast<HomingDirection>(k % 4);
    step.switch_mode = k % 2 ? SwitchMode::kEdgeOn : SwitchMode::kEdgeOff;
    step.velocity = between(5, 150);
    const Ticket ticket = bench.Give(step);
    ASSERT_TRUE(bench.RunToEnd(ticket, 200));
    EXPECT_EQ(bench.last[ticket].state, FeedbackState::kDone);
    const double off = std::min(std::abs(bench.place() - from), std::abs(bench.place() - to));
    EXPECT_LT(off, step.velocity * 0.0011 + 0.01);
    EXPECT_EQ(bench.seen.error, ErrorId::kNone);
  }
}

}  // namespace
}  // namespace takt::axis
