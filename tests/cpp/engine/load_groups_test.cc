// GR-02, GR-11, GR-20: groups of axes and paths of a machine file; each mistake is reported with its position and a
// sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "takt/core/writer.h"
#include "takt/engine/components.h"
#include "takt/engine/load.h"

namespace takt::engine {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// Added text begins in line 13.
const std::string kWithAxes = R"(name: m
axes:
  - {name: a, limits: {velocity: 1, acceleration: 1, jerk: 1, lower: -5, upper: 5}}
  - {name: b, limits: {velocity: 1, acceleration: 1, jerk: 1}}
  - {name: c, limits: {velocity: 1, acceleration: 1, jerk: 1}}
  - {name: d, limits: {velocity: 1, acceleration: 1, jerk: 1}}
  - {name: second, limits: {velocity: 1, acceleration: 1, jerk: 1}, follows: {axis: d}}
cams:
  - {name: hill, points: [{x: 0, y: 0}, {x: 1, y: 1}]}
flex_cams:
  - {name: cutter, slave: d, cams: [hill]}
groups:
)";
const std::string kPath = "path: {velocity: 100, acceleration: 1000, jerk: 10000}";
const std::string kGantry = "kinematics: {gantry: {axes: [x, y]}}";

std::vector<std::string> GroupProblems(const std::string& more) {
  return LoadMachine(kWithAxes + more, "m.yaml").problems;
}

std::string Group(const std::string& name, const std::string& axes, const std::string& more = kGantry) {
  return "  - {name: " + name + ", axes: [" + axes + "], " + kPath + (more.empty() ? "" : ", " + more) + "}\n";
}

TEST(LoadGroups, TakesGoodOnes) {
  EXPECT_THAT(GroupProblems(Group("robot", "a, b")), IsEmpty());
  EXPECT_THAT(GroupProblems(Group("robot", "a, b, c")), IsEmpty());  // c is auxiliary
  EXPECT_THAT(GroupProblems(Group("robot", "a, b") + Group("other", "c", "")), IsEmpty());
  EXPECT_THAT(GroupProblems(Group("empty", "", "")), IsEmpty());  // filled by add_axis
}

TEST(LoadGroups, NamesWhatIsNotThere) {
  EXPECT_THAT(GroupProblems(Group("robot", "a, e")),
              ElementsAre(AllOf(StartsWith("m.yaml:13:"), HasSubstr("groups[0].axes[1]: expected the name of an axis, "
                                                                    "found 'e'"))));
}

TEST(LoadGroups, HasEachAxisOnce) {
  EXPECT_THAT(GroupProblems(Group("robot", "a, a")),
              ElementsAre(HasSubstr("groups[0].axes[1]: expected each axis once, found 'a' again")));
  EXPECT_THAT(GroupProblems(Group("robot", "a, b") + Group("other", "b, c")),
              ElementsAre(AllOf(StartsWith("m.yaml:14:"), HasSubstr("groups[1].axes[0]: expected each axis once"))));
}

// A member must not be moved by anything but its group.
TEST(LoadGroups, LeavesOtherMastersTheirAxes) {
  EXPECT_THAT(
      GroupProblems(Group("robot", "a, second")),
      ElementsAre(HasSubstr("groups[0].axes[1]: expected an axis that does not follow another, found 'second'")));
  EXPECT_THAT(GroupProblems(Group("robot", "a, d")),
              ElementsAre(HasSubstr("groups[0].axes[1]: expected an axis that no cam module moves, found 'd'")));
}

TEST(LoadGroups, HasANameOfItsOwn) {
  const std::string own = "groups[0].name: expected a name that no axis and no cam module has, and not machine, found ";
  EXPECT_THAT(GroupProblems(Group("c", "a, b")), ElementsAre(HasSubstr(own + "'c'")));
  EXPECT_THAT(GroupProblems(Group("cutter", "a, b")), ElementsAre(HasSubstr(own + "'cutter'")));
  EXPECT_THAT(GroupProblems(Group("machine", "a, b")), ElementsAre(HasSubstr(own + "'machine'")));
  EXPECT_THAT(GroupProblems(Group("g", "a, b") + Group("g", "c", "")), ElementsAre(HasSubstr("groups[1].name")));
  EXPECT_THAT(GroupProblems(Group("g g", "a, b")), ElementsAre(HasSubstr("groups[0].name: expected 1 to 40 letters")));
}

