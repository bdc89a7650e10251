// GR-13: the workspace section of a machine file.
#include "takt/workspace/params.h"

#include <gtest/gtest.h>

#include "rig.h"
#include "takt/core/verify.h"

namespace takt::workspace {
namespace {

// Returns the sentence of the reader or of Make.
std::string ProblemOf(const std::string& text, const std::string& kinematics = testing::kGantry) {
  const auto read = ReadYaml<WorkspaceParams>(text, "m.yaml");
  if (!read.ok()) return read.problems.front().path + ": " + read.problems.front().message;
  const MakeResult made = Make(*read.value, testing::KinematicsOf(kinematics), "/nowhere");
  EXPECT_FALSE(made.checker) << text;
  return made.path + ": " + made.problem;
}

TEST(WorkspaceParams, AreDescribed) {
  EXPECT_EQ(Verify(TypeOf<WorkspaceParams>()), std::vector<std::string>{});
}

// GR-13
TEST(WorkspaceParams, SayWhatIsWrong) {
  EXPECT_EQ(ProblemOf("{margin: -1}"), "margin: expected a number in mm above 0, found -1");
  EXPECT_EQ(ProblemOf("{margin: 1, resolution: 2}"), "resolution: must not be above margin");
  EXPECT_EQ(ProblemOf("{bounds: {lower: {x: 5}, upper: {x: 5}}}"), "bounds.upper: must lie above lower");
  EXPECT_EQ(ProblemOf("{obstacles: [{name: a, sphere: {radius: -3}}]}"),
            "obstacles[0].sphere.radius: expected a number in mm above 0, found -3");
  EXPECT_EQ(ProblemOf("{obstacles: [{name: a, box: {x: 1, y: 2}}]}"),
            "obstacles[0].box.z: expected this key with a number in mm above 0, found nothing");
  EXPECT_EQ(ProblemOf("{obstacles: [{name: a}]}"),
            "obstacles[0]: expected exactly one of the keys box, cylinder, sphere, capsule, mesh, found 0");
  EXPECT_EQ(ProblemOf("{obstacles: [{name: a, sphere: {radius: 1}, cylinder: {radius: 1, height: 1}}]}"),
            "obstacles[0]: expected exactly one of the keys box, cylinder, sphere, capsule, mesh, found 2");
  EXPECT_EQ(ProblemOf("{obstacles: [{sphere: {radius: 1}}]}"), "obstacles: must each have a name and no `link`");
  EXPECT_EQ(ProblemOf("{gripper: [{name: a, link: x, sphere: {radius: 1}}]}"),
            "gripper: must each have a name and no `link`");
  EXPECT_EQ(ProblemOf("{links: [{name: a, sphere: {radius: 1}}]}"), "links: must each say which link they are on");
  EXPECT_EQ(
      ProblemOf("{links: [{link: xy, sphere: {radius: 1}}, {link: xyzz, sphere: {radius: 1}}]}"),
      "links[1].link: expected a link of this mechanism (base, x, y, z, xy, xz, yz, xyz, tool), found 'xyzz'; did "
      "you mean xyz?");
  EXPECT_EQ(ProblemOf("{obstacles: [{name: a, capsule: {radius: 1}}]}"),
            "obstacles[0].capsule.length: must be given: here is no link from one axis to the next");
  EXPECT_EQ(ProblemOf("{links: [{link: x, capsule: {radius: 1}}]}"),
            "links[0].capsule.length: must be given: here is no link from one axis to the next");
  EXPECT_EQ(ProblemOf("{gripper: [{name: jaw, sphere: {radius: 1}}], ignore: [[jaw, tool], [jawe, tool]]}"),
            "ignore[1]: expected the name of an obstacle, a link or a part of the gripper (base, x, y, z, xy, xz, yz, "
            "xyz, tool, jaw), found 'jawe'; did you mean jaw?");
  EXPECT_EQ(ProblemOf("{obstacles: [{name: a, mesh: {file: no.stl}}]}"),
            "obstacles[0].mesh.file: /nowhere/no.stl: cannot read this file: No such file or directory");
  EXPECT_EQ(ProblemOf("{obstacles: [{name: a, mesh: {file: no.stl, scale: 0}}]}"),
            "obstacles[0].mesh.scale: expected a number above 0, found 0");
}

// GR-13: a name may mean several links, as far as they agree.
TEST(WorkspaceParams, PutOneShapeOnSeveralLinks) {
  const auto read = ReadYaml<WorkspaceParams>(
      "{links: [{link: lower_arm_2, capsule: {radius: 8}}, {link: upper_arm, capsule: {radius: 20}}, "
      "{link: lower_arm, name: joint, sphere: {radius: 12}}]}",
      "m.yaml");
  const MadeCell made = MakeCell(*read.value, testing::KinematicsOf(testing::kDelta), ".");
  ASSERT_TRUE(made.cell) << made.problem;
  std::vector<std::string> names;
  for (const Body& body : made.cell->bodies) names.push_back(body.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"lower_arm_2_a", "lower_arm_2_b", "upper_arm_1", "upper_arm_2", "upper_arm_3",
                                      "joint on lower_arm_1_a", "joint on lower_arm_1_b", "joint on lower_arm_2_a",
                                      "joint on lower_arm_2_b", "joint on lower_arm_3_a", "joint on lower_arm_3_b"}));
  const Capsule& rod = std::get<Capsule>(made.cell->bodies[0].shape.form);
  EXPECT_EQ(rod.length, 800);
}

}  // namespace
}  // namespace takt::workspace
