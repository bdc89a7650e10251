#include "takt/path/blend.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/angle.h"
#include "takt/core/maths.h"
#include "takt/path/ends.h"
#include "takt/path/make.h"
#include "takt/path/place.h"
#include "takt/path/turn.h"

namespace takt::path {
namespace {

// Cosine of half the angle by which the path turns; below it the path reverses.
constexpr double kReversal = 1e-4;
// [rad] Largest turn of a curve within a blend.
constexpr double kMostSweep = 1;
// Share of the allowed deviation that the search for a distance may leave unused.
constexpr double kUnused = 0.02;
// Share of the deviation kept free for points between the samples.
constexpr double kMargin = 5e-3;
constexpr std::size_t kSamples = 16;
constexpr int kGuesses = 12;
// Of a blend without ramps, for small turns: its largest curvature relative to the circle's, and how fast it rises.
constexpr double kPeakBend = 1.62, kBendRise = 2;
// Largest curvature at the middle of a chord, relative to the smaller mean curvature of its two sides.
constexpr double kMostBend = 2.5;

// Returns the tangent length of a blend over its distance, by the cosine of half the angle.
double TangentShare(double q) {
  return q / (0.2067 + 0.28 * q);
}

// One side of a blend where it leaves its line, relative to its distance from the corner: the first and the second
// derivative by the parameter, both along the line.
struct Side {
  double first = 0;
  double second = 0;
};

// Returns the distance from rest in which a motion reaches this velocity, without acceleration at either end.
double WayTo(double velocity, const Ramp& ramp) {
  const double full = ramp.acceleration * ramp.acceleration / ramp.jerk;
  const double time = velocity > full ? velocity / ramp.acceleration + ramp.acceleration / ramp.jerk
                                      : 2 * std::sqrt(velocity / ramp.jerk);
  return 0.5 * velocity * time;
}

// Two ramps that overlap on a corner, `q` the cosine of half its turn: the overlap takes `k` times the time in which an
// acceleration builds up. `ramped`: speed of each ramp where the blend begins or ends; `steady`: constant speed at
// which the corner may be passed.
struct Overlapping {
  double x = 1, k = 1;
  double time_s = 0;
  double ramped = 0, steady = 0;  // [mm/s]
};
Overlapping OverlappingAt(double distance, double q, const Ramp& ramp) {
  const double highest = std::sqrt(std::min(ramp.velocity * ramp.jerk, ramp.acceleration * ramp.acceleration));
  const double built_up = highest * highest * highest / (6 * ramp.jerk * ramp.jerk);
  const double x = std::max(1.0, distance / built_up);
  const double k = 0.5 * (1 + std::sqrt(1 + 4.0 / 3 * (x - 1)));
  const double within = maths::Cbrt(6 * distance / ramp.jerk);  // duration if the acceleration is not fully built up
  const double time_s = x > 1 ? k * highest / ramp.jerk : within;
  const double ramped = x > 1 ? highest * highest / ramp.jerk * (k - 0.5)
                              : 0.5 * ramp.jerk * maths::Cbrt(36 * distance * distance / (ramp.jerk * ramp.jerk));
  // At constant speed: from the curvature, and from how fast it changes.
  const double bend = kPeakBend * std::sqrt(std::max(0.0, 1 - q * q)) / (q * distance);
  const double steady =
      std::min(std::sqrt(ramp.acceleration / bend), maths::Cbrt(ramp.jerk * distance / (kBendRise * bend)));
  return {x, k, time_s, ramped, steady};
}

// Returns the side of a corner at which the first motion ends and the second begins as a ramp does. Where constant
// speed is faster it is the side of the blend without ramps.
Side SideFor(double distance, double tangent, double q, const Ramp& ramp) {
  if (!(ramp.jerk > 0)) return {tangent, 0};
  const auto [x, k, time_s, ramped, steady] = OverlappingAt(distance, q, ramp);
  const double share = std::min(1.0, WayTo(ramp.velocity, ramp) / distance) * std::clamp(2 - steady / ramped, 0.0, 1.0);
  return {std::lerp(tangent, 6 * k * (k - 0.5) / x, share), 6 * k * k / x * share};
}

// Returns the length of the arc between two tangents to a circle, relative to the sum of their lengths.
double ArcShare(double q) {
  const double half = maths::Acos(std::min(q, 1.0));
  return half > 1e-6 ? half / maths::Tan(half) : 1;
}

struct Joint {
  Derivatives<Vector> first;
  Derivatives<Vector> second;
};

Joint JointAt(const Segment& first, double s_first, const Segment& second, double s_second) {
  return {PlaceAt(first, s_first), PlaceAt(second, s_second)};
}

// Returns true if the derivative at one side, as a Bézier polynomial, makes no loop: its control vectors all lie in one
// half space.
bool Onward(const Vector& way, const Vector& derivative, const Vector& second) {
  return way.dot(derivative + second / 4) > 0;
}

Problem Places(const Segment& first, double s_first, const Segment& second, double s_second, const Bends* bends,
               const Ramp& ramp, VectorPolynomial& out) {
  auto [a, b] = JointAt(first, s_first, second, s_second);
  const Vector way = a.first + b.first;
  const double q = way.norm() / 2;
  if (q < kReversal) return Problem::kReversal;
  const double before = first.length - s_first;
  const double third = (1 - 0.4 * TangentShare(q)) * std::min(before, s_second);
  double u = 2.5 * (before - third);
  double v = 2.5 * (s_second - third);
  Side leaves, joins;
  if (!bends && ramp.jerk > 0 && before > 0 && s_second > 0) {
    const double shorter = std::min(before, s_second);
    leaves = SideFor(shorter, u / before, q, ramp);
    joins = SideFor(shorter, v / s_second, q, ramp);
    u = leaves.first * before;
    v = joins.first * s_second;
  }
  if (bends) {
    a.second += ToVector(bends->first);
    b.second += ToVector(bends->second);
    u = v = (before + s_second) * ArcShare(q);
  }
  const Derivatives<Vector> begin{a.value, a.first * u, a.second * (u * u) - leaves.second * before * a.first};
  const Derivatives<Vector> end{b.value, b.first * v, b.second * (v * v) + joins.second * s_second * b.first};
  const Vector middle =
      end.value - 0.4 * end.first + end.second / 20 - (begin.value + 0.4 * begin.first + begin.second / 20);
  if (!(Onward(way, begin.first, begin.second) && Onward(way, end.first, -end.second) && way.dot(middle) > 0)) {
    return Problem::kTooSharp;
  }
  out = VectorHermite(begin, end);
  return Problem::kNone;
}

double DistanceTo(const Segment& segment, const Vector& point, double near) {
  if (segment.shape == Shape::kLine) {
    const Vector start = ToVector(segment.place[0]);
    const Vector tangent = ToVector(segment.place[1]);
    return (start + std::clamp(tangent.dot(point - start), 0.0, segment.length) * tangent - point).norm();
  }
  double s = std::clamp(near, 0.0, segment.length);
  for (int i = 0; i < 2; ++i) {
    const auto p = PlaceAt(segment, s);
    const Vector off = point - p.value;
    const double slope = std::max(1 - off.dot(p.second), 0.1);
    s = std::clamp(s + off.dot(p.first) / slope, 0.0, segment.length);
  }
  return (PlaceAt(segment, s).value - point).norm();
}

// The stretch that a blend replaces: the end of one segment and the beginning of the next.
class Corner {
 public:
  Corner(const Segment& first, const Segment& second) : first_(first), second_(second) {
    const auto [a, b] = JointAt(first, first.length, second, 0);
    place_ = a.value;
    way_ = a.first + b.first;
  }

