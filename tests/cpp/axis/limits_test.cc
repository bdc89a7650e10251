// SW limits, the limits of commands, and what happens when no plan can be made.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "rig.h"
#include "takt/axis/fit.h"
#include "takt/axis/request.h"

namespace takt::axis {
namespace {

AxisParams Fenced() {
  AxisParams p = LinearParams();
  p.limits.lower = -100;
  p.limits.upper = 100;
  return p;
}

// AX-83: a target behind a SW limit is error 0008 of the command; the motion in progress goes on (AX-06).
TEST(SoftLimit, RefusesATargetBehindIt) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 100});
  rig.Run(0.05);
  const Ticket far = rig.Give(MoveAbsolute{.position = 100.001});
  const Ticket relative = rig.Give(MoveRelative{.distance = -250});
  rig.Step();
  EXPECT_EQ(rig.lives[far].error_id, ErrorId::kTargetBehindLimit);
  EXPECT_EQ(rig.lives[relative].error_id, ErrorId::kTargetBehindLimit);
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_EQ(rig.position(), 100);
  const Ticket out = rig.Give(MoveVelocity{.velocity = 1});
  rig.Step();
  EXPECT_EQ(rig.lives[out].error_id, ErrorId::kTargetBehindLimit);
}

// AX-83, AX-13: a motion without an end brakes in time: ErrorStop 2006, and it stands at the limit, not behind it.
TEST(SoftLimit, StopsAMotionWithoutAnEndInFrontOfIt) {
  for (const double velocity : {10.0, 123.0, 500.0}) {
    Rig rig(Fenced());
    ASSERT_TRUE(rig.PowerOn());
    const Ticket move =
        rig.Give(MoveVelocity{.velocity = velocity, .acceleration = 1000, .deceleration = 500, .jerk = 20000});
    const std::size_t from = rig.trace.size();
    ASSERT_TRUE(rig.RunToEnd(move, 60));
    EXPECT_EQ(rig.lives[move].error_id, ErrorId::kSoftLimitPositive);
    rig.Run(1);
    EXPECT_EQ(rig.out.error, ErrorId::kSoftLimitPositive);
    EXPECT_EQ(rig.out.state, PlcState::kErrorStop);
    EXPECT_TRUE(rig.out.loop_closed);
    EXPECT_LE(rig.position(), 100 + 1e-9);
    EXPECT_GT(rig.position(), 100 - 1.5 * velocity * 0.001 - 0.01);  // no further off than a cycle's way
    const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
    EXPECT_LE(worst.acceleration, 1 + 1e-9);
    EXPECT_LE(worst.jerk, 1 + 1e-6);
    ASSERT_TRUE(rig.RunToEnd(rig.Give(Reset{})));
    ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = 0})));
    EXPECT_EQ(rig.position(), 0);
  }
}

// AX-13: a new command with a weak deceleration does not carry the axis over a limit that a stop at the axis' own
// deceleration keeps.
TEST(SoftLimit, IsKeptByABrakingHarderThanAsked) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  while (rig.position() < 50) rig.Step();
  const Ticket weak = rig.Give(MoveAbsolute{.position = 60, .deceleration = 100, .jerk = 1000});
  ASSERT_TRUE(rig.RunToEnd(weak));
  double furthest = 0;
  for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
  EXPECT_LE(furthest, 100 + 1e-9);
  EXPECT_EQ(rig.position(), 60);
}

// AX-13: nor does a halt or stop.
TEST(SoftLimit, IsKeptByAWeakHalt) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  while (rig.position() < 50) rig.Step();
  rig.Give(Halt{.deceleration = 100, .jerk = 1000});
  rig.Run(10);
  double furthest = 0;
  for (const Sample& s : rig.trace) furthest = std::max(furthest, s.setpoint.position);
  EXPECT_LE(furthest, 100 + 1e-9);
}

