#include "takt/path/make.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/angle.h"
#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/path/ends.h"
#include "takt/path/turn.h"
#include "takt/path/vectors.h"

namespace takt::path {
namespace {

constexpr double kWholeTurn = 2 * std::numbers::pi;
constexpr double kSameAuxiliary = 1e-9;
// A displacement up to this (mm or deg) does not count for the length beside one a thousand times as long.
constexpr double kTiny = 2e-4;
constexpr double kTinyShare = 1e-3;
// Least sine of the angle between two sides of a triangle; below it its points lie on a line.
constexpr double kOnALine = 1e-7;
// The same where start, centre and end define the plane; below it the plane would be determined by their errors.
constexpr double kPlaneSine = kCircleSlack;

// [mm] Largest radius: with a centre further away it cannot be decided which points lie on the circle.
constexpr double kFarthest = 1e9;

// An arc without orientation: its angle is counterclockwise about the normal, which has length 1, and above 0.
struct Round {
  Vector normal = Vector::UnitZ();
  Vector radius = Vector::Zero();  // from the centre to the start; the centre may be far away
  double angle = 0;
};

// Returns the angle counterclockwise from one radius to the other, above 0, at most a whole turn.
double AngleBetween(const Vector& normal, const Vector& from, const Vector& to) {
  const double angle = maths::Atan2(normal.dot(from.cross(to)), from.dot(to));
  return angle > 0 ? angle : angle + kWholeTurn;
}

Vector InPlane(const Vector& normal, const Vector& v) {
  return v - normal * normal.dot(v);
}

Problem ThroughBorder(const Vector& from, const Vector& border, const Vector& to, Round& out) {
  const Vector a = border - from;
  const Vector b = to - from;
  const double longest = std::max({a.norm(), b.norm(), (to - border).norm()});
  const double shortest = std::min({a.norm(), b.norm(), (to - border).norm()});
  if (shortest < kSame) return Problem::kCoincide;
  const Vector cross = a.cross(b);
  if (cross.norm() <= kOnALine * longest * longest) return Problem::kCollinear;
  out.normal = cross.normalized();
  out.radius = (b.squaredNorm() * a.cross(cross) + a.squaredNorm() * cross.cross(b)) / (2 * cross.squaredNorm());
  out.angle = AngleBetween(out.normal, out.radius, out.radius + b);
  return Problem::kNone;
}

// Finds a normal for start and end relative to the centre, if none is given.
Problem FindNormal(const Vector& from, const Vector& to, Vector& normal) {
  const double radius = from.norm();
  const Vector cross = from.cross(to);
  if (cross.norm() > kPlaneSine * radius * to.norm()) {
    normal = cross.normalized();
    constexpr double kNone = 1e-9;
    const double sign = std::abs(normal.z()) > kNone   ? normal.z()
                        : std::abs(normal.y()) > kNone ? normal.y()
                                                       : normal.x();
    if (sign < 0) normal = -normal;
    return Problem::kNone;
  }
  if (std::abs(from.z()) > kPlaneSine * radius) return Problem::kNoPlane;
  normal = Vector::UnitZ();
  return Problem::kNone;
}

Problem AboutCenter(const Vector& from, const Circle& circle, const Vector& to, Round& out) {
  if (circle.choice != PathChoice::kCounterclockwise && circle.choice != PathChoice::kClockwise) {
    return Problem::kChoice;
  }
  const Vector center = ToVector(circle.auxiliary_point);
  Vector normal = ToVector(circle.normal);
  if (normal.norm() > 0) {
    normal.normalize();
  } else if ((from - center).norm() < kSame) {
    return Problem::kRadiusZero;
  } else if (const Problem p = FindNormal(from - center, to - center, normal); p != Problem::kNone) {
    return p;
  }
  out.normal = circle.choice == PathChoice::kClockwise ? Vector(-normal) : normal;
  out.radius = InPlane(normal, from - center);
  const double radius = out.radius.norm();
  if (radius < kSame) return Problem::kRadiusZero;
  if (!(radius <= kFarthest)) return Problem::kNotOnCircle;
  const Vector chord = InPlane(normal, to - from);
  if (chord.norm() < kSame) {
    out.angle = kWholeTurn;
    return Problem::kNone;
  }
  // Moves the centre along the chord to where both ends are equally far away.
  const double off = chord.dot(out.radius + chord / 2) / chord.squaredNorm();
  if (std::abs(off) * chord.norm() > kCircleSlack * radius) return Problem::kNotOnCircle;
  out.radius -= off * chord;
  out.angle = AngleBetween(out.normal, out.radius, out.radius + chord);
  return Problem::kNone;
}

Problem WithRadius(const Vector& from, const Circle& circle, const Vector& to, Round& out) {
  if (circle.choice != PathChoice::kShort && circle.choice != PathChoice::kLong) return Problem::kChoice;
  const double radius = ToVector(circle.auxiliary_point).norm();
  if (radius < kSame) return Problem::kRadiusZero;
  out.normal = ToVector(circle.auxiliary_point) / radius;
  const Vector chord = InPlane(out.normal, to - from);
  const double half = chord.norm() / 2;
  if (2 * half < kSame) return Problem::kCoincide;
  if (half > radius * (1 + kCircleSlack)) return Problem::kNotOnCircle;
  const double height = half < radius ? std::sqrt((radius - half) * (radius + half)) : 0;
  const Vector left = out.normal.cross(chord) / (2 * half);
  const bool is_short = circle.choice == PathChoice::kShort;
  out.radius = (is_short ? -height : height) * left - chord / 2;
  const double small = 2 * maths::Atan2(half, height);
  out.angle = is_short ? small : kWholeTurn - small;
  return Problem::kNone;
}

bool Finite(const Circle& circle) {
  return ToVector(circle.auxiliary_point).allFinite() && ToVector(circle.normal).allFinite();
}

// Returns true if a displacement is large enough for the length to count it beside the others.
bool Counts(double displacement, double least, double others) {
  return displacement >= least && (displacement > kTiny || displacement >= kTinyShare * others);
}

// Sets the quantity that the length of a straight piece counts, and its length.
Problem Measured(const Vector& way, double turn_deg, const Auxiliaries& from, const Auxiliaries& to, Segment& segment) {
  double furthest = 0;
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) furthest = std::max(furthest, std::abs(to[i] - from[i]));
  if (Counts(way.norm(), kSame, std::max(turn_deg, furthest))) {
    segment.length = way.norm();
  } else if (Counts(turn_deg, kSameTurn, furthest)) {
    segment.measure = Measure::kTurn;
    segment.length = turn_deg;
  } else if (furthest >= kSameAuxiliary) {
    segment.measure = Measure::kAuxiliaries;
    segment.length = furthest;
  } else {
    return Problem::kLengthZero;
  }
  return std::isfinite(segment.length) ? Problem::kNone : Problem::kNotFinite;
}

}  // namespace

