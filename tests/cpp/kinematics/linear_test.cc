// GR-11, GR-12: gantries, with one axis per coordinate or on crossed belts.
#include "takt/kinematics/linear.h"

#include <gtest/gtest.h>

#include <kdl/chainfksolverpos_recursive.hpp>
#include <numbers>

#include "../core/trials.h"
#include "mechanisms.h"

namespace takt::kinematics {
namespace {

using testing::ForwardOrFail;
using testing::FromYaml;
using testing::Random;

// GR-11: one to three linear axes and C, in any order.
TEST(Gantry, MovesWhatItsAxesSay) {
  const Kinematics k = FromYaml("{gantry: {axes: [z, y, c]}}");
  EXPECT_EQ(k.count, 3u);
  const Pose pose = ToPose(ForwardOrFail(k, {30, 20, 45}));
  EXPECT_EQ(pose.x, 0);
  EXPECT_EQ(pose.y, 20);
  EXPECT_EQ(pose.z, 30);
  EXPECT_NEAR(pose.c, 45, 1e-12);
  Joints joints{};
  ASSERT_EQ(Inverse(k, ToFrame({.y = 7, .z = 8, .c = -170}), {}, {0, 0, 175}, joints), Reason::kNone);
  EXPECT_EQ(joints[0], 8);
  EXPECT_EQ(joints[1], 7);
  EXPECT_NEAR(joints[2], 190, 1e-10);
}

// GR-11: forward compared with KDL's own chain.
TEST(Gantry, PropertyAgreesWithKdl) {
  const Kinematics k = FromYaml("{gantry: {axes: [x, y, z, c]}}");
  KDL::Chain chain;
  for (const auto type : {KDL::Joint::TransX, KDL::Joint::TransY, KDL::Joint::TransZ, KDL::Joint::RotZ})
    chain.addSegment(KDL::Segment(KDL::Joint(type), Frame::Identity()));
  KDL::ChainFkSolverPos_recursive solver(chain);
  Random random(51);
  for (int i = 0; i < Trials(1000); ++i) {
    KDL::JntArray q(4);
    Joints joints{};
    for (unsigned n = 0; n < 4; ++n) {
      joints[n] = random.Between(-1000, 1000);
      q(n) = n < 3 ? joints[n] : joints[n] * std::numbers::pi / 180;
    }
    Frame expected;
    solver.JntToCart(q, expected);
    ASSERT_TRUE(KDL::Equal(ForwardOrFail(k, joints), expected, 1e-10));
  }
}

// GR-12: a coordinate that no axis moves must be 0; C without a C axis is ignored.
TEST(Gantry, RefusesWhatNoAxisMoves) {
  const Kinematics k = FromYaml("{gantry: {axes: [x, y]}}");
  Joints joints{};
  EXPECT_EQ(Inverse(k, ToFrame({.x = 1, .y = 2}), {}, {}, joints), Reason::kNone);
  EXPECT_EQ(Inverse(k, ToFrame({.x = 1, .y = 2, .c = 180}), {}, {}, joints), Reason::kNone);
  EXPECT_EQ(Inverse(k, ToFrame({.x = 1, .y = 2, .z = 1e-6}), {}, {}, joints), Reason::kOutOfReach);
  EXPECT_EQ(Inverse(k, ToFrame({.x = 1, .a = 1e-6}), {}, {}, joints), Reason::kOrientation);
  JointMotion motion;
  const KDL::Twist up({0, 0, 1}, {0, 0, 0});
  EXPECT_EQ(Inverse(k, MovingFrame(ToFrame({.x = 1}), up, KDL::Twist::Zero()), {}, {}, motion), Reason::kOutOfReach);
  EXPECT_EQ(Inverse(k, MovingFrame(ToFrame({.x = 1}), KDL::Twist::Zero(), up), {}, {}, motion), Reason::kOutOfReach);
}

// GR-11: by hand: both motors alike move X, against one another Y; a motor alone moves along a diagonal, half as far
// each.
TEST(CoreXy, MovesAlongDiagonals) {
  const Kinematics k = FromYaml("{core_xy: {with_z: true}}");
  EXPECT_EQ(k.count, 3u);
  const auto expect = [&](const Joints& joints, double x, double y, double z) {
    const Frame tool = ForwardOrFail(k, joints);
    EXPECT_EQ(tool.p.x(), x);
    EXPECT_EQ(tool.p.y(), y);
    EXPECT_EQ(tool.p.z(), z);
  };
  expect({10, 10, 0}, 10, 0, 0);
  expect({10, -10, 0}, 0, 10, 0);
  expect({10, 0, 5}, 5, 5, 5);
  expect({0, 10, 0}, 5, -5, 0);
  Joints joints{};
  ASSERT_EQ(Inverse(k, ToFrame({.x = 3, .y = 4, .z = 5}), {}, {}, joints), Reason::kNone);
  EXPECT_EQ(joints[0], 7);
  EXPECT_EQ(joints[1], -1);
  EXPECT_EQ(joints[2], 5);
}

// GR-11: an H-bot whose second motor counts in the opposite sense.
TEST(CoreXy, TakesAMotorThatCountsTheOtherWay) {
  const Kinematics k = FromYaml("{core_xy: {}, joints: [{}, {invert: true, zero: 100}]}");
  const Frame tool = ForwardOrFail(k, {10, 90});
  EXPECT_EQ(tool.p.x(), 10);
  EXPECT_EQ(tool.p.y(), 0);
}

}  // namespace
}  // namespace takt::kinematics