  double half_cosine() const { return way_.norm() / 2; }

  double Deviation(const VectorPolynomial& blend) const {
    std::array<double, kSamples + 1> distances{};
    double nearest = 0;
    double least = INFINITY;
    double side_before = -1;
    double at_change = 0;  // distance where the blend changes sides, which may be a maximum
    for (std::size_t i = 1; i < kSamples; ++i) {
      const double u = static_cast<double>(i) / kSamples;
      const Vector p = Place(blend, u);
      const double side = SideOf(p);
      if (side_before < 0 && side >= 0) {
        at_change = FromBoth(Place(blend, Change(blend, u - 1.0 / kSamples, u)));
      }
      side_before = side;
      distances[i] = FromPath(p);
      const double squared = (p - place_).squaredNorm();
      if (squared < least) {
        least = squared;
        nearest = u;
      }
    }
    double most = std::max(at_change, FromCorner(blend, nearest));
    for (std::size_t i = 1; i < kSamples; ++i) {
      most = std::max(most, distances[i]);
      const double less = distances[i - 1] - distances[i];
      const double more = distances[i + 1] - distances[i];
      if (less > 0 || more > 0 || less + more == 0) continue;
      // Maximum of the parabola through these three samples.
      const double top = static_cast<double>(i) + (less - more) / (2 * (less + more));
      most = std::max(most, FromPath(Place(blend, top / kSamples)));
    }
    return most;
  }

