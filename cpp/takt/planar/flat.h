// Path segments as curves in the plane.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "takt/core/maths.h"
#include "takt/path/segment.h"
#include "takt/path/vectors.h"
#include "takt/planar/point.h"

namespace takt::planar {

using Flat = Eigen::Vector2d;

inline Flat ToFlat(const Place& p) noexcept {
  return {p.x, p.y};
}
inline Flat ToFlat(const path::Triple& t) noexcept {
  return {t[0], t[1]};
}
inline Place ToPlace(const Flat& v) noexcept {
  return {v.x(), v.y()};
}
inline path::Vector ToSpace(const Flat& v) noexcept {
  return {v.x(), v.y(), 0};
}
inline Flat Heading(double direction) noexcept {
  const auto [sine, cosine] = maths::SinCos(direction);
  return {cosine, sine};
}
inline Flat Left(const Flat& v) noexcept {
  return {-v.y(), v.x()};
}
inline double Cross(const Flat& a, const Flat& b) noexcept {
  return a.x() * b.y() - a.y() * b.x();
}
// Returns the angle [rad] from one direction to the other, between -pi and pi.
inline double AngleTo(const Flat& from, const Flat& to) noexcept {
  return maths::Atan2(Cross(from, to), from.dot(to));
}

// Point and derivatives of a quintic with respect to its parameter.
struct Bent {
  Flat value, first, second, third;

  double curvature() const noexcept {
    const double squared = first.squaredNorm();
    return Cross(first, second) / (squared * std::sqrt(squared));
  }
  // Derivative of the curvature with respect to arc length.
  double curvature_rate() const noexcept {
    const double squared = first.squaredNorm();
    return (Cross(first, third) - 3 * Cross(first, second) * first.dot(second) / squared) / (squared * squared);
  }
};
inline Bent BentAt(const path::VectorPolynomial& c, double u) noexcept {
  Flat k[6];
  for (std::size_t i = 0; i < 6; ++i) k[i] = ToFlat(c[i]);
  return {k[0] + u * (k[1] + u * (k[2] + u * (k[3] + u * (k[4] + u * k[5])))),
          k[1] + u * (2 * k[2] + u * (3 * k[3] + u * (4 * k[4] + u * (5 * k[5])))),
          2 * k[2] + u * (6 * k[3] + u * (12 * k[4] + u * (20 * k[5]))), 6 * k[3] + u * (24 * k[4] + u * (60 * k[5]))};
}

// Returns the part of a polynomial between two parameters, reparameterised from 0 to 1.
inline path::VectorPolynomial PartOf(const path::VectorPolynomial& c, double from, double to) noexcept {
  const Bent p = BentAt(c, from);
  const double h = to - from;
  const Flat fourth = ToFlat(c[4]) + 5 * from * ToFlat(c[5]);
  const auto coefficient = [](const Flat& v) { return path::ToTriple(ToSpace(v)); };
  return {coefficient(p.value),
          coefficient(p.first * h),
          coefficient(p.second * (h * h / 2)),
          coefficient(p.third * (h * h * h / 6)),
          coefficient(fourth * (h * h * h * h)),
          coefficient(ToFlat(c[5]) * (h * h * h * h * h))};
}

}  // namespace takt::planar
