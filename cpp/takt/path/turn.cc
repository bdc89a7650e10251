#include "takt/path/turn.h"

#include <cmath>

#include "takt/core/maths.h"

namespace takt::path {
namespace {

// With t the angle: the factors of the angular velocity, (1 - cos t) / t² and (t - sin t) / t³, and their derivatives
// by t over t.
struct Factors {
  double a, b, da, db;
};

// The same as series in t², exact to the last bit up to 1. Coefficient k of the first is 1 / (2 k + 2)!, with
// alternating signs.
constexpr int kTerms = 9;
constexpr auto kSeries = [] {
  std::array<Factors, kTerms> out{};
  double factorial = 2;
  for (int k = 0; k < kTerms; ++k) {
    const double sign = k % 2 == 0 ? 1 : -1;
    const double even = sign / factorial;             // (2 k + 2)!
    const double odd = even / (2 * k + 3);            // (2 k + 3)!
    const double next_even = odd / (2 * k + 4);       // (2 k + 4)!
    const double next_odd = next_even / (2 * k + 5);  // (2 k + 5)!
    out[static_cast<std::size_t>(k)] = {even, odd, -2 * (k + 1) * next_even, -2 * (k + 1) * next_odd};
    factorial *= (2 * k + 3) * (2 * k + 4);
  }
  return out;
}();

Factors FactorsOf(double squared) {
  if (squared <= 1) {
    Factors sum = kSeries[kTerms - 1];
    for (std::size_t k = kTerms - 1; k-- > 0;) {
      sum = {kSeries[k].a + squared * sum.a, kSeries[k].b + squared * sum.b, kSeries[k].da + squared * sum.da,
             kSeries[k].db + squared * sum.db};
    }
    return sum;
  }
  const double t = std::sqrt(squared);
  const auto [sine, cosine] = maths::SinCos(t);
  return {(1 - cosine) / squared, (t - sine) / (squared * t), (t * sine - 2 * (1 - cosine)) / (squared * squared),
          (3 * sine - 2 * t - t * cosine) / (squared * squared * t)};
}

}  // namespace

Eigen::Quaterniond ToQuaternion(const KDL::Rotation& r) noexcept {
  const Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data);
  return Eigen::Quaterniond(matrix).normalized();
}

Turned TurnBy(const Derivatives<Vector>& turn) noexcept {
  const Vector& v = turn.value;
  const double squared = v.squaredNorm();
  const double half = std::sqrt(squared) / 2;
  const maths::SineCosine of_half = maths::SinCos(half);
  const double sine = half < 1e-8 ? 0.5 : of_half.sine / (2 * half);
  const auto [a, b, da, db] = FactorsOf(squared);
  const double outward = v.dot(turn.first);
  const Vector cross = v.cross(turn.first);
  const Vector double_cross = v.cross(cross);
  const Vector change = v.cross(turn.second);
  Turned out;
  out.rotation.w() = of_half.cosine;
  out.rotation.vec() = v * sine;
  out.velocity = turn.first + a * cross + b * double_cross;
  out.acceleration = turn.second + outward * (da * cross + db * double_cross) + a * change +
                     b * (turn.first.cross(cross) + v.cross(change));
  return out;
}

Derivatives<Vector> TurnOf(const Vector& turn, const Vector& velocity, const Vector& acceleration) noexcept {
  const double squared = turn.squaredNorm();
  const double half = std::sqrt(squared) / 2;
  const double factor = squared < 1e-4 ? 1.0 / 12 + squared / 720 : (1 - half / maths::Tan(half)) / squared;
  const auto inverse = [&](const Vector& v) -> Vector {
    const Vector cross = turn.cross(v);
    return v - cross / 2 + factor * turn.cross(cross);
  };
  Derivatives<Vector> out{turn, inverse(velocity), Vector::Zero()};
  out.second = inverse(acceleration - TurnBy(out).acceleration);
  return out;
}

}  // namespace takt::path