// AX-13: a command with a weak jerk, given while the axis accelerates hard towards its largest velocity, does not carry
// it beyond that.
TEST(VelocityLimit, IsKeptByARampHarderThanAsked) {
  for (const Command& weak :
       {Command(MoveVelocity{.velocity = 400, .jerk = 5000}), Command(MoveAbsolute{.position = 2000, .jerk = 5000}),
        Command(Halt{.jerk = 5000}), Command(Jog{.forward = true, .velocity = 500, .jerk = 5000})}) {
    Rig rig(LinearParams());
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveVelocity{.velocity = 500});
    while (rig.state.setpoint.velocity < 300) rig.Step();
    const std::size_t from = rig.trace.size();
    rig.Give(weak);
    rig.Run(2);
    const Worst worst = WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from);
    EXPECT_LE(worst.velocity, 1 + 1e-9);
    EXPECT_LE(worst.acceleration, 1 + 1e-9);
    EXPECT_LE(worst.jerk, 1 + 1e-6);
  }
}

// An axis that stands outside may move back inside and only there.
TEST(SoftLimit, LetsAnAxisOutsideComeBack) {
  Rig rig(Fenced());
  rig.frozen = true;
  for (int i = 0; i < 600; ++i) {  // pushed out by hand
    rig.inputs.counts += 200'000;
    rig.Step();
  }
  rig.frozen = false;
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_NEAR(rig.position(), 120, 1e-6);
  const Ticket out = rig.Give(MoveVelocity{.velocity = 10});
  rig.Step();
  EXPECT_EQ(rig.lives[out].error_id, ErrorId::kTargetBehindLimit);
  const Ticket back = rig.Give(MoveVelocity{.velocity = 100, .direction = Direction::kNegative});
  rig.Run(0.5);
  EXPECT_TRUE(rig.lives[back].reached);
  EXPECT_LT(rig.position(), 100);
}

// AX-06, AX-11: beyond the axis' limits, not a number, infinite, negative: error 0005, and the motion in progress does
// not notice.
TEST(Commands, BeyondTheLimitsAreRefusedAndDisturbNothing) {
  Rig calm(LinearParams());
  Rig rig(LinearParams());
  for (Rig* r : {&calm, &rig}) {
    ASSERT_TRUE(r->PowerOn());
    r->Give(MoveAbsolute{.position = 300});
  }
  std::vector<Ticket> refused;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, -1.0, 0.0, 5001.0, 1e300}) {
    refused.push_back(rig.Give(MoveAbsolute{.position = 1, .acceleration = bad}));
    refused.push_back(rig.Give(MoveAbsolute{.position = 1, .deceleration = bad}));
    refused.push_back(rig.Give(MoveRelative{.distance = 1, .velocity = bad}));
    if (bad != 5001.0) refused.push_back(rig.Give(MoveVelocity{.velocity = bad == 0 ? -0.5 : bad}));
    refused.push_back(rig.Give(Halt{.deceleration = bad}));
    refused.push_back(rig.Give(Stop{.deceleration = bad}));
    refused.push_back(rig.Give(Jog{.forward = true, .velocity = bad}));
    if (bad != 5001.0) refused.push_back(rig.Give(MoveAbsolute{.position = 1, .jerk = bad}));
    if (!std::isfinite(bad)) refused.push_back(rig.Give(MoveAbsolute{.position = bad}));
    if (!std::isfinite(bad)) refused.push_back(rig.Give(MoveRelative{.distance = bad}));
  }
  refused.push_back(rig.Give(MoveAbsolute{.position = 1, .direction = static_cast<Direction>(77)}));
  refused.push_back(rig.Give(MoveAbsolute{.position = 1, .buffer_mode = static_cast<BufferMode>(77)}));
  for (int i = 0; i < 2000; ++i) {
    calm.Step();
    rig.Step();
    ASSERT_EQ(calm.state.setpoint, rig.state.setpoint);
  }
  for (const Ticket t : refused) EXPECT_EQ(rig.lives[t].error_id, ErrorId::kParameter) << t;
}

// AX-06 for people: the sentence names the argument, the limit and what was found.
TEST(Commands, SayWhyTheyAreRefused) {
  const std::string why = Diagnose(MoveAbsolute{.position = 1, .velocity = 900}, LinearParams());
  EXPECT_NE(why.find("velocity"), std::string::npos) << why;
  EXPECT_NE(why.find("500"), std::string::npos) << why;
  EXPECT_NE(why.find("900"), std::string::npos) << why;
  EXPECT_EQ(Diagnose(MoveAbsolute{.position = 1}, LinearParams()), "");
  EXPECT_EQ(Diagnose(Reset{}, LinearParams()), "");
  EXPECT_NE(Diagnose(MoveAbsolute{.position = 361}, RotaryParams()), "");
}

