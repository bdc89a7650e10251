// Commands that follow one another: the buffer modes and the buffer itself.
#include <gtest/gtest.h>

#include <random>

#include "rig.h"

namespace takt::axis {
namespace {

struct BlendCase {
  BufferMode mode;
  double first_velocity, second_velocity;
  double expected;  // at the first move's end position
};
class Blending : public testing::TestWithParam<BlendCase> {};

// State when the set point passes `position` upwards: velocity by linear interpolation of v² over the two samples
// around it.
double VelocityAt(const std::vector<Sample>& trace, double position) {
  for (std::size_t i = 1; i < trace.size(); ++i) {
    const KinematicState& a = trace[i - 1].setpoint;
    const KinematicState& b = trace[i].setpoint;
    if (a.position <= position && b.position > position) {
      const double share = (position - a.position) / (b.position - a.position);
      return std::sqrt(a.velocity * a.velocity + share * (b.velocity * b.velocity - a.velocity * a.velocity));
    }
  }
  return NAN;
}

// AX-12: the velocity at the first move's end position, as the seed defines it for each mode; no stop between, all
// limits held.
TEST_P(Blending, PassesTheFirstTargetAtTheVelocityOfTheMode) {
  const BlendCase& c = GetParam();
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const std::size_t from = rig.trace.size();
  const Ticket first = rig.Give(MoveAbsolute{.position = 200, .velocity = c.first_velocity});
  const Ticket second = rig.Give(MoveAbsolute{.position = 400, .velocity = c.second_velocity, .buffer_mode = c.mode});
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_TRUE(rig.lives[first].done);
  EXPECT_TRUE(rig.lives[second].done);
  EXPECT_EQ(rig.position(), 400);
  EXPECT_NEAR(VelocityAt(rig.trace, 200), c.expected, 0.02 * c.expected + 0.5);
  EXPECT_EQ(rig.lives[first].final_cycle, rig.lives[second].active_cycle);
  const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
  EXPECT_LE(worst.position_step, 1 + 1e-6);
  double fastest_before = 0;
  for (const Sample& s : rig.trace) {
    if (s.setpoint.position < 150) fastest_before = std::max(fastest_before, s.setpoint.velocity);
  }
  EXPECT_LE(fastest_before,
            c.first_velocity * (1 + 1e-9));  // the first move keeps its own velocity until it has to leave it
}
INSTANTIATE_TEST_SUITE_P(Modes, Blending,
                         testing::Values(BlendCase{BufferMode::kBlendingLow, 300, 150, 150},
                                         BlendCase{BufferMode::kBlendingLow, 150, 300, 150},
                                         BlendCase{BufferMode::kBlendingPrevious, 300, 150, 300},
                                         BlendCase{BufferMode::kBlendingPrevious, 150, 300, 150},
                                         BlendCase{BufferMode::kBlendingNext, 300, 150, 150},
                                         BlendCase{BufferMode::kBlendingNext, 150, 300, 300},
                                         BlendCase{BufferMode::kBlendingHigh, 300, 150, 300},
                                         BlendCase{BufferMode::kBlendingHigh, 150, 300, 300}));

// AX-12: buffered starts when the move before is done, from standstill.
TEST(Buffered, WaitsForDone) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(MoveAbsolute{.position = 100});
  const Ticket second = rig.Give(MoveAbsolute{.position = 50, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_EQ(rig.lives[second].active_cycle, rig.lives[first].final_cycle);
  bool stood = false;
  for (const Sample& s : rig.trace) stood |= s.setpoint.position == 100 && s.setpoint.velocity == 0;
  EXPECT_TRUE(stood);
  EXPECT_EQ(rig.position(), 50);
}

// AX-12: a blend that would have to reverse comes to rest first, and says what held it back.
TEST(Blending, DoesNotRunThroughAReversal) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 100, .velocity = 200});
  const Ticket second =
      rig.Give(MoveAbsolute{.position = 50, .velocity = 200, .buffer_mode = BufferMode::kBlendingHigh});
  rig.Run(0.1);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kDistance);
  ASSERT_TRUE(rig.RunToEnd(second));
  double furthest = 0;
  for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
  EXPECT_EQ(furthest, 100);
}

