// Three numbers as a vector for calculations, and polynomials of them.
#pragma once

#include <Eigen/Core>
#include <kdl/frames.hpp>

#include "takt/path/segment.h"

namespace takt::path {

using Vector = Eigen::Vector3d;

inline Vector ToVector(const Triple& t) noexcept {
  return {t[0], t[1], t[2]};
}
inline Vector ToVector(const KDL::Vector& v) noexcept {
  return {v.data[0], v.data[1], v.data[2]};
}
inline Triple ToTriple(const Vector& v) noexcept {
  return {v[0], v[1], v[2]};
}
inline KDL::Vector ToKdl(const Vector& v) noexcept {
  return {v[0], v[1], v[2]};
}

// A value with its first and second derivative.
template <typename T>
struct Derivatives {
  T value;
  T first;
  T second;
};

// Returns the value and derivatives of a polynomial of the fifth degree, by its own parameter.
inline Derivatives<double> Evaluate(const Polynomial& c, double u) noexcept {
  return {c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
          c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * (5 * c[5])))),
          2 * c[2] + u * (6 * c[3] + u * (12 * c[4] + u * (20 * c[5])))};
}
inline Derivatives<Vector> Evaluate(const VectorPolynomial& c, double u) noexcept {
  Derivatives<Vector> out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto d = Evaluate(Polynomial{c[0][i], c[1][i], c[2][i], c[3][i], c[4][i], c[5][i]}, u);
    const auto k = static_cast<Eigen::Index>(i);
    out.value[k] = d.value;
    out.first[k] = d.first;
    out.second[k] = d.second;
  }
  return out;
}
inline Vector Place(const VectorPolynomial& c, double u) noexcept {
  return ToVector(c[0]) +
         u * (ToVector(c[1]) + u * (ToVector(c[2]) + u * (ToVector(c[3]) + u * (ToVector(c[4]) + u * ToVector(c[5])))));
}
inline Vector Slope(const VectorPolynomial& c, double u) noexcept {
  return ToVector(c[1]) +
         u * (2 * ToVector(c[2]) + u * (3 * ToVector(c[3]) + u * (4 * ToVector(c[4]) + u * 5 * ToVector(c[5]))));
}

// Returns the polynomial over 0 to 1 with these values and derivatives at both ends.
template <typename T>
std::array<T, 6> Hermite(const Derivatives<T>& begin, const Derivatives<T>& end) noexcept {
  const T way = end.value - begin.value - begin.first - begin.second / 2;
  const T slope = end.first - begin.first - begin.second;
  const T bend = end.second - begin.second;
  return {begin.value,
          begin.first,
          begin.second / 2,
          10 * way - 4 * slope + bend / 2,
          -15 * way + 7 * slope - bend,
          6 * way - 3 * slope + bend / 2};
}
inline VectorPolynomial VectorHermite(const Derivatives<Vector>& begin, const Derivatives<Vector>& end) noexcept {
  VectorPolynomial out;
  const std::array<Vector, 6> c = Hermite(begin, end);
  for (std::size_t i = 0; i < c.size(); ++i) out[i] = ToTriple(c[i]);
  return out;
}

}  // namespace takt::path