 private:
  // Negative before the corner, positive behind it.
  double SideOf(const Vector& p) const { return way_.dot(p - place_); }

  // Distance from the path on its side of the corner; the search begins at the point of the segment equally far from
  // the corner.
  double FromPath(const Vector& p) const { return SideOf(p) < 0 ? FromFirst(p) : FromSecond(p); }
  double FromBoth(const Vector& p) const { return std::max(FromFirst(p), FromSecond(p)); }
  double FromFirst(const Vector& p) const { return DistanceTo(first_, p, first_.length - (p - place_).norm()); }
  double FromSecond(const Vector& p) const { return DistanceTo(second_, p, (p - place_).norm()); }

  // Returns the parameter at which a blend changes sides, by two secant steps.
  double Change(const VectorPolynomial& blend, double from, double to) const {
    double a = SideOf(Place(blend, from));
    double b = SideOf(Place(blend, to));
    double u = to;
    for (int i = 0; i < 2; ++i) {
      u = (from * b - to * a) / (b - a);
      const double side = SideOf(Place(blend, u));
      (side < 0 ? from : to) = u;
      (side < 0 ? a : b) = side;
    }
    return u;
  }

  // Newton's method from the nearest sample.
  double FromCorner(const VectorPolynomial& blend, double u) const {
    for (int i = 0; i < 3; ++i) {
      const auto p = Evaluate(blend, u);
      const Vector off = p.value - place_;
      const double slope = std::max(p.first.squaredNorm() + off.dot(p.second), 0.1 * p.first.squaredNorm());
      u = std::clamp(u - off.dot(p.first) / slope, 0.0, 1.0);
    }
    return (Place(blend, u) - place_).norm();
  }

  const Segment& first_;
  const Segment& second_;
  Vector place_;
  Vector way_;
};

// Returns the turn from the orientation of the corner, with derivatives by s.
Derivatives<Vector> TurnFrom(const KDL::Rotation& corner, const MovingFrame& frame, bool before) {
  Vector turn = ToVector(kinematics::TurnBetween(corner, frame.M.R));
  const Vector velocity = ToVector(frame.M.w);
  // Half a turn is ambiguous: the sense in which the segment turns.
  const double outward = turn.dot(velocity);
  if (turn.norm() > std::numbers::pi - 1e-6 && (before ? outward > 0 : outward < 0)) {
    turn -= turn.normalized() * (2 * std::numbers::pi);
  }
  return TurnOf(turn, velocity, ToVector(frame.M.dw));
}

bool Near(const Vector& a, const Vector& b, double relative, double absolute) {
  return (a - b).norm() <= absolute + relative * std::max(a.norm(), b.norm());
}

bool SameOrientation(const KDL::Rotation& a, const KDL::Rotation& b) {
  return ToVector(kinematics::TurnBetween(a, b)).norm() <= kSameTurn * kDegree;
}

// Returns the difference of the derivatives of turns or auxiliary axes at the corner, in the unit that the length
// counts.
double Bend(const Segment& first, const Segment& second) {
  if (first.measure == Measure::kTurn) {
    const Vector a = ToVector(At(first, first.length).M.w);
    const Vector b = ToVector(At(second, 0).M.w);
    return (b - a).norm() / kDegree;
  }
  const AuxiliaryMotion a = AuxiliariesAt(first, first.length);
  const AuxiliaryMotion b = AuxiliariesAt(second, 0);
  double most = 0;
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) most = std::max(most, std::abs(b.velocity[i] - a.velocity[i]));
  return most;
}

double Apart(Measure measure, const Point& a, const Point& b) {
  if (measure == Measure::kTurn) return ToVector(kinematics::TurnBetween(a.frame.M, b.frame.M)).norm() / kDegree;
  double most = 0;
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    most = std::max(most, std::abs(b.auxiliaries[i] - a.auxiliaries[i]));
  }
  return most;
}

// Returns the minimum of a function with one valley between 0 and 1.
template <typename Function>
double Least(Function function) {
  double lower = 0;
  double upper = 1;
  for (int i = 0; i < 40; ++i) {
    const double third = (upper - lower) / 3;
    if (function(lower + third) < function(upper - third)) {
      upper -= third;
    } else {
      lower += third;
    }
  }
  return function((lower + upper) / 2);
}

