// Random paths, and measurements on them.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <random>
#include <vector>

#include "takt/path/make.h"
#include "takt/path/segment.h"

namespace takt::path {

inline void PrintTo(Problem problem, std::ostream* stream) {
  *stream << '"' << (problem == Problem::kNone ? "none" : Text(problem)) << '"';
}

namespace testing {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Between(double lower, double upper) { return std::uniform_real_distribution<>(lower, upper)(engine_); }
  // Uniform in its logarithm.
  double Size(double lower, double upper);
  bool Coin() { return engine_() % 2 == 0; }
  KDL::Vector Direction();
  KDL::Vector Across(const KDL::Vector& direction);  // of length 1, at a right angle to it
  KDL::Rotation Orientation() { return KDL::Rotation::Rot(Direction(), Between(-3, 3)); }
  Auxiliaries SomeAuxiliaries();

 private:
  std::mt19937 engine_;
};

Segment Line(const Point& from, const Point& to);
Segment Arc(const Point& from, const Circle& circle, const Point& to);
Point At(double x, double y, double z = 0);

// Kind of a random segment.
enum class Kind { kLine, kArc, kHelix, kSpline };
inline constexpr Kind kKinds[] = {Kind::kLine, Kind::kArc, Kind::kHelix, Kind::kSpline};

// A segment of about this length that leaves a point in this direction; or, `backwards`, that arrives at the point from
// there.
Segment RandomSegment(Random& random, Kind kind, const Point& point, const KDL::Vector& direction, double length,
                      bool backwards);

// Two segments that meet at a point, where the path turns by `angle` [rad].
struct RandomCorner {
  Segment first;
  Segment second;
  Point place;
  double angle = 0;
};
RandomCorner MakeCorner(Random& random, Kind first, Kind second, double angle, double length);

// Derivatives by s as differences of positions, orientations and auxiliaries around s; exact to the eighth order.
struct Differences {
  MovingFrame frame;
  AuxiliaryMotion auxiliaries;
};
Differences DifferencesAt(const Segment& segment, double s, double step);

// Jumps from one segment to another: of positions (mm), tangents, curvatures (1/mm), orientations (rad), their rates
// (rad/mm, rad/mm²), auxiliaries and their rates.
struct Step {
  double place = 0, tangent = 0, curvature = 0;
  double orientation = 0, turning = 0, turning_change = 0;
  double auxiliary = 0, auxiliary_rate = 0, auxiliary_change = 0;
};
Step StepBetween(const Segment& first, double s_first, const Segment& second, double s_second);

// KDL takes small vectors as zero.
double Length(const KDL::Vector& v);

// The largest curvature at this many evenly spaced points.
double PeakCurvature(const Segment& segment, int places = 400);

}  // namespace testing
}  // namespace takt::path
