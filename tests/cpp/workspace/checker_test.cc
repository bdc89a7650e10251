// GR-13: positions of collisions on a path, computed by hand.
#include "takt/workspace/checker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "rig.h"
#include "takt/core/angle.h"

namespace takt::workspace {
namespace {

using testing::CheckerOf;
using testing::kDelta;
using testing::kGantry;
using testing::kScara;
using testing::Line;
using testing::Say;

constexpr double kResolution = 0.1;  // [mm] of all tests here

const char* const kBall = "gripper: [{name: ball, sphere: {radius: 10}}]";

// With a margin of 5 mm.
Checker Among(const std::string& obstacles, const std::string& gripper = kBall,
              const std::string& kinematics = kGantry) {
  return CheckerOf(kinematics, "{margin: 5, resolution: 0.1, " + gripper + ", obstacles: [" + obstacles + "]}");
}

Finding Found(Checker& checker, const std::vector<Sample>& path) {
  const std::optional<Finding> found = checker.Check(path);
  EXPECT_TRUE(found);
  return found.value_or(Finding{});
}

// Reported at `s` or after it by the motion over the resolution; `speed`: [mm] of motion per mm of s.
void ExpectAt(const Finding& found, double s, double speed = 1) {
  EXPECT_GE(found.s, s - kDistanceError / speed);
  EXPECT_LE(found.s, s + (kResolution + kDistanceError) / speed);
}

// GR-13: a ball of radius 10 moving along X comes within 5 mm of an obstacle 200 mm ahead.
TEST(Checker, FindsThePlaceBeforeEachShape) {
  const struct {
    const char* shape;
    double s;
  } cases[] = {
      {"box: {x: 40, y: 500, z: 500}, pose: {x: 200}", 200 - 20 - 15},
      {"box: {x: 40, y: 40, z: 500}, pose: {x: 200, c: 45}", 200 - 20 * std::sqrt(2) - 15},
      {"sphere: {radius: 30}, pose: {x: 200}", 200 - 30 - 15},
      {"sphere: {radius: 30}, pose: {x: 200, y: 25}", 200 - std::sqrt(45 * 45 - 25 * 25)},
      {"cylinder: {radius: 30, height: 80}, pose: {x: 200}", 200 - 30 - 15},
      {"cylinder: {radius: 30, height: 80}, pose: {x: 200, b: 90}", 200 - 40 - 15},
      {"capsule: {radius: 30, length: 80}, pose: {x: 200, b: 90}", 200 - 40 - 30 - 15},
      {"capsule: {radius: 30, length: 80}, pose: {x: 200, y: -20, a: 90}", 200 - 30 - 15},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.shape);
    Checker checker = Among("{name: post, " + std::string(c.shape) + "}");
    for (const int steps : {1, 7, 400}) {
      const Finding found = Found(checker, Line({0}, {400}, 400, steps));
      EXPECT_EQ(found.trouble, Trouble::kCollision);
      EXPECT_EQ(found.first + "/" + found.second, "ball/post");
      ExpectAt(found, c.s);
      EXPECT_NEAR(found.joints[0], found.s, 1e-9);
      EXPECT_EQ(found.index, static_cast<std::size_t>(found.s * steps / 400 + 1e-9));
      EXPECT_LE(found.distance, 5);
      EXPECT_GE(found.distance, 5 - kResolution - kDistanceError);
    }
  }
}

// GR-13: a moving object may have any shape, too.
TEST(Checker, FindsThePlaceOfEachMovingShape) {
  const struct {
    const char* shape;
    double s;
  } cases[] = {
      {"box: {x: 20, y: 30, z: 40}", 180 - 5 - 10},
      {"box: {x: 20, y: 20, z: 40}, pose: {c: 45}", 180 - 5 - 10 * std::sqrt(2)},
      {"cylinder: {radius: 10, height: 60}, pose: {x: 3}", 180 - 5 - 10 - 3},
      {"capsule: {radius: 10, length: 60}, pose: {b: 90}", 180 - 5 - 10 - 30},
      {"capsule: {radius: 10, length: 60}, pose: {b: 60}", 180 - 5 - 10 - 30 * std::sin(60 * kDegree)},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.shape);
    Checker checker = Among("{name: wall, box: {x: 40, y: 900, z: 900}, pose: {x: 200}}",
                            "gripper: [{name: finger, " + std::string(c.shape) + "}]");
    ExpectAt(Found(checker, Line({0}, {400}, 400)), c.s);
  }
}