// Where nothing can be planned the command fails with 3004 and the motion in progress is kept to its stop. With a jerk
// limit so small that the numbers of a move no longer fit into doubles both scales of the planner give up.
TEST(Planning, FailureKeepsTheMotionInProgress) {
  AxisParams p = LinearParams();
  p.limits = {.velocity = 1, .acceleration = 1e-3, .deceleration = 1e-3, .jerk = 1e-3, .lower = {}, .upper = {}};
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveAbsolute{.position = 0.01});
  rig.Run(1);
  Ticket hopeless = 0;
  for (const double target : {1e12, -1e12}) {
    hopeless = rig.Give(MoveAbsolute{.position = target, .velocity = 1e-300, .acceleration = 1e-300, .jerk = 1e-300});
    rig.Step();
    EXPECT_EQ(rig.lives[hopeless].error_id, ErrorId::kPlanning);
  }
  EXPECT_EQ(rig.planner.counters().failures, 2u);
  ASSERT_TRUE(rig.RunToEnd(move, 60));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_EQ(rig.position(), 0.01);
}

// AX-01: an axis may count in anything; the same move in micrometres, millimetres and metres takes the same cycles and
// ends at the same place.
TEST(Units, DoNotMatter) {
  std::vector<std::vector<double>> runs;
  for (const double scale : {1000.0, 1.0, 0.001}) {
    AxisParams p = LinearParams();
    p.limits = {.velocity = 500 * scale,
                .acceleration = 5000 * scale,
                .deceleration = 4000 * scale,
                .jerk = 1e5 * scale,
                .lower = {},
                .upper = {}};
    p.encoder.increments_per_unit = 1e6 / scale;
    Rig rig(p);
    ASSERT_TRUE(rig.PowerOn());
    rig.Give(MoveAbsolute{.position = 123 * scale});
    rig.Run(0.1);
    const Ticket back = rig.Give(MoveAbsolute{.position = -45 * scale});
    ASSERT_TRUE(rig.RunToEnd(back));
    std::vector<double> positions;
    for (const Sample& s : rig.trace) positions.push_back(s.setpoint.position / scale);
    runs.push_back(positions);
  }
  for (const auto& run : runs) {
    ASSERT_EQ(run.size(), runs[1].size());
    for (std::size_t i = 0; i < run.size(); ++i) ASSERT_NEAR(run[i], runs[1][i], 1e-6);
  }
}

// AX-83, AX-13: what holds at the upper SW limit holds at the lower one.
TEST(SoftLimit, HoldsBelowAsAbove) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket move = rig.Give(MoveVelocity{.velocity = 300, .direction = Direction::kNegative});
  ASSERT_TRUE(rig.RunToEnd(move, 60));
  EXPECT_EQ(rig.lives[move].error_id, ErrorId::kSoftLimitNegative);
  rig.Run(1);
  EXPECT_GE(rig.position(), -100 - 1e-9);
  EXPECT_LT(rig.position(), -99);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(Reset{})));
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = -100})));
  const Ticket out = rig.Give(MoveVelocity{.velocity = 1, .direction = Direction::kNegative});
  rig.Step();
  EXPECT_EQ(rig.lives[out].error_id, ErrorId::kTargetBehindLimit);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = 50})));
  rig.Give(MoveVelocity{.velocity = 500, .direction = Direction::kNegative});
  while (rig.position() > -50) rig.Step();
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = -60, .deceleration = 100, .jerk = 1000})));
  for (const Sample& s : rig.trace) ASSERT_GE(s.setpoint.position, -100 - 1e-9);
}

