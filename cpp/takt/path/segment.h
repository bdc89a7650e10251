// A stretch of the way of a tool, by arc length: where the tool is and how it is turned after s, and where the axes are
// that go along. Pure geometry: no time, no limits.
//
// Segments are plain data of a fixed size, part of the state of what moves along them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "takt/core/describe_fwd.h"
#include "takt/kinematics/frames.h"
#include "takt/kinematics/joints.h"

namespace takt::path {

using kinematics::Frame;
using kinematics::MovingFrame;

// What goes along with the tool: extra axes, each in its own unit. Those that there are not stay 0.
inline constexpr std::size_t kMaxAuxiliaries = kinematics::kMaxJoints;
using Auxiliaries = kinematics::Joints;
using AuxiliaryMotion = kinematics::JointMotion;

// A place on a path.
struct Point {
  Frame frame;  // mm
  Auxiliaries auxiliaries{};
};

// Why there is no segment.
enum class Problem : std::uint8_t {
  kNone,         // there is one
  kNotFinite,    // a number given is NaN or infinite, or no rotation
  kLengthZero,   // nothing moves
  kCoincide,     // two points that must differ are the same
  kCollinear,    // the three points of an arc lie on a line
  kRadiusZero,   // the radius is 0
  kNotOnCircle,  // the end does not lie on the circle
  kNoPlane,      // the plane of the arc is not determined, or its normal is none
  kTurns,        // whole turns below 0, or a fraction of one
  kChoice,       // a choice of the arc that does not belong to its mode
  kMeasure,      // one moves the tool, the other only turns it or only moves auxiliary axes
  kReversal,     // the path goes back the way it came
  kTooSharp,     // the segments bend too much within a blend: it would make a loop
  kApart,        // one segment does not begin where the other ends
  kOutside,      // a place lies before the beginning or behind the end of its segment
  kTooFew,       // a spline needs at least two points
};

// One sentence without a full stop; empty for kNone.
std::string_view Text(Problem problem) noexcept;

using Triple = std::array<double, 3>;

// How the tool's place runs.
enum class Shape : std::uint8_t { kLine, kArc, kQuintic };

// What s counts.
enum class Measure : std::uint8_t {
  kWay,          // mm of the tool's way
  kTurn,         // the tool only turns: deg of its turn
  kAuxiliaries,  // only auxiliary axes move: the way of the one that moves furthest, in its unit
};

// How the orientation runs over the length.
enum class Course : std::uint8_t {
  kStill,   // not at all
  kEven,    // evenly, about an axis that stands still: the second coefficient
  kCurved,  // by all six
};

// A polynomial of the fifth degree and the vector of three.
using Polynomial = std::array<double, 6>;
using VectorPolynomial = std::array<Triple, 6>;

// Pieces into which the parameter of a quintic is cut so that the length of each is known.
inline constexpr std::size_t kMaxCells = 16;

struct Segment {
  double length = 0;  // as `measure` says, above 0
  Measure measure = Measure::kWay;
  Shape shape = Shape::kLine;
  Course turning = Course::kStill;
  std::uint8_t auxiliary_count = 0;  // how many of them there are: up to the last one that is not 0 all the way
  std::uint8_t cells = 0;            // of a quintic
  // The place, mm. Line: start and derivative by s. Arc, with the angle `rate` * s: start, from the centre to the
  // start, the same a quarter turn on, rise by s. Quintic: coefficients over its parameter, which runs from 0 to 1.
  VectorPolynomial place{};
  double rate = 0;  // rad/mm, arc
  // Where the cells of a quintic end: parameter, and mm from the start.
  std::array<double, kMaxCells> cell_parameter{};
  std::array<double, kMaxCells> cell_length{};
  // The orientation: turned from `base` by the vector `turn` (axis times angle, rad, in the frame the path is given
  // in), coefficients over s / length.
  std::array<double, 4> base{0, 0, 0, 1};  // quaternion x, y, z, w
  VectorPolynomial turn{};
  std::array<Polynomial, kMaxAuxiliaries> auxiliaries{};  // coefficients over s / length
};

// Place and orientation at s with first and second derivative by s (in the places of velocity and acceleration), all
// exact. What lies before the beginning or behind the end is taken as that.
MovingFrame At(const Segment& segment, double s) noexcept;
AuxiliaryMotion AuxiliariesAt(const Segment& segment, double s) noexcept;
// Both, without derivatives.
Point PointAt(const Segment& segment, double s) noexcept;

void describe(Enumeration<Problem>&);
void describe(Enumeration<Shape>&);
void describe(Enumeration<Measure>&);
void describe(Enumeration<Course>&);
void describe(Description<Segment>&);

}  // namespace takt::path