// GR-13: a ball 100 mm from its axis of rotation meets another one at 60 degrees when the chord between them is 10 + 10
// + 5.
TEST(Checker, FindsThePlaceOfATurn) {
  Checker checker = Among("{name: pin, sphere: {radius: 10}, pose: {x: 50, y: 86.602540378}}",
                          "gripper: [{name: ball, sphere: {radius: 10}, pose: {x: 100}}]");
  const double angle = 60 - 2 * std::asin(12.5 / 100) / kDegree;
  // rate at which the chord gets shorter [mm/deg]
  const double speed = 100 * kDegree * std::cos(std::asin(12.5 / 100));
  ExpectAt(Found(checker, Line({}, {0, 0, 0, 350}, 350)), angle, speed);
}

// GR-13: no wall is too thin and no step too long to be detected.
TEST(Checker, SeesThinWallsBetweenFarSamples) {
  const std::string wall = "{name: foil, box: {x: 0.001, y: 900, z: 900}, pose: {x: 7000}}";
  const std::string needle = "gripper: [{name: needle, capsule: {radius: 0.01, length: 20}}]";
  Checker checker = CheckerOf(kGantry, "{margin: 0.2, resolution: 0.1, " + needle + ", obstacles: [" + wall + "]}");
  ExpectAt(Found(checker, Line({0}, {20000}, 20000)), 7000 - 0.0005 - 0.01 - 0.2);

  // An arm that sweeps over most of a turn, and is far away from the post at both ends.
  Checker scara = CheckerOf(kScara,
                            "{margin: 1, resolution: 0.1, links: [{link: arm_2, capsule: {radius: 5}}], "
                            "obstacles: [{name: wire, cylinder: {radius: 0.1, height: 50}, "
                            "pose: {y: 450}}]}");
  const Finding found = Found(scara, Line({-100}, {200}, 300));
  EXPECT_EQ(found.first + "/" + found.second, "arm_2/wire");
  const double angle = 190 - std::asin((5 + 1 + 0.1) / 450) / kDegree;
  ExpectAt(found, angle, 450 * kDegree);
}

// GR-13
TEST(Checker, KeepsTheMarginAndNoMore) {
  Checker checker = Among("{name: post, cylinder: {radius: 20, height: 100}, pose: {x: 200}}");
  EXPECT_EQ(Say(checker, Line({0, 35.2}, {400, 35.2}, 400)), "free");
  EXPECT_NE(Say(checker, Line({0, 34.8}, {400, 34.8}, 400)), "free");
  EXPECT_EQ(Say(checker, Line({0}, {164.9}, 164.9)), "free");
}

// GR-13: a path that begins or ends too near; one of a single position; none at all.
TEST(Checker, LooksAtBothEnds) {
  Checker checker = Among("{name: post, cylinder: {radius: 20, height: 100}, pose: {x: 200}}");
  EXPECT_EQ(Say(checker, Line({180}, {0}, 180)), "ball meets post 0.0 mm along the path (5 mm are to be kept)");
  EXPECT_EQ(Say(checker, Line({0}, {165.3}, 165.3)), "ball meets post 165.1 mm along the path (5 mm are to be kept)");
  EXPECT_EQ(Say(checker, {{7, {200}}}), "ball meets post 7.0 mm along the path (5 mm are to be kept)");
  EXPECT_EQ(Say(checker, {{7, {100}}}), "free");
  EXPECT_EQ(Say(checker, {}), "free");
}