// An axis that stands outside below comes back in like one above, with the ramps asked for.
TEST(SoftLimit, LetsAnAxisBelowComeBack) {
  for (const double side : {1.0, -1.0}) {
    Rig rig(Fenced());
    rig.frozen = true;
    for (int i = 0; i < 600; ++i) {
      rig.inputs.counts += static_cast<std::uint32_t>(static_cast<std::int32_t>(side * 200'000));
      rig.Step();
    }
    rig.frozen = false;
    ASSERT_TRUE(rig.PowerOn());
    ASSERT_NEAR(rig.position(), side * 120, 1e-6);
    const std::size_t from = rig.trace.size();
    const Ticket back = rig.Give(MoveVelocity{.velocity = 100,
                                              .acceleration = 1000,
                                              .jerk = 20000,
                                              .direction = side > 0 ? Direction::kNegative : Direction::kPositive});
    rig.Run(0.5);
    EXPECT_TRUE(rig.lives[back].reached);
    EXPECT_LT(side * rig.position(), 100);
    EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
    EXPECT_LE(WorstOf(rig.trace, {100, 1000, 4000, 20000}, 0.001, from).acceleration, 1 + 1e-9);
  }
}

// AX-13: a way back with weak acceleration, which also weakens the brake where the motion reverses.
TEST(SoftLimit, IsKeptWhereTheWayBackIsWeak) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  while (rig.position() < 50) rig.Step();
  const Ticket back = rig.Give(MoveAbsolute{.position = 0, .acceleration = 100});
  rig.Step();
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kPosition);
  ASSERT_TRUE(rig.RunToEnd(back));
  EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
  for (const Sample& s : rig.trace) ASSERT_LE(s.setpoint.position, 100 + 1e-9);
}

// AX-13: a weak move that had to be made harder stays so when a blending move joins it.
TEST(SoftLimit, IsKeptWhenAMoveIsPlannedAnew) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500});
  while (rig.position() < 50) rig.Step();
  rig.Give(MoveAbsolute{.position = 60, .deceleration = 100, .jerk = 1000});
  rig.Step();
  const Ticket second = rig.Give(MoveAbsolute{.position = 20, .buffer_mode = BufferMode::kBlendingLow});
  ASSERT_TRUE(rig.RunToEnd(second));
  EXPECT_EQ(rig.position(), 20);
  for (const Sample& s : rig.trace) ASSERT_LE(s.setpoint.position, 100 + 1e-9);
}

// AX-13, AX-39: nor does a jog that is let go carry the axis over a limit, however weak its ramp.
TEST(SoftLimit, IsKeptByAWeakJog) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  const Ticket jog = rig.Give(Jog{.forward = true, .velocity = 500, .deceleration = 100, .jerk = 100000});
  while (rig.position() < 50) rig.Step();
  rig.Let(jog);
  ASSERT_TRUE(rig.RunToEnd(jog));
  for (const Sample& s : rig.trace) ASSERT_LE(s.setpoint.position, 100 + 1e-9);
}

// AX-13: the same downwards.
TEST(VelocityLimit, IsKeptDownwardsToo) {
  Rig rig(LinearParams());
  ASSERT_TRUE(rig.PowerOn());
  rig.Give(MoveVelocity{.velocity = 500, .direction = Direction::kNegative});
  while (rig.state.setpoint.velocity > -300) rig.Step();
  const std::size_t from = rig.trace.size();
  rig.Give(MoveVelocity{.velocity = 400, .jerk = 5000, .direction = Direction::kNegative});
  rig.Run(2);
  EXPECT_LE(WorstOf(rig.trace, rig.params.planner_limits(), 0.001, from).velocity, 1 + 1e-9);
}

// AX-06: positions a double cannot tell apart any more; on rotary axes anything but a position of the turn; a motion
// without an end in no sense.
TEST(Commands, OutsideWhatPositionsAndSensesThereAreAreRefused) {
  Rig linear(LinearParams());
  Rig rotary(RotaryParams());
  ASSERT_TRUE(linear.PowerOn());
  ASSERT_TRUE(rotary.PowerOn());
  std::vector<std::pair<Rig*, Command>> bad = {
      {&linear, MoveAbsolute{.position = 1.001e12}},
      {&linear, MoveRelative{.distance = -1.001e12}},
      {&linear, MoveVelocity{.velocity = 1, .direction = Direction::kShortest}},
      {&rotary, MoveAbsolute{.position = -0.001}},
      {&rotary, MoveAbsolute{.position = 360.001}},
  };
  for (const auto& [rig, command] : bad) {
    const Ticket t = rig->Give(command);
    rig->Step();
    EXPECT_EQ(rig->lives[t].error_id, ErrorId::kParameter);
    EXPECT_NE(Diagnose(command, rig->params), "");
  }
  EXPECT_EQ(Diagnose(MoveVelocity{.velocity = 1, .direction = Direction::kShortest}, LinearParams()),
            "direction: expected another value, this command has no such direction");
}

