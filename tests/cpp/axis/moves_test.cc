// Moves of one axis through its commands: where they end, when, and within which limits.
#include <gtest/gtest.h>

#include "rig.h"

namespace takt::axis {
namespace {

// A rest-to-rest move with all seven pieces: v/a ramps of v/a + a/j each, then cruise.
double SevenPieceTime(double distance, double v, double a, double d, double j) {
  const double up = v / a + a / j;
  const double down = v / d + d / j;
  return up + down + (distance - 0.5 * v * (up + down)) / v;
}

// AX-30, AX-13: position, duration against the closed form, and every limit on the way.
TEST(MoveAbsolute, EndsThereInTheClosedFormTime) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const std::uint64_t start = rig.cycle.count;
  const Ticket move = rig.Give(
      MoveAbsolute{.position = 300, .velocity = 400, .acceleration = 4000, .deceleration = 3000, .jerk = 80000});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_EQ(rig.out.set_position, 300);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_EQ(rig.out.set_acceleration, 0);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  const double took = static_cast<double>(rig.lives[move].final_cycle - start + 1) * 0.001;
  EXPECT_NEAR(took, SevenPieceTime(300, 400, 4000, 3000, 80000), 0.00101);
  const Worst worst = WorstOf(rig.trace, {400, 4000, 3000, 80000}, 0.001);
  EXPECT_LE(worst.velocity, 1 + 1e-9);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
  EXPECT_LE(worst.position_step, 1 + 1e-6);
}

// AX-13: jerk 0 is the trapezoid, where the axis has no jerk limit of its own.
TEST(MoveAbsolute, WithoutJerkLimitIsATrapezoid) {
  AxisParams p = LinearParams();
  p.limits.jerk = 0;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const std::uint64_t start = rig.cycle.count;
  const Ticket move =
      rig.Give(MoveAbsolute{.position = -100, .velocity = 200, .acceleration = 2000, .deceleration = 1000, .jerk = 0});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_EQ(rig.out.set_position, -100);
  const double took = static_cast<double>(rig.lives[move].final_cycle - start + 1) * 0.001;
  EXPECT_NEAR(took, 0.5 + 0.5 * (0.1 + 0.2), 0.00101);  // s/v + (t_up + t_down)/2
}

// AX-31: by a distance, from the set position at the moment it starts, also in the middle of another move.
TEST(MoveRelative, CountsFromTheSetPositionWhenItStarts) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket first = rig.Give(MoveRelative{.distance = 100});
  ASSERT_TRUE(rig.RunToEnd(first));
  EXPECT_EQ(rig.position(), 100);
  rig.Give(MoveAbsolute{.position = 400});
  rig.Run(0.15);
  const double here = rig.position();
  ASSERT_GT(rig.state.setpoint.velocity, 100);
  const Ticket second = rig.Give(MoveRelative{.distance = -150});
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_NEAR(rig.position(), here - 150, 1e-9);
}

// AX-32: adds to where the move in progress was to end; that is what tells it from MoveRelative. Without one it adds to
// the set position, and buffered to the end of the move before.
TEST(MoveAdditive, AddsToThePromisedEnd) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveAbsolute{.position = 100});
  rig.Run(0.1);
  ASSERT_GT(rig.position(), 1);
  const Ticket more = rig.Give(MoveAdditive{.distance = 20});
  ASSERT_TRUE(rig.RunToEnd(more));
  EXPECT_NEAR(rig.position(), 120, 1e-9);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAdditive{.distance = -20})));
  EXPECT_NEAR(rig.position(), 100, 1e-9);

  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(0.3);
  const double here = rig.position();
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAdditive{.distance = 50})));
  EXPECT_NEAR(rig.position(), here + 50, 1e-9);

  rig.Give(MoveAbsolute{.position = 0});
  const Ticket buffered = rig.Give(MoveAdditive{.distance = 7, .buffer_mode = BufferMode::kBuffered});
  const Ticket blended = rig.Give(MoveAdditive{.distance = 3, .buffer_mode = BufferMode::kBlendingLow});
  ASSERT_TRUE(rig.RunToEnd(blended));
  EXPECT_TRUE(rig.lives[buffered].done);
  EXPECT_NEAR(rig.position(), 10, 1e-9);
}

