#include "takt/cam/laws.h"

#include <algorithm>
#include <numbers>

#include "takt/cam/roots.h"
#include "takt/cam/tasks.h"
#include "takt/core/describe.h"
#include "takt/core/maths.h"

namespace takt::cam {

namespace {

constexpr double kPi = std::numbers::pi;

struct Shares {
  double sine = 0;
  double cosine = 0;
};

Shares SharesOf(Law law, double sine_share, double cosine_share) {
  switch (law) {
    case Law::kModifiedTrapezoid:
      return {0.25, 0.25};
    case Law::kModifiedSine:
      return {0.25, 0.75};
    case Law::kCycloid:
      return {0.5, 0.5};
    case Law::kHarmonic:
      return {0, 1};
    case Law::kSineConstantCosine:
      return {sine_share, cosine_share};
    default:
      return {};  // parabola
  }
}

// Returns the motion with acceleration constant + amplitude sin(frequency d + phase) from position y and velocity v.
Curve Integrated(double constant, const Curve& sine, double y, double v) {
  Curve curve;
  curve.c = {y, v, constant / 2};
  if (sine.amplitude == 0) return curve;
  const double w = sine.frequency;
  const maths::SineCosine of_phase = maths::SinCos(sine.phase);
  curve.c[0] += sine.amplitude / (w * w) * of_phase.sine;
  curve.c[1] += sine.amplitude / w * of_phase.cosine;
  curve.amplitude = -sine.amplitude / (w * w);
  curve.frequency = w;
  curve.phase = sine.phase;
  return curve;
}

std::vector<LawPiece> Family(const Shares& shares) {
  struct Zone {
    double length;
    double constant;
    Curve sine;
  };
  const double b = shares.sine, d = shares.cosine, c = std::max(0.0, 1 - b - d);
  const auto sine = [](double frequency, double phase) { return Curve{{}, 1, frequency, phase}; };
  std::vector<Zone> zones;
  const auto add = [&](double length, double constant, const Curve& curve) {
    if (length > 0) zones.push_back({length, constant, curve});
  };
  if (b > 0) add(b / 2, 0, sine(kPi / b, 0));
  add(c / 2, 1, {});
  if (d > 0) add(d, 0, sine(kPi / d, kPi / 2));
  add(c / 2, -1, {});
  if (b > 0) add(b / 2, 0, sine(kPi / b, -kPi / 2));

  std::vector<LawPiece> pieces;
  double x = 0, y = 0, v = 0;
  for (const Zone& zone : zones) {
    pieces.push_back({x, Integrated(zone.constant, zone.sine, y, v)});
    const Value end = ValueOf(pieces.back().curve, zone.length);
    x += zone.length;
    y = end.y;
    v = end.dy;
  }
  for (LawPiece& piece : pieces) piece.curve = Scaled(piece.curve, 1, 1 / y);
  return pieces;
}

// y = (1 - cos(pi z)) / 2 - (1 - cos(2 pi z)) / 8
Curve DoubleHarmonic() {
  Curve curve{.amplitude = -0.5, .frequency = kPi, .phase = kPi / 2, .amplitude2 = 0.125, .phase2 = kPi / 2};
  curve.c[0] = 0.375;
  return curve;
}

// 1 - y(1 - z)
Curve Reversed(const Curve& curve) {
  Curve result = curve;
  result.c[0] = 1 - curve.c[0];
  result.phase = kPi - curve.frequency - curve.phase + kPi;
  result.phase2 = kPi - 2 * curve.frequency - curve.phase2 + kPi;
  return result;
}

}  // namespace

std::vector<LawPiece> PiecesOf(Law law, double sine_share, double cosine_share) {
  switch (law) {
    case Law::kLine:
      return {{0, {.c = {0, 1}}}};
    case Law::kQuintic:
    case Law::kPolynomial345:
      return {{0, {.c = {0, 0, 0, 10, -15, 6}}}};
    case Law::kPolynomial4567:
      return {{0, {.c = {0, 0, 0, 0, 35, -84, 70, -20}}}};
    case Law::kPolynomial8:
      return PiecesOf(Law::kPolynomial4567);
    case Law::kTask:
    case Law::kLeastAcceleration:
    case Law::kLeastJerk:
      return PiecesOf(Resolved(law, {.length = 1, .begin = {}, .end = {.y = 1}}));
    case Law::kDoubleHarmonic:
      return {{0, DoubleHarmonic()}};
    case Law::kDoubleHarmonicBack:
      return {{0, Reversed(DoubleHarmonic())}};
    default:
      return Family(SharesOf(law, sine_share, cosine_share));
  }
}

bool JumpsInAcceleration(Law law, double sine_share) noexcept {
  return law == Law::kLine || law == Law::kDoubleHarmonic || law == Law::kDoubleHarmonicBack || law == Law::kParabola ||
         law == Law::kHarmonic || (law == Law::kSineConstantCosine && sine_share == 0);
}

PeakFactors PeakFactorsOf(Law law, double sine_share, double cosine_share) {
  PeakFactors factors;
  if (law == Law::kDwell) return factors;
  const std::vector<LawPiece> pieces = PiecesOf(law, sine_share, cosine_share);
  double before = 0;
  bool jumps = false;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double h = (i + 1 < pieces.size() ? pieces[i + 1].begin : 1) - pieces[i].begin;
    const Curve dy = Derivative(pieces[i].curve), ddy = Derivative(dy);
    factors.velocity = std::max(factors.velocity, LargestMagnitude(dy, h));
    factors.acceleration = std::max(factors.acceleration, LargestMagnitude(ddy, h));
    factors.jerk = std::max(factors.jerk, LargestMagnitude(Derivative(ddy), h));
    jumps |= std::abs(ddy.At(0) - before) > 1e-9;
    before = ddy.At(h);
  }
  jumps |= std::abs(before) > 1e-9 || law == Law::kLine;
  if (jumps) factors.jerk = std::numeric_limits<double>::infinity();
  return factors;
}