Problem MakeLine(const Point& from, const Point& to, Segment& out) noexcept {
  if (!Sound(from) || !Sound(to)) return Problem::kNotFinite;
  Segment segment;
  const Vector start = ToVector(from.frame.p);
  const Vector way = ToVector(to.frame.p) - start;
  const double turn = kinematics::ArcBetween(from.frame.M, to.frame.M).angle / kDegree;
  const Problem problem = Measured(way, turn, from.auxiliaries, to.auxiliaries, segment);
  if (problem != Problem::kNone) return problem;
  segment.place[0] = ToTriple(start);
  segment.place[1] = ToTriple(way / segment.length);
  SetEven(segment, from, to);
  out = segment;
  return Problem::kNone;
}

Problem MakeTwist(const Point& from, const Triple& way, const Triple& turn_rad, const Auxiliaries& to,
                  Segment& out) noexcept {
  if (!Sound(from) || !ToVector(turn_rad).allFinite()) return Problem::kNotFinite;
  Segment segment;
  const double turn = ToVector(turn_rad).norm() / kDegree;
  const Problem problem = Measured(ToVector(way), turn, from.auxiliaries, to, segment);
  if (problem != Problem::kNone) return problem;
  segment.place[0] = ToTriple(ToVector(from.frame.p));
  segment.place[1] = ToTriple(ToVector(way) / segment.length);
  SetEven(segment, from, {from.frame, to});
  segment.turn[1] = turn_rad;
  segment.turning = turn > 0 ? Course::kEven : Course::kStill;
  out = segment;
  return Problem::kNone;
}

