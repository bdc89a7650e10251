// A stretch of a tool's path, by arc length s: pose of the tool and positions of the auxiliary axes at s. Pure
// geometry: no time, no limits.
//
// Segments are plain data of a fixed size, part of the state of the motions that use them.
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

// Auxiliary axes, which move along with the tool, each in its own unit. Unused entries are 0.
inline constexpr std::size_t kMaxAuxiliaries = kinematics::kMaxJoints;
using Auxiliaries = kinematics::Joints;
using AuxiliaryMotion = kinematics::JointMotion;

// A point of a path.
struct Point {
  Frame frame;  // [mm]
  Auxiliaries auxiliaries{};
};

// The reason why a segment cannot be made.
enum class Problem : std::uint8_t {
  kNone,         // no problem
  kNotFinite,    // a given number is NaN or infinite, or an orientation is no rotation
  kLengthZero,   // nothing moves
  kCoincide,     // two points that must differ are the same
  kCollinear,    // the three points of an arc lie on a line
  kRadiusZero,   // the radius is 0
  kNotOnCircle,  // the end does not lie on the circle
  kNoPlane,      // the plane of the arc is not determined, or its normal is invalid
  kTurns,        // the number of whole turns is negative, fractional or too large
  kChoice,       // the choice of the arc does not belong to its mode
  kMeasure,      // one segment moves the tool, the other only turns it or only moves auxiliary axes
  kReversal,     // the path reverses at the corner
  kTooSharp,     // the segments bend too much within a blend: it would make a loop
  kApart,        // one segment does not begin where the other ends
  kOutside,      // a position lies before the beginning or behind the end of its segment
  kTooFew,       // a spline needs at least two points
};

// One sentence without a full stop; empty for kNone.
std::string_view Text(Problem problem) noexcept;

using Triple = std::array<double, 3>;

// The curve of the tool's position.
enum class Shape : std::uint8_t { kLine, kArc, kQuintic };

// The quantity that s counts.
enum class Measure : std::uint8_t {
  kWay,          // [mm] path length of the tool
  kTurn,         // [deg] turn of the tool, which does not move otherwise
  kAuxiliaries,  // auxiliary axes only: path length of the one that moves furthest, in its unit
};

// The course of the orientation over the length.
enum class Course : std::uint8_t {
  kStill,   // constant
  kEven,    // linear, about a fixed axis: the second coefficient
  kCurved,  // by all six coefficients
};

// A polynomial of the fifth degree, and a vector of three.
using Polynomial = std::array<double, 6>;
using VectorPolynomial = std::array<Triple, 6>;

// Largest number of cells into which the parameter of a quintic is divided; the length of each is known.
inline constexpr std::size_t kMaxCells = 16;

struct Segment {
  double length = 0;  // in the unit of `measure`, above 0
  Measure measure = Measure::kWay;
  Shape shape = Shape::kLine;
  Course turning = Course::kStill;
  std::uint8_t auxiliary_count = 0;  // index of the last auxiliary axis that is not 0 everywhere, plus 1
  std::uint8_t cells = 0;            // of a quintic
  // The position [mm]. Line: start and derivative by s. Arc, with the angle `rate` * s: start, radius vector from the
  // centre to the start, the same a quarter turn further, rise by s. Quintic: coefficients over its parameter, from 0
  // to 1.
  VectorPolynomial place{};
  double rate = 0;  // [rad/mm] of an arc
  // Ends of the cells of a quintic: parameter, and arc length [mm] from the start.
  std::array<double, kMaxCells> cell_parameter{};
  std::array<double, kMaxCells> cell_length{};
  // The orientation: `base` turned by the vector `turn` (axis times angle [rad], in the frame in which the path is
  // given), coefficients over s / length.
  std::array<double, 4> base{0, 0, 0, 1};  // quaternion x, y, z, w
  VectorPolynomial turn{};
  std::array<Polynomial, kMaxAuxiliaries> auxiliaries{};  // coefficients over s / length
};

// Returns pose at s with first and second derivative by s (as velocity and acceleration), all exact. Positions outside
// of the segment are taken as its nearer end.
MovingFrame At(const Segment& segment, double s) noexcept;
AuxiliaryMotion AuxiliariesAt(const Segment& segment, double s) noexcept;
// Returns both, without derivatives.
Point PointAt(const Segment& segment, double s) noexcept;

void describe(Enumeration<Problem>&);
void describe(Enumeration<Shape>&);
void describe(Enumeration<Measure>&);
void describe(Enumeration<Course>&);
void describe(Description<Segment>&);

}  // namespace takt::path
