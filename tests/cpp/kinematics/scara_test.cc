// GR-11, GR-12: SCARA.
#include "takt/kinematics/scara.h"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "../core/trials.h"
#include "mechanisms.h"
#include "takt/core/angle.h"

namespace takt::kinematics {
namespace {

using testing::ForwardOrFail;
using testing::FromYaml;
using testing::Random;

const char* const kCobra = "{scara: {first_arm: 325, second_arm: 275, height: 387}}";

void ExpectJoints(const Kinematics& k, const Pose& pose, Elbow elbow, const Joints& expected) {
  Joints joints{};
  ASSERT_EQ(Inverse(k, ToFrame(pose), {.elbow = elbow}, {}, joints), Reason::kNone);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(joints[i], expected[i], 1e-9) << "axis " << i;
}

// GR-11: by hand: arms 3 and 4 at a right angle reach 5; a right arm has its elbow to the right of the line to the
// tool.
TEST(Scara, AgreesWithATriangleByHandOnBothArms) {
  const Kinematics k = FromYaml("{scara: {first_arm: 300, second_arm: 400, height: 50}}");
  const double lean = std::atan2(4, 3) / kDegree;  // of the first arm from the line, 53.13 deg
  ExpectJoints(k, {.x = 500, .z = 20}, Elbow::kPositive, {-lean, 90, -30, lean - 90});
  ExpectJoints(k, {.x = 500, .z = 20}, Elbow::kNegative, {lean, -90, -30, 90 - lean});
  ExpectJoints(k, {.y = 500, .z = 20, .c = 90}, Elbow::kPositive, {90 - lean, 90, -30, lean - 90});
  const Frame right = ForwardOrFail(k, {-lean, 90, -30, 0});
  EXPECT_NEAR(right.p.x(), 500, 1e-10);
  EXPECT_NEAR(right.p.y(), 0, 1e-10);
  EXPECT_EQ(ConfigurationOf(k, {-lean, 90, 0, 0}).elbow, Elbow::kPositive);
  EXPECT_EQ(ConfigurationOf(k, {lean, -90, 0, 0}).elbow, Elbow::kNegative);
  EXPECT_EQ(ConfigurationOf(k, {lean, 270, 0, 0}).elbow, Elbow::kNegative);
}

// GR-11, GR-12: the Adept Cobra s600: arms 325 and 275 mm, joint 2 within +-150 deg; its data sheet gives a largest
// reach of 600 mm and a smallest one of 162.6 mm.
TEST(Scara, ReachesAsFarAsTheDataSheetSays) {
  Kinematics k = FromYaml(kCobra);
  k.ranges[1] = {-150, 150};
  Joints joints{};
  const auto ask = [&](double radius) {
    return Inverse(k, ToFrame({.x = radius}), {.elbow = Elbow::kPositive}, {}, joints);
  };
  EXPECT_EQ(ask(600.001), Reason::kOutOfReach);
  EXPECT_EQ(ask(600), Reason::kSingular);
  EXPECT_EQ(ask(599.999), Reason::kNone);
  EXPECT_EQ(ask(162.7), Reason::kNone);
  EXPECT_EQ(ask(162.5), Reason::kAxisLimit);
  EXPECT_EQ(ask(49.9), Reason::kOutOfReach);  // 325 - 275
  EXPECT_EQ(ask(0), Reason::kOutOfReach);
}

// GR-12: from far beyond to just inside both borders, in steps down to rounding; solutions are exact.
TEST(Scara, PropertyIsExactUpToItsBorders) {
  Random random(31);
  const Kinematics k = FromYaml(kCobra);
  for (int i = 0; i < Trials(3000); ++i) {
    const double direction = random.Between(-180, 180) * kDegree;
    const double off = std::pow(10, random.Between(-12, 1.5));
    for (const double radius : {600 - off, 50 + off, 600 + off, 50 - off}) {
      const Frame pose(KDL::Rotation::RotZ(random.Between(-3, 3)),
                       {radius * std::cos(direction), radius * std::sin(direction), random.Between(0, 300)});
      Joints joints{};
      const Reason reason = Inverse(k, pose, {.elbow = i % 2 ? Elbow::kPositive : Elbow::kNegative}, {}, joints);
      if (radius > 600 + 1e-12 || radius < 50 - 1e-12) {
        ASSERT_TRUE(reason == Reason::kOutOfReach || (off < 1e-9 && reason == Reason::kSingular));
      } else if (off > 1e-7) {
        ASSERT_EQ(reason, Reason::kNone) << "off " << off;
        ASSERT_LT((ForwardOrFail(k, joints).p - pose.p).Norm(), 1e-9);
      } else {
        ASSERT_TRUE(reason == Reason::kNone || reason == Reason::kSingular || reason == Reason::kOutOfReach);
      }
    }
  }
}

// GR-11: forward and Jacobian compared with KDL's own chain.
TEST(Scara, PropertyAgreesWithKdl) {
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), Frame(KDL::Vector(325, 0, 387))));
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), Frame(KDL::Vector(275, 0, 0))));
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::TransZ), Frame::Identity()));
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), Frame::Identity()));
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::ChainJntToJacSolver jacobian_solver(chain);
  const Kinematics k = FromYaml(kCobra);
  Random random(32);
  for (int i = 0; i < Trials(2000); ++i) {
    const Joints joints{random.Between(-400, 400), random.Between(-400, 400), random.Between(-300, 0),
                        random.Between(-400, 400)};
    KDL::JntArray q(4);
    for (unsigned n = 0; n < 4; ++n) q(n) = joints[n] * (n == 2 ? 1 : kDegree);
    Frame expected;
    solver.JntToCart(q, expected);
    ASSERT_TRUE(KDL::Equal(ForwardOrFail(k, joints), expected, 1e-10));
    KDL::Jacobian columns(4);
    jacobian_solver.JntToJac(q, columns);
    Jacobian own;
    ASSERT_EQ(JacobianAt(k, joints, own), Reason::kNone);
    for (unsigned n = 0; n < 4; ++n)
      ASSERT_TRUE(KDL::Equal(own[n], columns.getColumn(n) * (n == 2 ? 1 : kDegree), 1e-10));
  }
}

