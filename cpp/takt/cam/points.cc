#include "takt/cam/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "takt/core/maths.h"

namespace takt::cam {

namespace {

// The free values of a point: velocity, and acceleration with N = 2.
template <std::size_t N>
using Vector = std::array<double, N>;
template <std::size_t N>
using Matrix = std::array<std::array<double, N>, N>;

template <std::size_t N>
Vector<N> Times(const Matrix<N>& m, const Vector<N>& v) {
  Vector<N> result{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < N; ++k) result[i] += m[i][k] * v[k];
  }
  return result;
}

template <std::size_t N>
Matrix<N> Times(const Matrix<N>& a, const Matrix<N>& b) {
  Matrix<N> result{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      for (std::size_t k = 0; k < N; ++k) result[i][j] += a[i][k] * b[k][j];
    }
  }
  return result;
}

template <std::size_t N, typename T>
void Subtract(const T& from, T& result) {
  for (std::size_t i = 0; i < N; ++i) {
    if constexpr (std::is_same_v<T, Vector<N>>) {
      result[i] -= from[i];
    } else {
      for (std::size_t j = 0; j < N; ++j) result[i][j] -= from[i][j];
    }
  }
}

template <std::size_t N>
Matrix<N> Transposed(const Matrix<N>& m) {
  Matrix<N> result{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) result[i][j] = m[j][i];
  }
  return result;
}

Matrix<1> Inverse(const Matrix<1>& m) {
  return {{{1 / m[0][0]}}};
}

Matrix<2> Inverse(const Matrix<2>& m) {
  // By elimination: the determinant of a stiff matrix can overflow.
  const double below = m[1][0] / m[0][0];
  const double left = m[1][1] - below * m[0][1];
  const double aside = m[0][1] / m[0][0];
  return {{{1 / m[0][0] + aside * below / left, -aside / left}, {-below / left, 1 / left}}};
}