// AX-12: where the second move is too short to stop from the velocity asked for, the first target is passed as fast as
// still allows it.
TEST(Blending, LeavesRoomForTheNextMoveToStop) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 200, .velocity = 400});
  const Ticket second =
      rig.Give(MoveAbsolute{.position = 202, .velocity = 400, .buffer_mode = BufferMode::kBlendingPrevious});
  ASSERT_TRUE(rig.RunToEnd(second));
  double furthest = 0;
  for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
  EXPECT_LE(furthest, 202 + 1e-9);
  // With the same limits the two are one motion (AX-103).
  Rig one(LinearParams());
  ASSERT_TRUE(one.PowerOn());
  ASSERT_TRUE(one.RunToEnd(one.Give(MoveAbsolute{.position = 202, .velocity = 400})));
  EXPECT_NEAR(VelocityAt(rig.trace, 200), VelocityAt(one.trace, 200), 1e-6);
}

// AX-12: eight commands wait, the ninth is refused and nothing is lost.
TEST(Buffer, HoldsEightAndRefusesTheNinth) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 10});
  rig.Step();
  std::vector<Ticket> waiting;
  for (int i = 0; i < 8; ++i) {
    waiting.push_back(rig.Give(MoveAbsolute{.position = 20.0 + 10 * i,
                                            .buffer_mode = i % 2 ? BufferMode::kBuffered : BufferMode::kBlendingLow}));
  }
  const Ticket ninth = rig.Give(MoveAbsolute{.position = -5, .buffer_mode = BufferMode::kBuffered});
  rig.Step();
  EXPECT_EQ(rig.out.buffered_commands, 8);
  EXPECT_EQ(rig.lives[ninth].error_id, ErrorId::kBufferFull);
  ASSERT_TRUE(rig.RunToEnd(waiting.back()));
  for (const Ticket t : waiting) EXPECT_TRUE(rig.lives[t].done);
  EXPECT_EQ(rig.position(), 90);
}

// AX-12: an aborting command empties the buffer; every command in it hears of it, once.
TEST(Buffer, IsEmptiedByAnAbortingCommand) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(MoveAbsolute{.position = 100});
  const Ticket second = rig.Give(MoveAbsolute{.position = 200, .buffer_mode = BufferMode::kBlendingHigh});
  rig.Run(0.05);
  const Ticket third = rig.Give(MoveAbsolute{.position = -10});
  ASSERT_TRUE(rig.RunToEnd(third));
  EXPECT_TRUE(rig.lives[first].aborted);
  EXPECT_TRUE(rig.lives[second].aborted);
  EXPECT_FALSE(rig.lives[second].active);
  EXPECT_EQ(rig.position(), -10);
}

