// PL-10, PL-11: windows of C, and turns by a modulus.
#include "rig.h"

namespace takt::mover {
namespace {

// PL-10: the limits of C, four times, each turned by 90 deg: the manual's list for +-15 deg.
TEST(MoverTurns, WindowsAreThereFourTimes) {
  const CoordinateParams c = MoverParams{}.c;
  for (const double turn : {-360.0, 0.0, 720.0}) {
    for (const auto& [lower, upper] : {std::pair(-15.0, 15.0), {75, 105}, {165, 195}, {255, 285}}) {
      EXPECT_TRUE(InOneWindow(c, turn + lower, turn + upper));
      EXPECT_TRUE(InOneWindow(c, turn + lower + 3, turn + lower + 3));
      EXPECT_FALSE(InOneWindow(c, turn + lower - 0.01, turn + lower + 1));
      EXPECT_FALSE(InOneWindow(c, turn + upper - 1, turn + upper + 0.01));
      EXPECT_FALSE(InOneWindow(c, turn + upper + 30, turn + upper + 31));
    }
    EXPECT_FALSE(InOneWindow(c, turn, turn + 90));  // from one window to the next
  }
  CoordinateParams aside = c;
  aside.lower = 20;
  aside.upper = 30;
  EXPECT_TRUE(InOneWindow(aside, 20, 30));
  EXPECT_TRUE(InOneWindow(aside, -70, -60));
  EXPECT_FALSE(InOneWindow(aside, 0, 0));
}

// PL-10: the manual's program: to 20 deg, and on to 90.
TEST(MoverTurns, OutOfAWindowXAndYAreLocked) {
  Rig rig;
  rig.Enable();
  const Ticket out = rig.Give(MoveC{.position = 20});
  rig.Step();
  EXPECT_EQ(rig.out.command_mode, CommandMode::kCRotationFreeMovement);  // from the start
  EXPECT_EQ(rig.Of(rig.Give(MoveToPosition{.x = 10})).error, ErrorId::kCommandMode);
  EXPECT_EQ(rig.Become(out), FeedbackState::kDone);
  EXPECT_EQ(rig.out.c, 20);
  EXPECT_EQ(rig.out.command_mode, CommandMode::kCRotationFreeMovement);
  const Ticket on = rig.Give(MoveC{.position = 90});
  while (!IsFinal(rig.Of(on).state)) {
    EXPECT_EQ(rig.out.command_mode, CommandMode::kCRotationFreeMovement);  // also while it passes 80
    rig.Step();
  }
  EXPECT_EQ(rig.out.command_mode, CommandMode::kFreeMovement);
  EXPECT_EQ(rig.Become(rig.Give(MoveToPosition{.x = 10})), FeedbackState::kDone);
}

TEST(MoverTurns, WithinAWindowItTurnsOnTheWay) {
  Rig rig;
  rig.Enable();
  const Ticket move = rig.Give(MoveToPosition{.x = 500});
  rig.Run(100);
  EXPECT_EQ(rig.Of(rig.Give(MoveC{.position = 16})).error, ErrorId::kOutsideWindow);
  const Ticket turn = rig.Give(MoveC{.position = 14});
  rig.Step();
  EXPECT_EQ(rig.out.command_mode, CommandMode::kFreeMovement);
  EXPECT_TRUE(rig.out.busy_xyc && rig.out.busy_c);
  EXPECT_EQ(rig.Become(turn), FeedbackState::kDone);
  EXPECT_EQ(rig.Become(move), FeedbackState::kDone);
}

// PL-11: against a search of all equivalent positions.
TEST(MoverTurns, DirectionsFindTheirPlace) {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    const double turn = Whole(random, 0, 1) ? 360 : 90;
    const double tolerance = Whole(random, 0, 1) ? 0 : Uniform(random, 0, 20);
    const MoverParams params{.c_modulus = turn, .c_modulo_tolerance = tolerance};
    const double from = Uniform(random, -900, 900);
    MoveC command{.position = Uniform(random, -900, 900)};
    if (Whole(random, 0, 3) == 0) command.position = from + turn * Whole(random, -3, 3) + Uniform(random, -15, 15);
    const auto target = [&](TurnDirection direction, std::uint32_t turns) {
      command.direction = direction;
      command.additional_turns = turns;
      return TargetOf(params, {from, 0, 0}, from, command);
    };
    double above = 1e9, below = -1e9, nearest = 1e9;
    for (int k = -40; k <= 40; ++k) {
      const double place = command.position + k * turn;
      if (place >= from) above = std::min(above, place);
      if (place <= from) below = std::max(below, place);
      if (std::abs(place - from) < std::abs(nearest - from)) nearest = place;
    }
    const bool near = std::abs(nearest - from) <= tolerance;
    EXPECT_EQ(target(TurnDirection::kNonModulo, 0), command.position);
    EXPECT_NEAR(target(TurnDirection::kShortestWay, 0), nearest, 1e-9);
    EXPECT_NEAR(target(TurnDirection::kPositive, 0), near ? nearest : above, 1e-9);
    EXPECT_NEAR(target(TurnDirection::kNegative, 0), near ? nearest : below, 1e-9);
    EXPECT_NEAR(target(TurnDirection::kPositive, 2), (near ? nearest : above) + 2 * turn, 1e-9);
    EXPECT_NEAR(target(TurnDirection::kNegative, 1), (near ? nearest : below) - turn, 1e-9);
  }
}

// Both directions are equally short: the one to the given target.
TEST(MoverTurns, HalfATurnLeadsToWhatWasGiven) {
  for (const double given : {180.0, -180.0}) {
    const MoveC command{.position = given, .direction = TurnDirection::kShortestWay};
    EXPECT_EQ(TargetOf({}, {}, 0, command), given);
  }
}

TEST(MoverTurns, APositiveTurnDoesNotReverse) {
  Rig rig;
  rig.Enable();
  rig.Give(MoveC{.position = 30, .direction = TurnDirection::kPositive, .additional_turns = 2});
  rig.Run(400);
  ASSERT_GT(rig.out.velocity_c, 100);
  const double ahead = rig.out.c + 1;  // too near for a stop there
  const Ticket turn = rig.Give(MoveC{.position = ahead, .direction = TurnDirection::kPositive});
  while (!IsFinal(rig.Of(turn).state)) {
    rig.Step();
    EXPECT_GE(rig.out.velocity_c, 0);
  }
  EXPECT_NEAR(rig.out.c, ahead + 360, 1e-9);
}

// A halt with low deceleration does not carry the mover out of its window, or its limits.
TEST(MoverTurns, AHaltStaysWithinTheWindow) {
  MoverParams params;
  params.c.standard = Dynamics{10, 20, {}, 100};
  params.z.standard = Dynamics{10, 20, {}, 100};
  Rig rig(params);
  rig.Enable();
  Watch watch(rig);
  rig.Give(MoveToPosition{.x = 1000});
  rig.Give(MoveC{.position = 14.9, .velocity = 100.0, .acceleration = 3600.0, .deceleration = 3600.0, .jerk = 72000.0});
  rig.Give(MoveZ{.position = 4.9, .velocity = 60.0, .acceleration = 1000.0, .deceleration = 1000.0, .jerk = 20000.0});
  for (int i = 0; i < 100; ++i) {
    rig.Step();
    watch.Look();
  }
  ASSERT_GT(rig.out.velocity_c, 50);
  const Ticket halt = rig.Give(Halt{});
  while (!IsFinal(rig.Of(halt).state)) {
    rig.Step();
    watch.Look();
  }
  EXPECT_EQ(rig.out.command_mode, CommandMode::kFreeMovement);
}

}  // namespace
}  // namespace takt::mover
