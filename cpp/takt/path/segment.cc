#include "takt/path/segment.h"

#include <algorithm>

#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/path/place.h"
#include "takt/path/turn.h"
#include "takt/path/vectors.h"

namespace takt::path {
namespace {

double Within(const Segment& segment, double s) {
  return s > 0 ? std::min(s, segment.length) : 0;
}

KDL::Rotation ToKdl(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d m = q.toRotationMatrix();
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

KDL::RotationAcc TurnAt(const Segment& segment, double s) {
  const Eigen::Quaterniond base(segment.base.data());
  if (segment.turning == Course::kStill) {
    return {ToKdl(base), KDL::Vector::Zero(), KDL::Vector::Zero()};
  }
  const double share = s / segment.length;
  if (segment.turning == Course::kEven) {  // about a fixed axis
    const Vector whole = ToVector(segment.turn[1]);
    const Vector turn = share * whole;
    const double half = turn.norm() / 2;
    Eigen::Quaterniond by;
    const auto [sine, cosine] = maths::SinCos(half);
    by.w() = cosine;
    by.vec() = turn * (half < 1e-8 ? 0.5 : sine / (2 * half));
    return {ToKdl(by * base), path::ToKdl(whole / segment.length), KDL::Vector::Zero()};
  }
  const Turned turned = TurnBy(Evaluate(segment.turn, share));
  return {ToKdl(turned.rotation * base), path::ToKdl(turned.velocity / segment.length),
          path::ToKdl(turned.acceleration / (segment.length * segment.length))};
}

}  // namespace

MovingFrame At(const Segment& segment, double s) noexcept {
  s = Within(segment, s);
  const Derivatives<Vector> place = PlaceAt(segment, s);
  return {TurnAt(segment, s), KDL::VectorAcc(ToKdl(place.value), ToKdl(place.first), ToKdl(place.second))};
}

AuxiliaryMotion AuxiliariesAt(const Segment& segment, double s) noexcept {
  const double share = Within(segment, s) / segment.length;
  AuxiliaryMotion out;
  for (std::size_t i = 0; i < segment.auxiliary_count; ++i) {
    const Derivatives<double> d = Evaluate(segment.auxiliaries[i], share);
    out.position[i] = d.value;
    out.velocity[i] = d.first / segment.length;
    out.acceleration[i] = d.second / (segment.length * segment.length);
  }
  return out;
}

Point PointAt(const Segment& segment, double s) noexcept {
  return {At(segment, s).GetFrame(), AuxiliariesAt(segment, s).position};
}

std::string_view Text(Problem problem) noexcept {
  switch (problem) {
    case Problem::kNone:
      return "";
    case Problem::kNotFinite:
      return "a number of the path is not finite, or its orientation is no rotation";
    case Problem::kLengthZero:
      return "nothing moves: start and end are the same";
    case Problem::kCoincide:
      return "two points of the path that must differ are the same";
    case Problem::kCollinear:
      return "the three points of the arc lie on a line";
    case Problem::kRadiusZero:
      return "the radius of the arc is 0";
    case Problem::kNotOnCircle:
      return "the end of the arc does not lie on its circle";
    case Problem::kNoPlane:
      return "the plane of the arc is not determined: a normal is needed";
    case Problem::kTurns:
      return "whole turns must be a whole number of at least 0";
    case Problem::kChoice:
      return "this choice of the arc does not belong to its mode";
    case Problem::kMeasure:
      return "there is no blend between a motion of the tool and a turn on the spot";
    case Problem::kReversal:
      return "the path reverses at the corner: there is no blend";
    case Problem::kTooSharp:
      return "the path bends too much within the blend, which would make a loop";
    case Problem::kApart:
      return "a segment does not begin where the one before it ends";
    case Problem::kOutside:
      return "the blend begins or ends outside of its segments";
    case Problem::kTooFew:
      return "a spline needs at least two points";
  }
  return "";
}

void describe(Enumeration<Problem>& e) {
  e.about("Reason why a segment of a path cannot be made.");
  e.value(Problem::kNone, "none", "No problem.");
  e.value(Problem::kNotFinite, "not_finite", "A number is not finite, or the orientation is no rotation.");
  e.value(Problem::kLengthZero, "length_zero", "Nothing moves: start and end are the same.");
  e.value(Problem::kCoincide, "coincide", "Two points that must differ are the same.");
  e.value(Problem::kCollinear, "collinear", "The three points of an arc lie on a line.");
  e.value(Problem::kRadiusZero, "radius_zero", "The radius is 0.");
  e.value(Problem::kNotOnCircle, "not_on_circle", "The end of the arc does not lie on the circle.");
  e.value(Problem::kNoPlane, "no_plane", "The plane of the arc is not determined, or its normal is invalid.");
  e.value(Problem::kTurns, "turns", "The number of whole turns is negative, fractional or too large.");
  e.value(Problem::kChoice, "choice", "The choice of the arc does not belong to its mode.");
  e.value(Problem::kMeasure, "measure",
          "One segment moves the tool, the other only turns it or only moves auxiliary axes.");
  e.value(Problem::kReversal, "reversal", "The path reverses at the corner.");
  e.value(Problem::kTooSharp, "too_sharp", "The segments bend too much within a blend.");
  e.value(Problem::kApart, "apart", "One segment does not begin where the other ends.");
  e.value(Problem::kOutside, "outside", "A blend begins or ends outside its segments.");
  e.value(Problem::kTooFew, "too_few", "A spline has fewer than two points.");
}

void describe(Enumeration<Shape>& e) {
  e.about("Curve of the tool's position along a segment of a path.");
  e.value(Shape::kLine, "line", "A straight line, or no displacement.");
  e.value(Shape::kArc, "arc", "A circular arc or a helix.");
  e.value(Shape::kQuintic, "quintic", "A polynomial of the fifth degree.");
}

void describe(Enumeration<Measure>& e) {
  e.about("Quantity that the length of a segment counts.");
  e.value(Measure::kWay, "way", "Path length of the tool in mm.");
  e.value(Measure::kTurn, "turn", "Angle by which the tool turns, in deg.");
  e.value(Measure::kAuxiliaries, "auxiliaries", "Path length of the auxiliary axis that moves farthest, in its unit.");
}

void describe(Enumeration<Course>& e) {
  e.about("Course of the orientation along a segment of a path.");
  e.value(Course::kStill, "still", "Constant.");
  e.value(Course::kEven, "even", "Linear, about a fixed axis.");
  e.value(Course::kCurved, "curved", "A polynomial of the fifth degree.");
}

void describe(Description<Segment>& d) {
  using S = Segment;
  d.about("A segment of a tool path, by arc length.");
  d.internal<&S::length>("Length in the unit of measure.");
  d.internal<&S::measure>("Quantity that the length counts.");
  d.internal<&S::shape>("Curve of the position.");
  d.internal<&S::turning>("Course of the orientation.");
  d.internal<&S::auxiliary_count>("Number of the last auxiliary axis that is not 0 throughout; 0: none.");
  d.internal<&S::cells>("Number of cells of a quintic.");
  d.internal<&S::place>(unit::mm, "Coefficients of the position, by shape.");
  d.internal<&S::rate>("Angle of an arc per length, rad/mm.");
  d.internal<&S::cell_parameter>("Parameters at the ends of the cells of a quintic.");
  d.internal<&S::cell_length>(unit::mm, "Arc lengths at the ends of the cells of a quintic.");
  d.internal<&S::base>("Orientation before the turn: quaternion x, y, z, w.");
  d.internal<&S::turn>(
      "Turn of the orientation: axis times angle in rad, coefficients over the fraction of the length.");
  d.internal<&S::auxiliaries>("Auxiliary axes: coefficients over the fraction of the length.");
}

}  // namespace takt::path