// AX-12, the seed's table 8.3: what starts the command behind each kind.
TEST(Buffered, StartsAtTheSignalOfTheCommandBefore) {
  Rig rig(LinearParams());
  // Behind MC_Power: at Status.
  const Ticket on = rig.Give(Power{});
  const Ticket move = rig.Give(MoveVelocity{.velocity = 100, .buffer_mode = BufferMode::kBuffered});
  rig.Run(0.01);
  EXPECT_TRUE(rig.lives[on].done);
  EXPECT_EQ(rig.lives[move].active_cycle, rig.lives[on].final_cycle);
  // Behind MC_MoveVelocity: at InVelocity.
  rig.Run(1);
  const Ticket faster = rig.Give(MoveVelocity{.velocity = 300});
  const Ticket halt = rig.Give(Halt{.buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(halt));
  EXPECT_TRUE(rig.lives[faster].reached);
  EXPECT_EQ(rig.lives[faster].reached_cycle, rig.lives[halt].active_cycle);
  EXPECT_TRUE(rig.lives[halt].done);
  // Behind MC_Stop: at Done and not Execute.
  const Ticket stop = rig.Give(Stop{.hold = true});
  const Ticket next = rig.Give(MoveRelative{.distance = 5, .buffer_mode = BufferMode::kBuffered});
  rig.Run(0.5);
  EXPECT_TRUE(rig.lives[stop].done);
  EXPECT_FALSE(rig.lives[next].active);
  rig.Let(stop);
  ASSERT_TRUE(rig.RunToEnd(next));
  EXPECT_TRUE(rig.lives[next].done);
  // MC_Power may wait itself: off behind the move.
  const Ticket last = rig.Give(MoveRelative{.distance = 5});
  const Ticket off = rig.Give(Power{.enable = false, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(off));
  EXPECT_TRUE(rig.lives[last].done);
  EXPECT_EQ(rig.out.state, PlcState::kDisabled);
}

// AX-12: what cannot be buffered or followed is refused, and says so.
TEST(Buffered, IsRefusedWhereTheTableSaysNo) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(Jog{.forward = true, .velocity = 50});
  rig.Run(0.1);
  const Ticket behind_jog = rig.Give(MoveAbsolute{.position = 5, .buffer_mode = BufferMode::kBuffered});
  const Ticket blended_halt = rig.Give(Halt{.buffer_mode = BufferMode::kBlendingLow});
  const Ticket blended_stop = rig.Give(Stop{.buffer_mode = BufferMode::kBlendingNext});
  rig.Step();
  EXPECT_EQ(rig.lives[behind_jog].error_id, ErrorId::kState);
  EXPECT_EQ(rig.lives[blended_halt].error_id, ErrorId::kParameter);
  EXPECT_EQ(rig.lives[blended_stop].error_id, ErrorId::kParameter);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
}

// AX-12: nine moves blended into one another, random lengths and speeds, both senses: all done, none stopped at but at
// reversals.
TEST(Blending, ChainsOfManyMoves) {
  std::mt19937_64 random(7);
  for (int run = 0; run < 200; ++run) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    std::uniform_real_distribution<double> distance(-80, 120), speed(20, 500);
    std::vector<Ticket> moves;
    std::vector<double> distances;
    double end = 0;
    const std::size_t from = rig.trace.size();
    for (int i = 0; i < 9; ++i) {
      const double d = distance(random);
      end += d;
      distances.push_back(d);
      const auto mode = static_cast<BufferMode>(2 + run % 4);
      moves.push_back(rig.Give(
          MoveRelative{.distance = d, .velocity = speed(random), .buffer_mode = i ? mode : BufferMode::kAborting}));
    }
    ASSERT_TRUE(rig.RunToEnd(moves.back())) << run;
    for (const Ticket t : moves) ASSERT_TRUE(rig.lives[t].done) << run;
    ASSERT_NEAR(rig.position(), end, 1e-6);
    for (std::size_t i = 0; i + 1 < moves.size(); ++i) {
      const double passed = rig.trace[rig.lives[moves[i]].final_cycle].setpoint.velocity;
      ASSERT_EQ(passed == 0, distances[i] * distances[i + 1] < 0) << run << ' ' << i;
    }
    const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
    ASSERT_LE(worst.velocity, 1 + 1e-9) << run;
    ASSERT_LE(worst.acceleration, 1 + 1e-9) << run;
    ASSERT_LE(worst.jerk, 1 + 1e-6) << run;
    ASSERT_LE(worst.position_step, 1 + 1e-6) << run;
  }
}

