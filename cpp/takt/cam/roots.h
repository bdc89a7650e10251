// Zeros of a curve: exact, from the zeros of its derivatives, without sampling. Fit for the cycle.
#pragma once

#include <array>
#include <cstddef>

#include "takt/cam/curve.h"

namespace takt::cam {

// Enough for a polynomial of the eighth degree with one period of a sine and two of the other.
inline constexpr std::size_t kMaxRoots = 16;

struct Roots {
  std::array<double, kMaxRoots> at{};  // in ascending order
  std::size_t count = 0;

  const double* begin() const noexcept { return at.data(); }
  const double* end() const noexcept { return at.data() + count; }
};

// Returns the zeros in [0, h], accurate to rounding. A point where the curve only touches zero counts, within rounding;
// a curve that is zero everywhere has 0 and h. `rounding`: absolute error that the caller's values already have.
Roots RootsOf(const Curve& curve, double h, double rounding = 0) noexcept;

// Returns the x at which the curve can have its extremes in [0, h]: both ends, and the zeros of the derivative.
Roots ExtremePlaces(const Curve& curve, double h) noexcept;

// Returns the largest |curve| in [0, h].
double LargestMagnitude(const Curve& curve, double h) noexcept;

}  // namespace takt::cam