// GR-11
TEST(LoadGroups, HasTheAxesOfItsKinematics) {
  EXPECT_THAT(GroupProblems(Group("robot", "a")),
              ElementsAre(HasSubstr("groups[0].axes: expected the names of the 2 axes of the kinematics, found 1")));
  EXPECT_THAT(GroupProblems(Group("robot", "a, b", "kinematics: {}")),
              ElementsAre(HasSubstr("groups[0].kinematics: expected exactly one of the keys gantry")));
  EXPECT_THAT(GroupProblems(Group("robot", "a, b", "kinematics: {gantry: {axes: [x, y]}, joints: [{}]}")),
              ElementsAre(HasSubstr("groups[0].kinematics.joints: expected one entry for each of the 2 axes")));
  EXPECT_THAT(GroupProblems(Group("robot", "a, b", "kinematics: {serial: {urdf: nowhere.urdf}}")),
              ElementsAre(HasSubstr("groups[0].kinematics.serial.urdf: nowhere.urdf: ")));
}

TEST(LoadGroups, HasLimitsAlongThePath) {
  EXPECT_THAT(GroupProblems("  - {name: g, axes: [a]}\n"), ElementsAre(HasSubstr("groups[0].path: expected this key")));
  EXPECT_THAT(GroupProblems("  - {name: g, axes: [a], path: {velocity: 0, acceleration: 1, jerk: 1}}\n"),
              ElementsAre(HasSubstr("groups[0].path.velocity: expected a number in mm")));
  EXPECT_THAT(GroupProblems("  - {name: g, axes: [a], path: {velocity: 1, acceleration: 1, jerk: -1}}\n"),
              ElementsAre(HasSubstr("groups[0].path.jerk: expected a number in mm")));
  EXPECT_THAT(GroupProblems("  - {name: g, axes: [a, b], " + kPath + ", tool_limits: {velocity: 0}}\n"),
              ElementsAre(HasSubstr("groups[0].tool_limits.velocity: expected a number in mm")));
}

TEST(LoadGroups, IsPublishedAtARateOfItsOwn) {
  EXPECT_THAT(GroupProblems(Group("robot", "a, b") + "lcm: {rates: [{axis: robot, rate_hz: 5}]}\n"), IsEmpty());
  EXPECT_THAT(GroupProblems(Group("robot", "a, b") + "lcm: {rates: [{axis: robott, rate_hz: 5}]}\n"),
              ElementsAre(HasSubstr("expected the name of an axis or other component, found 'robott'; did you mean "
                                    "robot?")));
}

std::vector<std::string> PathProblems(const std::string& elements) {
  return GroupProblems(Group("robot", "a, b") + "paths:\n  - {name: p, elements: [" + elements + "]}\n");
}

// GR-20
TEST(LoadPaths, TakesLinesArcsAndSplines) {
  EXPECT_THAT(
      PathProblems(
          "{shape: line, to: {x: 1, y: 0, z: 0}}, {shape: arc, via_x: 2, via_y: 1, via_z: 0, to: {x: 3, y: 0, z: 0}, "
          "velocity: 5}, {shape: spline, points: [{x: 4, y: 1, z: 0}, {x: 5, y: -1, z: 0}]}"),
      IsEmpty());
}