Segment Still(const Point& point) noexcept {
  Segment segment;
  segment.length = 1;
  segment.place[0] = ToTriple(ToVector(point.frame.p));
  SetEven(segment, point, point);
  return segment;
}

Problem MakeArc(const Point& from, const Circle& circle, const Point& to, Segment& out) noexcept {
  if (!Sound(from) || !Sound(to) || !Finite(circle)) return Problem::kNotFinite;
  if (!(circle.turns >= 0) || circle.turns != std::floor(circle.turns) || circle.turns > kMostTurns) {
    return Problem::kTurns;
  }
  const Vector start = ToVector(from.frame.p);
  const Vector end = ToVector(to.frame.p);
  Round round;
  Problem problem = Problem::kNone;
  switch (circle.mode) {
    case CircMode::kBorder:
      problem = ThroughBorder(start, ToVector(circle.auxiliary_point), end, round);
      break;
    case CircMode::kCenter:
      problem = AboutCenter(start, circle, end, round);
      break;
    case CircMode::kRadius:
      problem = WithRadius(start, circle, end, round);
      break;
  }
  if (problem != Problem::kNone) return problem;
  const double angle = round.angle + circle.turns * kWholeTurn;
  const Vector rise = round.normal * round.normal.dot(end - start);
  Segment segment;
  segment.shape = Shape::kArc;
  segment.length = maths::Hypot(round.radius.norm() * angle, rise.norm());
  if (!std::isfinite(segment.length)) return Problem::kNotFinite;
  segment.rate = angle / segment.length;
  segment.place[0] = ToTriple(start);
  segment.place[1] = ToTriple(round.radius);
  segment.place[2] = ToTriple(round.normal.cross(round.radius));
  segment.place[3] = ToTriple(rise / segment.length);
  SetEven(segment, from, to);
  out = segment;
  return Problem::kNone;
}

void describe(Description<Circle>& d) {
  d.about("A circular arc.");
  d.internal<&Circle::mode>("Definition of the arc.");
  d.internal<&Circle::auxiliary_point>("Border point, centre, or vector of the radius, by mode.");
  d.internal<&Circle::choice>("Choice between several arcs.");
  d.internal<&Circle::normal>("Normal of the plane.");
  d.internal<&Circle::turns>("Additional whole turns.");
}

void describe(Enumeration<CircMode>& e) {
  e.about("Definition of a circular arc.");
  e.value(CircMode::kBorder, "border", "By a point on the arc.");
  e.value(CircMode::kCenter, "center", "By its centre.");
  e.value(CircMode::kRadius, "radius", "By a vector normal to its plane, as long as its radius.");
}

void describe(Enumeration<PathChoice>& e) {
  e.about("Choice between several arcs.");
  e.value(PathChoice::kCounterclockwise, "counterclockwise",
          "Counterclockwise, seen with the normal pointing at the eye.");
  e.value(PathChoice::kClockwise, "clockwise", "Clockwise, seen with the normal pointing at the eye.");
  e.value(PathChoice::kShort, "short", "Up to half a turn, with a radius.");
  e.value(PathChoice::kLong, "long", "Half a turn or more, with a radius.");
}

}  // namespace takt::path
