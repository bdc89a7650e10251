#include "takt/cam/curve.h"

#include <numbers>

#include "takt/core/maths.h"

namespace takt::cam {

Curve Derivative(const Curve& curve) noexcept {
  Curve result;
  for (std::size_t i = 0; i + 1 < curve.c.size(); ++i) result.c[i] = static_cast<double>(i + 1) * curve.c[i + 1];
  result.amplitude = curve.amplitude * curve.frequency;
  result.frequency = curve.frequency;
  result.phase = curve.phase + std::numbers::pi / 2;
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
  result.frequency /= length;
  return result;
}

Curve Combined(double p, const Curve& first, double q, const Curve& second) noexcept {
  Curve result;
  for (std::size_t i = 0; i < result.c.size(); ++i) result.c[i] = p * first.c[i] + q * second.c[i];
  const double a = p * first.amplitude, b = q * second.amplitude;
  const maths::SineCosine one = maths::SinCos(first.phase), other = maths::SinCos(second.phase);
  const double sine = a * one.sine + b * other.sine;
  const double cosine = a * one.cosine + b * other.cosine;
  result.amplitude = maths::Hypot(sine, cosine);
  result.frequency = a != 0 ? first.frequency : second.frequency;
  result.phase = maths::Atan2(sine, cosine);
  return result;
}

Value ValueOf(const Curve& curve, double d) noexcept {
  const Curve first = Derivative(curve);
  const Curve second = Derivative(first);
  return {curve.At(d), first.At(d), second.At(d), Derivative(second).At(d)};
}

Curve Quintic(double h, const Value& begin, const Value& end) noexcept {
  // What is left after the motion that begins with begin's velocity and acceleration.
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
