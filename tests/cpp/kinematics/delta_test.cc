// GR-11, GR-12: the Delta robot.
#include "takt/kinematics/delta.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../core/trials.h"
#include "mechanisms.h"
#include "takt/core/angle.h"

namespace takt::kinematics {
namespace {

using testing::CaseOf;
using testing::ForwardOrFail;
using testing::FromYaml;
using testing::kFlexPicker;
using testing::Random;

void ExpectPlace(const Kinematics& k, const Joints& joints, double x, double y, double z, double tolerance) {
  const Frame tool = ForwardOrFail(k, joints);
  EXPECT_NEAR(tool.p.x(), x, tolerance);
  EXPECT_NEAR(tool.p.y(), y, tolerance);
  EXPECT_NEAR(tool.p.z(), z, tolerance);
}

void ExpectJoints(const Kinematics& k, const Pose& pose, const Joints& expected, double tolerance) {
  Joints joints{};
  ASSERT_EQ(Inverse(k, ToFrame(pose), {}, {}, joints), Reason::kNone);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(joints[i], expected[i], tolerance) << "axis " << i;
}

// GR-11: R. L. Williams II, "The Delta Parallel Robot: Kinematics Solutions": the examples for the FlexPicker IRB
// 360-1/1600 with base 164 mm, platform 44 mm, arms 524 and 1244 mm (given in m and deg; their
// lengths are rounded to mm, which leaves 1 mm).
TEST(Delta, AgreesWithPublishedPoses) {
  const Kinematics k = FromYaml(kFlexPicker);
  ExpectJoints(k, {.z = -900}, {-20.5, -20.5, -20.5}, 0.05);
  ExpectJoints(k, {.x = 300, .y = 500, .z = -1100}, {47.5, -11.6, 21.4}, 0.05);
  ExpectPlace(k, {0, 0, 0}, 0, 0, -1065, 1);
  ExpectPlace(k, {10, 20, 30}, 108, -180, -1244, 1);
}

// GR-11: by hand. Level arms end 200 - 45 + 235 = 390 mm from the middle line, and lower arms of 650 mm are the long
// side of a triangle 390, 520, 650 (3, 4, 5). Hanging straight down the arms end 155 mm out and 235 mm down.
TEST(Delta, AgreesWithTrianglesByHand) {
  const Kinematics k =
      FromYaml("{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 650, first_arm_deg: 17}}");
  ExpectPlace(k, {0, 0, 0}, 0, 0, -520, 1e-10);
  ExpectPlace(k, {90, 90, 90}, 0, 0, -235 - std::sqrt(650.0 * 650 - 155.0 * 155), 1e-10);
  ExpectJoints(k, {.z = -520}, {0, 0, 0}, 1e-10);
}

// GR-11: arm 1 along X, the others 120 and 240 degrees on: raising arm 2 alone moves the platform away from it.
TEST(Delta, NumbersItsArmsAboutZ) {
  const Kinematics k = FromYaml("{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800}}");
  for (std::size_t i = 0; i < 3; ++i) {
    Joints joints{20, 20, 20};
    joints[i] = 10;
    const Frame tool = ForwardOrFail(k, joints);
    const double arm = static_cast<double>(i) * 120 * kDegree;
    const double along = tool.p.x() * std::cos(arm) + tool.p.y() * std::sin(arm);
    EXPECT_GT(along, 10) << "towards the arm that was raised";
    EXPECT_NEAR(std::hypot(tool.p.x(), tool.p.y()), along, 1e-9) << "and nowhere else";
  }
}

// GR-11: the equations of the closed chains: each lower arm is as long as it is, from its knee to its joint on the
// platform.
TEST(Delta, PropertyClosesItsChains) {
  Random random(21);
  const testing::Case& c = CaseOf("Delta");
  for (int i = 0; i < Trials(5000); ++i) {
    const Joints joints = random.In(c);
    const Frame tool = ForwardOrFail(c.kinematics, joints);
    for (int arm = 0; arm < 3; ++arm) {
      const double turn = (-90 + 120 * arm) * kDegree, angle = joints[static_cast<std::size_t>(arm)] * kDegree;
      const KDL::Vector out(std::cos(turn), std::sin(turn), 0);
      const KDL::Vector knee = out * (164 + 524 * std::cos(angle)) - KDL::Vector(0, 0, 524 * std::sin(angle));
      const KDL::Vector joint = tool.p + out * 44;
      ASSERT_NEAR((joint - knee).Norm(), 1244, 1e-9);
    }
    ASSERT_LT(tool.p.z(), 0);
  }
}

// GR-11: C turns with the shaft and nothing else; without it C of the pose is ignored.
TEST(Delta, TurnsItsToolWithOrWithoutAShaft) {
  const Kinematics with =
      FromYaml("{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800, rotary: true}}");
  EXPECT_EQ(with.count, 4u);
  EXPECT_NEAR(ToPose(ForwardOrFail(with, {10, 20, 30, -75})).c, -75, 1e-12);
  Joints joints{};
  ASSERT_EQ(Inverse(with, ToFrame({.z = -700, .c = 170}), {}, {0, 0, 0, 560}, joints), Reason::kNone);
  EXPECT_NEAR(joints[3], 530, 1e-9);

  const Kinematics without = FromYaml(kFlexPicker);
  EXPECT_EQ(without.count, 3u);
  Joints turned{}, straight{};
  ASSERT_EQ(Inverse(without, ToFrame({.x = 100, .z = -900, .c = 180}), {}, {}, turned), Reason::kNone);
  ASSERT_EQ(Inverse(without, ToFrame({.x = 100, .z = -900}), {}, {}, straight), Reason::kNone);
  EXPECT_EQ(turned, straight);
  EXPECT_EQ(Inverse(without, ToFrame({.z = -900, .a = 1}), {}, {}, turned), Reason::kOrientation);
  EXPECT_EQ(Inverse(without, ToFrame({.z = -900, .a = 180}), {}, {}, turned), Reason::kOrientation);
}

// GR-12: straight down, the arms end where upper and lower arm are in line: sqrt((524 + 1244)^2 - (164 - 44)^2) mm.
TEST(Delta, RefusesFromTheBorderOn) {
  const Kinematics k = FromYaml(kFlexPicker);
  const double border = std::sqrt(1768.0 * 1768 - 120.0 * 120);
  Joints joints{};
  const auto ask = [&](double z) { return Inverse(k, ToFrame({.z = -z}), {}, {}, joints); };
  EXPECT_EQ(ask(border + 1), Reason::kOutOfReach);
  EXPECT_EQ(ask(border + 1e-6), Reason::kOutOfReach);
  EXPECT_NE(ask(border), Reason::kNone);
  EXPECT_EQ(ask(border - 1e-6), Reason::kNone);
  EXPECT_NEAR(ForwardOrFail(k, joints).p.z(), -border + 1e-6, 1e-9);
  EXPECT_EQ(ask(border - 1), Reason::kNone);
}

// GR-12: on lines from a point inside outwards in all directions: solved up to a border found by bisection, and from
// there on refused, to far beyond it; on the last stretch the solutions are as exact as elsewhere.
TEST(Delta, PropertyRefusesBeyondEveryBorder) {
  Random random(22);
  const Kinematics k = FromYaml(kFlexPicker);
  const KDL::Vector inside(0, 0, -900);
  for (int i = 0; i < Trials(1000); ++i) {
    KDL::Vector direction = random.Direction();
    direction.z(-std::abs(direction.z()));  // upwards the workspace has hollows, behind which it continues
    Joints joints{};
    const auto ask = [&](double distance) { return Inverse(k, Frame(inside + direction * distance), {}, {}, joints); };
    double good = 0, bad = 4000;
    ASSERT_EQ(ask(bad), Reason::kOutOfReach);
    for (int n = 0; n < 60; ++n) {
      const double middle = (good + bad) / 2;
      (ask(middle) == Reason::kNone ? good : bad) = middle;
    }
    ASSERT_NE(ask(bad), Reason::kNone);
    for (const double back : {1e-6, 1e-3, 1.0}) {
      ASSERT_EQ(ask(good - back), Reason::kNone);
      const Frame wanted(inside + direction * (good - back));
      Frame found;
      // Where the arms can hardly hold the platform the forward solution has its own border; the equations still close.
      if (Forward(k, joints, found) == Reason::kNone && back == 1.0) {
        ASSERT_LT((found.p - wanted.p).Norm(), 1e-9);
      }
    }
    for (double beyond = 1e-6; beyond < 1e4; beyond *= 10) ASSERT_NE(ask(bad + beyond), Reason::kNone);
  }
}

// GR-12: above the base the same lengths would fit, with the platform standing on its arms: never returned.
TEST(Delta, NeverStandsOnItsArms) {
  const Kinematics k = FromYaml(kFlexPicker);
  Joints joints{};
  EXPECT_NE(Inverse(k, ToFrame({.z = 900}), {}, {}, joints), Reason::kNone);
  EXPECT_NE(Inverse(k, ToFrame({.z = 0}), {}, {}, joints), Reason::kNone);
}

// GR-12: arms that cannot meet, and lower arms that all lie level with the platform.
TEST(Delta, RefusesPositionsWithoutAPose) {
  const Kinematics wide = FromYaml("{delta: {base_radius: 500, platform_radius: 0, upper_arm: 300, lower_arm: 700}}");
  Frame tool;
  EXPECT_EQ(Forward(wide, Joints{0, 0, 0}, tool), Reason::kOutOfReach);
  EXPECT_EQ(Forward(wide, Joints{90, 90, 90}, tool), Reason::kNone);
  const Kinematics flat = FromYaml("{delta: {base_radius: 400, platform_radius: 0, upper_arm: 300, lower_arm: 700}}");
  EXPECT_EQ(Forward(flat, Joints{0, 0, 0}, tool), Reason::kSingular);
  Jacobian columns;
  EXPECT_EQ(JacobianAt(flat, Joints{0, 0, 0}, columns), Reason::kSingular);
  MovingFrame moving;
  EXPECT_EQ(Forward(flat, JointMotion{}, moving), Reason::kSingular);
  Joints joints{};
  EXPECT_EQ(Inverse(flat, Frame::Identity(), {}, {}, joints), Reason::kSingular);
  // Knees 150 mm down and 700 mm out: lower arms of 700 mm are all level there.
  const Kinematics level =
      FromYaml("{delta: {base_radius: 440.1923788646684, platform_radius: 0, upper_arm: 300, lower_arm: 700}}");
  EXPECT_EQ(Inverse(level, ToFrame({.z = -150}), {}, {}, joints), Reason::kSingular);
  EXPECT_EQ(Inverse(level, ToFrame({.z = -160}), {}, {}, joints), Reason::kNone);
}

}  // namespace
}  // namespace takt::kinematics
