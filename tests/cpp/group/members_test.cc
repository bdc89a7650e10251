// GR-02: who belongs to a group, what it is told of itself, and what is refused.
#include "machines.h"
#include "watch.h"

namespace takt::group {
namespace {

ErrorId ErrorOf(Rig& rig, const Command& command) {
  const Ticket ticket = rig.Give(command);
  EXPECT_TRUE(rig.RunToEnd(ticket, 5));
  EXPECT_NE(rig.lives[ticket].done, rig.lives[ticket].error);
  return rig.lives[ticket].error_id;
}

// A member twice (1000), a place taken or none left (1001), nobody there (1003), somebody else's (1004), none at all
// (1005).
TEST(Members, AreRefused) {
  Rig rig = GantryWithAuxiliary();
  EXPECT_EQ(ErrorOf(rig, AddAxis{Name::Of("x"), 5}), ErrorId::kGroupMember);
  EXPECT_EQ(static_cast<int>(ErrorId::kGroupMember), 1000);
  ASSERT_EQ(ErrorOf(rig, RemoveAxis{4}), ErrorId::kNone);
  EXPECT_EQ(rig.out().axes, 3U);
  EXPECT_EQ(ErrorOf(rig, AddAxis{Name::Of("u"), 1}), ErrorId::kGroupFull);
  EXPECT_EQ(static_cast<int>(ErrorId::kGroupFull), 1001);
  EXPECT_EQ(ErrorOf(rig, RemoveAxis{4}), ErrorId::kNotGroupMember);
  EXPECT_EQ(static_cast<int>(ErrorId::kNotGroupMember), 1003);
  rig.group_of[3] = 2;
  EXPECT_EQ(ErrorOf(rig, AddAxis{Name::Of("u"), 4}), ErrorId::kOtherGroupMember);
  EXPECT_EQ(static_cast<int>(ErrorId::kOtherGroupMember), 1004);
  rig.group_of[3] = 0;
  EXPECT_EQ(ErrorOf(rig, AddAxis{Name::Of("u"), 4}), ErrorId::kNone);
  EXPECT_EQ(ErrorOf(rig, AddAxis{Name::Of("nobody"), 5}), ErrorId::kUnknownTarget);
  EXPECT_EQ(ErrorOf(rig, UngroupAllAxes{}), ErrorId::kNone);
  EXPECT_EQ(rig.out().axes, 0U);
  EXPECT_EQ(rig.group_of, std::vector<std::uint32_t>(4));
  EXPECT_EQ(static_cast<int>(ErrorId::kGroupEmpty), 1005);
  EXPECT_EQ(ErrorOf(rig, UngroupAllAxes{}), ErrorId::kGroupEmpty);
  EXPECT_EQ(ErrorOf(rig, Enable{}), ErrorId::kGroupEmpty);
  EXPECT_EQ(ErrorOf(rig, Power{}), ErrorId::kGroupEmpty);
  EXPECT_EQ(ErrorOf(rig, RemoveAxis{1}), ErrorId::kGroupEmpty);
}

// Not while it moves.
TEST(Members, StayInMotion) {
  Rig rig = GantryWithAuxiliary();
  rig.Start();
  const Ticket move = rig.Give(MoveLinearAbsolute{.x = 100});
  rig.Run(0.05);
  EXPECT_EQ(ErrorOf(rig, RemoveAxis{4}), ErrorId::kState);
  EXPECT_EQ(ErrorOf(rig, AddAxis{Name::Of("u"), 5}), ErrorId::kState);
  EXPECT_EQ(ErrorOf(rig, SetPosition{.a4 = 3}), ErrorId::kState);
  EXPECT_EQ(ErrorOf(rig, SetKinTransform{false}), ErrorId::kState);
  EXPECT_TRUE(rig.RunToEnd(move));
  EXPECT_TRUE(rig.lives[move].done);
}

// In standby the group may change; without an axis of the kinematics it has no tool.
TEST(Members, ChangeInStandby) {
  Rig rig = GantryWithAuxiliary();
  rig.Start();
  EXPECT_EQ(ErrorOf(rig, RemoveAxis{3}), ErrorId::kNone);
  EXPECT_TRUE(std::isnan(rig.out().x));
  EXPECT_EQ(ErrorOf(rig, MoveLinearAbsolute{.x = 10}), ErrorId::kState);
  EXPECT_EQ(ErrorOf(rig, MoveDirectAbsolute{.a1 = 10, .a4 = 5}), ErrorId::kNone);
  EXPECT_NEAR(rig.states[0].setpoint.position, 10, 1e-9);
  EXPECT_NEAR(rig.states[3].setpoint.position, 5, 1e-9);
  EXPECT_EQ(ErrorOf(rig, AddAxis{Name::Of("z"), 3}), ErrorId::kNone);
  EXPECT_EQ(ErrorOf(rig, MoveLinearAbsolute{.x = 20}), ErrorId::kNone);
  EXPECT_NEAR(rig.out().x, 20, 1e-9);
  EXPECT_EQ(ErrorOf(rig, UngroupAllAxes{}), ErrorId::kNone);
  EXPECT_EQ(rig.out().state, GroupState::kDisabled);
}

// GroupSetPosition: other numbers for where the members are, in the axes' system and in the tool's.
TEST(Members, TakeOtherNumbers) {
  Rig rig = GantryWithAuxiliary();
  rig.Start({5, 6, 7, 8});
  EXPECT_EQ(ErrorOf(rig, SetPosition{.a1 = 100, .a4 = -3}), ErrorId::kNone);
  EXPECT_NEAR(rig.states[0].setpoint.position, 100, 1e-9);
  EXPECT_NEAR(rig.states[1].setpoint.position, 6, 1e-9);
  EXPECT_NEAR(rig.states[3].setpoint.position, -3, 1e-9);
  EXPECT_EQ(ErrorOf(rig, SetPosition{.y = 50, .coordinate_system = CoordinateSystem::kMcs}), ErrorId::kNone);
  rig.Step();
  EXPECT_NEAR(rig.out().y, 50, 1e-9);
  EXPECT_EQ(ErrorOf(rig, MoveLinearAbsolute{.x = 90, .y = 40}), ErrorId::kNone);
  EXPECT_NEAR(rig.out().x, 90, 1e-9);
  EXPECT_NEAR(rig.out().y, 40, 1e-9);
  EXPECT_NEAR(rig.states[3].setpoint.position, -3, 1e-9);
}

// 8001: a following error of a member.
TEST(Members, FollowingErrorIsOneOfTheGroup) {
  Rig rig = Gantry();
  for (axis::AxisParams& p : rig.axes) p.supervision.deviation_moving = 1;
  rig.Start();
  rig.Give(MoveLinearAbsolute{.x = 300});
  rig.Run(0.2);
  for (int i = 0; i < 10; ++i, rig.Step()) rig.slip_counts[0] += 0.2e6;
  rig.Run(0.01);
  EXPECT_EQ(static_cast<int>(rig.out().error), 8001);
}

// GR-20, GR-12: what makes no sense is refused, and nothing moves.
TEST(Members, BadInputIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Rig rig = Gantry();
  rig.Start({100, 0, 0});
  rig.Step();
  const std::vector<KinematicState> before = rig.trace.back().set;
  std::vector<Command> bad;
  for (const double wrong : {nan, inf, 1e300}) {
    bad.push_back(MoveLinearAbsolute{.x = wrong});
    bad.push_back(MoveDirectAbsolute{.a1 = wrong});
  }
  for (const double wrong : {nan, inf, 0.0, -1.0}) {
    bad.push_back(MoveLinearAbsolute{.x = 10, .velocity = wrong});
    bad.push_back(MoveLinearAbsolute{.x = 10, .acceleration = wrong});
    bad.push_back(MoveLinearAbsolute{.x = 10, .deceleration = wrong});
    bad.push_back(MoveLinearAbsolute{.x = 10, .jerk = wrong});
    bad.push_back(MoveDirectAbsolute{.a1 = 10, .velocity_factor = wrong});
  }
  bad.push_back(MoveLinearAbsolute{.x = 10, .transition_parameter = nan});
  bad.push_back(MoveLinearAbsolute{.x = 10, .coordinate_system = CoordinateSystem::kPcs, .pcs = 17});
  bad.push_back(MoveLinearAbsolute{.x = 10, .coordinate_system = CoordinateSystem::kPcs, .pcs = 0});
  bad.push_back(MoveLinearAbsolute{.x = 10, .coordinate_system = CoordinateSystem::kAcs});
  bad.push_back(MoveLinearAbsolute{.a1 = 10});
  bad.push_back(MovePath{.path = Name::Of("none")});
  bad.push_back(SetCartesianTransform{1, nan});
  bad.push_back(SetOverride{.velocity_factor = -1});
  bad.push_back(SetOverride{.velocity_factor = nan});
  bad.push_back(AddAxis{Name::Of("x"), 0});
  bad.push_back(RemoveAxis{9});
  bad.push_back(Stop{.deceleration = -1});
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_NE(ErrorOf(rig, bad[i]), ErrorId::kNone) << i;
    rig.Run(0.01);
  }
  EXPECT_EQ(rig.state.state, GroupState::kStandby);
  EXPECT_EQ(rig.trace.back().set, before);
}

// Arcs and lines that are none.
TEST(Members, BadGeometryIsRefused) {
  Rig rig = Gantry();
  rig.Start({100, 0, 0});
  std::vector<std::pair<Command, path::Problem>> bad;
  MoveCircularAbsolute arc{.circ_mode = path::CircMode::kBorder};
  arc.aux_x = 50;
  arc.x = 0;
  bad.emplace_back(arc, path::Problem::kCollinear);
  arc.aux_x = 100;
  bad.emplace_back(arc, path::Problem::kCoincide);
  arc.circ_mode = path::CircMode::kRadius;
  arc.path_choice = path::PathChoice::kShort;
  arc.aux_x = 0;
  bad.emplace_back(arc, path::Problem::kRadiusZero);
  arc.circ_mode = path::CircMode::kCenter;
  arc.path_choice = path::PathChoice::kCounterclockwise;
  arc.normal_z = 1;
  arc.aux_x = 90;
  bad.emplace_back(arc, path::Problem::kNotOnCircle);
  for (const auto& [command, problem] : bad) {
    EXPECT_EQ(ErrorOf(rig, command), ErrorId::kPathGeometry);
    EXPECT_EQ(rig.out().problem, problem);
    EXPECT_NEAR(rig.out().x, 100, 1e-12);
    rig.Run(0.005);
    EXPECT_EQ(rig.out().state, GroupState::kStandby);
  }
}

// GR-20: a move to where the group stands is done at once, also between others.
TEST(Members, ZeroLengthIsDone) {
  Rig rig = Gantry();
  rig.Start({100, 0, 0});
  for (const Command& command :
       {Command(MoveLinearAbsolute{.x = 100}), Command(MoveLinearRelative{}), Command(MoveDirectAbsolute{.a1 = 100})}) {
    const Ticket move = rig.Give(command);
    rig.Run(0.005);
    EXPECT_TRUE(rig.lives[move].done);
    EXPECT_EQ(rig.out().state, GroupState::kStandby);
  }
  const Ticket first = rig.Give(MoveLinearAbsolute{.x = 150});
  const Ticket same = rig.Give(MoveLinearAbsolute{.x = 150, .buffer_mode = BufferMode::kBuffered});
  const Ticket last = rig.Give(MoveLinearAbsolute{.x = 200, .buffer_mode = BufferMode::kBuffered});
  ASSERT_TRUE(rig.RunToEnd(last));
  EXPECT_TRUE(rig.lives[first].done && rig.lives[same].done && rig.lives[last].done);
  EXPECT_NEAR(rig.out().x, 200, 1e-12);
}

}  // namespace
}  // namespace takt::group