// AX-33: reached once, Active for good; only another command ends it.
TEST(MoveVelocity, IsReachedAndGoesOn) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const std::uint64_t start = rig.cycle.count;
  const Ticket move =
      rig.Give(MoveVelocity{.velocity = 250, .acceleration = 2500, .jerk = 50000, .direction = Direction::kNegative});
  rig.Run(1);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
  EXPECT_EQ(rig.out.set_velocity, -250);
  EXPECT_TRUE(rig.lives[move].reached);
  EXPECT_FALSE(rig.Ended(move));
  EXPECT_NEAR(static_cast<double>(rig.lives[move].reached_cycle - start + 1) * 0.001, 250.0 / 2500 + 2500.0 / 50000,
              0.00101);
  const Ticket slower = rig.Give(MoveVelocity{.velocity = 0, .direction = Direction::kCurrent});
  rig.Run(1);
  EXPECT_TRUE(rig.lives[move].aborted);
  EXPECT_TRUE(rig.lives[slower].reached);
  EXPECT_EQ(rig.out.set_velocity, 0);
  EXPECT_EQ(rig.out.state, PlcState::kContinuousMotion);
}

// AX-14: where the new target cannot be reached without overshoot, the axis overshoots within its limits and returns.
TEST(MoveAbsolute, OvershootsAndReturnsWhenItMust) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  rig.Run(0.5);
  const double target = rig.position() + 1;
  const Ticket move = rig.Give(MoveAbsolute{.position = target});
  const std::size_t from = rig.trace.size();
  ASSERT_TRUE(rig.RunToEnd(move));
  double furthest = 0;
  for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
  EXPECT_GT(furthest, target + 10);
  EXPECT_EQ(rig.position(), target);
  const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
  EXPECT_LE(worst.velocity, 1 + 1e-9);
  EXPECT_LE(worst.acceleration, 1 + 1e-9);
  EXPECT_LE(worst.jerk, 1 + 1e-6);
}

// AX-14: on a rotary axis with a fixed sense it goes on to the next turn instead.
TEST(MoveAbsolute, GoesOnToTheNextTurnWithAFixedSense) {
  Rig rig(RotaryParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  rig.Run(0.5);
  const double target = std::fmod(rig.position() + 1, 360);
  const double before = rig.position();
  const Ticket move = rig.Give(MoveAbsolute{.position = target, .direction = Direction::kPositive});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_NEAR(rig.position(), before + 361, 1e-6);
  for (std::size_t i = 1; i < rig.trace.size(); ++i) {
    ASSERT_GE(rig.trace[i].setpoint.position, rig.trace[i - 1].setpoint.position - 1e-12);
  }
}

// AX-14: the same downwards.
TEST(MoveAbsolute, GoesOnToTheNextTurnDownwards) {
  Rig rig(RotaryParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500, .direction = Direction::kNegative});
  rig.Run(0.5);
  const double before = rig.position();
  const double target = before - 1 - 360 * std::floor((before - 1) / 360);
  const Ticket move = rig.Give(MoveAbsolute{.position = target, .direction = Direction::kCurrent});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_NEAR(rig.position(), before - 361, 1e-6);
}

// AX-30: in motion the shortest way is the one from where the axis could stand.
TEST(MoveAbsolute, TheShortestWayCountsFromWhereItCouldStop) {
  Rig rig(RotaryParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  rig.Run(0.5);
  const double before = rig.position();
  const Ticket move = rig.Give(MoveAbsolute{.position = std::fmod(before + 200, 360)});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_NEAR(rig.position(), before + 200, 1e-6);
}

// AX-30: rounding of the place it stands at is no reason for a turn.
TEST(MoveAbsolute, DoesNotTurnRoundForARounding) {
  Rig rig(RotaryParams());
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = 0.1})));
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = 0.2})));
  ASSERT_NE(rig.position(), 0.3);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = 0.3, .direction = Direction::kPositive})));
  EXPECT_NEAR(rig.position(), 0.3, 1e-9);
}

// AX-33: the current sense is that of the last motion, also after it.
TEST(MoveVelocity, TheCurrentSenseIsThatOfTheLastMotion) {
  for (const double last : {-10.0, 10.0}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveRelative{.distance = last})));
    rig.Give(MoveVelocity{.velocity = 50, .direction = Direction::kCurrent});
    rig.Run(0.2);
    EXPECT_EQ(rig.out.set_velocity, last > 0 ? 50 : -50);
  }
}

