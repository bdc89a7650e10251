// GR-13: the guarantees of the checker, for random cells, compared with distances without FCL at thousands of
// positions.
#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "../core/trials.h"
#include "reference.h"
#include "rig.h"

namespace takt::workspace {
namespace {

using kinematics::Frame;
using kinematics::Joints;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Between(double lower, double upper) { return std::uniform_real_distribution<>(lower, upper)(engine_); }
  int Of(int count) { return std::uniform_int_distribution<>(0, count - 1)(engine_); }

  // Small and large, thin and thick.
  std::string ShapeText(double largest) {
    const auto size = [&] { return std::to_string(std::pow(Between(0, 1), 2) * largest + 0.5); };
    switch (Of(4)) {
      case 0:
        return "box: {x: " + size() + ", y: " + size() + ", z: " + size() + "}";
      case 1:
        return "cylinder: {radius: " + size() + ", height: " + size() + "}";
      case 2:
        return "sphere: {radius: " + size() + "}";
      default:
        return "capsule: {radius: " + size() + ", length: " + size() + "}";
    }
  }
  std::string PoseText(double range, double up) {
    std::ostringstream text;
    text << "pose: {x: " << Between(-range, range) << ", y: " << Between(-range, range) << ", z: " << up
         << ", a: " << Between(-180, 180) << ", b: " << Between(-90, 90) << ", c: " << Between(-180, 180) << "}";
    return text.str();
  }

 private:
  std::mt19937 engine_;
};

// GR-13: FCL's own distances.
TEST(Scene, MeasuresAsWellAsItSays) {
  Random random(5);
  for (int trial = 0; trial < Trials(1500); ++trial) {
    const std::string text = "{obstacles: [{name: a, " + random.ShapeText(300) + ", " + random.PoseText(200, 0) +
                             "}, {name: b, " + random.ShapeText(300) + ", " + random.PoseText(200, 100) + "}]}";
    const auto read = ReadYaml<WorkspaceParams>(text, "test.yaml");
    ASSERT_TRUE(read.ok()) << text;
    const Shape a = *MakeShape(read.value->obstacles[0], {}, ".").shape;
    const Shape b = *MakeShape(read.value->obstacles[1], {}, ".").shape;
    Scene scene;
    scene.AddBody(a);
    scene.AddBody(b);
    scene.AddObstacle(b);
    const double expected = testing::ReferenceDistance(a.form, a.pose, b.form, b.pose);
    EXPECT_NEAR(scene.Between(0, {}, 1, {}, 1e4), expected, kDistanceError) << text;
    EXPECT_NEAR(scene.NearestObstacle(0, {}, 1e4).distance, expected, kDistanceError) << text;
    EXPECT_NEAR(scene.NearestObstacle(0, {}, 50).distance, std::min(expected, 50.0), kDistanceError) << text;
  }
}

struct Machine {
  const char* kinematics;
  const char* links;
  double range;  // [mm] of obstacles in X and Y
  double up;     // [mm] height of the obstacles
  std::vector<std::array<double, 2>> axes;
};

const Machine kMachines[] = {
    {testing::kGantry, "", 400, 0, {{-400, 400}, {-400, 400}, {-100, 100}, {-300, 300}}},
    {testing::kScara, "{link: arm, capsule: {radius: 20}}", 500, 0, {{-150, 150}, {-140, 140}, {-50, 50}, {-90, 90}}},
    {testing::kDelta,
     "{link: upper_arm, capsule: {radius: 20}}, {link: lower_arm, capsule: {radius: 8}}, {link: platform, cylinder: "
     "{radius: 50, height: 20}}",
     500,
     -500,
     {{-10, 70}, {-10, 70}, {-10, 70}, {-180, 180}}},
    {"{six_axis: {a1: 25, a2: 35, c1: 400, c2: 315, c3: 365, c4: 80}}",
     "{link: link_2, capsule: {radius: 40}}, {link: link_3, capsule: {radius: 30}}, {link: link_6, capsule: {radius: "
     "30}}",
     700,
     500,
     {{-170, 170}, {-90, 90}, {-90, 90}, {-180, 180}, {-100, 100}, {-300, 300}}},
};

// Returns the smallest distance between moving bodies and obstacles, by the reference.
double Nearest(const Cell& cell, const Joints& joints) {
  kinematics::LinkFrameArray frames;
  EXPECT_EQ(kinematics::LinkFrames(cell.kinematics, joints, frames), kinematics::Reason::kNone);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Body& body : cell.bodies) {
    for (const Obstacle& obstacle : cell.obstacles) {
      const Frame at = frames[body.link] * body.shape.pose;
      nearest =
          std::min(nearest, testing::ReferenceDistance(body.shape.form, at, obstacle.shape.form, obstacle.shape.pose));
    }
  }
  return nearest;
}

// GR-13: findings are true, no earlier approach was nearer than margin - resolution, and without a finding nothing is
// nearer than that.
TEST(Checker, KeepsItsPromises) {
  Random random(6);
  int free = 0;
  int met = 0;
  for (int trial = 0; trial < Trials(80); ++trial) {
    const Machine& machine = kMachines[trial % 4];
    const double margin = random.Between(1, 30);
    const double resolution = margin * random.Between(0.05, 0.9);
    std::ostringstream text;
    text << "{margin: " << margin << ", resolution: " << resolution << ", self_collisions: false, links: ["
         << machine.links << "], gripper: [{name: tip, " << random.ShapeText(120) << ", " << random.PoseText(20, -30)
         << "}], obstacles: [";
    for (int i = random.Of(4); i >= 0; --i) {
      text << "{name: o" << i << ", " << random.ShapeText(150) << ", "
           << random.PoseText(machine.range, machine.up + random.Between(-200, 200)) << "}" << (i == 0 ? "]}" : ", ");
    }
    SCOPED_TRACE(text.str());
    const auto read = ReadYaml<WorkspaceParams>(text.str(), "test.yaml");
    ASSERT_TRUE(read.ok());
    const MadeCell cell = MakeCell(*read.value, testing::KinematicsOf(machine.kinematics), ".");
    ASSERT_TRUE(cell.cell) << cell.problem;
    Checker checker = testing::CheckerOf(machine.kinematics, text.str());

    Joints from{};
    Joints to{};
    for (std::size_t i = 0; i < machine.axes.size(); ++i) {
      from[i] = random.Between(machine.axes[i][0], machine.axes[i][1]);
      to[i] = random.Between(machine.axes[i][0], machine.axes[i][1]);
    }
    const std::optional<Finding> found = checker.Check(testing::Line(from, to, 1, 1 + random.Of(5)));
    const double end = found ? found->s : 1;
    ++(found ? met : free);
    if (found) {
      ASSERT_EQ(found->trouble, Trouble::kCollision) << checker.Describe(*found);
      EXPECT_LT(Nearest(*cell.cell, found->joints), margin + kDistanceError);
    }
    constexpr int kPlaces = 300;
    for (int i = 0; i < kPlaces && end > 0; ++i) {
      const double s = end * i / kPlaces;
      Joints joints = from;
      for (std::size_t k = 0; k < machine.axes.size(); ++k) joints[k] += s * (to[k] - from[k]);
      ASSERT_GT(Nearest(*cell.cell, joints), margin - resolution - kDistanceError) << "at " << s << " of " << end;
    }
  }
  EXPECT_GT(free, Trials(80) / 10);
  EXPECT_GT(met, Trials(80) / 4);
}

}  // namespace
}  // namespace takt::workspace
