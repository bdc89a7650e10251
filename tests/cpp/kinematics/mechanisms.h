// The mechanisms of the tests, as in a machine file, and random positions of their axes.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "takt/kinematics/kinematics.h"

namespace takt::kinematics {

inline void PrintTo(Reason reason, std::ostream* stream) {
  *stream << '"' << (reason == Reason::kNone ? "none" : Text(reason)) << '"';
}

namespace testing {

// From {delta: {...}}; fails the test with the reader's own sentence. Files are those of this folder.
Kinematics FromYaml(const std::string& text);

struct Case {
  std::string name;
  Kinematics kinematics;
  std::vector<JointRange> sample;  // [u] of each axis: no singularity inside except for single points
  bool closed_form = true;
};

const std::vector<Case>& Cases();
const Case& CaseOf(const std::string& name);

// The Delta of a published article on the kinematics of such robots (metres and millimetres apart).
extern const char* const kFlexPicker;
extern const char* const kPuma;
extern const char* const kAgilus;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Between(double lower, double upper) { return std::uniform_real_distribution<>(lower, upper)(engine_); }
  // Positions of the axes with a pose.
  Joints In(const Case& c);
  KDL::Vector Direction();

 private:
  std::mt19937 engine_;
};

Frame ForwardOrFail(const Kinematics& k, const Joints& joints);

// Ratio of the largest to the smallest effect of a unit of motion of the axes on the tool, with parts of `length` (mm)
// comparable to rad.
double ConditionOf(const Kinematics& kinematics, const Joints& joints, double length = 500);

// The angle between two orientations [deg].
double DegreesBetween(const KDL::Rotation& a, const KDL::Rotation& b);

// Displacement and turn of a tool from one frame to another, mm and rad.
KDL::Twist Difference(const Frame& from, const Frame& to);

}  // namespace testing
}  // namespace takt::kinematics
