// GR-44: a direct move to a pose is taken whenever some configuration within the axes' ranges leads there, and takes
// the nearest one. Poses come from random positions of the axes.
#include <random>

#include "../core/trials.h"
#include "machines.h"
#include "takt/kinematics/solutions.h"
#include "watch.h"

namespace takt::group {
namespace {

using kinematics::Joints;
using kinematics::Reason;

struct Range {
  double lower, upper;
};

// An arm as its maker's URDF has it: axes that count the other way round, at rest stretched forwards (lengths of an
// Agilus of 1.1 m).
constexpr const char* kStretched = R"(<robot name="stretched">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/><link name="l5"/><link name="l6"/>
  <link name="flange"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.4"/><axis xyz="0 0 -1"/>
    <limit lower="-2.967" upper="2.967" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.025 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-3.316" upper="0.785" effort="1" velocity="1"/></joint>
  <joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0.56 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2.094" upper="2.722" effort="1" velocity="1"/></joint>
  <joint name="j4" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="0 0 0.035"/><axis xyz="-1 0 0"/>
    <limit lower="-3.229" upper="3.229" effort="1" velocity="1"/></joint>
  <joint name="j5" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0.515 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2.094" upper="2.094" effort="1" velocity="1"/></joint>
  <joint name="j6" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0.09 0 0"/><axis xyz="-1 0 0"/>
    <limit lower="-6.109" upper="6.109" effort="1" velocity="1"/></joint>
  <joint name="end" type="fixed"><parent link="l6"/><child link="flange"/><origin rpy="0 1.5708 0"/></joint>
</robot>)";

// An arm with an offset wrist (lengths of a UR5e), stretched to the side of -X at rest.
constexpr const char* kOffset = R"(<robot name="offset">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/><link name="l5"/><link name="l6"/>
  <link name="flange"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.1625"/><axis xyz="0 0 1"/>
    <limit lower="-6.283" upper="6.283" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0 -0.138 0"/><axis xyz="0 -1 0"/>
    <limit lower="-6.283" upper="6.283" effort="1" velocity="1"/></joint>
  <joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="-0.425 0.131 0"/><axis xyz="0 -1 0"/>
    <limit lower="-3.141" upper="3.141" effort="1" velocity="1"/></joint>
  <joint name="j4" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="-0.3922 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-6.283" upper="6.283" effort="1" velocity="1"/></joint>
  <joint name="j5" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0 -0.1263 0"/><axis xyz="0 0 -1"/>
    <limit lower="-6.283" upper="6.283" effort="1" velocity="1"/></joint>
  <joint name="j6" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0 0 -0.0997"/><axis xyz="0 -1 0"/>
    <limit lower="-6.283" upper="6.283" effort="1" velocity="1"/></joint>
  <joint name="end" type="fixed"><parent link="l6"/><child link="flange"/><origin xyz="0 -0.0996 0" rpy="1.5708 0 0"/></joint>
</robot>)";

const std::vector<std::string> kSix = {"a1", "a2", "a3", "a4", "a5", "a6"};

Rig Arm(const std::string& urdf) {
  KinematicsParams k;
  k.serial = {.urdf = urdf, .base = {}, .tip = {}};
  return Machine(k, kSix, {300, 3000, 100000},
                 {.velocity = 1000, .acceleration = 8000, .deceleration = {}, .jerk = 300000});
}

struct PtpCase {
  std::string name;
  Rig rig;
  std::vector<Range> ranges;
};

std::vector<PtpCase> PtpCases() {
  std::vector<PtpCase> cases;
  const std::vector<Range> wide = {{-170, 170}, {-100, 45}, {-120, 66}, {-185, 185}, {-120, 120}, {-350, 350}};
  cases.push_back({"six_axis", SixAxisRobot({10, 5, 120, 0, 30, 0}), wide});
  cases.push_back({"scara", ScaraRobot(), {{-130, 130}, {-145, 145}, {-200, 0}, {-360, 360}}});
  const std::vector<Range> own = {{-169, 169}, {-189, 44}, {-119, 155}, {-184, 184}, {-119, 119}, {-349, 349}};
  cases.push_back({"URDF, stretched at rest", Arm(kStretched), own});
  const std::vector<Range> puma = {{-160, 160}, {-110, 110}, {-135, 135}, {-266, 266}, {-100, 100}, {-266, 266}};
  cases.push_back({"URDF, Puma", Arm(std::string(TAKT_SOURCE_DIR) + "/tests/cpp/kinematics/puma.urdf"), puma});
  cases.push_back({"URDF, offset wrist",
                   Arm(kOffset),
                   {{-270, 270}, {-200, 20}, {-160, 160}, {-350, 350}, {-350, 350}, {-350, 350}}});
  for (PtpCase& one : cases) {
    for (std::size_t k = 0; k < one.ranges.size(); ++k) {
      const kinematics::JointRange& own = one.rig.kinematics->ranges[k];
      one.ranges[k] = {std::max(one.ranges[k].lower, own.lower), std::min(one.ranges[k].upper, own.upper)};
      one.rig.axes[k].limits.lower = one.ranges[k].lower;
      one.rig.axes[k].limits.upper = one.ranges[k].upper;
    }
  }
  return cases;
}

