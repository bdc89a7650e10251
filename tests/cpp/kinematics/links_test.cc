// GR-13: frames of the parts of a mechanism, and bounds of their displacement.
#include "takt/kinematics/links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../core/trials.h"
#include "mechanisms.h"

namespace takt::kinematics {
namespace {

using KDL::Vector;
using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

std::vector<std::string> NamesOf(const Kinematics& k) {
  std::vector<std::string> names;
  for (const LinkInfo& link : LinksOf(k)) names.push_back(link.name);
  return names;
}

std::size_t Index(const Kinematics& k, const std::string& name) {
  const std::vector<std::string> names = NamesOf(k);
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  return static_cast<std::size_t>(found - names.begin());
}

Frame FrameOf(const Kinematics& k, const std::string& name, const Joints& joints) {
  LinkFrameArray frames;
  EXPECT_EQ(LinkFrames(k, joints, frames), Reason::kNone);
  return frames[Index(k, name)];
}

void ExpectAt(const Vector& place, const Vector& expected) {
  EXPECT_LT((place - expected).Norm(), 1e-9) << place.x() << ' ' << place.y() << ' ' << place.z();
}

// GR-13
TEST(Links, HaveNames) {
  EXPECT_THAT(NamesOf(testing::FromYaml("{gantry: {axes: [y]}}")), ElementsAre("base", "y", "tool"));
  EXPECT_THAT(NamesOf(testing::FromYaml("{gantry: {axes: [z, x, y, c]}}")),
              ElementsAre("base", "x", "y", "z", "xy", "xz", "yz", "xyz", "tool"));
  EXPECT_THAT(NamesOf(testing::FromYaml("{core_xy: {}}")), ElementsAre("base", "x", "y", "xy", "tool"));
  EXPECT_THAT(NamesOf(testing::FromYaml("{scara: {first_arm: 3, second_arm: 2}}")),
              ElementsAre("base", "arm_1", "arm_2", "spindle", "flange", "tool"));
  EXPECT_THAT(NamesOf(testing::CaseOf("Delta").kinematics),
              ElementsAre("base", "upper_arm_1", "upper_arm_2", "upper_arm_3", "lower_arm_1_a", "lower_arm_1_b",
                          "lower_arm_2_a", "lower_arm_2_b", "lower_arm_3_a", "lower_arm_3_b", "platform", "tool"));
  EXPECT_THAT(NamesOf(testing::CaseOf("Puma").kinematics),
              ElementsAre("base", "link_1", "link_2", "link_3", "link_4", "link_5", "link_6", "tool"));
  // URDF's own names; a link called tool there is not Takt's tool.
  EXPECT_THAT(NamesOf(testing::CaseOf("SerialScara").kinematics),
              ElementsAre("base", "arm1", "arm2", "quill", "link_4", "tool"));
}

// GR-13: the last link is the tool, of every mechanism in any position; links that touch name each other.
TEST(Links, EndWithTheTool) {
  testing::Random random(1);
  for (const testing::Case& c : testing::Cases()) {
    SCOPED_TRACE(c.name);
    const std::vector<LinkInfo> links = LinksOf(c.kinematics);
    ASSERT_LE(links.size(), kMaxLinks);
    for (std::size_t i = 0; i < links.size(); ++i) {
      EXPECT_FALSE(links[i].neighbours.empty());
      for (const std::size_t n : links[i].neighbours)
        EXPECT_EQ(std::count(links[n].neighbours.begin(), links[n].neighbours.end(), i), 1) << links[i].name;
    }
    for (int trial = 0; trial < 20; ++trial) {
      const Joints joints = random.In(c);
      LinkFrameArray frames;
      ASSERT_EQ(LinkFrames(c.kinematics, joints, frames), Reason::kNone);
      EXPECT_TRUE(KDL::Equal(frames[links.size() - 1], testing::ForwardOrFail(c.kinematics, joints), 1e-9));
      EXPECT_TRUE(KDL::Equal(frames[0], Frame::Identity(), 1e-12));
    }
  }
}

// GR-13: by hand.
TEST(Links, StandWhereTheyShould) {
  const Kinematics gantry = testing::FromYaml("{gantry: {axes: [z, x, c]}, joints: [{invert: true}, {}, {}]}");
  ExpectAt(FrameOf(gantry, "x", {5, 7, 90}).p, {7, 0, 0});
  ExpectAt(FrameOf(gantry, "z", {5, 7, 90}).p, {0, 0, -5});
  ExpectAt(FrameOf(gantry, "xz", {5, 7, 90}) * Vector(1, 0, 0), {8, 0, -5});
  ExpectAt(FrameOf(gantry, "tool", {5, 7, 90}) * Vector(1, 0, 0), {7, 1, -5});

  const Kinematics belts = testing::FromYaml("{core_xy: {}}");
  ExpectAt(FrameOf(belts, "x", {30, 10}).p, {20, 0, 0});
  ExpectAt(FrameOf(belts, "y", {30, 10}).p, {0, 10, 0});
  ExpectAt(FrameOf(belts, "xy", {30, 10}).p, {20, 10, 0});

  const Kinematics scara = testing::FromYaml("{scara: {first_arm: 300, second_arm: 200, height: 50}}");
  ExpectAt(FrameOf(scara, "arm_1", {90, -90, 10, 45}) * Vector(300, 0, 0), {0, 300, 0});
  ExpectAt(FrameOf(scara, "arm_2", {90, -90, 10, 45}) * Vector(200, 0, 0), {200, 300, 0});
  ExpectAt(FrameOf(scara, "spindle", {90, -90, 10, 45}) * Vector(0, 1, 0), {200, 301, 60});
  ExpectAt(FrameOf(scara, "flange", {90, -90, 10, 90}) * Vector(1, 0, 0), {200, 301, 60});
  ExpectAt(LinksOf(scara)[2].span, {200, 0, 0});

  const Kinematics six = testing::CaseOf("Agilus").kinematics;
  ExpectAt(LinksOf(six)[1].span, {25, 0, 400});
  ExpectAt(LinksOf(six)[6].span, {0, 0, 80});
}

// GR-13: the rods of a Delta lead from the knees to the platform, side by side across the arm.
TEST(Links, OfADeltaHangTogether) {
  const Kinematics delta = testing::FromYaml(
      "{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800, rod_spacing: 80, rotary: "
      "true}}");
  testing::Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Joints joints = random.In(testing::CaseOf("DeltaC"));
    LinkFrameArray frames;
    ASSERT_EQ(LinkFrames(delta, joints, frames), Reason::kNone);
    for (std::size_t arm = 0; arm < 3; ++arm) {
      const double angle = 2 * std::numbers::pi / 3 * static_cast<double>(arm);
      const Vector outward(std::cos(angle), std::sin(angle), 0);
      const Vector across(-std::sin(angle), std::cos(angle), 0);
      const Frame& upper = frames[1 + arm];
      const Vector hanging = outward * std::cos(joints[arm] * std::numbers::pi / 180) -
                             Vector(0, 0, std::sin(joints[arm] * std::numbers::pi / 180));
      EXPECT_LT((upper.p - outward * 200).Norm(), 1e-9);
      const Vector knee = upper * Vector(235, 0, 0);
      EXPECT_LT((knee - (outward * 200 + hanging * 235)).Norm(), 1e-9);
      for (const double side : {1.0, -1.0}) {
        const Frame& rod = frames[4 + 2 * arm + (side < 0 ? 1 : 0)];
        EXPECT_LT((rod.p - (knee + across * (40 * side))).Norm(), 1e-9);
        const Vector end = rod * Vector(800, 0, 0);
        EXPECT_LT((end - (frames[10] * (outward * 45 + across * (40 * side)))).Norm(), 1e-9);
      }
    }
  }
}

// GR-13: no point moves further than the bound, of any link, relative to any other, on short and long motions of the
// axes.
TEST(Links, MoveNoFurtherThanSaid) {
  testing::Random random(3);
  for (const testing::Case& c : testing::Cases()) {
    SCOPED_TRACE(c.name);
    const std::size_t count = LinksOf(c.kinematics).size();
    int bounded = 0;
    double tightest = 0;
    for (int trial = 0; trial < Trials(300); ++trial) {
      const Joints from = random.In(c);
      Joints to = random.In(c);
      const double scale = std::pow(10, random.Between(-3, 0));
      for (std::size_t i = 0; i < kMaxJoints; ++i) to[i] = from[i] + scale * (to[i] - from[i]);
      const auto link = static_cast<std::size_t>(random.Between(0, static_cast<double>(count)));
      const auto other = static_cast<std::size_t>(random.Between(0, static_cast<double>(count)));
      const Vector middle = random.Direction() * random.Between(0, 500);
      const double radius = random.Between(0, 100);
      const Vector point = middle + random.Direction() * radius;
      Sweep sweep;
      ASSERT_EQ(MakeSweep(c.kinematics, from, to, sweep), Reason::kNone);
      const double most = DisplacementBound(c.kinematics, sweep, link, other, middle, radius);
      ASSERT_GE(most, 0);
      if (std::isinf(most)) continue;
      ++bounded;
      const Vector start = (sweep.start[other].Inverse() * sweep.start[link]) * point;
      for (int step = 1; step <= 8; ++step) {
        const double share = step / 8.0;
        Joints joints = from;
        for (std::size_t i = 0; i < kMaxJoints; ++i) joints[i] += share * (to[i] - from[i]);
        LinkFrameArray frames;
        ASSERT_EQ(LinkFrames(c.kinematics, joints, frames), Reason::kNone);
        const double move = ((frames[other].Inverse() * frames[link]) * point - start).Norm();
        ASSERT_LE(move, share * most + 1e-6) << LinksOf(c.kinematics)[link].name;
        if (most > 0) tightest = std::max(tightest, move / most);
      }
    }
    EXPECT_GT(bounded, Trials(300) / 4);
    EXPECT_GT(tightest, 0.5);  // and the bound is not trivial
  }
}

// GR-13
TEST(Links, RefuseWhatIsNoPosition) {
  LinkFrameArray frames;
  for (const testing::Case& c : testing::Cases()) {
    for (std::size_t i = 0; i < c.kinematics.count; ++i) {
      Joints joints{};
      joints[i] = std::nan("");
      EXPECT_NE(LinkFrames(c.kinematics, joints, frames), Reason::kNone) << c.name;
    }
  }
  const Kinematics small =
      testing::FromYaml("{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 300}}");
  EXPECT_EQ(LinkFrames(small, {}, frames), Reason::kOutOfReach);
}

}  // namespace
}  // namespace takt::kinematics
