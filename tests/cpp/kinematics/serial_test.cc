// GR-11, GR-12: chains from URDF, solved iteratively.
#include "takt/kinematics/serial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_nr.hpp>
#include <kdl/chainiksolvervel_wdls.hpp>
#include <sstream>

#include "../core/trials.h"
#include "mechanisms.h"
#include "takt/core/angle.h"

// The URDF library never frees the model of a robot without a root, and only reports that there is none.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:liburdfdom_model";
}

namespace takt::kinematics {
namespace {

using testing::CaseOf;
using testing::DegreesBetween;
using testing::ForwardOrFail;
using testing::FromYaml;
using testing::kPuma;
using testing::Random;

std::string TextOf(const std::string& name) {
  std::ifstream file(std::string(TAKT_SOURCE_DIR) + "/tests/cpp/kinematics/" + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// GR-11: the chain of a URDF is the arm of the closed form: the same poses, and the same solutions from nearby.
TEST(Serial, PropertyAgreesWithTheClosedForm) {
  const Kinematics closed = FromYaml(kPuma);
  const testing::Case& c = CaseOf("SerialPuma");
  Random random(61);
  for (int i = 0; i < Trials(1000); ++i) {
    const Joints joints = random.In(c);
    const Frame pose = ForwardOrFail(c.kinematics, joints);
    ASSERT_TRUE(KDL::Equal(pose, ForwardOrFail(closed, joints), 1e-9));
    Joints near = joints, found{}, expected{};
    for (std::size_t n = 0; n < 6; ++n) near[n] += random.Between(-3, 3);
    ASSERT_EQ(Inverse(c.kinematics, pose, {}, near, found), Reason::kNone);
    ASSERT_EQ(Inverse(closed, pose, {}, near, expected), Reason::kNone);
    for (std::size_t n = 0; n < 6; ++n) ASSERT_NEAR(found[n], expected[n], 1e-7);
  }
}

// GR-11: compared with KDL's own solver (Newton-Raphson with damped least squares) on the same arm of seven axes.
TEST(Serial, PropertyAgreesWithKdlOnSevenAxes) {
  const std::array<std::pair<double, KDL::Vector>, 7> axes{{{340, {0, 0, 1}},
                                                            {0, {0, 1, 0}},
                                                            {400, {0, 0, 1}},
                                                            {0, {0, -1, 0}},
                                                            {400, {0, 0, 1}},
                                                            {0, {0, 1, 0}},
                                                            {0, {0, 0, 1}}}};
  KDL::Chain chain;
  for (const auto& [height, axis] : axes) {
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), Frame(KDL::Vector(0, 0, height))));
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Vector::Zero(), axis, KDL::Joint::RotAxis), Frame::Identity()));
  }
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), Frame(KDL::Vector(0, 0, 126))));
  KDL::ChainFkSolverPos_recursive forward(chain);
  KDL::ChainIkSolverVel_wdls velocity(chain);
  KDL::ChainIkSolverPos_NR inverse(chain, forward, velocity, 100, 1e-10);
  const testing::Case& c = CaseOf("SerialSeven");
  Random random(62);
  int solved = 0;
  for (int i = 0; i < Trials(300); ++i) {
    const Joints joints = random.In(c);
    KDL::JntArray q(7), near(7), out(7);
    Joints start = joints;
    for (unsigned n = 0; n < 7; ++n) {
      q(n) = joints[n] * kDegree;
      start[n] += random.Between(-2, 2);
      near(n) = start[n] * kDegree;
    }
    Frame expected;
    forward.JntToCart(q, expected);
    const Frame pose = ForwardOrFail(c.kinematics, joints);
    ASSERT_TRUE(KDL::Equal(pose, expected, 1e-9));
    if (inverse.CartToJnt(near, pose, out) < 0) continue;
    ++solved;
    Joints found{};
    ASSERT_EQ(Inverse(c.kinematics, pose, {}, start, found), Reason::kNone);
    // Both take about the least motion; the metrics differ.
    for (unsigned n = 0; n < 7; ++n) ASSERT_NEAR(found[n], out(n) / kDegree, 5);
  }
  EXPECT_GT(solved, Trials(200));
}

// GR-12: unreachable poses are reported as such, from anywhere near or far.
TEST(Serial, RefusesWhatIsOutOfReach) {
  Random random(63);
  for (const char* name : {"SerialPuma", "SerialSeven", "SerialScara"}) {
    const testing::Case& c = CaseOf(name);
    for (int i = 0; i < Trials(50); ++i) {
      const double distance = 1400 + random.Between(0, 1e5);
      Frame pose = ForwardOrFail(c.kinematics, random.In(c));
      pose.p = random.Direction() * distance;
      if (c.sample.size() == 4) pose.p.z(0);  // its Z axis would move far, but for its range
      if (pose.p.Norm() < 1400) continue;
      Joints joints{};
      ASSERT_EQ(Inverse(c.kinematics, pose, {}, random.In(c), joints), Reason::kOutOfReach);
    }
  }
}