TEST(Ptp, TakesAllThatTheAxesReach) {
  for (PtpCase& one : PtpCases()) {
    SCOPED_TRACE(one.name);
    std::mt19937_64 random(44);
    const Context c = one.rig.Now();
    const auto position = [&] {
      Joints joints{};
      for (std::size_t k = 0; k < one.ranges.size(); ++k) {
        joints[k] = Uniform(random, one.ranges[k].lower, one.ranges[k].upper);
      }
      return joints;
    };
    const auto time = [&](const Joints& from, const Joints& to) {
      double slowest = 0, sum = 0;
      for (std::size_t k = 0; k < one.ranges.size(); ++k) {
        const double takes = std::abs(to[k] - from[k]) / one.rig.axes[k].limits.velocity;
        slowest = std::max(slowest, takes);
        sum += takes;
      }
      return slowest + 1e-3 * sum;
    };
    int others = 0;
    const int poses = Trials(1000);
    for (int i = 0; i < poses; ++i) {
      const Joints there = position(), near = position();
      Frame tool;
      ASSERT_EQ(ToolAt(c, there, tool), Reason::kNone);
      Joints found = near;
      Failures failures;
      ASSERT_EQ(NearestJointsAt(c, one.rig.state, tool, {}, near, found, failures), Reason::kNone) << i;
      Frame reached;
      ToolAt(c, found, reached);
      ASSERT_LE((reached.p - tool.p).Norm(), 1e-6);
      ASSERT_LE(KDL::diff(reached.M, tool.M).Norm(), 1e-8);
      ASSERT_TRUE(WithinRanges(c, one.rig.state, found));
      ASSERT_LE(time(near, found), time(near, there) + 1e-6);
      others += time(near, found) < time(near, there) - 1e-6 ? 1 : 0;
    }
    EXPECT_GT(others, poses / 5) << "a test that cannot fail";
  }
}

// All eight, each another one, and each of them there.
TEST(Ptp, KnowsAllConfigurationsOfAnOffsetWrist) {
  const Rig rig = Arm(kOffset);
  const kinematics::Kinematics& k = *rig.kinematics;
  std::mt19937_64 random(8);
  int eight = 0;
  for (int i = 0; i < 200; ++i) {
    Joints there{};
    for (std::size_t n = 0; n < 6; ++n) there[n] = Uniform(random, -170, 170);
    kinematics::Frame tool;
    ASSERT_EQ(kinematics::Forward(k, there, tool), Reason::kNone);
    const kinematics::Solutions all = kinematics::SolutionsOf(k, tool, {}, there);
    eight += all.count == 8 ? 1 : 0;
    bool known = false;
    for (std::size_t a = 0; a < all.count; ++a) {
      kinematics::Frame reached;
      ASSERT_EQ(kinematics::Forward(k, all.of[a], reached), Reason::kNone);
      ASSERT_LE((reached.p - tool.p).Norm(), 1e-6) << i;
      ASSERT_LE(KDL::diff(reached.M, tool.M).Norm(), 1e-8) << i;
      double most = 0;
      for (std::size_t n = 0; n < 6; ++n) most = std::max(most, std::abs(all.of[a][n] - there[n]));
      known |= most < 1e-4;
      for (std::size_t b = 0; b < a; ++b) ASSERT_FALSE(all.in[a] == all.in[b]);
    }
    ASSERT_TRUE(known) << i;
  }
  EXPECT_GT(eight, 60);
}

// By name: that configuration, or none.
TEST(Ptp, InTheConfigurationAsked) {
  Rig rig = SixAxisRobot();
  rig.Start({0, -30, 60, 0, 50, 0});
  rig.Step();
  const Pose target = kinematics::ToPose(ToolOf(rig));
  int solutions = 0;
  for (const kinematics::Wrist wrist : {kinematics::Wrist::kPositive, kinematics::Wrist::kNegative}) {
    MoveDirectAbsolute move{.x = target.x,
                            .y = target.y + 60,
                            .z = target.z,
                            .a = target.a,
                            .b = target.b,
                            .c = target.c,
                            .coordinate_system = CoordinateSystem::kMcs,
                            .wrist = wrist};
    const Ticket ticket = rig.Give(move);
    ASSERT_TRUE(rig.RunToEnd(ticket, 20));
    ASSERT_TRUE(rig.lives[ticket].done);
    EXPECT_EQ(std::sin(rig.states[4].setpoint.position * std::numbers::pi / 180) > 0,
              wrist == kinematics::Wrist::kPositive);
    ExpectAt(ToolOf(rig), {target.x, target.y + 60, target.z, target.a, target.b, target.c});
    ++solutions;
  }
  EXPECT_EQ(solutions, 2);
}

}  // namespace
}  // namespace takt::group
