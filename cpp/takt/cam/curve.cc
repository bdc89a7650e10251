#include "takt/cam/curve.h"

#include <numbers>

#include "takt/core/maths.h"

namespace takt::cam {

namespace {

// Adds two sines of the same frequency.
void Add(double a, double phase_a, double b, double phase_b, double& amplitude, double& phase) noexcept {
  if (a == 0 && b == 0) {
    amplitude = phase = 0;
    return;
  }
  const double sine = a * maths::Sin(phase_a) + b * maths::Sin(phase_b);
  const double cosine = a * maths::Cos(phase_a) + b * maths::Cos(phase_b);
  amplitude = maths::Hypot(sine, cosine);
  phase = maths::Atan2(sine, cosine);
}

}  // namespace

Curve Derivative(const Curve& curve) noexcept {
  Curve result;
  for (std::size_t i = 0; i + 1 < curve.c.size(); ++i) result.c[i] = static_cast<double>(i + 1) * curve.c[i + 1];
  result.amplitude = curve.amplitude * curve.frequency;
  result.frequency = curve.frequency;
  result.phase = curve.phase + std::numbers::pi / 2;
  result.amplitude2 = 2 * curve.amplitude2 * curve.frequency;
  result.phase2 = curve.phase2 + std::numbers::pi / 2;
  return result;
}

Curve Scaled(const Curve& curve, double length, double height) noexcept {
  Curve result = curve;
  double factor = height;
  for (double& c : result.c) {
    c *= factor;
    factor /= length;
  }
  result.amplitude *= height;
  result.amplitude2 *= height;
  result.frequency /= length;
  return result;
}

Curve Combined(double p, const Curve& first, double q, const Curve& second) noexcept {
  Curve result;
  for (std::size_t i = 0; i < result.c.size(); ++i) result.c[i] = p * first.c[i] + q * second.c[i];
  const bool of_first = first.amplitude != 0 || first.amplitude2 != 0;
  result.frequency = of_first ? first.frequency : second.frequency;
  Add(p * first.amplitude, first.phase, q * second.amplitude, second.phase, result.amplitude, result.phase);
  Add(p * first.amplitude2, first.phase2, q * second.amplitude2, second.phase2, result.amplitude2, result.phase2);
  return result;
}

Value ValueOf(const Curve& curve, double d) noexcept {
  const Curve first = Derivative(curve);
  const Curve second = Derivative(first);
  return {curve.At(d), first.At(d), second.At(d), Derivative(second).At(d)};
}

Curve Quintic(double h, const Value& begin, const Value& end) noexcept {
  // The remainder after the motion with the velocity and acceleration of `begin`.
  const double y = end.y - begin.y - (begin.dy + 0.5 * begin.ddy * h) * h;
  const double v = (end.dy - begin.dy - begin.ddy * h) * h;
  const double a = (end.ddy - begin.ddy) * h * h;
  Curve curve;
  curve.c[0] = begin.y;
  curve.c[1] = begin.dy;
  curve.c[2] = 0.5 * begin.ddy;
  curve.c[3] = (10 * y - 4 * v + 0.5 * a) / (h * h * h);
  curve.c[4] = (-15 * y + 7 * v - a) / (h * h * h * h);
  curve.c[5] = (6 * y - 3 * v + 0.5 * a) / (h * h * h * h * h);
  return curve;
}

}  // namespace takt::cam
