// Where a curve is zero: exact, by way of its derivatives, never by sampling. Fit for the cycle.
#pragma once

#include <array>
#include <cstddef>

#include "takt/cam/curve.h"

namespace takt::cam {

// Enough for a polynomial of the eighth degree with a whole turn of a sine and two of the other.
inline constexpr std::size_t kMaxRoots = 16;

struct Roots {
  std::array<double, kMaxRoots> at{};  // growing
  std::size_t count = 0;

  const double* begin() const noexcept { return at.data(); }
  const double* end() const noexcept { return at.data() + count; }
};

// The zeros in [0, h], to the last digits. One where the curve only touches zero counts, within rounding; a curve that
// is zero all over has 0 and h. `rounding`: what the caller's numbers have lost already.
Roots RootsOf(const Curve& curve, double h, double rounding = 0) noexcept;

// Where the curve can have its extremes in [0, h]: both ends, and what lies between.
Roots ExtremePlaces(const Curve& curve, double h) noexcept;

// Of |curve| in [0, h].
double LargestMagnitude(const Curve& curve, double h) noexcept;

}  // namespace takt::cam
