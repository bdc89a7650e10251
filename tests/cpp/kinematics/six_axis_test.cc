// GR-11, GR-12: articulated arms with a spherical wrist.
#include "takt/kinematics/six_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacdotsolver.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>
#include <vector>

#include "../core/trials.h"
#include "mechanisms.h"
#include "takt/core/angle.h"

namespace takt::kinematics {
namespace {

using testing::CaseOf;
using testing::ConditionOf;
using testing::DegreesBetween;
using testing::ForwardOrFail;
using testing::FromYaml;
using testing::kAgilus;
using testing::kPuma;
using testing::Random;

// The Puma 560 by its Denavit-Hartenberg table (Corke's; lengths in mm).
KDL::Chain PumaOfKdl() {
  const KDL::Joint z(KDL::Joint::RotZ);
  const double right = std::numbers::pi / 2;
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(z, Frame::DH(0, right, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(431.8, 0, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(20.3, -right, 150.05, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, right, 431.8, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, -right, 0, 0)));
  chain.addSegment(KDL::Segment(z, Frame::DH(0, 0, 0, 0)));
  return chain;
}

KDL::JntArray ToKdl(const Joints& joints) {
  KDL::JntArray q(6);
  for (unsigned n = 0; n < 6; ++n) q(n) = joints[n] * kDegree;
  return q;
}

Joints Anywhere(Random& random) {
  Joints joints{};
  for (std::size_t n = 0; n < 6; ++n) joints[n] = random.Between(-360, 360);
  return joints;
}

// GR-11: forward, Jacobian and its derivative compared with KDL's own chain from another description of the same arm.
TEST(SixAxis, PropertyAgreesWithKdl) {
  const KDL::Chain chain = PumaOfKdl();
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::ChainJntToJacSolver jacobian_solver(chain);
  KDL::ChainJntToJacDotSolver change_solver(chain);
  const Kinematics k = FromYaml(kPuma);
  Random random(41);
  for (int i = 0; i < Trials(2000); ++i) {
    const Joints joints = Anywhere(random);
    Frame expected;
    solver.JntToCart(ToKdl(joints), expected);
    ASSERT_TRUE(KDL::Equal(ForwardOrFail(k, joints), expected, 1e-10));

    KDL::Jacobian columns(6);
    jacobian_solver.JntToJac(ToKdl(joints), columns);
    Jacobian own;
    ASSERT_EQ(JacobianAt(k, joints, own), Reason::kNone);
    for (unsigned n = 0; n < 6; ++n) ASSERT_TRUE(KDL::Equal(own[n], columns.getColumn(n) * kDegree, 1e-9));

    JointMotion motion{.position = joints, .velocity = Anywhere(random), .acceleration = {}};
    KDL::Twist bias;
    change_solver.JntToJacDot(KDL::JntArrayVel(ToKdl(joints), ToKdl(motion.velocity)), bias);
    MovingFrame tool;
    ASSERT_EQ(Forward(k, motion, tool), Reason::kNone);
    ASSERT_TRUE(KDL::Equal(tool.GetAccTwist(), bias, 1e-7));
  }
}

// GR-11: the KUKA KR 6 R700 (a1 25, a2 -35, c1 400, c2 315, c3 365, c4 80 mm). By hand, in the position A2 = -90, A3 =
// 90 the upper arm stands and the forearm lies level: X = 25 + 365 + 80, Z = 400 + 315 + 35, the flange looks along X.
TEST(SixAxis, AgreesWithAPoseByHand) {
  const Kinematics k = FromYaml(kAgilus);
  const Frame tool = ForwardOrFail(k, {0, -90, 90, 0, 0, 0});
  EXPECT_NEAR(tool.p.x(), 470, 1e-10);
  EXPECT_NEAR(tool.p.y(), 0, 1e-10);
  EXPECT_NEAR(tool.p.z(), 750, 1e-10);
  EXPECT_NEAR(tool.M.UnitZ().x(), 1, 1e-14);
  // Its axis 1 counts clockwise, seen from above.
  const Frame turned = ForwardOrFail(k, {90, -90, 90, 0, 0, 0});
  EXPECT_NEAR(turned.p.y(), -470, 1e-10);
  // Stretched forwards: A2 = 0, A3 = 0.
  EXPECT_NEAR(ForwardOrFail(k, {0, 0, 0, 0, 0, 0}).p.x(), 25 + 315 + 365 + 80, 1e-10);
  EXPECT_NEAR(ForwardOrFail(k, {0, 0, 0, 0, 0, 0}).p.z(), 400 + 35, 1e-10);
}

// GR-11, GR-12: the reach of the wrist that KUKA's data sheets give: 706.7 mm (KR 6 R700) and 901.5 mm (KR 6 R900).
TEST(SixAxis, ReachesAsFarAsTheDataSheetsSay) {
  const std::vector<std::pair<std::string, double>> arms{
      {"{six_axis: {a1: 25, a2: -35, c1: 400, c2: 315, c3: 365, c4: 80}}", 706.7},
      {"{six_axis: {a1: 25, a2: -35, c1: 400, c2: 455, c3: 420, c4: 80}}", 901.5}};
  for (const auto& [text, reach] : arms) {
    const Kinematics k = FromYaml(text);
    Joints joints{};
    // The wrist straight ahead at the height of axis 2, the flange turned aside.
    const auto ask = [&](double distance) {
      const KDL::Rotation aside = ToFrame({.a = 40, .b = 30}).M;
      return Inverse(k, Frame(aside, KDL::Vector(distance, 0, 400) + aside.UnitZ() * 80),
                     {.shoulder = Shoulder::kFront}, {}, joints);
    };
    EXPECT_EQ(ask(reach + 0.1), Reason::kOutOfReach);
    EXPECT_EQ(ask(reach - 0.1), Reason::kNone);
  }
}

// GR-11: all eight branches lead to the pose, all differ, and each is the one that it is called.
TEST(SixAxis, PropertyHasEightBranches) {
  Random random(42);
  for (const char* name : {"Puma", "Agilus"}) {
    const testing::Case& c = CaseOf(name);
    int complete = 0;
    for (int i = 0; i < Trials(1000); ++i) {
      const Joints from = random.In(c);
      if (ConditionOf(c.kinematics, from) > 1e5) continue;
      const Frame pose = ForwardOrFail(c.kinematics, from);
      std::vector<Joints> found;
      for (const Shoulder shoulder : {Shoulder::kFront, Shoulder::kBack}) {
        for (const Elbow elbow : {Elbow::kPositive, Elbow::kNegative}) {
          for (const Wrist wrist : {Wrist::kPositive, Wrist::kNegative}) {
            Joints joints{};
            const Configuration wanted{shoulder, elbow, wrist};
            if (Inverse(c.kinematics, pose, wanted, {}, joints) != Reason::kNone) continue;
            ASSERT_EQ(ConfigurationOf(c.kinematics, joints), wanted);
            const Frame back = ForwardOrFail(c.kinematics, joints);
            ASSERT_LT((back.p - pose.p).Norm(), 1e-9);
            ASSERT_LT(DegreesBetween(back.M, pose.M), 1e-9);
            for (const Joints& other : found) {
              double apart = 0;
              for (std::size_t n = 0; n < 6; ++n)
                apart = std::max(apart, std::abs(std::sin((other[n] - joints[n]) / 2 * kDegree)));
              ASSERT_GT(apart, 1e-6);
            }
            found.push_back(joints);
          }
        }
      }
      ASSERT_GE(found.size(), 2u);
      complete += found.size() == 8;
    }
    EXPECT_GT(complete, Trials(100)) << name;
  }
}

// GR-12: the three singular positions are reported, and so are positions just beside them.
TEST(SixAxis, TellsItsSingularPositions) {
  const Kinematics k = FromYaml(kAgilus);
  Joints joints{};
  const auto ask = [&](const Joints& at) {
    return Inverse(k, ForwardOrFail(k, at), ConfigurationOf(k, at), at, joints);
  };
  const Joints well{10, -60, 100, 20, 40, 30};
  EXPECT_EQ(ask(well), Reason::kNone);
  Joints wrist = well;
  wrist[4] = 0;
  EXPECT_EQ(ask(wrist), Reason::kSingular);
  wrist[4] = 1e-3;
  EXPECT_EQ(ask(wrist), Reason::kNone);
  Joints elbow = well;
  elbow[2] = std::atan2(35, 365) / kDegree;  // the wrist in line with the upper arm
  EXPECT_NE(ask(elbow), Reason::kNone);
  elbow[2] += 1e-3;
  EXPECT_EQ(ask(elbow), Reason::kNone);
  // The wrist on axis 1.
  const KDL::Rotation aside = ToFrame({.a = 40, .b = 30}).M;
  const auto above = [&](double off) {
    return Inverse(k, Frame(aside, KDL::Vector(off, 0, 800) + aside.UnitZ() * 80), {}, {}, joints);
  };
  EXPECT_EQ(above(0), Reason::kSingular);
  EXPECT_EQ(above(1e-9), Reason::kSingular);
  EXPECT_EQ(above(0.01), Reason::kNone);
}

// GR-12: closer and closer to the wrist's singular position the solutions stay exact, then there is none.
TEST(SixAxis, PropertyIsExactBesideSingularPositions) {
  Random random(43);
  const testing::Case& c = CaseOf("Agilus");
  for (int i = 0; i < Trials(3000); ++i) {
    Joints joints = random.In(c);
    const double off = std::pow(10, random.Between(-9, 0));
    joints[4] = -off;
    const Frame pose = ForwardOrFail(c.kinematics, joints);
    Joints found{};
    const Reason reason = Inverse(c.kinematics, pose, ConfigurationOf(c.kinematics, joints), joints, found);
    if (off > 1e-4) {
      ASSERT_EQ(reason, Reason::kNone);
    } else if (off < 5e-5) {
      ASSERT_EQ(reason, Reason::kSingular);
    }
    if (reason != Reason::kNone) continue;
    const Frame back = ForwardOrFail(c.kinematics, found);
    ASSERT_LT((back.p - pose.p).Norm(), 1e-9);
    ASSERT_LT(DegreesBetween(back.M, pose.M), 1e-9);
  }
}

// GR-12: an arm whose wrist is beside axis 1 has a hollow about it.
TEST(SixAxis, CannotReachIntoItsOwnAxis) {
  const Kinematics k = FromYaml(kPuma);
  Joints joints{};
  const auto ask = [&](double radius) { return Inverse(k, ToFrame({.x = radius, .z = 500, .a = 30}), {}, {}, joints); };
  EXPECT_EQ(ask(100), Reason::kOutOfReach);
  EXPECT_EQ(ask(150.04), Reason::kOutOfReach);
  EXPECT_EQ(ask(150.06), Reason::kNone);
}

}  // namespace
}  // namespace takt::kinematics