TEST(LoadPaths, SayWhatAnElementNeeds) {
  EXPECT_THAT(PathProblems("{shape: arc, to: {x: 3, y: 0, z: 0}}"),
              ElementsAre(HasSubstr("paths[0].elements[0].via_x: must be given for an arc")));
  EXPECT_THAT(PathProblems("{shape: line, via_x: 1, to: {x: 3, y: 0, z: 0}}"),
              ElementsAre(HasSubstr("paths[0].elements[0].via_x: must be given for an arc")));
  EXPECT_THAT(PathProblems("{shape: spline, to: {x: 3, y: 0, z: 0}}"),
              testing::Contains(HasSubstr("paths[0].elements[0].to: must be given for a line and an arc")));
  EXPECT_THAT(PathProblems("{shape: line}"),
              ElementsAre(HasSubstr("paths[0].elements[0].to: must be given for a line")));
  EXPECT_THAT(PathProblems("{shape: line, to: {x: 3, y: 0}}"),
              ElementsAre(HasSubstr("paths[0].elements[0].to.z: expected this key")));
  EXPECT_THAT(GroupProblems(Group("robot", "a, b") + "paths:\n  - {name: p}\n"),
              ElementsAre(HasSubstr("paths[0].elements: must be given, or a file")));
  EXPECT_THAT(PathProblems("{shape: line, to: {x: 3, y: 0, z: 0}, velocity: 0}"),
              ElementsAre(HasSubstr("paths[0].elements[0].velocity: expected a number in mm")));
}

// GR-12, GR-20: the geometry is checked as far as possible.
TEST(LoadPaths, RefusePointsThatMakeNoPath) {
  EXPECT_THAT(PathProblems("{shape: line, to: {x: 3, y: 0, z: 0}}, {shape: line, to: {x: 3, y: 0, z: 0}}"),
              ElementsAre(HasSubstr("paths[0].elements[1]: ")));
  EXPECT_THAT(
      PathProblems(
          "{shape: line, to: {x: 0, y: 0, z: 0}}, {shape: arc, via_x: 1, via_y: 0, via_z: 0, to: {x: 2, y: 0, z: 0}}"),
      ElementsAre(HasSubstr("paths[0].elements[1]: ")));
  EXPECT_THAT(PathProblems("{shape: spline, points: [{x: 0, y: 0, z: 0}]}"),
              ElementsAre(HasSubstr("paths[0].elements[0].points: ")));
  EXPECT_THAT(PathProblems("{shape: spline, points: [{x: 0, y: 0, z: 0}, {x: 0, y: 0, z: 0}]}"),
              ElementsAre(HasSubstr("paths[0].elements[0].points: ")));
}

TEST(LoadPaths, KnowTheOrientationOrLeaveIt) {
  EXPECT_THAT(PathProblems("{shape: line, to: {x: 1, y: 0, z: 0, c: 10}}"),
              ElementsAre(HasSubstr("paths[0].elements[0].to: expected a, b and c, or none of them")));
  EXPECT_THAT(
      PathProblems(
          "{shape: line, to: {x: 1, y: 0, z: 0, a: 0, b: 0, c: 10}}, {shape: line, to: {x: 2, y: 0, z: 0, c: 20}}"),
      IsEmpty());
  EXPECT_THAT(
      PathProblems(
          "{shape: line, to: {x: 1, y: 0, z: 0}}, {shape: spline, points: [{x: 2, y: 0, z: 0, a: 0, b: 0, c: 1}]}"),
      ElementsAre(HasSubstr("paths[0].elements[1].points[0]: expected no a, b and c")));
}

class PathFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("takt_paths_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  LoadResult Load(const std::string& csv) {
    std::ofstream(folder_ / "p.csv") << csv;
    return LoadMachine(kWithAxes + Group("robot", "a, b") + "paths:\n  - {name: p, file: p.csv}\n",
                       (folder_ / "m.yaml").string());
  }
  std::vector<std::string> ProblemsOf(const std::string& csv) { return Load(csv).problems; }

  std::filesystem::path folder_;
};

