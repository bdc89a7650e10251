// GR-13: surfaces from STL files.
#include "takt/workspace/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "rig.h"
#include "surfaces.h"

namespace takt::workspace {
namespace {

using testing::Binary;
using testing::BoxFacets;
using testing::Folder;
using testing::Line;
using testing::Say;
using testing::Text;

std::string Diagnose(const std::string& bytes) {
  std::string why;
  EXPECT_FALSE(ReadStl(bytes, 1, why)) << bytes.substr(0, 80);
  return why;
}

// GR-13: both formats are equivalent, and common vertices of facets are merged.
TEST(Stl, IsReadFromBinaryAndText) {
  for (const std::string& bytes : {Binary(BoxFacets(20, 40, 60)), Text(BoxFacets(20, 40, 60))}) {
    std::string why;
    const std::optional<Mesh> mesh = ReadStl(bytes, 10, why);
    ASSERT_TRUE(mesh) << why;
    EXPECT_EQ(mesh->triangles.size(), 12u);
    EXPECT_EQ(mesh->vertices.size(), 8u);
    EXPECT_EQ(mesh->lower, KDL::Vector(-100, -200, -300));
    EXPECT_EQ(mesh->upper, KDL::Vector(100, 200, 300));
  }
}

// GR-13: some programs begin binary files with "solid"; others write DOS line ends, capital exponents, no names.
TEST(Stl, IsReadAsProgramsWriteIt) {
  std::string why;
  std::string binary = Binary(BoxFacets(1, 1, 1));
  std::memcpy(binary.data(), "solid part", 10);
  EXPECT_TRUE(ReadStl(binary, 1, why)) << why;
  const std::optional<Mesh> mesh = ReadStl(
      "solid\r\n  facet normal 0 0 1\r\n outer loop\r\n vertex 0 0 0\r\n\tvertex 1.5E+01 0 0\r\n vertex 0 -2e0 0\r\n"
      " endloop\r\n endfacet\r\nendsolid\r\n",
      1, why);
  ASSERT_TRUE(mesh) << why;
  EXPECT_EQ(mesh->vertices[1].x(), 15);
  // Old line ends, all in one line, a name that contains keywords.
  const std::string words =
      "solid vertex 1 facet normal 0 0 1 outer loop vertex 0 0 0 vertex 15 0 0 vertex 0 -2 0 "
      "endloop endfacet endsolid vertex";
  for (const char end : {'\r', ' ', '\t'}) {
    std::string text = words;
    std::ranges::replace(text, ' ', end);
    const std::optional<Mesh> same = ReadStl(text, 1, why);
    ASSERT_TRUE(same) << why;
    EXPECT_EQ(same->vertices, mesh->vertices);
  }
}

// GR-13
TEST(Stl, SaysWhatIsWrong) {
  EXPECT_EQ(Diagnose(""), "this is no STL: neither a text that begins with 'solid' nor long enough for a binary file");
  EXPECT_EQ(Diagnose("solid empty\nendsolid empty\n"), "this STL holds no triangles");
  EXPECT_EQ(Diagnose(Binary({})), "this STL holds no triangles");
  std::string cut = Binary(BoxFacets(1, 1, 1));
  cut.resize(cut.size() - 30);
  EXPECT_EQ(Diagnose(cut), "this is no STL: 12 triangles would need 684 bytes, found 654");
  EXPECT_EQ(Diagnose("solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n"),
            "line 7: a facet has 2 vertices instead of three");
  EXPECT_EQ(Diagnose("solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 1 1\nendfacet\n"),
            "line 6: a facet has more than three vertices");
  EXPECT_EQ(Diagnose("solid\nfacet\nvertex 0 0\n"), "line 3: expected three numbers behind 'vertex'");
  EXPECT_EQ(Diagnose("solid\nfacet\nvertex 0 0 1mm\n"), "line 3: expected three numbers behind 'vertex'");
  EXPECT_EQ(Diagnose("solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 nan\nendfacet\n"),
            "line 6: a facet has a vertex that is no number");
  EXPECT_EQ(Diagnose("solid\nfacet\nvertex 0 0 0\n"), "the text ends within a facet");
  EXPECT_EQ(Diagnose("solid\rfacet\rvertex 0 0\r"), "line 3: expected three numbers behind 'vertex'");
  EXPECT_EQ(Diagnose("solid\nfacet\nvertex 0 0 0\nfacet\n"), "line 4: a facet begins within another");
  EXPECT_EQ(Diagnose("solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\nendfacet\n"),
            "this STL holds no triangles");
  std::string infinite = Binary(BoxFacets(1, 1, 1));
  const float x = std::numeric_limits<float>::infinity();
  std::memcpy(infinite.data() + 84 + 50 + 12, &x, sizeof x);
  EXPECT_EQ(Diagnose(infinite), "triangle 2 has a corner that is no number");
}

// GR-13: a broken file is reported by its key in the machine file and its own name.
TEST(Stl, IsNamedWhenItIsBroken) {
  const Folder folder;
  folder.Write("guard.stl", "solid\nfacet\n vertex 1 2 x\n");
  const auto read = ReadYaml<WorkspaceParams>("{obstacles: [{name: g, mesh: {file: guard.stl}}]}", "m.yaml");
  const MakeResult made = Make(*read.value, testing::KinematicsOf(testing::kGantry), folder.path());
  EXPECT_EQ(made.path, "obstacles[0].mesh.file");
  EXPECT_EQ(made.problem, folder.path() + "/guard.stl: line 3: expected three numbers behind 'vertex'");
}

// GR-13: for either orientation of the facets.
TEST(Mesh, KnowsWhatItEncloses) {
  std::string why;
  for (const bool inside_out : {false, true}) {
    const Mesh box = *ReadStl(Text(BoxFacets(20, 40, 60, inside_out)), 1, why);
    EXPECT_TRUE(Encloses(box, {0, 0, 0}));
    EXPECT_TRUE(Encloses(box, {9.9, -19.9, 29.9}));
    EXPECT_FALSE(Encloses(box, {10.1, 0, 0}));
    EXPECT_FALSE(Encloses(box, {0, 0, -500}));
  }
  std::vector<testing::Facet> open = BoxFacets(20, 40, 60);
  open.resize(2);
  EXPECT_FALSE(Encloses(*ReadStl(Text(open), 1, why), {0, 0, 0}));
}

// GR-13: a box of triangles is found like a box, by all shapes, near and far, rotated and scaled.
TEST(Mesh, IsMetWhereABoxIs) {
  const Folder folder;
  folder.Write("box.stl", Binary(BoxFacets(0.04, 0.3, 0.5)));
  const std::string pose = ", pose: {x: 300, y: 20, a: 10, b: -15, c: 30}}]";
  for (const std::string shape : {"sphere: {radius: 12}", "box: {x: 10, y: 40, z: 20}",
                                  "cylinder: {radius: 9, height: 33}", "capsule: {radius: 9, length: 33}"}) {
    const std::string start = "{margin: 5, resolution: 0.1, gripper: [{name: tip, " + shape +
                              ", pose: {a: 33, b: 40}}], obstacles: [{name: wall, ";
    Checker box = testing::CheckerOf(testing::kGantry, start + "box: {x: 40, y: 300, z: 500}" + pose + "}");
    Checker mesh =
        testing::CheckerOf(testing::kGantry, start + "mesh: {file: box.stl, scale: 1000}" + pose + "}", folder.path());
    for (const double turn : {0.0, 50.0, 400.0}) {
      const std::vector<Sample> path = Line({0, 0, 0, 0}, {600, 30, 0, turn}, 600, 3);
      const std::optional<Finding> by_box = box.Check(path);
      const std::optional<Finding> by_mesh = mesh.Check(path);
      ASSERT_TRUE(by_box && by_mesh) << shape;
      EXPECT_NEAR(by_box->s, by_mesh->s, 0.1 + 2 * kDistanceError) << shape;
    }
  }
}

// GR-13: a path that begins inside a closed surface collides with it, though it touches no triangle; one through an
// open surface does not begin inside.
TEST(Mesh, BelongsWithWhatItEncloses) {
  const Folder folder;
  folder.Write("box.stl", Text(BoxFacets(200, 200, 200)));
  std::vector<testing::Facet> open = BoxFacets(200, 200, 200);
  open.resize(4);  // two faces perpendicular to X
  folder.Write("open.stl", Text(open));
  const auto said = [&](const std::string& file, const std::string& rest) {
    Checker checker = testing::CheckerOf(testing::kGantry,
                                         "{" + rest + ", obstacles: [{name: tank, mesh: {file: " + file +
                                             "}}, {name: pin, sphere: {radius: 1}, pose: {x: "
                                             "500}}]}",
                                         folder.path());
    return Say(checker, Line({0}, {20}, 20));
  };
  const std::string tip = "gripper: [{name: tip, sphere: {radius: 5}}]";
  EXPECT_EQ(said("box.stl", tip), "tip meets tank 0.0 mm along the path (5 mm are to be kept)");
  EXPECT_EQ(said("open.stl", tip), "free");
  // Vice versa: the gripper is a box around an obstacle.
  const std::string hood = "gripper: [{name: hood, mesh: {file: box.stl}, pose: {x: 500}}]";
  EXPECT_EQ(said("open.stl", hood), "hood meets pin 0.0 mm along the path (5 mm are to be kept)");
}

}  // namespace
}  // namespace takt::workspace