// AX-12: a relative move behind another is known for what it is: no stop between two in the same sense.
TEST(Blending, RelativeMovesDoNotStopBetween) {
  for (const double sense : {1.0, -1.0}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket first = rig.Give(MoveRelative{.distance = sense * 150, .velocity = 300});
    const Ticket second =
        rig.Give(MoveRelative{.distance = sense * 150, .velocity = 300, .buffer_mode = BufferMode::kBlendingPrevious});
    ASSERT_TRUE(rig.RunToEnd(first));
    EXPECT_NEAR(rig.state.setpoint.velocity, sense * 300, 1e-6);
    ASSERT_TRUE(rig.RunToEnd(second));
    EXPECT_NEAR(rig.position(), sense * 300, 1e-9);
  }
}

// AX-12: into a motion without an end, in the same sense with its speed, else from standstill.
TEST(Blending, IntoAMotionWithoutAnEnd) {
  for (const Direction direction : {Direction::kPositive, Direction::kNegative, Direction::kCurrent}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket first = rig.Give(MoveAbsolute{.position = 150, .velocity = 300});
    const Ticket second =
        rig.Give(MoveVelocity{.velocity = 200, .direction = direction, .buffer_mode = BufferMode::kBlendingNext});
    ASSERT_TRUE(rig.RunToEnd(first));
    EXPECT_TRUE(rig.lives[second].active);
    EXPECT_NEAR(rig.state.setpoint.velocity, direction == Direction::kNegative ? 0 : 200, 1e-6);
    double furthest = 0;
    for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
    if (direction == Direction::kNegative) {
      EXPECT_EQ(furthest, 150);
    }
  }
}

// AX-12: also where the axis has to turn round before the first move; that is no reversal between the two.
TEST(Blending, MayBeginInTheOtherSense) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 200, .direction = Direction::kNegative});
  rig.Run(0.3);
  const Ticket first = rig.Give(MoveAbsolute{.position = 100, .velocity = 300});
  rig.Give(MoveAbsolute{.position = 300, .velocity = 300, .buffer_mode = BufferMode::kBlendingPrevious});
  ASSERT_TRUE(rig.RunToEnd(first));
  EXPECT_NEAR(rig.state.setpoint.velocity, 300, 1e-6);
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
}

// AX-12: a first move too short for the speed asked for never runs back to gain a run-up; it passes its end as fast as
// it can and says what holds it.
TEST(Blending, TakesNoRunUp) {
  for (const double own : {400.0, 20.0}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const std::size_t from = rig.trace.size();
    const Ticket first = rig.Give(MoveAbsolute{.position = 1, .velocity = own});
    const Ticket second =
        rig.Give(MoveAbsolute{.position = 300, .velocity = 400, .buffer_mode = BufferMode::kBlendingHigh});
    rig.Step();
    EXPECT_EQ(rig.out.limited_by, LimitedBy::kDistance);
    ASSERT_TRUE(rig.RunToEnd(first));
    EXPECT_GT(rig.state.setpoint.velocity, 10);
    ASSERT_TRUE(rig.RunToEnd(second));
    for (std::size_t i = from; i < rig.trace.size(); ++i) ASSERT_GE(rig.trace[i].setpoint.velocity, 0);
  }
}

// AX-12: what the second move can brake with decides, not what the first one could.
TEST(Blending, LeavesRoomForAWeakSecondMove) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 200, .velocity = 400});
  const Ticket second = rig.Give(MoveAbsolute{
      .position = 220, .velocity = 400, .deceleration = 500, .buffer_mode = BufferMode::kBlendingPrevious});
  ASSERT_TRUE(rig.RunToEnd(second));
  double furthest = 0;
  for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
  EXPECT_LE(furthest, 220 + 1e-9);
}

// AX-12: on a rotary axis the current sense of the second move is the sense of the first.
TEST(Blending, TheCurrentSenseIsThatOfTheMoveBefore) {
  Rig rig(RotaryParams());
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = 300, .direction = Direction::kPositive})));
  const double start = rig.position();
  const Ticket first = rig.Give(MoveAbsolute{.position = 200, .velocity = 300, .direction = Direction::kNegative});
  const Ticket second = rig.Give(MoveAbsolute{.position = 100,
                                              .velocity = 300,
                                              .direction = Direction::kCurrent,
                                              .buffer_mode = BufferMode::kBlendingPrevious});
  ASSERT_TRUE(rig.RunToEnd(first));
  EXPECT_NEAR(rig.state.setpoint.velocity, -300, 1e-6);
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_NEAR(rig.position() - start, -200, 1e-9);
}

