#include "takt/cam/roots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "takt/core/maths.h"

namespace takt::cam {

namespace {

constexpr int kMaxSteps = 100;

std::size_t DegreeOf(const Curve& curve) {
  std::size_t degree = curve.c.size() - 1;
  while (degree > 0 && curve.c[degree] == 0) --degree;
  return degree;
}

void Append(double root, Roots& roots) {
  if (roots.count == kMaxRoots) return;
  if (roots.count > 0 && root <= roots.at[roots.count - 1]) return;
  roots.at[roots.count++] = root;
}

// Returns the rounding error when the curve is evaluated in [0, h].
double RoundingOf(const Curve& curve, double h) {
  double sum = 0;
  for (std::size_t i = curve.c.size(); i-- > 0;) sum = sum * h + std::abs(curve.c[i]);
  return 4 * std::numeric_limits<double>::epsilon() * (sum + std::abs(curve.amplitude) + std::abs(curve.amplitude2));
}

// Returns the zero between low and high, where the curve has different signs: Newton's method, or bisection if that
// leaves the interval.
double Between(const Curve& curve, const Curve& slope, double low, double high) {
  const bool rises = curve.At(low) < 0;
  double x = 0.5 * (low + high);
  for (int i = 0; i < kMaxSteps; ++i) {
    const double f = curve.At(x);
    if (f == 0) return x;
    ((f < 0) == rises ? low : high) = x;
    const double newton = x - f / slope.At(x);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (next == x || next <= low || next >= high) return next;
    x = next;
  }
  return x;
}

Roots OfSine(const Curve& curve, double h) {
  Roots roots;
  constexpr double kPi = std::numbers::pi;
  const double from = std::ceil(curve.phase / kPi - 1e-9);
  for (double k = from; roots.count < kMaxRoots; ++k) {
    const double x = (k * kPi - curve.phase) / curve.frequency;
    if (x > h * (1 + 1e-9)) break;
    Append(std::clamp(x, 0.0, h), roots);
  }
  return roots;
}

// Returns the zeros of p sin(w) + q sin(2w + delta) with w = frequency d + phase: with t = tan(w/2) a polynomial of the
// fourth degree, for each turn of w from -pi to pi. Where t is infinite two turns meet: that point is included, zero or
// not, as it separates intervals of the curve.
Roots OfSines(const Curve& curve, double h) {
  constexpr double kPi = std::numbers::pi;
  const double p = curve.amplitude, q = curve.amplitude2, delta = curve.phase2 - 2 * curve.phase;
  const double sine = q * maths::Sin(delta), cosine = q * maths::Cos(delta);
  // Over t from -1 to 1, and over 1/t beyond.
  const Curve inner{.c = {sine, 2 * p + 4 * cosine, -6 * sine, 2 * p - 4 * cosine, sine}};
  const Curve outer{.c = {sine, 2 * p - 4 * cosine, -6 * sine, 2 * p + 4 * cosine, sine}};
  std::array<double, kMaxRoots + 2> angles{};  // in (-pi, pi]
  std::size_t count = 0;
  const auto take = [&](double angle) {
    if (count < angles.size()) angles[count++] = std::remainder(angle, 2 * kPi);
  };
  for (const bool within : {true, false}) {
    const Curve& of = within ? inner : outer;
    Curve shifted;  // over t + 1
    for (std::size_t i = 0; i <= 4; ++i) {
      double binomial = 1;
      for (std::size_t k = 0; k <= i; ++k) {
        shifted.c[k] += of.c[i] * binomial * ((i - k) % 2 == 0 ? 1 : -1);
        binomial = binomial * static_cast<double>(i - k) / static_cast<double>(k + 1);
      }
    }
    for (const double at : RootsOf(shifted, 2)) {
      const double t = at - 1;
      take(within ? 2 * maths::Atan(t) : 2 * maths::Atan2(1, t));
    }
  }
  take(kPi);
  std::sort(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(count));
  Roots roots;
  const double turns = std::floor(curve.phase / (2 * kPi) - 1);
  for (double turn = turns; roots.count < kMaxRoots; ++turn) {
    double x = 0;
    for (std::size_t i = 0; i < count; ++i) {
      x = (angles[i] + 2 * kPi * turn - curve.phase) / curve.frequency;
      if (x > -1e-9 * h && x < h * (1 + 1e-9)) Append(std::clamp(x, 0.0, h), roots);
    }
    if (x >= h) break;
  }
  return roots;
}

}  // namespace

Roots RootsOf(const Curve& curve, double h, double rounding_before) noexcept {
  // The curve and its derivatives, up to the one whose zeros are known; each is monotonic between the zeros of the
  // next.
  std::array<Curve, kCoefficients + 1> chain;
  chain[0] = curve;
  const bool sine = (curve.amplitude != 0 || curve.amplitude2 != 0) && curve.frequency > 0;
  const std::size_t last = DegreeOf(curve) + (sine ? 1 : 0);
  for (std::size_t i = 1; i <= std::max<std::size_t>(last, 1); ++i) chain[i] = Derivative(chain[i - 1]);
  Roots roots;
  if (sine) roots = curve.amplitude2 == 0 ? OfSine(chain[last], h) : OfSines(chain[last], h);
  // A constant passes through the loop, too.
  for (std::size_t k = std::max<std::size_t>(last, 1); k-- > 0;) {
    const double rounding = RoundingOf(chain[k], h) + (k == 0 ? rounding_before : 0);
    Roots found;
    double before = 0;
    int sign_before = 0;
    for (std::size_t i = 0; i < roots.count + 2; ++i) {
      const double x = i == 0 ? 0 : i <= roots.count ? roots.at[i - 1] : h;
      if (i > 0 && x <= before) continue;
      const double f = chain[k].At(x);
      const int sign = f > rounding ? 1 : f < -rounding ? -1 : 0;
      if (i > 0 && sign * sign_before < 0) Append(Between(chain[k], chain[k + 1], before, x), found);
      if (sign == 0) Append(x, found);
      before = x;
      sign_before = sign;
    }
    roots = found;
  }
  return roots;
}

Roots ExtremePlaces(const Curve& curve, double h) noexcept {
  Roots places;
  Append(0, places);
  for (const double x : RootsOf(Derivative(curve), h)) Append(x, places);
  Append(h, places);
  return places;
}

double LargestMagnitude(const Curve& curve, double h) noexcept {
  double largest = 0;
  for (const double x : ExtremePlaces(curve, h)) largest = std::max(largest, std::abs(curve.At(x)));
  return largest;
}

}  // namespace takt::cam