TEST_F(PathFiles, HoldElements) {
  const LoadResult loaded = Load(
      "# a path\nshape;x;y;z;via_x;via_y;via_z;velocity\nline;1;0;0;;;;\narc;3;0;0;2;1;0;5\nspline;4;1;0;;;;7\n"
      "spline;5;-1;0;;;;\nspline;6;1;0;;;;\nline;9;0;0;;;;\n");
  ASSERT_THAT(loaded.problems, IsEmpty());
  EXPECT_TRUE(loaded.names_files);
  const group::PathParams& path = loaded.machine->paths.front();
  ASSERT_EQ(path.elements.size(), 4u);
  EXPECT_TRUE(path.file.empty());
  EXPECT_EQ(path.elements[0].to->x, 1);
  EXPECT_EQ(path.elements[1].via_y, 1);
  EXPECT_EQ(path.elements[1].velocity, 5);
  EXPECT_EQ(path.elements[2].points.size(), 3u);
  EXPECT_EQ(path.elements[2].velocity, 7);
  // The text is complete, for a journal.
  EXPECT_EQ(LoadMachine(WriteYaml(*loaded.machine), "again.yaml").machine->paths.front().elements.size(), 4u);
}

TEST_F(PathFiles, SayWhatIsWrongAndWhere) {
  const std::string file = (folder_ / "p.csv").string();
  EXPECT_THAT(ProblemsOf("x,y\n1,2\n"), ElementsAre(file + ":1:1: expected the columns x, y and z, found 'x,y'"));
  EXPECT_THAT(ProblemsOf("x,y,z\n1,b,3\n"), ElementsAre(file + ":2:3: expected a finite number for y, found 'b'"));
  EXPECT_THAT(ProblemsOf("shape,x,y,z\nlyne,1,2,3\n"),
              ElementsAre(file + ":2:1: expected line, arc or spline, found 'lyne'"));
  EXPECT_THAT(ProblemsOf("shape,x,y,z\narc,1,2,3\n"), ElementsAre(HasSubstr(file + ":2:5: via_x: must be given")));
  EXPECT_THAT(ProblemsOf("x,y,z\n1,2,3\n1,2,3\n"), ElementsAre(HasSubstr(file + ":3:1: paths[0]: ")));
  EXPECT_THAT(ProblemsOf("shape,x,y,z,velocity\nspline,1,2,3,4\nspline,2,3,4,5\n"),
              ElementsAre(HasSubstr(file + ":3:14: expected none")));
  EXPECT_THAT(ProblemsOf("shape,x,y,z,a,b,c\nspline,1,2,3,,,\nspline,2,3,4,0,0,1\n"),
              ElementsAre(HasSubstr(file + ":3:1: paths[0]: expected no a, b and c")));
  EXPECT_THAT(ProblemsOf("x,y,z\n"), ElementsAre(HasSubstr("expected at least one element")));
}

// GR-11: a URDF becomes part of the machine, so that a journal can be replayed without the file.
TEST(LoadGroups, TakesTheUrdfIntoTheMachine) {
  const std::string urdf = std::string(TAKT_SOURCE_DIR) + "/tests/cpp/kinematics/cobra.urdf";
  const std::string text = kWithAxes +
                           Group("robot", "a, b, c, e", "kinematics: {serial: {urdf: " + urdf + ", tip: tool}}") +
                           "simulation: {}\n";
  const std::string with_e = std::string(text).replace(
      text.find("cams:"), 0, "  - {name: e, limits: {velocity: 1, acceleration: 1, jerk: 1}}\n");
  const LoadResult loaded = LoadMachine(with_e, "m.yaml");
  ASSERT_THAT(loaded.problems, IsEmpty());
  EXPECT_TRUE(loaded.names_files);
  const LoadResult again = LoadMachine(WriteYaml(*loaded.machine), "again.yaml");
  ASSERT_THAT(again.problems, IsEmpty());
  EXPECT_FALSE(again.names_files);
  EXPECT_EQ(again.machine->groups[0].kinematics->serial->urdf, loaded.machine->groups[0].kinematics->serial->urdf);
}

TEST(LoadGroups, AreComponents) {
  const LoadResult loaded = LoadMachine(kWithAxes + Group("robot", "a, b"), "m.yaml");
  ASSERT_TRUE(loaded.machine);
  const std::optional<std::uint32_t> robot = FindComponent(*loaded.machine, "robot");
  ASSERT_EQ(robot, 6u);  // after five axes and a cam module
  EXPECT_EQ(PlaceOf(*loaded.machine, *robot).kind->name, "group");
}

}  // namespace
}  // namespace takt::engine
