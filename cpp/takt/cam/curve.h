// A cam between two joints: a polynomial of the eighth degree, a sine and one of twice its frequency, over the distance
// d from the first joint. Every law of motion is made of such pieces, so derivatives, roots and extremes are exact.
#pragma once

#include <array>
#include <cstddef>

#include "takt/core/maths.h"

namespace takt::cam {

// The value of a cam at one x of its master; derivatives over x, in slave's units per master's unit.
struct Value {
  double y = 0;
  double dy = 0;
  double ddy = 0;
  double dddy = 0;
  bool operator==(const Value&) const = default;
};

inline constexpr std::size_t kCoefficients = 9;

// c[0] + c[1] d + ... + c[8] d^8 + amplitude sin(frequency d + phase) + amplitude2 sin(2 frequency d + phase2)
struct Curve {
  std::array<double, kCoefficients> c{};
  double amplitude = 0;
  double frequency = 0;  // [rad per master's unit]
  double phase = 0;      // [rad]
  double amplitude2 = 0;
  double phase2 = 0;  // [rad]

  double At(double d) const noexcept {
    double sum = c[kCoefficients - 1];
    for (std::size_t i = kCoefficients - 1; i-- > 0;) sum = sum * d + c[i];
    if (amplitude != 0) sum += amplitude * maths::Sin(frequency * d + phase);
    return amplitude2 == 0 ? sum : sum + amplitude2 * maths::Sin(2 * frequency * d + phase2);
  }
  bool operator==(const Curve&) const = default;
};

Curve Derivative(const Curve& curve) noexcept;
// Returns height * curve(d / length).
Curve Scaled(const Curve& curve, double length, double height) noexcept;
// Returns p * first + q * second. Requires: if both have sines, they have the same frequency.
Curve Combined(double p, const Curve& first, double q, const Curve& second) noexcept;
// Returns y and its derivatives at d.
Value ValueOf(const Curve& curve, double d) noexcept;

// Returns the polynomial of the fifth degree from (0, begin) to (h, end); dddy is not used.
Curve Quintic(double h, const Value& begin, const Value& end) noexcept;

}  // namespace takt::cam