void describe(Enumeration<Law>& e) {
  e.about(
      "A law of motion. The laws from parabola to sine_constant_cosine lead from rest to rest unless velocities or "
      "accelerations at their ends are given.");
  e.value(Law::kDwell, "dwell", "Constant position.");
  e.value(Law::kLine, "line", "Constant velocity.");
  e.value(Law::kQuintic, "quintic", "Polynomial of the fifth degree, with velocity and acceleration at both ends.");
  e.value(Law::kParabola, "parabola", "Constant acceleration, then constant deceleration.");
  e.value(Law::kModifiedTrapezoid, "modified_trapezoid", "Trapezoid of acceleration with edges along a sine.");
  e.value(Law::kModifiedSine, "modified_sine", "Short rise of acceleration, long fall, both along a sine.");
  e.value(Law::kCycloid, "cycloid", "One sine of acceleration (inclined sine).");
  e.value(Law::kHarmonic, "harmonic", "Half a cosine of acceleration (simple harmonic motion).");
  e.value(Law::kPolynomial345, "polynomial_345", "Polynomial 3-4-5: the acceleration is 0 at the ends.");
  e.value(Law::kPolynomial4567, "polynomial_4567", "Polynomial 4-5-6-7: the jerk is 0 at the ends, too.");
  e.value(Law::kSineConstantCosine, "sine_constant_cosine",
          "Acceleration that rises along a sine, stays, falls along a cosine; sine_share and cosine_share say how "
          "long.");
  e.value(Law::kDoubleHarmonic, "double_harmonic",
          "From rest to a reversal: the acceleration at the end is that of the reversal, -pi^2 rise / length^2.");
  e.value(Law::kDoubleHarmonicBack, "double_harmonic_back",
          "From a reversal to rest, as the reverse of double_harmonic.");
  e.value(Law::kPolynomial8, "polynomial_8",
          "Polynomial of the eighth degree: the jerk is 0 at the ends, the acceleration at the inflection.");
  e.value(Law::kTask, "task", "As VDI 2143 recommends: modified_sine; quintic if accelerations at the ends are given.");
  e.value(Law::kLeastAcceleration, "least_acceleration",
          "The one of quintic, modified_sine, modified_trapezoid, cycloid and polynomial_4567 with the least peak "
          "acceleration.");
  e.value(Law::kLeastJerk, "least_jerk", "The one of the same laws with the least peak jerk.");
}

}  // namespace takt::cam
