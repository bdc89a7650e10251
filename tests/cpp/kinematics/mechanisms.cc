#include "mechanisms.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "takt/core/yaml_reader.h"

namespace takt::kinematics::testing {

const char* const kFlexPicker =
    "{delta: {base_radius: 164, platform_radius: 44, upper_arm: 524, lower_arm: 1244, first_arm_deg: -90}}";
const char* const kPuma =
    "{six_axis: {a2: 20.3, b: -150.05, c2: 431.8, c3: 431.8}, "
    "joints: [{}, {zero: 90, invert: true}, {zero: -90, invert: true}, {}, {invert: true}, {}]}";
const char* const kAgilus =
    "{six_axis: {a1: 25, a2: -35, c1: 400, c2: 315, c3: 365, c4: 80}, "
    "joints: [{invert: true}, {zero: -90}, {}, {invert: true}, {}, {invert: true}]}";

Kinematics FromYaml(const std::string& text) {
  const ReadResult<KinematicsParams> read = ReadYaml<KinematicsParams>(text, "test.yaml");
  for (const Problem& problem : read.problems) ADD_FAILURE() << problem.Text();
  const MakeResult made =
      Make(read.value.value_or(KinematicsParams{}), std::string(TAKT_SOURCE_DIR) + "/tests/cpp/kinematics");
  EXPECT_TRUE(made.kinematics) << made.path << ": " << made.problem;
  return made.kinematics.value_or(Kinematics{});
}

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases{
      {"Gantry1", FromYaml("{gantry: {axes: [x]}}"), {{-500, 500}}},
      {"Gantry3C",
       FromYaml("{gantry: {axes: [z, x, y, c]}}"),
       {{-500, 500}, {-2000, 2000}, {-2000, 2000}, {-720, 720}}},
      {"CoreXy",
       FromYaml("{core_xy: {with_z: true, with_c: true}, joints: [{}, {invert: true}, {zero: 10}, {}]}"),
       {{-500, 500}, {-500, 500}, {-100, 100}, {-720, 720}}},
      {"ScaraRight",
       FromYaml("{scara: {first_arm: 325, second_arm: 275, height: 387}}"),
       {{-130, 130}, {2, 150}, {-210, 0}, {-400, 400}}},
      {"ScaraLeft",
       FromYaml("{scara: {first_arm: 325, second_arm: 275}, joints: [{}, {zero: 10, invert: true}, {}, {}]}"),
       {{-130, 130}, {12, 160}, {-210, 0}, {-400, 400}}},
      {"Delta", FromYaml(kFlexPicker), {{-40, 80}, {-40, 80}, {-40, 80}}},
      {"DeltaC",
       FromYaml("{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800, rotary: true}, "
                "joints: [{zero: 30}, {zero: 30}, {zero: 30, invert: true}, {}]}"),
       {{0, 100}, {0, 100}, {-40, 60}, {-720, 720}}},
      {"Puma", FromYaml(kPuma), {{-160, 160}, {-220, 40}, {-50, 220}, {-170, 170}, {2, 100}, {-260, 260}}},
      {"Agilus", FromYaml(kAgilus), {{-170, 170}, {-190, 45}, {-80, 156}, {-185, 185}, {-120, -2}, {-350, 350}}},
      {"SerialPuma",
       FromYaml("{serial: {urdf: puma.urdf}}"),
       {{-150, 150}, {-60, 30}, {-45, 10}, {-160, 160}, {10, 90}, {-150, 150}},
       false},
      {"SerialSeven",
       FromYaml("{serial: {urdf: iiwa.urdf}}"),
       {{-150, 150}, {10, 100}, {-150, 150}, {20, 110}, {-150, 150}, {20, 110}, {-150, 150}},
       false},
      {"SerialScara",
       FromYaml("{serial: {urdf: cobra.urdf, tip: tool}, joints: [{}, {zero: 5}, {invert: true}, {}]}"),
       {{-90, 90}, {15, 140}, {10, 200}, {-400, 400}},
       false},
  };
  return cases;
}

const Case& CaseOf(const std::string& name) {
  for (const Case& c : Cases()) {
    if (c.name == name) return c;
  }
  ADD_FAILURE() << "no mechanism " << name;
  return Cases().front();
}

Joints Random::In(const Case& c) {
  Frame unused;
  for (;;) {
    Joints joints{};
    for (std::size_t i = 0; i < c.sample.size(); ++i) joints[i] = Between(c.sample[i].lower, c.sample[i].upper);
    if (Forward(c.kinematics, joints, unused) == Reason::kNone) return joints;
  }
}

KDL::Vector Random::Direction() {
  for (;;) {
    KDL::Vector v(Between(-1, 1), Between(-1, 1), Between(-1, 1));
    if (v.Norm() > 0.1 && v.Norm() < 1) return v / v.Norm();
  }
}

double ConditionOf(const Kinematics& k, const Joints& joints, double length) {
  Jacobian columns;
  EXPECT_EQ(JacobianAt(k, joints, columns), Reason::kNone);
  Eigen::MatrixXd matrix(6, k.count);
  for (std::size_t i = 0; i < k.count; ++i) {
    const double unit = k.kinds[i] == JointKind::kRotary ? 180 / std::numbers::pi : length;
    for (int r = 0; r < 3; ++r) {
      matrix(r, static_cast<int>(i)) = columns[i].vel(r) / length * unit;
      matrix(r + 3, static_cast<int>(i)) = columns[i].rot(r) * unit;
    }
  }
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values(0) / values(values.size() - 1);
}

Frame ForwardOrFail(const Kinematics& k, const Joints& joints) {
  Frame tool;
  EXPECT_EQ(Forward(k, joints, tool), Reason::kNone);
  return tool;
}

double DegreesBetween(const KDL::Rotation& a, const KDL::Rotation& b) {
  return TurnBetween(a, b).Norm() * 180 / std::numbers::pi;
}

KDL::Twist Difference(const Frame& from, const Frame& to) {
  return {to.p - from.p, TurnBetween(from.M, to.M)};
}

}  // namespace takt::kinematics::testing
