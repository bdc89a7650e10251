// What a cam is between two joints: a polynomial of the seventh degree and a sine, over the distance d from the first
// joint. Every law of motion is made of such pieces; so derivatives, roots and extremes are exact.
#pragma once

#include <array>
#include <cstddef>

#include "takt/core/maths.h"

namespace takt::cam {

// What a cam says at one x of its master; derivatives over x, in slave's units per master's unit.
struct Value {
  double y = 0;
  double dy = 0;
  double ddy = 0;
  double dddy = 0;
  bool operator==(const Value&) const = default;
};

// c[0] + c[1] d + ... + c[7] d^7 + amplitude sin(frequency d + phase)
struct Curve {
  std::array<double, 8> c{};
  double amplitude = 0;
  double frequency = 0;  // rad per master's unit
  double phase = 0;      // rad

  double At(double d) const noexcept {
    double sum = c[7];
    for (std::size_t i = 7; i-- > 0;) sum = sum * d + c[i];
    return amplitude == 0 ? sum : sum + amplitude * maths::Sin(frequency * d + phase);
  }
  bool operator==(const Curve&) const = default;
};

Curve Derivative(const Curve& curve) noexcept;
// height * curve(d / length)
Curve Scaled(const Curve& curve, double length, double height) noexcept;
// p * first + q * second. If both have a sine, then of the same frequency.
Curve Combined(double p, const Curve& first, double q, const Curve& second) noexcept;
// y and its derivatives at d.
Value ValueOf(const Curve& curve, double d) noexcept;

// The polynomial of the fifth degree from (0, begin) to (h, end); dddy is not used.
Curve Quintic(double h, const Value& begin, const Value& end) noexcept;

}  // namespace takt::cam