struct TurnCase {
  double from, to;
  Direction direction;
  double distance;
};
class RotaryTargets : public testing::TestWithParam<TurnCase> {};

// AX-30: the four senses on a rotary axis; 0 and the modulus are one place; half a turn goes upwards.
TEST_P(RotaryTargets, TakeTheWayTheSenseSays) {
  const TurnCase& c = GetParam();
  Rig rig(RotaryParams());
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = c.from, .direction = Direction::kPositive})));
  const double start = rig.position();
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = c.to, .direction = c.direction})));
  EXPECT_NEAR(rig.position() - start, c.distance, 1e-9);
  EXPECT_NEAR(rig.out.set_position, c.to == 360 ? 0 : c.to, 1e-9);
}
INSTANTIATE_TEST_SUITE_P(
    Senses, RotaryTargets,
    testing::Values(TurnCase{10, 350, Direction::kShortest, -20}, TurnCase{350, 10, Direction::kShortest, 20},
                    TurnCase{10, 190, Direction::kShortest, 180}, TurnCase{10, 350, Direction::kPositive, 340},
                    TurnCase{10, 350, Direction::kNegative, -20}, TurnCase{350, 10, Direction::kNegative, -340},
                    TurnCase{90, 90, Direction::kPositive, 0}, TurnCase{90, 90, Direction::kNegative, 0},
                    TurnCase{90, 80, Direction::kCurrent, 350}, TurnCase{90, 360, Direction::kPositive, 270},
                    TurnCase{90, 0, Direction::kNegative, -90}));

// AX-02: reported in [0, modulus) however many turns, and positions stay exact over thousands of them.
TEST(RotaryAxis, ReportsWithinOneTurnOverThousandsOfTurns) {
  AxisParams p = RotaryParams();
  p.limits = {
      .velocity = 36000, .acceleration = 360000, .deceleration = 360000, .jerk = 36000000, .lower = {}, .upper = {}};
  p.encoder.increments_per_unit = 100;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 36000});
  for (int i = 0; i < 60000; ++i) {  // 6000 turns
    rig.Step();
    ASSERT_GE(rig.out.set_position, 0);
    ASSERT_LT(rig.out.set_position, 360);
    ASSERT_GE(rig.out.actual_position, 0);
    ASSERT_LT(rig.out.actual_position, 360);
    ASSERT_LT(std::abs(rig.state.setpoint.position), 360 * 1002.0);
    ASSERT_LT(std::abs(rig.out.following_error), 0.011);
    if (i % 1000 == 0) rig.trace.clear();
  }
  EXPECT_GT(rig.state.origin, 360 * 1000.0);
  const Ticket home = rig.Give(MoveAbsolute{.position = 123.25, .direction = Direction::kPositive});
  ASSERT_TRUE(rig.RunToEnd(home));
  EXPECT_NEAR(rig.out.set_position, 123.25, 1e-6);
  EXPECT_NEAR(rig.out.actual_position, 123.25, 0.011);
}

// AX-02: the same downwards, and for what the position loop of a velocity drive sees: no cycle in which the turns that
// were taken out show.
TEST(RotaryAxis, TurnsTakenOutAreNotSeen) {
  for (const Direction direction : {Direction::kPositive, Direction::kNegative}) {
    AxisParams p = RotaryParams();
    p.limits = {
        .velocity = 36000, .acceleration = 360000, .deceleration = 360000, .jerk = 36000000, .lower = {}, .upper = {}};
    p.encoder.increments_per_unit = 100;
    p.drive.mode = DriveMode::kCyclicVelocity;
    p.loop.kp = 0.05;
    p.loop.ff = 1;
    p.loop.velocity_at_10v = 72000;
    Rig rig(p);
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveVelocity{.velocity = 36000, .direction = direction});
    rig.Run(1);
    for (int i = 0; i < 20000; ++i) {
      rig.Step();
      ASSERT_NEAR(rig.commanded.velocity_counts_s, direction == Direction::kPositive ? 3.6e6 : -3.6e6, 1e3) << i;
      ASSERT_LT(std::abs(rig.state.setpoint.position), 360 * 1002.0);
      if (i % 1000 == 0) rig.trace.clear();
    }
  }
}

