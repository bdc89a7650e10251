#include "takt/planar/transition.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "takt/core/angle.h"
#include "takt/core/maths.h"
#include "takt/path/place.h"
#include "takt/path/vectors.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

using path::VectorPolynomial;

// [rad], and in units of the chord: below this, both sides lie on one straight line.
constexpr double kNoBend = 1e-12;
// [rad] Angle from which on the next piece counts as behind the one before, or as running against it.
constexpr double kBehind = 170 * kDegree;
// [rad] Largest turn to each side of the direction in the middle.
constexpr double kMostTurn = 171 * kDegree;

// Both sides of a gap in the frame of the chord between them, scaled to length 1.
struct Gap {
  double begin_angle = 0;  // [rad] from the chord to the direction of the first side
  double end_angle = 0;
  double begin_bend = 0;  // curvature, scaled
  double end_bend = 0;
};

// Returns the curve, over a parameter from 0 to 1, with derivatives of these lengths at its ends.
VectorPolynomial CurveOf(const Gap& gap, double begin_length, double end_length) {
  const auto side = [](double place, double angle, double bend, double length) -> path::Derivatives<path::Vector> {
    const Flat first = length * Heading(angle);
    return {ToSpace({place, 0}), ToSpace(first), ToSpace(bend * length * Left(first))};
  };
  return path::VectorHermite(side(0, gap.begin_angle, gap.begin_bend, begin_length),
                             side(1, gap.end_angle, gap.end_bend, end_length));
}

// Returns the quantity to be minimised, by the midpoint rule.
double BendOf(const VectorPolynomial& curve) {
  constexpr int kPlaces = 64;
  constexpr double kRateShare = 0.01;
  double length = 0, bend = 0, rate = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const Bent p = BentAt(curve, (i + 0.5) / kPlaces);
    const double speed = p.first.norm() / kPlaces;
    const double curvature = p.curvature();
    const double curvature_rate = p.curvature_rate();
    length += speed;
    bend += curvature * curvature * speed;
    rate += curvature_rate * curvature_rate * speed;
  }
  const double root = std::sqrt(length);
  return root * std::sqrt(root) * std::sqrt(bend + kRateShare * length * length * rate);
}

// Finds the lengths of the derivatives for the least bending, in logarithms: the best of a grid, then Newton's method
// with finite differences.
class TransitionSearch {
 public:
  explicit TransitionSearch(const Gap& gap) : gap_(gap) {
    for (int i = 0; i < kGrid; ++i) {
      for (int k = 0; k < kGrid; ++k) Try({kFirst + i * kStep, kFirst + k * kStep});
    }
    double reach = kStep;
    for (int i = 0; i < kMostSteps && reach > kCloseEnough; ++i) reach = Improve(reach);
  }

  VectorPolynomial curve() const { return CurveOf(gap_, maths::Exp(best_.x()), maths::Exp(best_.y())); }

 private:
  static constexpr int kGrid = 14;
  static constexpr double kFirst = -2.4;
  static constexpr double kStep = 0.32;
  static constexpr int kMostSteps = 60;
  static constexpr double kCloseEnough = 1e-11;
  static constexpr double kDifference = 1e-3;
  static constexpr double kFlat = 1e-3;

  double Value(const Flat& at) const {
    return maths::Log(BendOf(CurveOf(gap_, maths::Exp(at.x()), maths::Exp(at.y()))));
  }

  bool Try(const Flat& at) {
    const double value = Value(at);
    if (!(value < least_)) return false;
    least_ = value;
    best_ = at;
    return true;
  }

  // Takes a step no longer than `reach`; returns the bound of the next one.
  double Improve(double reach) {
    const double h = kDifference;
    const auto at = [&](double x, double y) { return Value(best_ + Flat(x, y)); };
    const double right = at(h, 0), left = at(-h, 0), up = at(0, h), down = at(0, -h);
    const double mixed = (at(h, h) - at(h, -h) - at(-h, h) + at(-h, -h)) / (4 * h * h);
    const Flat slope((right - left) / (2 * h), (up - down) / (2 * h));
    Eigen::Matrix2d bend;
    bend << (right - 2 * least_ + left) / (h * h), mixed, mixed, (up - 2 * least_ + down) / (h * h);
    // Negative curvature along an axis is treated as positive: that makes progress in a valley, too.
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
    axes.computeDirect(bend);
    const Eigen::Matrix2d& turn = axes.eigenvectors();
    const Flat bends = axes.eigenvalues().cwiseAbs().cwiseMax(kFlat);
    Flat step = -(turn * (turn.transpose() * slope).cwiseQuotient(bends));
    const bool valley = axes.eigenvalues().minCoeff() > 0;
    // At the minimum, rounding dominates the differences: the last steps are taken unchecked.
    if (valley && step.norm() < kDifference / 10) {
      best_ += step;
      least_ = Value(best_);
      return step.norm();
    }
    if (step.norm() > reach) step *= reach / step.norm();
    return Try(best_ + step) ? 2 * reach : reach / 4;
  }