// Minimises the integral of the square of the (N + 1)th derivative of Hermite pieces: a symmetric, positive definite
// system in which each point is coupled to its neighbours only.
template <std::size_t N>
class Spline {
 public:
  Spline(std::span<const CamPoint> points, bool cyclic)
      : points_(points), cyclic_(cyclic), diagonal_(points.size()), next_(points.size()), right_(points.size()) {
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) AddPiece(i);
    if (cyclic_) Join();
    for (std::size_t i = 0; i < diagonal_.size(); ++i) {
      const CamPoint& p = points_[i];
      const bool first = cyclic_ && i == 0;
      Fix(i, 0, first && !p.v ? points_.back().v : p.v);
      if constexpr (N == 2) Fix(i, 1, first && !p.a ? points_.back().a : p.a);
    }
    Solve();
  }

  // Velocity (and acceleration) of each point.
  const std::vector<Vector<N>>& solution() const { return right_; }

 private:
  // Returns d^(N+1) y / du^(N+1) at u in [0, 1] of a piece of length h, as a linear form: coefficients of the step in
  // y, then of the values of the first and of the second point.
  static std::array<double, 1 + 2 * N> Form(double h, double u) {
    if constexpr (N == 1) {
      return {6 - 12 * u, (-4 + 6 * u) * h, (-2 + 6 * u) * h};
    } else {
      const double y = 60 - 360 * u + 360 * u * u;
      const double v = -24 + 168 * u - 180 * u * u;
      const double a = 3 - 24 * u + 30 * u * u;
      return {y, -(y + v) * h, -(y / 2 + v + a) * h * h, v * h, a * h * h};
    }
  }

  void AddPiece(std::size_t i) {
    const double h = points_[i + 1].x - points_[i].x;
    const double step = points_[i + 1].y - points_[i].y;
    const double root = std::sqrt(0.6) / 2;
    const std::array<std::array<double, 2>, 3> gauss{{{0.5 - root, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + root, 5.0 / 18}}};
    for (const auto& [u, share] : gauss) {
      const auto form = Form(h, u);
      const double weight = share / maths::Power(h, 2 * N + 1);
      for (std::size_t r = 0; r < N; ++r) {
        for (std::size_t c = 0; c < N; ++c) {
          diagonal_[i][r][c] += weight * form[1 + r] * form[1 + c];
          diagonal_[i + 1][r][c] += weight * form[1 + N + r] * form[1 + N + c];
          next_[i][r][c] += weight * form[1 + r] * form[1 + N + c];
        }
        right_[i][r] -= weight * form[1 + r] * form[0] * step;
        right_[i + 1][r] -= weight * form[1 + N + r] * form[0] * step;
      }
    }
  }

  // First and last point of a cyclic cam are one; next_ of the last one leads to the first.
  void Join() {
    for (std::size_t r = 0; r < N; ++r) {
      for (std::size_t c = 0; c < N; ++c) diagonal_.front()[r][c] += diagonal_.back()[r][c];
      right_.front()[r] += right_.back()[r];
    }
    diagonal_.pop_back();
    right_.pop_back();
    next_.pop_back();
    if (diagonal_.size() > 1) return;
    const Matrix<N> both = next_[0];  // a single piece joins the point to itself
    for (std::size_t r = 0; r < N; ++r) {
      for (std::size_t c = 0; c < N; ++c) diagonal_[0][r][c] += both[r][c] + both[c][r];
    }
    next_[0] = {};
  }

  // Eliminates a given value from the system.
  void Fix(std::size_t i, std::size_t k, const std::optional<double>& value) {
    if (!value) return;
    const std::size_t n = diagonal_.size();
    const auto clear = [&](std::size_t of, Matrix<N>& m, bool column) {
      for (std::size_t r = 0; r < N; ++r) {
        double& entry = column ? m[r][k] : m[k][r];
        if (!(of == i && r == k)) right_[of][r] -= entry * *value;
        entry = 0;
      }
    };
    clear(i, diagonal_[i], true);
    for (std::size_t c = 0; c < N; ++c) diagonal_[i][k][c] = 0;
    if (n > 1 && (cyclic_ || i + 1 < n)) clear((i + 1) % n, next_[i], false);
    if (n > 1 && (cyclic_ || i > 0)) clear((i + n - 1) % n, next_[(i + n - 1) % n], true);
    diagonal_[i][k][k] = 1;
    right_[i][k] = *value;
  }

  // Block elimination from the second point on; the first point is last, since it alone has two distant neighbours in a
  // cyclic cam.
  void Solve() {
    const std::size_t n = diagonal_.size();
    if (n == 1) {
      right_[0] = Times(Inverse(diagonal_[0]), right_[0]);
      Close();
      return;
    }
    // far[i]: coefficients of the first point in the equations of point i.
    std::vector<Matrix<N>> far(n);
    far[1] = Transposed(next_[0]);
    if (cyclic_) {
      for (std::size_t r = 0; r < N; ++r) {
        for (std::size_t c = 0; c < N; ++c) far[n - 1][r][c] += next_[n - 1][r][c];
      }
    }
    for (std::size_t i = 1; i < n; ++i) {
      const Matrix<N> inverse = Inverse(diagonal_[i]);
      Subtract<N>(Times(Transposed(far[i]), Times(inverse, far[i])), diagonal_[0]);
      Subtract<N>(Times(Transposed(far[i]), Times(inverse, right_[i])), right_[0]);
      if (i + 1 < n) {
        const Matrix<N> back = Times(Transposed(next_[i]), inverse);
        Subtract<N>(Times(back, next_[i]), diagonal_[i + 1]);
        Subtract<N>(Times(back, far[i]), far[i + 1]);
        Subtract<N>(Times(back, right_[i]), right_[i + 1]);
      }
    }
    right_[0] = Times(Inverse(diagonal_[0]), right_[0]);
    for (std::size_t i = n; i-- > 1;) {
      Subtract<N>(Times(far[i], right_[0]), right_[i]);
      if (i + 1 < n) Subtract<N>(Times(next_[i], right_[i + 1]), right_[i]);
      right_[i] = Times(Inverse(diagonal_[i]), right_[i]);
    }
    Close();
  }
  void Close() {
    if (cyclic_) right_.push_back(right_.front());
  }

  std::span<const CamPoint> points_;
  bool cyclic_;
  std::vector<Matrix<N>> diagonal_;
  std::vector<Matrix<N>> next_;   // coupling of a point with the next one
  std::vector<Vector<N>> right_;  // finally the solution
};