// AX-02, AX-12: nor in a move of so many turns that a blending move joins on the way.
TEST(RotaryAxis, TurnsTakenOutDoNotMoveATarget) {
  AxisParams p = RotaryParams();
  p.limits = {
      .velocity = 36000, .acceleration = 360000, .deceleration = 360000, .jerk = 36000000, .lower = {}, .upper = {}};
  p.encoder.increments_per_unit = 100;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveRelative{.distance = 360 * 1500.0 + 10});
  while (rig.state.origin == 0) rig.Step();
  const Ticket second = rig.Give(MoveRelative{.distance = 20, .buffer_mode = BufferMode::kBlendingLow});
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_NEAR(rig.position() + rig.state.origin, 360 * 1500.0 + 30, 1e-6);
}

// AX-36: halt brakes as asked and another command may take over on the way.
TEST(Halt, BrakesAndCanBeTakenOver) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  const Ticket halt = rig.Give(Halt{.deceleration = 1000, .jerk = 20000});
  rig.Run(0.05);
  EXPECT_EQ(rig.out.state, PlcState::kDiscreteMotion);
  const Ticket on = rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  EXPECT_TRUE(rig.lives[halt].aborted);
  EXPECT_TRUE(rig.lives[on].reached);
  const std::uint64_t start = rig.cycle.count;
  const Ticket last = rig.Give(Halt{.deceleration = 1000, .jerk = 20000});
  ASSERT_TRUE(rig.RunToEnd(last));
  EXPECT_TRUE(rig.lives[last].done);
  EXPECT_NEAR(static_cast<double>(rig.lives[last].final_cycle - start + 1) * 0.001, 400.0 / 1000 + 1000.0 / 20000,
              0.00101);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
}

// AX-37: Stopping lasts as long as Execute; Done comes when the axis stands; nothing takes over meanwhile.
TEST(Stop, HoldsTheAxisUntilReleased) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 400});
  rig.Run(0.5);
  const Ticket stop = rig.Give(Stop{.hold = true});
  rig.Run(0.02);
  EXPECT_EQ(rig.out.state, PlcState::kStopping);
  EXPECT_FALSE(rig.lives[stop].done);
  const Ticket refused = rig.Give(MoveAbsolute{.position = 0});
  rig.Run(1);
  EXPECT_EQ(rig.lives[refused].error_id, ErrorId::kAxisStopping);
  EXPECT_TRUE(rig.lives[stop].done);
  EXPECT_EQ(rig.out.state, PlcState::kStopping);
  EXPECT_EQ(rig.out.set_velocity, 0);
  rig.Let(stop);
  rig.Run(0.002);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  const Ticket move = rig.Give(MoveAbsolute{.position = 0});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_EQ(rig.lives[stop].events.size(), 2u);  // Active, Done: once each
}

// AX-37 from Standstill: to Stopping and back.
TEST(Stop, WorksAtStandstill) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket stop = rig.Give(Stop{});
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kStopping);
  EXPECT_FALSE(rig.lives[stop].done);
  rig.Step();
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_TRUE(rig.lives[stop].done);  // with the state that takes the next command
}

// AX-05: done only inside the in-position window; too late is error 0003, not a fault.
TEST(InPosition, DecidesWhenAMoveIsDone) {
  AxisParams p = LinearParams();
  p.supervision.in_position = 0.01;
  p.supervision.in_position_timeout_s = 0.2;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 10});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_TRUE(rig.out.in_position);

  const Ticket stuck = rig.Give(MoveAbsolute{.position = 20});
  rig.Run(0.02);
  rig.frozen = true;
  ASSERT_TRUE(rig.RunToEnd(stuck));
  EXPECT_EQ(rig.lives[stuck].error_id, ErrorId::kDeviationLimit);
  EXPECT_EQ(rig.out.state, PlcState::kStandstill);
  EXPECT_EQ(rig.out.error, ErrorId::kNone);
}

