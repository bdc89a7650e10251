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
      return "this choice of the arc does not belong to the way it is given";
    case Problem::kMeasure:
      return "there is no blend between a motion of the tool and a turn on the spot";
    case Problem::kReversal:
      return "the path goes back the way it came: there is no blend";
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
  e.about("Why there is no stretch of path.");
  e.value(Problem::kNone, "none", "There is one.");
  e.value(Problem::kNotFinite, "not_finite", "A number is not finite, or the orientation is no rotation.");
  e.value(Problem::kLengthZero, "length_zero", "Nothing moves.");
  e.value(Problem::kCoincide, "coincide", "Two points that must differ are the same.");
  e.value(Problem::kCollinear, "collinear", "The three points of an arc lie on a line.");
  e.value(Problem::kRadiusZero, "radius_zero", "The radius is 0.");
  e.value(Problem::kNotOnCircle, "not_on_circle", "The end does not lie on the circle.");
  e.value(Problem::kNoPlane, "no_plane", "The plane of the arc is not determined.");
  e.value(Problem::kTurns, "turns", "Whole turns are below 0 or no whole number.");
  e.value(Problem::kChoice, "choice", "The choice of the arc does not belong to its mode.");
  e.value(Problem::kMeasure, "measure", "One moves the tool, the other does not.");
  e.value(Problem::kReversal, "reversal", "The path goes back the way it came.");
  e.value(Problem::kTooSharp, "too_sharp", "The segments bend too much within a blend.");
  e.value(Problem::kApart, "apart", "One segment does not begin where the other ends.");
  e.value(Problem::kOutside, "outside", "A blend begins or ends outside of its segments.");
  e.value(Problem::kTooFew, "too_few", "A spline of fewer than two points.");
}

void describe(Enumeration<Shape>& e) {
  e.about("How the tool's place runs along a stretch of path.");
  e.value(Shape::kLine, "line", "Straight, or not at all.");
  e.value(Shape::kArc, "arc", "Along a circle or a helix.");
  e.value(Shape::kQuintic, "quintic", "Along a polynomial of the fifth degree.");
}

void describe(Enumeration<Measure>& e) {
  e.about("What the length of a stretch of path counts.");
  e.value(Measure::kWay, "way", "The tool's way in mm.");
  e.value(Measure::kTurn, "turn", "The tool's turn in deg.");
  e.value(Measure::kAuxiliaries, "auxiliaries", "The largest way of an auxiliary axis in its unit.");
}

void describe(Enumeration<Course>& e) {
  e.about("How the orientation runs along a stretch of path.");
  e.value(Course::kStill, "still", "Not at all.");
  e.value(Course::kEven, "even", "Evenly.");
  e.value(Course::kCurved, "curved", "By a polynomial of the fifth degree.");
}

void describe(Description<Segment>& d) {
  using S = Segment;
  d.about("A stretch of the way of a tool, by arc length.");
  d.internal<&S::length>("How long it is, as measure says.");
  d.internal<&S::measure>("What the length counts.");
  d.internal<&S::shape>("How the place runs.");
  d.internal<&S::turning>("How the orientation runs.");
  d.internal<&S::auxiliary_count>("How many auxiliary axes move or stand elsewhere than at 0.");
  d.internal<&S::cells>("How many cells a quintic has.");
  d.internal<&S::place>(unit::mm, "The place: what the shape needs.");
  d.internal<&S::rate>("Angle of an arc by its length, rad/mm.");
  d.internal<&S::cell_parameter>("Where the cells of a quintic end: parameter.");
  d.internal<&S::cell_length>(unit::mm, "Where the cells of a quintic end: length.");
  d.internal<&S::base>("The orientation that is turned: quaternion x, y, z, w.");
  d.internal<&S::turn>("What it is turned by: axis times angle in rad, coefficients over the share of the length.");
  d.internal<&S::auxiliaries>("Auxiliary axes: coefficients over the share of the length.");
}

}  // namespace takt::path