// GR-12: the border of a SCARA solved iteratively: 600 mm.
TEST(Serial, RefusesFromTheBorderOn) {
  const Kinematics k = FromYaml("{serial: {urdf: cobra.urdf, tip: tool}}");
  Joints joints{};
  const auto ask = [&](double radius) {
    return Inverse(k, ToFrame({.x = radius, .z = 300}), {}, {-20, 40, -80, 0}, joints);
  };
  EXPECT_EQ(ask(600.1), Reason::kOutOfReach);
  EXPECT_EQ(ask(600.00001), Reason::kOutOfReach);
  EXPECT_NE(ask(600), Reason::kNone);
  EXPECT_EQ(ask(599.9), Reason::kNone);
  EXPECT_EQ(ask(599), Reason::kNone);
  // By the law of cosines.
  const double cosine = (599.0 * 599 - 325.0 * 325 - 275.0 * 275) / (2 * 325.0 * 275);
  EXPECT_NEAR(joints[1], std::acos(cosine) / kDegree, 1e-6);
}

// GR-11: a stretched arm, the zero position of many URDFs, moves out of it.
TEST(Serial, StartsFromAStretchedArm) {
  const testing::Case& c = CaseOf("SerialSeven");
  Random random(64);
  int solved = 0;
  for (int i = 0; i < 100; ++i) {
    const Frame pose = ForwardOrFail(c.kinematics, random.In(c));
    Joints joints{};
    if (Inverse(c.kinematics, pose, {}, {}, joints) != Reason::kNone) continue;
    ++solved;
    const Frame back = ForwardOrFail(c.kinematics, joints);
    ASSERT_LT((back.p - pose.p).Norm(), 1e-9);
    ASSERT_LT(DegreesBetween(back.M, pose.M), 1e-9);
  }
  EXPECT_GT(solved, 30);  // the other ones reach the ends of axes
}

// GR-11: stretched towards the target, no axis determines the side: it bends nevertheless.
TEST(Serial, BendsAnArmThatPointsAtItsTarget) {
  const Kinematics k = FromYaml("{serial: {urdf: cobra.urdf, tip: tool}}");
  const Frame pose = ToFrame({.x = 500, .z = 300});
  Joints joints{};
  ASSERT_EQ(Inverse(k, pose, {}, {0, 0, -87, 0}, joints), Reason::kNone);
  EXPECT_LT((ForwardOrFail(k, joints).p - pose.p).Norm(), 1e-9);
}

// GR-12: a pose just on the other side of a singularity never gets a position there: of the wrist of six axes, of the
// elbow of four.
TEST(Serial, PropertyStaysOnItsSide) {
  Random random(65);
  const testing::Case& six = CaseOf("SerialPuma");
  const testing::Case& four = CaseOf("SerialScara");
  int refused = 0;
  for (int i = 0; i < Trials(500); ++i) {
    Joints near = random.In(six), target = near, found{};
    near[4] = random.Between(1, 5);
    target[4] = random.Between(-5, -1);
    Reason reason = Inverse(six.kinematics, ForwardOrFail(six.kinematics, target), {}, near, found);
    if (reason == Reason::kNone) {
      ASSERT_GT(found[4], 0);
    }
    refused += reason == Reason::kSingular;

    near = target = random.In(four);
    near[1] = 5 + random.Between(1, 5);  // its zero is at 5
    target[1] = 5 - random.Between(1, 5);
    target[0] += random.Between(-3, 3);
    reason = Inverse(four.kinematics, ForwardOrFail(four.kinematics, target), {}, near, found);
    if (reason == Reason::kNone) {
      ASSERT_GT(found[1], 5);
    }
    refused += reason == Reason::kSingular;
  }
  EXPECT_GT(refused, Trials(100));
}

// GR-11: limits of the URDF become the axes', in deg and mm, with the axis' own zero and sense.
TEST(Serial, TakesRangesFromUrdf) {
  const Kinematics k =
      FromYaml("{serial: {urdf: cobra.urdf, base: base, tip: tool}, joints: [{}, {zero: 5}, {invert: true}, {}]}");
  EXPECT_EQ(k.count, 4u);
  EXPECT_EQ(k.kinds[2], JointKind::kLinear);
  EXPECT_NEAR(k.ranges[0].upper, 1.83 / kDegree, 1e-9);
  EXPECT_NEAR(k.ranges[1].lower, -2.62 / kDegree + 5, 1e-9);
  EXPECT_NEAR(k.ranges[2].lower, 0, 1e-9);
  EXPECT_NEAR(k.ranges[2].upper, 210, 1e-9);
  EXPECT_FALSE(std::isfinite(k.ranges[3].upper));
  const Frame camera = ForwardOrFail(FromYaml("{serial: {urdf: cobra.urdf, tip: camera}}"), {0, 90});
  EXPECT_NEAR(camera.p.x(), 325, 1e-9);
  EXPECT_NEAR(camera.p.y(), 100, 1e-9);
  EXPECT_NEAR(camera.p.z(), 437, 1e-9);
}