// AX-05: so it is in the other sense; what waits behind is aborted, and what is to blend into it meanwhile neither
// starts nor gives it more time.
TEST(InPosition, TooLateAbortsWhatWaits) {
  for (const double target : {-10.0, 10.0}) {
    AxisParams p = LinearParams();
    p.supervision.in_position = 0.01;
    p.supervision.in_position_timeout_s = 0.2;
    Rig rig(p);
    ASSERT_TRUE(rig.PowerOn());
    const Ticket stuck = rig.Give(MoveAbsolute{.position = target});
    rig.Run(0.02);
    rig.frozen = true;
    while (rig.position() != target) rig.Step();
    const std::uint64_t arrived = rig.cycle.count;
    rig.Run(0.1);
    const Ticket next = rig.Give(MoveAbsolute{.position = 2 * target, .buffer_mode = BufferMode::kBlendingHigh});
    ASSERT_TRUE(rig.RunToEnd(stuck));
    EXPECT_EQ(rig.lives[stuck].error_id, ErrorId::kDeviationLimit);
    EXPECT_NEAR(static_cast<double>(rig.cycle.count - arrived) * 0.001, 0.2, 0.003);
    EXPECT_TRUE(rig.lives[next].aborted);
    EXPECT_EQ(rig.out.buffered_commands, 0);
    EXPECT_EQ(rig.position(), target);
  }
}

// AX-24: what is published of position, velocity and torque is what the wires say.
TEST(Outputs, SayWhatIsMeasured) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.inputs.torque_nm = 1.25;
  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(0.5);
  EXPECT_NEAR(rig.out.actual_velocity, 100, 0.01);
  EXPECT_NEAR(rig.out.actual_position, rig.trace[rig.trace.size() - 2].out.set_position, 1e-6);
  EXPECT_NEAR(rig.out.following_error, 0, 1e-6);
  EXPECT_EQ(rig.out.torque_nm, 1.25);
}

// AX-24: with an open loop there is no following error, and no position to be in.
TEST(Outputs, SayNothingOfALoopThatIsOpen) {
  Rig rig(LinearParams());
  rig.frozen = true;
  for (int i = 0; i < 10; ++i) {
    rig.inputs.counts += 1000;
    rig.Step();
    EXPECT_EQ(rig.out.following_error, 0);
    EXPECT_FALSE(rig.out.in_position);
  }
}

// AX-02: a position below 0 by less than it can be told from a turn is 0, not the modulus.
TEST(Outputs, StayBelowTheModulus) {
  State state;
  state.setpoint.position = -1e-17;
  state.actual.position = -1e-17;
  Outputs out;
  Publish(RotaryParams(), state, out);
  EXPECT_EQ(out.set_position, 0);
  EXPECT_EQ(out.actual_position, 0);
}

// AX-03: an inverted control sense turns position and speed round that a position drive gets.
TEST(Outputs, InvertTurnsThePositionDriveRound) {
  AxisParams p = LinearParams();
  p.drive.invert = true;
  p.encoder.invert = true;
  Rig rig(p);
  rig.frozen = true;
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 100});
  rig.Run(0.2);
  EXPECT_NEAR(rig.commanded.position_counts, rig.position() * 1e6, 1e-3);
  EXPECT_NEAR(rig.commanded.velocity_counts_s, 100e6, 1e-3);
}

// The way of the data: a velocity drive is fed the speed that leads from the set point before to this one, so that an
// ideal one has no following error while it accelerates either.
TEST(Outputs, AnIdealVelocityDriveHasNoFollowingError) {
  AxisParams p = LinearParams();
  p.drive.mode = DriveMode::kCyclicVelocity;
  p.loop.kp = 0;
  p.loop.ff = 1;
  p.loop.velocity_at_10v = 1000;
  Rig rig(p);
  rig.frozen = true;
  double counts = 0;
  const auto step = [&] {
    counts += rig.commanded.velocity_counts_s * 0.001;
    rig.inputs.counts = static_cast<std::uint32_t>(std::llround(counts));
    rig.Step();
    EXPECT_LT(std::abs(rig.out.following_error), 1e-4);
  };
  rig.Give(Power{});
  for (int i = 0; i < 20; ++i) step();
  const Ticket move = rig.Give(MoveAbsolute{.position = 100});
  for (int i = 0; i < 2000 && !rig.Ended(move); ++i) step();
  EXPECT_TRUE(rig.lives[move].done);
}

// AX-05: in position is an axis that has arrived.
TEST(Outputs, InPositionIsNotSaidInMotion) {
  AxisParams p = LinearParams();
  p.supervision.in_position = 0.01;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  EXPECT_TRUE(rig.out.in_position);
  const Ticket move = rig.Give(MoveAbsolute{.position = 50});
  rig.Run(0.05);
  EXPECT_LT(std::abs(rig.out.following_error), 0.01);
  EXPECT_FALSE(rig.out.in_position);
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.out.in_position);
}

}  // namespace
}  // namespace takt::axis