// Returns the length of a curve that may be blended: up to kMostSweep.
double Sweep(const Derivatives<Vector>& place) {
  const double curvature = place.second.norm();
  return curvature > 0 ? kMostSweep / curvature : INFINITY;
}

// Returns the longest distance whose blend stays within the deviation, starting the search at `guess`; 0 if none is
// found.
double Search(const Segment& first, const Segment& second, const Corner& corner, double deviation, double guess,
              double most, const Ramp& ramp) {
  double good = 0;
  double bad = INFINITY;
  double d = std::min(guess, most);
  for (int i = 0; i < 20; ++i) {
    VectorPolynomial blend;
    double found = INFINITY;
    if (Places(first, first.length - d, second, d, nullptr, ramp, blend) == Problem::kNone) {
      found = corner.Deviation(blend) * (1 + kMargin);
    }
    if (found <= deviation) {
      good = d;
      if (d >= most || found >= (1 - kUnused) * deviation) break;
    } else {
      bad = d;
    }
    double next = std::isfinite(found) ? d * std::clamp((1 - kUnused / 2) * deviation / found, 0.1, 4.0) : d / 2;
    if (good > 0 && std::isfinite(bad)) {
      if (bad - good < 1e-3 * good) break;
      if (!(next > good && next < bad)) next = (good + bad) / 2;
    }
    d = std::min(next, most);
  }
  return good;
}

Problem MakeBlend(const Segment& first, double s_first, const Segment& second, double s_second, const Bends* bends,
                  const Ramp& ramp, Segment& out) {
  if (first.measure != second.measure) return Problem::kMeasure;
  const bool inside = s_first >= 0 && s_first < first.length && s_second > 0 && s_second <= second.length;
  if (!inside) return Problem::kOutside;
  const Point corner = PointAt(second, 0);
  const Point end = PointAt(first, first.length);
  if ((ToVector(end.frame.p) - ToVector(corner.frame.p)).norm() > kSame ||
      !SameOrientation(end.frame.M, corner.frame.M)) {
    return Problem::kApart;
  }
  Segment blend;
  blend.measure = first.measure;
  if (first.measure == Measure::kWay) {
    VectorPolynomial place;
    const Problem problem = Places(first, s_first, second, s_second, bends, ramp, place);
    if (problem != Problem::kNone) return problem;
    SetQuintic(blend, place);
  } else {
    blend.length = first.length - s_first + s_second;
    const Vector begin = PlaceAt(first, s_first).value;
    blend.place[0] = ToTriple(begin);
    blend.place[1] = ToTriple((PlaceAt(second, s_second).value - begin) / blend.length);
  }
  const auto along = [&](const Segment& segment, double s, bool before) -> Along {
    return {TurnFrom(corner.frame.M, At(segment, s), before), AuxiliariesAt(segment, s)};
  };
  SetCurved(blend, corner.frame.M, along(first, s_first, true), along(second, s_second, false));
  out = blend;
  return Problem::kNone;
}

}  // namespace

Problem Blend(const Segment& first, double s_first, const Segment& second, double s_second, Segment& out,
              const Ramp& ramp) noexcept {
  return MakeBlend(first, s_first, second, s_second, nullptr, ramp, out);
}

Problem Blend(const Segment& first, double s_first, const Segment& second, double s_second, const Bends& bends,
              Segment& out) noexcept {
  return MakeBlend(first, s_first, second, s_second, &bends, {}, out);
}

std::optional<Triple> ChordCurvature(const Segment& before, const Segment& chord, const Segment& after) noexcept {
  const auto is_line = [](const Segment& s) { return s.measure == Measure::kWay && s.shape == Shape::kLine; };
  if (!is_line(before) || !is_line(chord) || !is_line(after)) return {};
  const Vector tangent = ToVector(chord.place[1]);
  struct Side {
    double cosine = 0;
    Vector mean;  // curvature of the blend
    Vector here;  // curvature at the chord if it changes evenly
  };
  const auto side = [&](const Segment& other) -> Side {
    const Vector way = ToVector(other.place[1]);
    const double cosine = tangent.dot(way);
    const double sum = chord.length + other.length;
    const Vector mean = (way - cosine * tangent) * (4 / (sum * (1 + cosine)));
    const double longer = (chord.length - other.length) / sum;
    return {cosine, mean, mean * std::clamp(1 - 3 * longer, 0.0, kMostBend)};
  };
  const Side first = side(before);
  const Side second = side(after);
  if (first.cosine < 0 || second.cosine < 0) return {};
  // The vector of the first side is seen backwards, hence the opposite sign.
  if (!(first.mean.dot(second.mean) < 0)) return Triple{};
  const Vector middle = (second.here - first.here) / 2;
  const double most = kMostBend * std::min(first.mean.norm(), second.mean.norm());
  return ToTriple(middle * (most / std::max(middle.norm(), most)));
}

