// GR-13: self-collisions of mechanisms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "rig.h"
#include "takt/core/angle.h"

namespace takt::workspace {
namespace {

using testing::CheckerOf;
using testing::kDelta;
using testing::kScara;
using testing::Line;
using ::testing::Pair;
using testing::Say;
using ::testing::UnorderedElementsAre;

// GR-13: as the elbow closes the gripper, at the end of the second arm, approaches the first one.
TEST(SelfCollision, OfAScara) {
  const std::string cell =
      "{margin: 5, resolution: 0.1, links: [{link: base, cylinder: {radius: 80, height: 400}}, "
      "{link: arm, capsule: {radius: 30}}], gripper: [{name: bit, cylinder: {radius: 20, height: "
      "100}}]";
  Checker checker = CheckerOf(kScara, cell + "}");
  const std::optional<Finding> found = checker.Check(Line({0, 0}, {0, 179}, 179));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first + "/" + found->second, "arm_1/bit");
  EXPECT_NEAR(found->s, 180 - std::asin((30 + 20 + 5) / 200.0) / kDegree, 0.1);

  Checker turning = CheckerOf(kScara, cell + "}");
  EXPECT_EQ(Say(turning, Line({-170, 90}, {170, 90}, 340)), "free");  // all together: no relative motion
  Checker off = CheckerOf(kScara, cell + ", self_collisions: false}");
  EXPECT_EQ(Say(off, Line({0, 0}, {0, 179}, 179)), "free");
  Checker ignored = CheckerOf(kScara, cell + ", ignore: [[base, arm_2], [bit, base], [arm, bit]]}");
  EXPECT_EQ(Say(ignored, Line({0, 0}, {0, 179}, 179)), "free");
}

// GR-13: with large steps the reported position is the same as with small ones.
TEST(SelfCollision, DoesNotDependOnTheSteps) {
  Checker checker = CheckerOf(kDelta,
                              "{margin: 5, resolution: 0.1, links: [{link: lower_arm, capsule: {radius: 8}}], "
                              "gripper: [{name: valve, cylinder: {radius: 60, height: 100}, pose: {z: 150}}]}");
  const kinematics::Joints from{30, 30, 30};
  const kinematics::Joints to{95, -30, -30};
  const std::optional<Finding> coarse = checker.Check(Line(from, to, 100, 1));
  const std::optional<Finding> fine = checker.Check(Line(from, to, 100, 500));
  ASSERT_TRUE(coarse && fine);
  EXPECT_EQ(coarse->first, fine->first);
  EXPECT_EQ(coarse->second, "valve");
  EXPECT_NEAR(coarse->s, fine->s, 0.2);
  EXPECT_GT(coarse->s, 5);
}

// GR-13: neighbours always touch, and some other pairs by design.
TEST(SelfCollision, LeavesOutWhatMeetsAtRest) {
  Checker checker =
      CheckerOf(kScara,
                "{links: [{link: arm, capsule: {radius: 30}}, {link: spindle, cylinder: {radius: 10, height: 300}}], "
                "gripper: [{name: wide, sphere: {radius: 150}}]}");
  EXPECT_THAT(checker.NearAtRest(), UnorderedElementsAre(Pair("arm_2", "wide")));
  EXPECT_EQ(Say(checker, Line({0, 0}, {0, 10}, 10)), "free");
}

}  // namespace
}  // namespace takt::workspace
