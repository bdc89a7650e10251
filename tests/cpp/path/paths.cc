#include "paths.h"

#include <algorithm>
#include <cmath>

#include "takt/path/spline.h"

namespace takt::path::testing {
namespace {

// Any type that can be added and scaled.
template <typename T, typename Values>
std::pair<T, T> Derive(Values values, double h) {
  constexpr double kFirst[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  constexpr double kSecond[] = {8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
  T first = values(0) * 0.0;
  T second = values(0) * (-205.0 / 72);
  for (int i = 0; i < 4; ++i) {
    const T more = values((i + 1) * h), less = values(-(i + 1) * h);
    first = first + (more - less) * kFirst[i];
    second = second + (more + less) * kSecond[i];
  }
  return {first * (1 / h), second * (1 / (h * h))};
}

Segment Curved(Random& random, bool helix, const Point& point, const KDL::Vector& direction, double length,
               bool backwards, const Point& other) {
  const double slope = helix ? random.Between(-1, 1) : 0;
  const double angle = random.Between(0.3, 5);
  const double radius = length * std::cos(slope) / angle;
  const KDL::Vector normal = random.Across(direction) * std::cos(slope) + direction * std::sin(slope);
  const KDL::Vector level = (direction - normal * std::sin(slope)) / std::cos(slope);
  const KDL::Vector center = point.frame.p + normal * level * radius;
  Point far = other;
  far.frame.p = center + KDL::Rotation::Rot(normal, angle) * (point.frame.p - center) +
                normal * (radius * angle * std::tan(slope));
  const PathChoice choice = backwards ? PathChoice::kClockwise : PathChoice::kCounterclockwise;
  const Circle circle{.mode = CircMode::kCenter,
                      .auxiliary_point = {center.x(), center.y(), center.z()},
                      .choice = choice,
                      .normal = {normal.x(), normal.y(), normal.z()}};
  return backwards ? Arc(far, circle, point) : Arc(point, circle, far);
}

Segment SplinePiece(Random& random, const Point& point, const KDL::Vector& direction, double length, bool backwards,
                    const Point& other) {
  std::vector<Point> points{point, other, other};
  points[1].frame.p = point.frame.p + (direction + random.Across(direction) * 0.5) * length;
  points[2].frame.p = points[1].frame.p + (direction + random.Direction()) * length;
  points[2].frame.M = random.Orientation();
  const KDL::Vector way = backwards ? -direction : direction;
  const Triple along{way.x(), way.y(), way.z()};
  SplineOptions options;
  (backwards ? options.end_direction : options.start_direction) = along;
  if (backwards) std::reverse(points.begin(), points.end());
  std::vector<Segment> pieces;
  EXPECT_EQ(MakeSpline(points, options, pieces), Problem::kNone);
  return backwards ? pieces.back() : pieces.front();
}

}  // namespace

double Random::Size(double lower, double upper) {
  return std::exp(Between(std::log(lower), std::log(upper)));
}

KDL::Vector Random::Direction() {
  for (;;) {
    const KDL::Vector v(Between(-1, 1), Between(-1, 1), Between(-1, 1));
    if (v.Norm() > 0.1 && v.Norm() < 1) return v / v.Norm();
  }
}

KDL::Vector Random::Across(const KDL::Vector& direction) {
  for (;;) {
    const KDL::Vector v = direction * Direction();
    if (v.Norm() > 0.1) return v / v.Norm();
  }
}

Auxiliaries Random::SomeAuxiliaries() {
  return {Between(-100, 100), 0, Between(-100, 100)};
}

Segment Line(const Point& from, const Point& to) {
  Segment out;
  EXPECT_EQ(MakeLine(from, to, out), Problem::kNone);
  return out;
}

Segment Arc(const Point& from, const Circle& circle, const Point& to) {
  Segment out;
  EXPECT_EQ(MakeArc(from, circle, to, out), Problem::kNone);
  return out;
}

Point At(double x, double y, double z) {
  return {Frame(KDL::Vector(x, y, z)), {}};
}

Segment RandomSegment(Random& random, Kind kind, const Point& point, const KDL::Vector& direction, double length,
                      bool backwards) {
  Point other{Frame(random.Coin() ? random.Orientation() : point.frame.M), point.auxiliaries};
  if (random.Coin()) other.auxiliaries = random.SomeAuxiliaries();
  switch (kind) {
    case Kind::kLine:
      other.frame.p = point.frame.p + direction * length;
      return backwards ? Line(other, point) : Line(point, other);
    case Kind::kArc:
    case Kind::kHelix:
      return Curved(random, kind == Kind::kHelix, point, direction, length, backwards, other);
    case Kind::kSpline:
      return SplinePiece(random, point, direction, length, backwards, other);
  }
  return {};
}

RandomCorner MakeCorner(Random& random, Kind first, Kind second, double angle, double length) {
  RandomCorner corner;
  corner.angle = angle;
  corner.place = {Frame(random.Orientation(), random.Direction() * random.Between(0, 1000)), random.SomeAuxiliaries()};
  const KDL::Vector before = random.Direction();
  const KDL::Vector behind = before * std::cos(angle) + random.Across(before) * std::sin(angle);
  corner.first = RandomSegment(random, first, corner.place, -before, length * random.Size(0.3, 3), true);
  corner.second = RandomSegment(random, second, corner.place, behind, length * random.Size(0.3, 3), false);
  return corner;
}

Differences DifferencesAt(const Segment& segment, double s, double step) {
  Differences out;
  const MovingFrame here = path::At(segment, s);
  const auto [tangent, curvature] =
      Derive<KDL::Vector>([&](double d) { return path::At(segment, s + d).p.p - here.p.p; }, step);
  out.frame.p = KDL::VectorAcc(here.p.p, tangent, curvature);
  // Seen from here, a turn as a vector has the angular velocity and acceleration as its derivatives.
  const auto [turning, change] = Derive<KDL::Vector>(
      [&](double d) { return kinematics::TurnBetween(here.M.R, path::At(segment, s + d).M.R); }, step);
  out.frame.M = KDL::RotationAcc(here.M.R, turning, change);
  out.auxiliaries.position = AuxiliariesAt(segment, s).position;
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    const auto [rate, acceleration] =
        Derive<double>([&](double d) { return AuxiliariesAt(segment, s + d).position[i]; }, step);
    out.auxiliaries.velocity[i] = rate;
    out.auxiliaries.acceleration[i] = acceleration;
  }
  return out;
}

Step StepBetween(const Segment& first, double s_first, const Segment& second, double s_second) {
  const MovingFrame a = path::At(first, s_first), b = path::At(second, s_second);
  Step step{.place = Length(b.p.p - a.p.p),
            .tangent = Length(b.p.v - a.p.v),
            .curvature = Length(b.p.dv - a.p.dv),
            .orientation = Length(kinematics::TurnBetween(a.M.R, b.M.R)),
            .turning = Length(b.M.w - a.M.w),
            .turning_change = Length(b.M.dw - a.M.dw)};
  const AuxiliaryMotion c = AuxiliariesAt(first, s_first), d = AuxiliariesAt(second, s_second);
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    step.auxiliary = std::max(step.auxiliary, std::abs(d.position[i] - c.position[i]));
    step.auxiliary_rate = std::max(step.auxiliary_rate, std::abs(d.velocity[i] - c.velocity[i]));
    step.auxiliary_change = std::max(step.auxiliary_change, std::abs(d.acceleration[i] - c.acceleration[i]));
  }
  return step;
}

double Length(const KDL::Vector& v) {
  return std::hypot(v.x(), v.y(), v.z());
}

double PeakCurvature(const Segment& segment, int places) {
  double peak = 0;
  for (int i = 0; i <= places; ++i) {
    peak = std::max(peak, Length(path::At(segment, segment.length * i / places).p.dv));
  }
  return peak;
}

}  // namespace takt::path::testing