Room HalfOf(const Segment& first, const Segment& second) noexcept {
  return {first.length / 2, second.length / 2};
}

double CornerDistance(const Segment& first, const Segment& second, double deviation, const Room& room,
                      const Ramp& ramp) noexcept {
  if (first.measure != second.measure || !(deviation > 0) || Smooth(first, second)) return 0;
  double most = std::min({room.first, room.second, first.length, second.length});
  if (!(most > 0)) return 0;
  if (first.measure != Measure::kWay) {
    const double bend = Bend(first, second);
    return bend > 0 ? std::min(most, deviation / (bend * 3 / 16)) : most;
  }
  const auto [a, b] = JointAt(first, first.length, second, 0);
  const Corner corner(first, second);
  const double q = corner.half_cosine();
  if (q < kReversal) return 0;
  const double sine = (b.first - a.first).norm() / 2;
  // Distance from the corner to the middle of a symmetric blend, relative to d, from its six control points.
  const auto middle = [&](double d) {
    const Side side = SideFor(d, TangentShare(q), q, ramp);
    return sine * (1 - (5.0 / 16) * side.first + side.second / 32);
  };
  double guess = deviation / middle(deviation);
  for (int i = 0; i < kGuesses && ramp.jerk > 0; ++i) guess = deviation / middle(std::min(guess, most));
  if (first.shape == Shape::kLine && second.shape == Shape::kLine) {
    // The last guess may be slightly too long.
    const double d = std::min(guess, most);
    return ramp.jerk > 0 ? d * std::min(1.0, (1 - 1e-9) * deviation / (middle(d) * d)) : d;
  }
  most = std::min({most, Sweep(a), Sweep(b)});
  return Search(first, second, corner, deviation, guess, most, ramp);
}

double Overlap(const Segment& first, const Segment& second, double distance, const Ramp& ramp) noexcept {
  constexpr double kNotRamped = std::numeric_limits<double>::infinity();
  if (!(ramp.jerk > 0) || first.measure != Measure::kWay || second.measure != Measure::kWay) return kNotRamped;
  const Overlapping o = OverlappingAt(distance, Corner(first, second).half_cosine(), ramp);
  return o.steady < o.ramped ? o.time_s : kNotRamped;
}

double Deviation(const Segment& first, const Segment& second, const Segment& blend) noexcept {
  if (blend.measure == Measure::kWay) return Corner(first, second).Deviation(blend.place);
  const Point corner = PointAt(second, 0);
  return Least([&](double share) { return Apart(blend.measure, corner, PointAt(blend, share * blend.length)); });
}

bool Smooth(const Segment& first, const Segment& second) noexcept {
  if (first.measure != second.measure) return false;
  constexpr double kTangent = 1e-9;
  constexpr double kRelative = 1e-6;
  constexpr double kNone = 1e-12;
  const MovingFrame a = At(first, first.length);
  const MovingFrame b = At(second, 0);
  const bool along = first.measure != Measure::kWay || Near(ToVector(a.p.v), ToVector(b.p.v), 0, kTangent);
  if (!along || !Near(ToVector(a.p.dv), ToVector(b.p.dv), kRelative, kNone)) return false;
  if (!Near(ToVector(a.M.w), ToVector(b.M.w), kTangent, kNone)) return false;
  if (!Near(ToVector(a.M.dw), ToVector(b.M.dw), kRelative, kNone)) return false;
  const AuxiliaryMotion c = AuxiliariesAt(first, first.length);
  const AuxiliaryMotion d = AuxiliariesAt(second, 0);
  for (std::size_t i = 0; i < kMaxAuxiliaries; ++i) {
    const auto near = [](double x, double y, double relative) {
      return std::abs(x - y) <= kNone + relative * std::max(std::abs(x), std::abs(y));
    };
    if (!near(c.velocity[i], d.velocity[i], kTangent)) return false;
    if (!near(c.acceleration[i], d.acceleration[i], kRelative)) return false;
  }
  return true;
}

}  // namespace takt::path