// GR-12: a tilted tool is refused, and so is a motion that tilts it.
TEST(Scara, RefusesToTilt) {
  const Kinematics k = FromYaml(kCobra);
  Joints joints{};
  EXPECT_EQ(Inverse(k, ToFrame({.x = 400, .b = 1}), {}, {}, joints), Reason::kOrientation);
  EXPECT_EQ(Inverse(k, ToFrame({.x = 400, .a = 180}), {}, {}, joints), Reason::kOrientation);
  JointMotion motion;
  const MovingFrame tilting(ToFrame({.x = 400}), KDL::Twist({0, 0, 0}, {0.1, 0, 0}), KDL::Twist::Zero());
  EXPECT_EQ(Inverse(k, tilting, {.elbow = Elbow::kPositive}, {}, motion), Reason::kOrientation);
}

// GR-12: the requested arm is taken, wherever the axes are; if none is requested the arm stays.
TEST(Scara, KeepsOrChangesItsArm) {
  const Kinematics k = FromYaml(kCobra);
  const Frame pose = ToFrame({.x = 300, .y = 200, .z = 300});
  Joints right{}, left{}, kept{};
  ASSERT_EQ(Inverse(k, pose, {.elbow = Elbow::kPositive}, {}, right), Reason::kNone);
  ASSERT_EQ(Inverse(k, pose, {.elbow = Elbow::kNegative}, right, left), Reason::kNone);
  EXPECT_GT(right[1], 0);
  EXPECT_NEAR(left[1], -right[1], 1e-9);
  ASSERT_EQ(Inverse(k, pose, {}, right, kept), Reason::kNone);
  EXPECT_EQ(kept, right);
  ASSERT_EQ(Inverse(k, pose, {}, left, kept), Reason::kNone);
  EXPECT_NEAR(kept[1], left[1], 1e-12);
}

// GR-12: C continues turning instead of jumping by a whole turn, and is refused at the end of its range rather than
// turned back; without a history it comes into the middle of its range.
TEST(Scara, CountsWholeTurns) {
  Kinematics k = FromYaml(kCobra);
  k.ranges[3] = {-270, 270};
  Joints joints{};
  const auto ask = [&](double c, const Joints& near) {
    return Inverse(k, ToFrame({.x = 400, .c = c}), {.elbow = Elbow::kPositive}, near, joints);
  };
  ASSERT_EQ(ask(0, {0, 10, 0, 0}), Reason::kNone);
  const Joints start = joints;
  for (double c = 0; start[3] + c < 270; c += 10) {
    ASSERT_EQ(ask(c, joints), Reason::kNone);
    ASSERT_NEAR(joints[3], start[3] + c, 1e-9);
  }
  EXPECT_EQ(ask(275 - start[3], joints), Reason::kAxisLimit);
  Joints nowhere{};
  nowhere.fill(std::nan(""));
  ASSERT_EQ(ask(275 - start[3], nowhere), Reason::kNone);
  EXPECT_NEAR(joints[3], -85, 1e-9);
}

}  // namespace
}  // namespace takt::kinematics
