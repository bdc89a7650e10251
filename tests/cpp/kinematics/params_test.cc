// GR-11: kinematics in a machine file.
#include "takt/kinematics/params.h"

#include <gtest/gtest.h>

#include "mechanisms.h"
#include "takt/core/verify.h"
#include "takt/core/yaml_reader.h"

namespace takt::kinematics {
namespace {

// The sentence of the reader or of Make.
std::string ProblemOf(const std::string& text) {
  const ReadResult<KinematicsParams> read = ReadYaml<KinematicsParams>(text, "m.yaml");
  if (!read.ok()) return read.problems.front().path + ": " + read.problems.front().message;
  const MakeResult made = Make(*read.value, "/nowhere");
  EXPECT_FALSE(made.kinematics) << text;
  return made.path + ": " + made.problem;
}

TEST(KinematicsParams, AreDescribed) {
  EXPECT_EQ(Verify(TypeOf<KinematicsParams>()), std::vector<std::string>{});
  EXPECT_EQ(Verify(TypeOf<Configuration>()), std::vector<std::string>{});
  EXPECT_EQ(Verify(TypeOf<Reason>()), std::vector<std::string>{});
}

// GR-11
TEST(KinematicsParams, SayWhatIsWrong) {
  EXPECT_EQ(ProblemOf("{}"),
            ": expected exactly one of the keys gantry, core_xy, scara, delta, six_axis, serial, found 0");
  EXPECT_EQ(ProblemOf("{core_xy: {}, scara: {first_arm: 1, second_arm: 1}}"),
            ": expected exactly one of the keys gantry, core_xy, scara, delta, six_axis, serial, found 2");
  EXPECT_EQ(ProblemOf("{scara: {first_arm: 0, second_arm: 1}}"),
            "scara.first_arm: expected a number in mm above 0, found 0");
  EXPECT_EQ(ProblemOf("{scara: {first_arm: 10}}"),
            "scara.second_arm: expected this key with a number in mm above 0, found nothing");
  EXPECT_EQ(ProblemOf("{delta: {base_radius: 100, platform_radius: 50, upper_arm: 100, lower_arm: -3}}"),
            "delta.lower_arm: expected a number in mm above 0, found -3");
  EXPECT_EQ(ProblemOf("{delta: {base_radius: 500, platform_radius: 50, upper_arm: 100, lower_arm: 300}}"),
            "delta.lower_arm: must be long enough for the arms to meet: upper_arm + lower_arm above base_radius - "
            "platform_radius");
  EXPECT_EQ(ProblemOf("{six_axis: {c2: 100, c3: 0}}"), "six_axis.c3: expected a number in mm above 0, found 0");
  EXPECT_EQ(ProblemOf("{gantry: {axes: [x, x]}}"), "gantry.axes: must name x, y or z, and nothing twice");
  EXPECT_EQ(ProblemOf("{gantry: {axes: [c]}}"), "gantry.axes: must name x, y or z, and nothing twice");
  EXPECT_EQ(ProblemOf("{gantry: {axes: []}}"), "gantry.axes: must name x, y or z, and nothing twice");
  EXPECT_EQ(ProblemOf("{core_xy: {}, joints: [{}]}"), "joints: expected one entry for each of the 2 axes, found 1");
  EXPECT_EQ(ProblemOf("{serial: {urdf: arm.urdf}}"), "serial.urdf: cannot read /nowhere/arm.urdf");
}

// GR-11: zero and sense of an axis, by hand: it reads 90 where the mechanism is at 0, and counts down where that counts
// up.
TEST(KinematicsParams, GiveAnAxisItsZeroAndSense) {
  const Kinematics plain = testing::FromYaml("{scara: {first_arm: 300, second_arm: 200}}");
  const Kinematics own = testing::FromYaml(
      "{scara: {first_arm: 300, second_arm: 200}, joints: [{zero: 90, invert: true}, {}, {zero: -5}, {}]}");
  const Frame expected = testing::ForwardOrFail(plain, {30, 40, 15, 0});
  EXPECT_TRUE(KDL::Equal(testing::ForwardOrFail(own, {60, 40, 10, 0}), expected, 1e-12));
}

}  // namespace
}  // namespace takt::kinematics
