// CAM-03, CAM-04: cams of a machine file, and the files they name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "takt/axis/axis.h"
#include "takt/core/writer.h"
#include "takt/engine/cycle.h"
#include "takt/engine/load.h"

namespace takt::engine {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::string kAxis = "name: m\naxes: [{name: x, limits: {velocity: 1, acceleration: 1, jerk: 1}}]\ncams:\n";

std::vector<std::string> CamProblems(const std::string& cams) {
  return LoadMachine(kAxis + cams, "m.yaml").problems;
}

// A temporary folder with files.
class LoadCamFiles : public testing::Test {
 protected:
  LoadCamFiles()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("takt_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~LoadCamFiles() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  void Write(const std::string& name, const std::string& text) const { std::ofstream(Path(name)) << text; }
  LoadResult Load(const std::string& cams) const { return LoadMachine(kAxis + cams, Path("m.yaml")); }

 private:
  std::filesystem::path folder_;
};

TEST(LoadCams, MakesTablesForTheAxes) {
  const LoadResult loaded =
      LoadMachine(kAxis +
                      "  - {name: flat, points: [{x: 0, y: 5}, {x: 10, y: 5}]}\n"
                      "  - {name: saw, interpolation: linear, cyclic: true, points: [{x: 0, y: 0}, {x: 360, y: 40}]}\n",
                  "m.yaml");
  ASSERT_THAT(loaded.problems, IsEmpty());
  World world(*loaded.machine);
  ASSERT_EQ(world.cams.of_machine, 2u);
  EXPECT_EQ(world.cams.tables[0].name(), "flat");
  EXPECT_FALSE(world.cams.tables[0].cyclic());
  EXPECT_EQ(world.cams.tables[1].name(), "saw");
  EXPECT_TRUE(world.cams.tables[1].cyclic());
  EXPECT_EQ(world.cams.tables[1].At(90).y, 10);
}

TEST(LoadCams, NamesFilePlaceAndValue) {
  EXPECT_THAT(CamProblems("  - {name: a, points: [{x: 0, y: 0}, {x: 2, y: 0}, {x: 2, y: 1}]}\n"),
              ElementsAre("m.yaml:4:56: cams[0].points[2].x: expected x above 2 of the point before, found 2"));
  EXPECT_THAT(
      CamProblems("  - {name: a, points: [{x: 0, y: 0}]}\n"),
      ElementsAre(AllOf(StartsWith("m.yaml:4:23: cams[0].points: "), HasSubstr("2 to 100,000 points, found 1"))));
  EXPECT_THAT(CamProblems("  - {name: a, points: [{x: 0, y: .nan}, {x: 1, y: 1}]}\n"),
              ElementsAre(HasSubstr("points[0].y: expected a finite number")));
  EXPECT_THAT(CamProblems("  - {name: a}\n"), ElementsAre(HasSubstr("must be given, or segments, or a file")));
  EXPECT_THAT(CamProblems("  - {name: a b, points: [{x: 0, y: 0}, {x: 1, y: 0}]}\n"),
              ElementsAre(HasSubstr("1 to 40 letters")));
  EXPECT_THAT(CamProblems("  - {name: a, interpolation: linear, points: [{x: 0, y: 0, v: 1}, {x: 1, y: 0}]}\n"),
              ElementsAre(HasSubstr("points[0].v: expected no velocity in a linear cam, found 1")));
}

// CAM-01: segments as YAML.
TEST(LoadCams, ReadsSegments) {
  const LoadResult loaded = LoadMachine(kAxis + R"(  - name: press
    cyclic: true
    segments:
      - {to: {x: 120, y: 50}, law: modified_sine}
      - {to: {x: 180, y: 50}, law: dwell}
      - {to: {x: 240, y: 20}, end_v: -0.4, end_a: 0}
      - {to: {x: 360, y: 0}}
)",
                                        "m.yaml");
  ASSERT_THAT(loaded.problems, IsEmpty());
  EXPECT_THAT(loaded.warnings, IsEmpty());
  const World world(*loaded.machine);
  EXPECT_NEAR(world.cams.tables[0].At(60).y, 25, 1e-12);
  EXPECT_NEAR(world.cams.tables[0].At(240).dy, -0.4, 1e-12);
  const LoadResult again = LoadMachine(WriteYaml(*loaded.machine), "again.yaml");
  EXPECT_THAT(again.problems, IsEmpty());
  EXPECT_EQ(World(*again.machine).cams.tables[0].At(200), world.cams.tables[0].At(200));
  EXPECT_THAT(CamProblems("  - {name: a, segments: [{to: {x: 1, y: 1}}, {to: {x: 1, y: 2}}]}\n"),
              ElementsAre(HasSubstr("m.yaml:4:55: cams[0].segments[1].to.x: expected x above 1 of its beginning")));
  EXPECT_THAT(CamProblems("  - {name: a, segments: [{to: {x: 1, y: 1}, law: cycloidal}]}\n"),
              ElementsAre(HasSubstr("did you mean cycloid?")));
  EXPECT_THAT(CamProblems("  - {name: a, points: [{x: 0, y: 0}], segments: [{to: {x: 1, y: 1}}]}\n"),
              ElementsAre(HasSubstr("must be the only one of points, segments and file")));
}

// CAM-03: a warning does not prevent loading.
TEST(LoadCams, WarnsOfLinearCams) {
  const LoadResult loaded = LoadMachine(
      kAxis + "  - {name: a, interpolation: linear, points: [{x: 0, y: 0}, {x: 1, y: 1}, {x: 2, y: 0}]}\n", "m.yaml");
  EXPECT_TRUE(loaded.machine);
  EXPECT_THAT(loaded.warnings, ElementsAre(StartsWith("m.yaml:4:61: cams[0].points[1]: warning: straight lines meet")));
}

TEST_F(LoadCamFiles, ReadsFilesBesideTheMachineFile) {
  Write("cam.csv", "# made by hand\nx; y; v; a\n0; 0; 0; 0\n\n90; 10; ; \n180; 0; 0; 0\n");
  const LoadResult loaded = Load("  - {name: a, cyclic: true, file: cam.csv}\n");
  ASSERT_THAT(loaded.problems, IsEmpty());
  const World world(*loaded.machine);
  EXPECT_EQ(world.cams.tables[0].At(90).y, 10);
  EXPECT_TRUE(loaded.names_files);
  // A written machine needs no file any more.
  const LoadResult again = LoadMachine(WriteYaml(*loaded.machine), "nowhere/m.yaml");
  ASSERT_THAT(again.problems, IsEmpty());
  EXPECT_FALSE(again.names_files);
  EXPECT_EQ(again.machine->cams[0].points.size(), 3u);
}

TEST_F(LoadCamFiles, NameFileRowAndValue) {
  const auto problems = [&](const std::string& csv) {
    Write("cam.csv", csv);
    return Load("  - {name: a, file: cam.csv}\n").problems;
  };
  const std::string file = Path("cam.csv");
  EXPECT_THAT(problems("x,y\n0,0\n# no\n5,1\n5,2\n"),
              ElementsAre(file + ":5:1: cams[0]: expected x above 5 of the point before, found 5"));
  EXPECT_THAT(problems("x,y\n0,0\n1,abc\n"), ElementsAre(file + ":3:3: expected a finite number for y, found 'abc'"));
  EXPECT_THAT(problems("x,y\n0,nan\n1,1\n"), ElementsAre(HasSubstr(":2:3: expected a finite number for y")));
  EXPECT_THAT(problems("x,y\n0,0,0\n1,1\n"), ElementsAre(HasSubstr(":2:1: expected 2 columns, found 3")));
  EXPECT_THAT(problems("x,y\n0;0\n"), ElementsAre(HasSubstr(":2:1: expected 2 columns, found 1")));
  std::string long_file = "x,y\n";
  for (std::size_t i = 0; i < cam::kMaxPoints + 5; ++i) long_file += std::to_string(i) + ",0\n";
  EXPECT_THAT(problems(long_file),
              ElementsAre(HasSubstr(":100002:1: expected 100,000 points at most, found one more")));
  EXPECT_THAT(problems("x,z\n0,0\n"),
              ElementsAre(HasSubstr(":1:3: expected the columns x, y and perhaps v, a, found 'z'")));
  EXPECT_THAT(problems("x\n0\n"), ElementsAre(HasSubstr("expected the columns x and y, found 'x'")));
  EXPECT_THAT(problems(""), ElementsAre(HasSubstr("found an empty file")));
  EXPECT_THAT(Load("  - {name: a, file: no.csv}\n").problems,
              ElementsAre(AllOf(StartsWith(Path("m.yaml") + ":4:21: cams[0].file: "), HasSubstr("no.csv: "))));
}

}  // namespace
}  // namespace takt::engine