std::string Diagnose(const std::string& xml, const std::string& base = "", const std::string& tip = "") {
  std::string why;
  EXPECT_FALSE(ReadUrdf(xml, base, tip, why));
  return why;
}

// GR-11: errors in a URDF are reported in a sentence.
TEST(Serial, SaysWhatIsWrongWithAUrdf) {
  const std::string cobra = TextOf("cobra.urdf");
  EXPECT_EQ(Diagnose("nonsense"), "this is no URDF that can be read");
  EXPECT_EQ(Diagnose("<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/>"
                     "<child link='b'/><origin xyz='1 two 3'/></joint></robot>"),
            "this is no URDF that can be read");
  EXPECT_EQ(Diagnose(cobra), "the URDF has several ends (camera, tool ...): say which one is the tip");
  EXPECT_EQ(Diagnose(cobra, "", "hand"), "the URDF has no link 'hand'");
  EXPECT_EQ(Diagnose(cobra, "foot", "tool"), "the URDF has no link 'foot'");
  EXPECT_EQ(Diagnose(cobra, "camera", "tool"), "no joints lead from 'camera' to 'tool'");
  EXPECT_EQ(Diagnose(cobra, "tool", "tool"), "base and tip are the same link");
  EXPECT_EQ(Diagnose(cobra, "arm2", "camera"), "the chain has no axes");
  std::string floating = cobra;
  floating.replace(floating.find("prismatic"), 9, "floating");
  EXPECT_EQ(Diagnose(floating, "", "tool"), "joint 'j3' neither slides nor turns about one axis");
  std::string idle = cobra;
  idle.replace(idle.find("axis xyz=\"0 0 1\""), 16, "axis xyz=\"0 0 0\"");
  EXPECT_EQ(Diagnose(idle, "", "tool"), "joint 'j1' has an axis without a direction");
  std::string mimic = cobra;
  mimic.replace(mimic.find("<limit"), 0, "<mimic joint=\"j2\"/>");
  EXPECT_EQ(Diagnose(mimic, "", "tool"), "joint 'j1' copies another one, which a chain cannot");

  // A chain has a beginning, and one connection to each link.
  const auto joint = [](const std::string& name, const std::string& from, const std::string& to) {
    return "<joint name='" + name + "' type='continuous'><parent link='" + from + "'/><child link='" + to +
           "'/><axis xyz='0 0 1'/></joint>";
  };
  const std::string links = "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'/>";
  const std::string no_urdf = "this is no URDF that can be read";
  const std::string in_loop = ": link 'a' is in a loop of joints, or hangs on one";
  const std::string loop = links + joint("j", "a", "b") + joint("k", "b", "a") + joint("l", "c", "d") + "</robot>";
  EXPECT_EQ(Diagnose(loop, "c", "b"), no_urdf + in_loop);
  EXPECT_EQ(Diagnose(links + joint("j", "a", "b") + joint("k", "b", "c") + joint("l", "c", "d") + joint("m", "d", "a") +
                     "</robot>"),
            no_urdf + in_loop);  // without a root
  const std::string closed =
      links + joint("j", "a", "b") + joint("k", "a", "c") + joint("l", "b", "d") + joint("m", "c", "d") + "</robot>";
  EXPECT_EQ(Diagnose(closed, "a", "d"), "link 'd' hangs on two joints, which a chain cannot");
  EXPECT_EQ(Diagnose("<robot name='r'></robot>"), no_urdf);
  // Only continuous axes go without limits.
  for (const char* type : {"revolute", "prismatic"}) {
    std::string unlimited = joint("j", "a", "b");
    unlimited.replace(unlimited.find("continuous"), 10, type);
    EXPECT_EQ(Diagnose("<robot name='r'><link name='a'/><link name='b'/>" + unlimited + "</robot>"), no_urdf);
  }

  std::ostringstream nine;
  nine << "<robot name='nine'><link name='l0'/>";
  for (int n = 1; n <= 9; ++n) {
    nine << "<link name='l" << n << "'/><joint name='j" << n << "' type='continuous'><parent link='l" << n - 1
         << "'/><child link='l" << n << "'/><axis xyz='0 0 1'/></joint>";
  }
  EXPECT_EQ(Diagnose(nine.str() + "</robot>"), "the chain has more than 8 axes");
}

}  // namespace
}  // namespace takt::kinematics
