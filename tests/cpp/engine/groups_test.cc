// Groups of axes within a machine: the commands of their members, their step order, what stops them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "portal.h"

namespace takt::engine {
namespace {

using group::GroupState;

// GR-03
TEST(Members, AreNotMovedByThemselvesWhileTheGroupIsEnabled) {
  Portal portal;
  ASSERT_EQ(portal.group().state, GroupState::kStandby);
  const std::vector<axis::Command> own = {axis::MoveAbsolute{.position = 10},
                                          axis::MoveVelocity{.velocity = 10},
                                          axis::Jog{.forward = true},
                                          axis::Halt{},
                                          axis::Stop{},
                                          Gear("a3"),
                                          axis::Home{.position = 1},
                                          axis::SetPosition{.position = 1},
                                          axis::SetOverride{},
                                          axis::SetSoftLimits{},
                                          axis::SetConstants{.kp = 1},
                                          axis::WriteParameter{.number = 2, .value = 1},
                                          axis::DirectOutput{},
                                          axis::Touch{}};
  for (const axis::Command& command : own) {
    for (const std::size_t member : {0u, 1u, 2u}) {
      const Ticket ticket = portal.Give(member, command);
      portal.Step();
      EXPECT_EQ(portal.last[ticket].error, ErrorId::kGroupMember) << command.index();
    }
  }
  const Ticket of_other = portal.Give(3, axis::MoveAbsolute{.position = 10});
  portal.Run(500);
  EXPECT_EQ(portal.last[of_other].state, FeedbackState::kDone);
  portal.Tell(group::Disable{});
  const Ticket then = portal.Give(0, axis::MoveAbsolute{.position = 10});
  portal.Run(500);
  EXPECT_EQ(portal.last[then].state, FeedbackState::kDone);
}

// GR-03
TEST(Members, TakeWhatMovesNothing) {
  Portal portal;
  const std::vector<axis::Command> harmless = {axis::Power{}, axis::Reset{}, axis::ReadParameter{.number = 1},
                                               axis::TouchProbe{}, axis::AbortTrigger{}};
  for (const axis::Command& command : harmless) {
    const Ticket ticket = portal.Give(0, command);
    portal.Run(3);
    EXPECT_NE(portal.last[ticket].error, ErrorId::kGroupMember) << command.index();
  }
}

// GR-25: the master of a path steps before the group, followers of the path after it; no loop.
TEST(Members, FollowInNoLoop) {
  Portal portal;
  const auto error_of = [&](const group::Command& command) {
    const Ticket ticket = portal.Tell(command);
    portal.Run(3);
    return portal.last[ticket].error;
  };
  const Name square = Name::Of("square");
  EXPECT_EQ(error_of(group::MovePathSynchronized{.path = square, .master = Name::Of("a1")}), ErrorId::kCouplingLoop);
  EXPECT_EQ(error_of(group::SyncAxis{.axis = Name::Of("a1")}), ErrorId::kCouplingLoop);
  // a3 follows a member: no path of the group may follow a3.
  portal.Give(3, Gear("a0"));
  portal.Run(3);
  EXPECT_EQ(error_of(group::MovePathSynchronized{.path = square, .master = Name::Of("a3")}), ErrorId::kCouplingLoop);
  // The path follows a4: a4 may not follow a member.
  EXPECT_EQ(error_of(group::MovePathSynchronized{.path = square, .master = Name::Of("a4")}), ErrorId::kNone);
  const Ticket gear = portal.Give(4, Gear("a0"));
  portal.Run(3);
  EXPECT_EQ(portal.last[gear].error, ErrorId::kCouplingLoop);
}

// GR-02: from one group to another, and back: each moves its present members only.
TEST(Members, MoveToAnotherGroup) {
  Machine machine = PortalMachine();
  group::GroupParams other = machine.groups[0];
  other.name = "other";
  other.axes = {"a3", "a4"};
  machine.groups.push_back(other);
  Line line(machine);
  const auto tell = [&](std::size_t index, const group::Command& body) {
    Command command = ToGroup(line.machine, body);
    command.target += static_cast<std::uint32_t>(index);
    const Ticket ticket = line.engine.Submit(command);
    for (int i = 0; i < 2000 && !IsFinal(line.last[ticket].state); ++i) line.Step();
    return line.last[ticket].error;
  };
  for (const std::size_t index : {0u, 1u}) EXPECT_EQ(tell(index, group::Enable{}), ErrorId::kNone);
  const group::AddAxis add{Name::Of("a2"), 3};
  EXPECT_EQ(tell(1, add), ErrorId::kOtherGroupMember);
  EXPECT_EQ(tell(0, group::RemoveAxis{3}), ErrorId::kNone);
  // Between two groups it is free: it accepts commands of its own, and may join only at rest.
  const Ticket own = line.Give(2, axis::MoveAbsolute{.position = 20, .velocity = 200});
  line.Run(20);
  EXPECT_EQ(tell(1, add), ErrorId::kState);
  for (int i = 0; i < 1000 && !IsFinal(line.last[own].state); ++i) line.Step();
  EXPECT_EQ(line.last[own].state, FeedbackState::kDone);
  EXPECT_EQ(tell(1, add), ErrorId::kNone);
  EXPECT_EQ(tell(1, group::MoveLinearAbsolute{.x = 10, .y = 5, .a3 = 50}), ErrorId::kNone);
  EXPECT_NEAR(line.At(2).set_position, 50, 1e-9);
  EXPECT_NEAR(line.At(3).set_position, 10, 1e-9);
  EXPECT_EQ(tell(0, group::MoveLinearAbsolute{.x = 7, .a3 = 1}), ErrorId::kNotGroupMember);
  EXPECT_EQ(tell(0, group::SetPosition{.a3 = 1}), ErrorId::kNotGroupMember);
  EXPECT_EQ(tell(0, group::MoveLinearAbsolute{.x = 7}), ErrorId::kNone);
  EXPECT_NEAR(line.At(0).set_position, 7, 1e-9);
  EXPECT_NEAR(line.At(2).set_position, 50, 1e-9);
  const Ticket refused = line.Give(2, axis::MoveAbsolute{.position = 0});
  line.Step();
  EXPECT_EQ(line.last[refused].error, ErrorId::kGroupMember);
  EXPECT_EQ(tell(1, group::RemoveAxis{3}), ErrorId::kNone);
  EXPECT_EQ(tell(0, add), ErrorId::kNone);
  EXPECT_EQ(tell(0, group::MoveLinearAbsolute{.x = 0, .a3 = 0}), ErrorId::kNone);
  EXPECT_NEAR(line.At(2).set_position, 0, 1e-9);
}

// GR-12: the limits of a URDF apply to moves of the tool and of the axes, if the axes have no limits of their own.
TEST(Members, KeepTheLimitsOfTheirUrdf) {
  const std::string urdf = std::string(TAKT_SOURCE_DIR) + "/tests/cpp/kinematics/cobra.urdf";
  const std::string limits = "limits: {velocity: 300, acceleration: 3000, jerk: 60000}}\n";
  std::string text = "name: cell\naxes:\n";
  for (const std::string axis : {"j1, unit: deg", "j2, unit: deg", "j3", "j4, unit: deg"}) {
    text += "  - {name: " + axis + ", " + limits;
  }
  text += "groups:\n  - {name: arm, axes: [j1, j2, j3, j4], kinematics: {serial: {urdf: " + urdf +
          ", tip: tool}}, path: {velocity: 300, acceleration: 3000, jerk: 60000}}\n";
  const LoadResult loaded = LoadMachine(text, "cell.yaml");
  ASSERT_TRUE(loaded.machine) << loaded.problems.front();
  Line line(*loaded.machine);
  const auto tell = [&](const group::Command& body) {
    const Ticket ticket = line.engine.Submit(ToGroup(line.machine, body));
    for (int i = 0; i < 5000 && !IsFinal(line.last[ticket].state); ++i) line.Step();
    return line.last[ticket].error;
  };
  ASSERT_EQ(tell(group::Enable{}), ErrorId::kNone);
  ASSERT_EQ(tell(group::MoveDirectAbsolute{.a1 = 20, .a2 = 40, .a3 = -50}), ErrorId::kNone);
  // j3 slides from -210 to 0 mm.
  EXPECT_EQ(tell(group::MoveLinearRelative{.z = 60}), ErrorId::kUnreachable);
  EXPECT_EQ(tell(group::MoveDirectRelative{.z = 60, .coordinate_system = group::CoordinateSystem::kMcs}),
            ErrorId::kUnreachable);
  EXPECT_EQ(tell(group::MoveDirectAbsolute{.a3 = 1}), ErrorId::kUnreachable);
  EXPECT_EQ(tell(group::MoveLinearAbsolute{.a3 = -211, .coordinate_system = group::CoordinateSystem::kAcs}),
            ErrorId::kUnreachable);
  EXPECT_NEAR(line.At(2).set_position, -50, 1e-9);
  EXPECT_EQ(tell(group::MoveDirectAbsolute{.a3 = -209}), ErrorId::kNone);
  EXPECT_NEAR(line.At(2).set_position, -209, 1e-9);
}

// EN-42, GR-20: StopAll stops groups on their paths.
TEST(StopAllOfGroups, StopsThemOnTheirPath) {
  Portal portal;
  const Ticket move = portal.Tell(group::MoveLinearAbsolute{.x = 200, .y = 100});
  portal.Run(300);
  ASSERT_EQ(portal.group().state, GroupState::kMoving);
  ASSERT_GT(portal.group().x, 1);
  Command stop;
  stop.body = MachineCommand(StopAll{});
  portal.engine.Submit(stop);
  for (int i = 0; i < 1000; ++i) {
    portal.Step();
    EXPECT_NEAR(portal.group().y, portal.group().x / 2, 1e-6);
  }
  EXPECT_EQ(portal.last[move].state, FeedbackState::kAborted);
  EXPECT_EQ(portal.group().state, GroupState::kStandby);
  EXPECT_TRUE(portal.engine.at_rest());
  EXPECT_LT(portal.group().x, 190);
}

// EN-06
TEST(StopAllOfGroups, OpensTheirLoopsAtShutdown) {
  Portal portal;
  portal.Tell(group::MoveLinearAbsolute{.x = 200, .y = 100});
  portal.Run(300);
  portal.engine.RequestShutdown();
  portal.Run(1500);
  EXPECT_TRUE(portal.engine.all_disabled());
}

// AX-38
TEST(StopAllOfGroups, EmergencyStopSwitchesMembersOff) {
  Portal portal;
  portal.Tell(group::MoveLinearAbsolute{.x = 200, .y = 100});
  portal.Run(300);
  Command stop;
  stop.body = MachineCommand(EmergencyStop{});
  portal.engine.Submit(stop);
  portal.Run(5);
  EXPECT_TRUE(portal.engine.all_disabled());
  EXPECT_NE(portal.group().state, GroupState::kMoving);
  const Ticket move = portal.Tell(group::MoveLinearAbsolute{.x = 0});
  portal.Run(5);
  EXPECT_EQ(portal.last[move].state, FeedbackState::kError);
}

// EN-22: a held stop is released by its ticket, by an expired lease, or stays.
TEST(HeldStop, IsLetGoOf) {
  Portal portal;
  const Ticket stop = portal.Tell(group::Stop{.hold = true});
  portal.Run(50);
  ASSERT_EQ(portal.group().state, GroupState::kStopping);
  Command release;
  release.body = MachineCommand(Release{stop});
  portal.engine.Submit(release);
  portal.Run(5);
  EXPECT_EQ(portal.group().state, GroupState::kStandby);
  Command leased = ToGroup(portal.machine, group::Stop{.hold = true});
  leased.lease_s = 0.1;
  const Ticket held = portal.engine.Submit(leased);
  for (int i = 0; i < 10; ++i) {
    portal.Run(50);
    EXPECT_EQ(portal.group().state, GroupState::kStopping);
    Command renew;
    renew.body = MachineCommand(Renew{held});
    portal.engine.Submit(renew);
  }
  portal.Run(200);
  EXPECT_EQ(portal.group().state, GroupState::kStandby);
}

// A command for a target that is no group, given in C++ without the parser.
TEST(GroupTarget, MustBeAGroup) {
  Portal portal;
  const auto axes = static_cast<std::uint32_t>(portal.machine.axes.size());
  for (const std::uint32_t target : {0u, 1u, axes, axes + 2, 77u, 0xffffffffu}) {
    Command command = ToGroup(portal.machine, group::Halt{});
    command.target = target;
    const Ticket ticket = portal.engine.Submit(command);
    portal.Step();
    EXPECT_EQ(portal.last[ticket].error, ErrorId::kUnknownTarget) << target;
  }
}

// EN-04, GR-20: a run is replayed to the bit.
TEST(GroupStates, ComeOutTheSameAgain) {
  const auto run = [] {
    Portal portal;
    std::vector<std::uint64_t> hashes;
    portal.Tell(group::MovePath{.path = Name::Of("square"),
                                .transition_mode = group::TransitionMode::kMaxCornerDeviation,
                                .transition_parameter = 1});
    for (int i = 0; i < 2000; ++i) {
      portal.Step();
      hashes.push_back(portal.engine.StateHash());
      if (i == 300) portal.Tell(group::Interrupt{});
      if (i == 800) portal.Tell(group::Continue{});
    }
    EXPECT_EQ(portal.group().state, GroupState::kStandby);
    EXPECT_NEAR(portal.group().x, 0, 1e-9);
    EXPECT_NEAR(portal.group().y, 0, 1e-9);
    return hashes;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace takt::engine
