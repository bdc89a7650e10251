#include "takt/path/spline.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"
#include "takt/path/ends.h"
#include "takt/path/make.h"
#include "takt/path/place.h"
#include "takt/path/turn.h"

namespace takt::path {
namespace {

// Rates of orientation and auxiliary axes at a point, by arc length.
struct Rates {
  Vector turn = Vector::Zero();
  Vector turn_change = Vector::Zero();
  Auxiliaries auxiliary{};
  Auxiliaries auxiliary_change{};
};

// Returns the derivatives by the parameter at the points of the cubic spline through them: a tridiagonal system,
// eliminated from the front (Thomas).
std::vector<Vector> Slopes(std::span<const Vector> p, std::span<const double> h, const SplineOptions& options) {
  const std::size_t last = p.size() - 1;
  std::vector<Vector> right(p.size());
  std::vector<double> diagonal(p.size()), above(p.size(), 0), below(p.size(), 0);
  const auto rise = [&](std::size_t i) -> Vector { return (p[i + 1] - p[i]) / h[i]; };
  const auto end = [&](std::size_t i, const std::optional<Triple>& direction, std::size_t piece, double& beside) {
    diagonal[i] = direction ? 1 : 2;
    beside = direction ? 0 : 1;
    right[i] = direction ? Vector(ToVector(*direction).normalized() * rise(piece).norm()) : Vector(3 * rise(piece));
  };
  end(0, options.start_direction, 0, above[0]);
  end(last, options.end_direction, last - 1, below[last]);
  for (std::size_t i = 1; i < last; ++i) {
    below[i] = h[i];
    diagonal[i] = 2 * (h[i - 1] + h[i]);
    above[i] = h[i - 1];
    right[i] = 3 * (h[i] * rise(i - 1) + h[i - 1] * rise(i));
  }
  for (std::size_t i = 1; i <= last; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    right[i] -= factor * right[i - 1];
  }
  std::vector<Vector> slopes(p.size());
  slopes[last] = right[last] / diagonal[last];
  for (std::size_t i = last; i-- > 0;) slopes[i] = (right[i] - above[i] * slopes[i + 1]) / diagonal[i];
  return slopes;
}

// Returns the cubic from begin to end over the parameter 0 to 1 with these derivatives there.
VectorPolynomial Cubic(const Vector& begin, const Vector& begin_slope, const Vector& end, const Vector& end_slope) {
  const Vector way = end - begin;
  return {ToTriple(begin), ToTriple(begin_slope), ToTriple(3 * way - 2 * begin_slope - end_slope),
          ToTriple(begin_slope + end_slope - 2 * way)};
}

// Returns the rate and its change at the middle of three points, from the mean rates on both sides and their lengths.
template <typename T>
std::pair<T, T> Parabola(const T& before, const T& behind, double length_before, double length_behind) {
  const double both = length_before + length_behind;
  return {(length_behind * before + length_before * behind) / both, 2 * (behind - before) / both};
}

std::vector<Rates> RatesAt(std::span<const Point> points, std::span<const Segment> pieces) {
  const auto turn = [&](std::size_t i) -> Vector {
    return ToVector(kinematics::TurnBetween(points[i].frame.M, points[i + 1].frame.M)) / pieces[i].length;
  };
  const auto rate = [&](std::size_t i, std::size_t k) {
    return (points[i + 1].auxiliaries[k] - points[i].auxiliaries[k]) / pieces[i].length;
  };
  const std::size_t last = points.size() - 1;
  std::vector<Rates> rates(points.size());
  for (std::size_t i = 0; i <= last; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t behind = std::min(i, last - 1);
    const double a = pieces[before].length, b = pieces[behind].length;
    std::tie(rates[i].turn, rates[i].turn_change) = Parabola<Vector>(turn(before), turn(behind), a, b);
    for (std::size_t k = 0; k < kMaxAuxiliaries; ++k) {
      std::tie(rates[i].auxiliary[k], rates[i].auxiliary_change[k]) =
          Parabola<double>(rate(before, k), rate(behind, k), a, b);
    }
  }
  return rates;
}

Problem Check(std::span<const Point> points, const SplineOptions& options) {
  if (points.size() < 2) return Problem::kTooFew;
  if (!std::all_of(points.begin(), points.end(), Sound)) return Problem::kNotFinite;
  for (const auto& direction : {options.start_direction, options.end_direction}) {
    if (!direction) continue;
    if (!ToVector(*direction).allFinite()) return Problem::kNotFinite;
    if (ToVector(*direction).norm() == 0) return Problem::kLengthZero;
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((ToVector(points[i].frame.p) - ToVector(points[i - 1].frame.p)).norm() < kSame) return Problem::kCoincide;
  }
  return Problem::kNone;
}

}  // namespace

Problem MakeSpline(std::span<const Point> points, const SplineOptions& options, std::vector<Segment>& out) {
  if (const Problem problem = Check(points, options); problem != Problem::kNone) return problem;
  std::vector<Vector> places;
  for (const Point& point : points) places.push_back(ToVector(point.frame.p));
  std::vector<double> h;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double distance = (places[i] - places[i - 1]).norm();
    h.push_back(options.spacing == Spacing::kChord ? distance : std::sqrt(distance));
  }
  const std::vector<Vector> slopes = Slopes(places, h, options);
  std::vector<Segment> pieces(h.size());
  for (std::size_t i = 0; i < h.size(); ++i) {
    SetQuintic(pieces[i], Cubic(places[i], slopes[i] * h[i], places[i + 1], slopes[i + 1] * h[i]));
    if (!std::isfinite(pieces[i].length)) return Problem::kNotFinite;
  }
  const std::vector<Rates> rates = RatesAt(points, pieces);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Vector turn = ToVector(kinematics::TurnBetween(points[i].frame.M, points[i + 1].frame.M));
    const Rates& a = rates[i];
    const Rates& b = rates[i + 1];
    SetCurved(pieces[i], points[i].frame.M,
              {TurnOf(Vector::Zero(), a.turn, a.turn_change), {points[i].auxiliaries, a.auxiliary, a.auxiliary_change}},
              {TurnOf(turn, b.turn, b.turn_change), {points[i + 1].auxiliaries, b.auxiliary, b.auxiliary_change}});
  }
  out = std::move(pieces);
  return Problem::kNone;
}

void describe(Enumeration<Spacing>& e) {
  e.about("Increment of a spline's parameter from point to point.");
  e.value(Spacing::kCentripetal, "centripetal", "The square root of the distance between them.");
  e.value(Spacing::kChord, "chord", "The distance between them.");
}

}  // namespace takt::path