  const Gap& gap_;
  Flat best_{0, 0};
  double least_ = INFINITY;
};

// Transforms the curve into the plane, at true size.
VectorPolynomial Put(const VectorPolynomial& curve, const Flat& from, const Flat& chord) {
  VectorPolynomial out{};
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Flat c = curve[i][0] * chord + curve[i][1] * Left(chord);
    out[i] = path::ToTriple(ToSpace(i == 0 ? from : c));
  }
  return out;
}

// Returns the largest curvature; infinite if the curve turns too far, NaN if it has a cusp.
double Peak(const VectorPolynomial& curve) {
  constexpr int kPlaces = 512;
  double peak = 0;
  Flat heading = BentAt(curve, 0).first;
  double turned = 0;
  double least = 0, most = 0, middle = 0;
  for (int i = 0; i <= kPlaces; ++i) {
    const Bent p = BentAt(curve, static_cast<double>(i) / kPlaces);
    const double curvature = std::abs(p.curvature());
    if (!std::isfinite(curvature)) return NAN;
    peak = std::max(peak, curvature);
    turned += AngleTo(heading, p.first);
    heading = p.first;
    least = std::min(least, turned);
    most = std::max(most, turned);
    if (2 * i == kPlaces) middle = turned;
  }
  return std::max(most - middle, middle - least) < kMostTurn ? peak : INFINITY;
}

// Returns the error of the length: cells against their halves.
double LengthError(const path::Segment& segment) {
  double error = 0;
  double from = 0, length = 0;
  for (std::size_t i = 0; i < segment.cells; ++i) {
    const double to = segment.cell_parameter[i];
    const double middle = (from + to) / 2;
    const double halves =
        path::LengthBetween(segment.place, from, middle) + path::LengthBetween(segment.place, middle, to);
    error += std::abs(halves - (segment.cell_length[i] - length));
    from = to;
    length = segment.cell_length[i];
  }
  return error;
}

void Append(const VectorPolynomial& curve, int halvings, std::vector<path::Segment>& out) {
  path::Segment segment;
  path::SetQuintic(segment, curve);
  if (halvings == 0 || LengthError(segment) <= kLengthError * std::max(1.0, segment.length / 1000))
    return out.push_back(segment);
  Append(PartOf(curve, 0, 0.5), halvings - 1, out);
  Append(PartOf(curve, 0.5, 1), halvings - 1, out);
}

}  // namespace

Problem MakeTransition(const TrackPoint& begin, const TrackPoint& end, std::vector<path::Segment>& out) {
  const Flat from = ToFlat(begin.place);
  const Flat chord = ToFlat(end.place) - from;
  const double distance = chord.norm();
  const Gap gap{AngleTo(chord, Heading(begin.direction)), AngleTo(chord, Heading(end.direction)),
                begin.curvature * distance, end.curvature * distance};
  const double off = std::max(std::abs(gap.begin_angle), std::abs(gap.end_angle));
  const double bend = std::max(std::abs(gap.begin_bend), std::abs(gap.end_bend));
  if (off < kNoBend && bend < kNoBend) {
    path::Segment segment;
    segment.length = distance;
    segment.place[0] = path::ToTriple(ToSpace(from));
    segment.place[1] = path::ToTriple(ToSpace(chord / distance));
    out.push_back(segment);
    return Problem::kNone;
  }
  if (off > kBehind) return Problem::kReversal;
  const TransitionSearch search(gap);
  const VectorPolynomial curve = search.curve();
  const double peak = Peak(curve);
  if (std::isinf(peak)) return Problem::kLoop;
  if (!(peak * kLeastRadius <= distance)) return Problem::kTooSharp;
  constexpr int kHalvings = 5;
  Append(Put(curve, from, chord), kHalvings, out);
  return Problem::kNone;
}

}  // namespace takt::planar
