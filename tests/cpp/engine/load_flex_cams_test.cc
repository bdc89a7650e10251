// CAM-01: cam modules of a machine file; each mistake is reported with its position and a sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt/engine/load.h"

namespace takt::engine {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// Cam modules begin in line 13.
const std::string kWithCams = R"(name: m
axes:
  - {name: knife, limits: {velocity: 1, acceleration: 1, jerk: 1}}
  - {name: web, limits: {velocity: 1, acceleration: 1, jerk: 1}}
  - {name: press, limits: {velocity: 1, acceleration: 1, jerk: 1}}
  - name: second
    limits: {velocity: 1, acceleration: 1, jerk: 1}
    follows: {axis: web}
cams:
  - {name: hill, points: [{x: 0, y: 0}, {x: 1, y: 1}]}
  - {name: dale, points: [{x: 0, y: 0}, {x: 1, y: 1}]}
flex_cams:
)";

std::vector<std::string> FlexCamProblems(const std::string& modules) {
  return LoadMachine(kWithCams + modules, "m.yaml").problems;
}

TEST(LoadFlexCams, TakesGoodOnes) {
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, master: web, cams: [hill, dale, hill, dale]}\n"
                              "  - {name: b, slave: press, master: knife, cams: [dale]}\n"),
              IsEmpty());
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, cams: [hill]}\n"), IsEmpty());  // a virtual master
}

TEST(LoadFlexCams, NamesWhatIsNotThere) {
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knive, master: wep, cams: [hill, hil]}\n"),
              ElementsAre("m.yaml:13:22: flex_cams[0].slave: expected the name of an axis, found 'knive'; did you mean "
                          "knife?",
                          "m.yaml:13:37: flex_cams[0].master: expected the name of an axis, a belt or a mover, found "
                          "'wep'; did you mean "
                          "web?",
                          "m.yaml:13:55: flex_cams[0].cams[1]: expected the name of a cam, found 'hil'; did you mean "
                          "hill?"));
}

TEST(LoadFlexCams, LeadsAnAxisOnce) {
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, master: web, cams: [hill]}\n"
                              "  - {name: b, slave: knife, master: press, cams: [hill]}\n"),
              ElementsAre("m.yaml:14:22: flex_cams[1].slave: expected each axis once, found 'knife' again"));
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: second, master: press, cams: [hill]}\n"),
              ElementsAre("m.yaml:13:22: flex_cams[0].slave: expected an axis that does not follow another, found "
                          "'second'"));
}

TEST(LoadFlexCams, HasANameOfItsOwn) {
  EXPECT_THAT(FlexCamProblems("  - {name: web, slave: knife, cams: [hill]}\n"),
              ElementsAre("m.yaml:13:12: flex_cams[0].name: expected a name that no axis has, and not machine, found "
                          "'web'"));
  EXPECT_THAT(FlexCamProblems("  - {name: machine, slave: knife, cams: [hill]}\n"),
              ElementsAre(StartsWith("m.yaml:13:12: flex_cams[0].name: expected a name that no axis has")));
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, cams: [hill]}\n  - {name: a, slave: web, cams: [hill]}\n"),
              ElementsAre(AllOf(StartsWith("m.yaml:14:"), HasSubstr("flex_cams[1].name"), HasSubstr("'a'"))));
  EXPECT_THAT(FlexCamProblems("  - {name: a b, slave: knife, cams: [hill]}\n"),
              ElementsAre(AllOf(StartsWith("m.yaml:13:12: flex_cams[0].name: "), HasSubstr("1 to 40 letters"))));
}

TEST(LoadFlexCams, FollowsNoLoop) {
  const std::string begin = "expected axes that follow one another in no loop, found ";
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, master: web, cams: [hill]}\n"
                              "  - {name: b, slave: web, master: knife, cams: [hill]}\n"),
              ElementsAre("m.yaml:4:5: axes[1]: " + begin + "web -> knife -> web"));
  // Through an axis that follows another by the machine file.
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: web, master: second, cams: [hill]}\n"),
              ElementsAre("m.yaml:6:5: axes[3]: " + begin + "second -> web -> second"));
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, master: knife, cams: [hill]}\n"),
              ElementsAre("m.yaml:13:37: flex_cams[0].master: must be another axis than the slave"));
}

TEST(LoadFlexCams, HasOneToFourCams) {
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, cams: []}\n"),
              ElementsAre(AllOf(StartsWith("m.yaml:13:35: flex_cams[0].cams: "), HasSubstr("must be 1 to 4 names"))));
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, cams: [hill, hill, hill, hill, hill]}\n"),
              ElementsAre(AllOf(StartsWith("m.yaml:13:35: flex_cams[0].cams: "), HasSubstr("must be 1 to 4 names"))));
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife}\n"), ElementsAre(HasSubstr("cams")));
  EXPECT_THAT(FlexCamProblems("  - {name: a, cams: [hill]}\n"), ElementsAre(HasSubstr("slave")));
}

TEST(LoadFlexCams, ChecksSettings) {
  EXPECT_THAT(FlexCamProblems("  - {name: a, slave: knife, cams: [hill], settings: {sync_mode: ramp_tim, jerk: -1}}\n"),
              ElementsAre(AllOf(HasSubstr("flex_cams[0].settings.sync_mode: "), HasSubstr("did you mean ramp_time?")),
                          HasSubstr("flex_cams[0].settings.jerk: expected ")));
}

// EN-20: a module can have its own rate.
TEST(LoadFlexCams, IsPublishedAtARateOfItsOwn) {
  const std::string module = "  - {name: cutter, slave: knife, cams: [hill]}\n";
  EXPECT_THAT(FlexCamProblems(module + "lcm: {rates: [{axis: cutter, rate_hz: 5}, {axis: web, rate_hz: 5}]}\n"),
              IsEmpty());
  EXPECT_THAT(
      FlexCamProblems(
          module +
          "lcm: {rates: [{axis: cuter, rate_hz: 5}, {axis: cutter, rate_hz: 5}, {axis: cutter, rate_hz: 6}]}\n"),
      ElementsAre(
          "m.yaml:14:22: lcm.rates[0].axis: expected the name of an axis or other component, found 'cuter'; did you "
          "mean cutter?",
          "m.yaml:14:77: lcm.rates[2].axis: expected each axis or other component once, found 'cutter' again"));
}

}  // namespace
}  // namespace takt::engine
