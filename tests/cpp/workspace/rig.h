// Checkers from the text of a machine file, and paths for them.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "takt/core/yaml_reader.h"
#include "takt/workspace/checker.h"

namespace takt::workspace::testing {

inline const char* const kGantry = "{gantry: {axes: [x, y, z, c]}}";
inline const char* const kScara = "{scara: {first_arm: 300, second_arm: 200}}";
inline const char* const kDelta =
    "{delta: {base_radius: 200, platform_radius: 45, upper_arm: 235, lower_arm: 800, rod_spacing: 80, rotary: true}}";

inline kinematics::Kinematics KinematicsOf(const std::string& text) {
  const auto read = ReadYaml<kinematics::KinematicsParams>(text, "test.yaml");
  for (const Problem& problem : read.problems) ADD_FAILURE() << problem.Text();
  const kinematics::MakeResult made = kinematics::Make(read.value.value_or(kinematics::KinematicsParams{}), ".");
  EXPECT_TRUE(made.kinematics) << made.path << ": " << made.problem;
  return made.kinematics.value_or(kinematics::Kinematics{});
}

inline Checker CheckerOf(const std::string& kinematics, const std::string& workspace, const std::string& folder = ".") {
  const auto read = ReadYaml<WorkspaceParams>(workspace, "test.yaml");
  for (const Problem& problem : read.problems) ADD_FAILURE() << problem.Text();
  MakeResult made = Make(read.value.value_or(WorkspaceParams{}), KinematicsOf(kinematics), folder);
  EXPECT_TRUE(made.checker) << made.path << ": " << made.problem;
  return made.checker ? std::move(*made.checker) : Checker(Cell{});
}

// A linear path of all axes, in equal steps; `length` in [mm].
inline std::vector<Sample> Line(const kinematics::Joints& from, const kinematics::Joints& to, double length,
                                int steps = 1) {
  std::vector<Sample> path;
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    Sample sample{share * length, from};
    for (std::size_t k = 0; k < kinematics::kMaxJoints; ++k) sample.joints[k] += share * (to[k] - from[k]);
    path.push_back(sample);
  }
  return path;
}

// Returns the finding's sentence; "free" if there is none.
inline std::string Say(Checker& checker, const std::vector<Sample>& path) {
  const std::optional<Finding> found = checker.Check(path);
  return found ? checker.Describe(*found) : "free";
}

}  // namespace takt::workspace::testing