// AX-12, AX-83: a second move that will be refused does not let the first one run through its end; it is told when its
// turn comes, what waits behind it is aborted, and the axis stands.
TEST(Buffered, RefusedWhenItsTurnComes) {
  for (const BufferMode mode : {BufferMode::kBuffered, BufferMode::kBlendingPrevious}) {
    AxisParams p = LinearParams();
    p.limits.upper = 100;
    Rig rig(p);
    ASSERT_TRUE(rig.PowerOn());
    const Ticket first = rig.Give(MoveAbsolute{.position = 50});
    const Ticket wrong = rig.Give(MoveAbsolute{.position = 101, .buffer_mode = mode});
    const Ticket behind = rig.Give(MoveAbsolute{.position = 60, .buffer_mode = BufferMode::kBuffered});
    ASSERT_TRUE(rig.RunToEnd(behind));
    EXPECT_TRUE(rig.lives[first].done);
    EXPECT_EQ(rig.lives[wrong].error_id, ErrorId::kTargetBehindLimit);
    EXPECT_TRUE(rig.lives[behind].aborted);
    rig.Run(0.5);
    double furthest = 0;
    for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
    EXPECT_EQ(furthest, 50);
    EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  }
}

// The same out of a motion without an end: nobody is in control any more, so the axis comes to rest.
TEST(Buffered, RefusedInMotionTheAxisComesToRest) {
  AxisParams p = LinearParams();
  p.limits.upper = 1000;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const Ticket endless = rig.Give(MoveVelocity{.velocity = 300});
  const Ticket wrong = rig.Give(MoveAbsolute{.position = 1001, .buffer_mode = BufferMode::kBuffered});
  const std::size_t from = rig.trace.size();
  ASSERT_TRUE(rig.RunToEnd(wrong));
  EXPECT_EQ(rig.lives[wrong].error_id, ErrorId::kTargetBehindLimit);
  EXPECT_TRUE(rig.lives[endless].aborted);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  rig.Run(0.5);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_EQ(rig.out.set_velocity, 0);
  const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
  EXPECT_LE(worst.position_step, 1 + 1e-6);
}

// What holds a motion back is forgotten with it: by the command that takes over, at its end, by an open loop.
TEST(LimitedBy, EndsWithItsMotion) {
  for (const int end : {0, 1, 2}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveAbsolute{.position = 100});
    const Ticket back = rig.Give(MoveAbsolute{.position = 50, .buffer_mode = BufferMode::kBlendingHigh});
    rig.Run(0.05);
    ASSERT_EQ(rig.out.limited_by, LimitedBy::kDistance);
    if (end == 0) rig.Give(MoveAbsolute{.position = 0});
    if (end == 1) rig.RunToEnd(back);
    if (end == 2) rig.inputs.drive_fault = true;
    rig.Step();
    EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing) << end;
  }
}

// AX-12: where the first move is too short to reach the higher speed of the second, its end is passed as fast as the
// ramp from its own velocity allows, not with its own velocity.
TEST(Blending, HighRampsUpAsFarAsItCan) {
  for (const double distance : {10.0, 25.0}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket first = rig.Give(MoveAbsolute{.position = distance, .velocity = 50});
    rig.Give(MoveAbsolute{.position = 300, .velocity = 400, .buffer_mode = BufferMode::kBlendingHigh});
    ASSERT_TRUE(rig.RunToEnd(first));
    EXPECT_GT(rig.state.setpoint.velocity, 100);
  }
}

}  // namespace
}  // namespace takt::axis