// AX-13: an axis without a jerk limit takes any jerk, and keeps it.
TEST(Commands, MayHaveAJerkWhereTheAxisHasNone) {
  AxisParams p = LinearParams();
  p.limits.jerk = 0;
  Rig rig(p);
  ASSERT_TRUE(rig.PowerOn());
  const std::size_t from = rig.trace.size();
  const Ticket move = rig.Give(MoveAbsolute{.position = 50, .jerk = 30000});
  ASSERT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
  EXPECT_LE(WorstOf(rig.trace, {500, 5000, 4000, 30000}, 0.001, from).jerk, 1 + 1e-6);
}

// AX-33, AX-83: no speed is none towards a limit either; but on the way to it a weak ramp is not waited for.
TEST(SoftLimit, AndAVelocityOfZero) {
  Rig rig(Fenced());
  ASSERT_TRUE(rig.PowerOn());
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = 100})));
  const Ticket none = rig.Give(MoveVelocity{.velocity = 0});
  rig.Run(0.01);
  EXPECT_TRUE(rig.lives[none].reached);
  ASSERT_TRUE(rig.RunToEnd(rig.Give(MoveAbsolute{.position = -100})));
  rig.Give(MoveVelocity{.velocity = 500});
  while (rig.position() < 50) rig.Step();
  const Ticket weak = rig.Give(MoveVelocity{.velocity = 0, .deceleration = 100});
  ASSERT_TRUE(rig.RunToEnd(weak));
  EXPECT_EQ(rig.lives[weak].error_id, ErrorId::kSoftLimitPositive);
  rig.Run(1);
  for (const Sample& s : rig.trace) ASSERT_LE(s.setpoint.position, 100 + 1e-9);
}

// A move that leads an axis back inside is made with the ramps asked for.
TEST(SoftLimit, DoesNotHardenTheWayBackInside) {
  for (const double side : {1.0, -1.0}) {
    Rig rig(Fenced());
    rig.frozen = true;
    for (int i = 0; i < 600; ++i) {
      rig.inputs.counts += static_cast<std::uint32_t>(static_cast<std::int32_t>(side * 200'000));
      rig.Step();
    }
    rig.frozen = false;
    ASSERT_TRUE(rig.PowerOn());
    const std::size_t from = rig.trace.size();
    const Ticket back = rig.Give(MoveAbsolute{.position = side * 50, .acceleration = 500, .deceleration = 500});
    rig.Step();
    EXPECT_EQ(rig.out.limited_by, LimitedBy::kNothing);
    ASSERT_TRUE(rig.RunToEnd(back));
    EXPECT_EQ(rig.position(), side * 50);
    EXPECT_LE(WorstOf(rig.trace, {500, 500, 500, 100000}, 0.001, from).acceleration, 1 + 1e-9);
  }
}

// AX-13: what is said of a set point near SW limits or far from them, at whatever speed and acceleration, is what the
// stop from there does when it is planned.
TEST(SoftLimitProperty, CanStopInsideIsWhatAPlannedStopDoes) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  trajectory::Planner planner;
  int inside = 0;
  for (int i = 0; i < 200000; ++i) {
    AxisParams p = Fenced();
    p.limits.deceleration = 1000 * std::pow(10, any(random));
    p.limits.jerk = i % 5 ? 100000 * std::pow(10, 2 * any(random)) : 0;
    const KinematicState x{110 * any(random), 500 * any(random) * std::pow(10, -2 + 2 * any(random)),
                           i % 3 ? 5000 * any(random) : 0};
    trajectory::Profile stop{x};
    ASSERT_TRUE(planner.Stop(x, p.planner_limits(), stop).ok());
    const trajectory::Profile::Range range = stop.PositionRange();
    const double margin = std::min(100 - range.max, range.min + 100);
    if (std::abs(margin) < 1e-6) continue;  // rounding may say either
    const KinematicState middle{0, 0, 0};
    ASSERT_EQ(CanStopInside(p, middle, x), margin > 0) << i;
    inside += margin > 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 50000);
  EXPECT_LT(inside, 180000);
}

}  // namespace
}  // namespace takt::axis