// GR-13: of several findings the first one on the path is reported, in any order of the file.
TEST(Checker, TellsTheFirstOfMany) {
  const std::string gripper =
      "gripper: [{name: left, sphere: {radius: 10}, pose: {y: -50}}, {name: right, sphere: {radius: 10}, pose: {y: "
      "50}}]";
  std::string posts = "{name: last, sphere: {radius: 10}, pose: {x: 900, y: -50}}";
  for (int i = 0; i < 60; ++i)
    posts += ", {name: aside" + std::to_string(i) +
             ", sphere: {radius: 5}, pose: {y: 200, x: " + std::to_string(20 * i) + "}}";
  Checker checker = Among(posts + ", {name: first, sphere: {radius: 10}, pose: {x: 600, y: 50}}", gripper);
  Finding found = Found(checker, Line({0}, {1200}, 1200));
  EXPECT_EQ(found.first + "/" + found.second, "right/first");
  ExpectAt(found, 575);
  found = Found(checker, Line({1200}, {0}, 1200, 50));
  EXPECT_EQ(found.first + "/" + found.second, "left/last");
  ExpectAt(found, 275);
  EXPECT_EQ(Say(checker, Line({0, -200}, {1200, -200}, 1200)), "free");

  // Two within the resolution.
  Checker both = Among(
      "{name: near, sphere: {radius: 10}, pose: {x: 600, y: -50}}, "
      "{name: nearly, sphere: {radius: 10}, pose: {x: 600.06, y: 50}}",
      gripper);
  EXPECT_EQ(Found(both, Line({0}, {1200}, 1200)).first, "left");
}

// GR-13: pairs that may meet, by the names of links, of several links at once, of parts and of obstacles.
TEST(Checker, IgnoresPairs) {
  const auto said = [](const std::string& ignore) {
    Checker checker = CheckerOf(
        kGantry,
        "{margin: 5, links: [{link: xy, box: {x: 100, y: 100, z: 20}}], gripper: [{name: tip, sphere: {radius: "
        "10}, pose: {z: -100}}], obstacles: [{name: pile_1, box: {x: 10, y: 10, z: 400}, pose: {x: 300}}], "
        "ignore: " +
            ignore + "}");
    const std::optional<Finding> found = checker.Check(Line({0}, {600}, 600));
    return found ? found->first + "/" + found->second : "free";
  };
  EXPECT_EQ(said("[]"), "xy/pile_1");
  EXPECT_EQ(said("[[pile_1, xy]]"), "tip/pile_1");
  EXPECT_EQ(said("[[tip, pile_1], [xy, pile]]"), "free");
  EXPECT_EQ(said("[[tip, xy]]"), "xy/pile_1");
}

// GR-13: links follow their own coordinates only: a part that moves along X alone does not move with Z.
TEST(Checker, MovesLinksOfAGantryByThemselves) {
  const auto said = [](const std::string& link) {
    Checker checker = CheckerOf(kGantry, "{margin: 5, links: [{link: " + link +
                                             ", sphere: {radius: 10}}], obstacles: [{name: floor, box: {x: 999, y: "
                                             "999, z: 10}, pose: {z: -100}}]}");
    const std::optional<Finding> found = checker.Check(Line({0, 0, 0}, {50, 50, -120}, 100));
    return found ? found->first : "free";
  };
  EXPECT_EQ(said("x"), "free");
  EXPECT_EQ(said("xy"), "free");
  EXPECT_EQ(said("z"), "z");
  EXPECT_EQ(said("yz"), "yz");
  EXPECT_EQ(said("xyz"), "xyz");
  EXPECT_EQ(said("tool"), "tool");
  EXPECT_EQ(said("base"), "free");
}