// Returns slopes at the points for which no quintic between two of them, with accelerations 0 at both, leaves their
// range.
//
// With m the slope of the straight line and v, w the slopes at both ends, all of one sign, the derivative of such a
// quintic is v (1 - S) + w S + 30 (m - (v + w) / 2) u^2 (1 - u)^2, where S rises from 0 to 1. It is linear in v and w,
// and nowhere negative (m > 0) for v and w each 0 or 2 m; hence neither for any v and w from 0 to 2 m. Within this
// range the slopes are the weighted harmonic means of Fritsch and Butland; 0 where the points reverse.
std::vector<double> MonotoneSlopes(std::span<const CamPoint> points, bool cyclic) {
  const std::size_t n = points.size();
  const auto length = [&](std::size_t i) { return points[i + 1].x - points[i].x; };
  const auto slope = [&](std::size_t i) { return (points[i + 1].y - points[i].y) / length(i); };
  const auto mean = [&](std::size_t before, std::size_t behind) {
    const double m = slope(before), k = slope(behind);
    if (!(m * k > 0)) return 0.0;
    const double h = length(before), g = length(behind);
    const double harmonic = 3 * (h + g) / ((2 * g + h) / m + (g + 2 * h) / k);
    const double most = 2 * std::min(std::abs(m), std::abs(k));
    return std::clamp(harmonic, -most, most);
  };
  std::vector<double> slopes(n);
  for (std::size_t i = 1; i + 1 < n; ++i) slopes[i] = mean(i - 1, i);
  slopes.front() = cyclic ? mean(n - 2, 0) : slope(0);
  slopes.back() = cyclic ? slopes.front() : slope(n - 2);
  for (std::size_t i = 0; i < n; ++i) slopes[i] = points[i].v.value_or(slopes[i]);
  if (cyclic && !points.back().v) slopes.back() = slopes.front();
  if (cyclic && !points.front().v) slopes.front() = slopes.back();
  return slopes;
}

bool GivesNothing(const CamPoint& p) {
  return !p.v && !p.a;
}

}  // namespace

std::vector<Curve> Interpolate(std::span<const CamPoint> points, Interpolation interpolation, bool cyclic) {
  std::vector<Curve> curves(points.size() - 1);
  const auto pieces = [&](auto make) {
    for (std::size_t i = 0; i < curves.size(); ++i) {
      const double h = points[i + 1].x - points[i].x;
      curves[i] = make(i, h, (points[i + 1].y - points[i].y) / h);
      curves[i].c[0] = points[i].y;
    }
  };
  const bool just_two = points.size() == 2 && GivesNothing(points[0]) && GivesNothing(points[1]) && !cyclic;
  if (interpolation == Interpolation::kLinear || just_two) {
    pieces([](std::size_t, double, double slope) { return Curve{.c = {0, slope}}; });
  } else if (interpolation == Interpolation::kCubicSpline) {
    const Spline<1> spline(points, cyclic);
    pieces([&](std::size_t i, double h, double slope) {
      const double v0 = spline.solution()[i][0], v1 = spline.solution()[i + 1][0];
      return Curve{.c = {0, v0, (3 * slope - 2 * v0 - v1) / h, (v0 + v1 - 2 * slope) / (h * h)}};
    });
  } else if (interpolation == Interpolation::kMonotone) {
    const std::vector<double> slopes = MonotoneSlopes(points, cyclic);
    const auto bend = [&](std::size_t k) {  // first and last point of a cyclic cam are one
      const bool seam = cyclic && (k == 0 || k + 1 == points.size());
      return points[k].a.value_or(seam ? points[points.size() - 1 - k].a.value_or(0) : 0);
    };
    pieces([&](std::size_t i, double h, double) {
      const auto value = [&](std::size_t k) { return Value{points[k].y, slopes[k], bend(k), 0}; };
      return Quintic(h, value(i), value(i + 1));
    });
  } else {
    const Spline<2> spline(points, cyclic);
    pieces([&](std::size_t i, double h, double) {
      const auto value = [&](std::size_t k) {
        const auto& [v, a] = spline.solution()[k];
        return Value{points[k].y, v, a, 0};
      };
      return Quintic(h, value(i), value(i + 1));
    });
  }
  return curves;
}

}  // namespace takt::cam