// GR-13: the tool stays within its bounds, also between samples that are both inside.
TEST(Checker, KeepsTheToolInItsBounds) {
  Checker gantry = CheckerOf(kGantry, "{resolution: 0.1, bounds: {lower: {z: -50}, upper: {x: 300, y: 40}}}");
  EXPECT_EQ(Say(gantry, Line({0, 0, -50}, {300, 40, 900}, 300)), "free");
  Finding found = Found(gantry, Line({0}, {400}, 400));
  EXPECT_EQ(found.trouble, Trouble::kBounds);
  ExpectAt(found, 300);
  EXPECT_EQ(Say(gantry, Line({0, 0, 0}, {0, 0, -100}, 100)),
            "tool leaves the workspace at its bound lower z 50.1 mm along the path");

  // On a circle of radius 500 from -60 to 60 degrees X is greatest in between.
  Checker scara = CheckerOf(kScara, "{resolution: 0.1, bounds: {upper: {x: 499}}}");
  found = Found(scara, Line({-60}, {60}, 120));
  EXPECT_EQ(found.second, "upper x");
  const double angle = 60 - std::acos(499 / 500.0) / kDegree;
  ExpectAt(found, angle, 500 * std::sin(std::acos(499 / 500.0)) * kDegree);
  Checker wide = CheckerOf(kScara, "{resolution: 0.1, bounds: {upper: {x: 500}}}");
  EXPECT_EQ(Say(wide, Line({-60}, {60}, 120)), "free");
}

// GR-13: positions without a solution are reported, unless something is found before.
TEST(Checker, SaysWhereThereIsNoPosition) {
  Checker gantry = Among("{name: post, cylinder: {radius: 20, height: 100}, pose: {x: 200}}");
  std::vector<Sample> path = Line({0}, {400}, 400, 4);
  path[1].joints[1] = std::numeric_limits<double>::quiet_NaN();
  const Finding found = Found(gantry, path);
  EXPECT_EQ(found.trouble, Trouble::kNoPose);
  EXPECT_EQ(found.reason, kinematics::Reason::kNotFinite);
  EXPECT_EQ(found.index, 1u);
  EXPECT_EQ(found.s, 100);
  path = Line({0}, {400}, 400, 4);
  path[3].joints[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Say(gantry, path), "ball meets post 165.1 mm along the path (5 mm are to be kept)");
  path[0].joints[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Found(gantry, path).index, 0u);
  EXPECT_TRUE(gantry.Check(Line({-1e300}, {1e300}, 400)));

  // Short lower arms do not reach from one knee to the other. Between two valid positions the knees meet, at cos =
  // -155/235 of the arms.
  const std::string cell =
      "{gripper: [{name: cup, sphere: {radius: 20}}], obstacles: [{name: far, sphere: {radius: 1}, pose: {z: 5000}}]}";
  const char* const small = "{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 300}}";
  Checker delta = CheckerOf(small, cell);
  EXPECT_EQ(Say(delta, Line({60, 60, 60}, {0, 0, 0}, 100)),
            "the links have no position 100.0 mm along the path: the place is out of reach");
  delta = CheckerOf(kDelta, cell);
  const Finding singular = Found(delta, Line({30, 30, 30}, {-170, -170, -170}, 100));
  EXPECT_EQ(singular.reason, kinematics::Reason::kSingular);
  EXPECT_NEAR(singular.s, (30 + std::acos(-155 / 235.0) / kDegree) / 2, 0.5);
}

// GR-13: equal requests have equal results.
TEST(Checker, RemembersNothing) {
  Checker checker = Among("{name: post, cylinder: {radius: 20, height: 100}, pose: {x: 200}}");
  const std::string first = Say(checker, Line({0}, {400}, 400, 30));
  EXPECT_EQ(Say(checker, Line({0, 500}, {400, 500}, 400)), "free");
  EXPECT_EQ(Say(checker, Line({0}, {400}, 400, 30)), first);
  Checker moved = std::move(checker);
  EXPECT_EQ(Say(moved, Line({0}, {400}, 400, 30)), first);
}

}  // namespace
}  // namespace takt::workspace
