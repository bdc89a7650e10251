#include "takt/cam/tasks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "takt/cam/roots.h"
#include "takt/core/maths.h"

namespace takt::cam {

namespace {

constexpr double kHalfTurn = std::numbers::pi;

// An interval of constant, linear and sine acceleration.
struct Zone {
  double length = 0;
  double pulse = 0;  // constant part of the pulse ...
  Curve sine{};      // ... or its sine
  bool behind = false;
};

// Returns the zones of the pulse: it rises along a sine over the share b, is constant, falls along a cosine over d.
std::vector<Zone> ZonesOf(double inflection, double length, double b, double d) {
  const double c = std::max(0.0, 1 - b - d);
  const auto sine = [](double frequency, double phase) {
    return Curve{.amplitude = 1, .frequency = frequency, .phase = phase};
  };
  const double first = inflection * length, second = length - first;
  std::vector<Zone> zones;
  const auto add = [&](double width, double pulse, const Curve& curve, bool behind) {
    if (width > 0) zones.push_back({width, pulse, curve, behind});
  };
  if (b > 0) add(b * first, 0, sine(kHalfTurn / 2 / (b * first), 0), false);
  add(c * first, 1, {}, false);
  if (d > 0) add(d * first, 0, sine(kHalfTurn / 2 / (d * first), kHalfTurn / 2), false);
  if (d > 0) add(d * second, 0, sine(kHalfTurn / 2 / (d * second), 0), true);
  add(c * second, 1, {}, true);
  if (b > 0) add(b * second, 0, sine(kHalfTurn / 2 / (b * second), kHalfTurn / 2), true);
  return zones;
}

// Returns the motion through all zones with these heights of the two pulses.
std::vector<LawPiece> Integrated(const std::vector<Zone>& zones, const Task& task, const Value& begin, double end_ddy,
                                 const std::array<double, 2>& heights, Value& end) {
  const double first = task.inflection * task.length, second = task.length - first;
  std::vector<LawPiece> pieces;
  double x = 0;
  end = begin;
  for (const Zone& zone : zones) {
    const double height = heights[zone.behind ? 1 : 0];
    const double slope = zone.behind ? end_ddy / second : -begin.ddy / first;
    const double level = zone.behind ? slope * (x - first) : begin.ddy + slope * x;
    Curve curve;
    curve.c = {end.y, end.dy, (level + height * zone.pulse) / 2, slope / 6};
    if (zone.sine.amplitude != 0) {
      const double w = zone.sine.frequency;
      curve.c[0] += height / (w * w) * maths::Sin(zone.sine.phase);
      curve.c[1] += height / w * maths::Cos(zone.sine.phase);
      curve.amplitude = -height / (w * w);
      curve.frequency = w;
      curve.phase = zone.sine.phase;
    }
    pieces.push_back({x, curve});
    end = ValueOf(curve, zone.length);
    x += zone.length;
  }
  return pieces;
}

std::vector<LawPiece> WithPulses(const Task& task, double b, double d) {
  const std::vector<Zone> zones = ZonesOf(task.inflection, task.length, b, d);
  Value base, one, other, end;
  Integrated(zones, task, task.begin, task.end.ddy, {0, 0}, base);
  Integrated(zones, task, {}, 0, {1, 0}, one);
  Integrated(zones, task, {}, 0, {0, 1}, other);
  const double y = task.end.y - base.y, v = task.end.dy - base.dy;
  const double determinant = one.y * other.dy - other.y * one.dy;
  const std::array<double, 2> heights{(y * other.dy - other.y * v) / determinant,
                                      (one.y * v - y * one.dy) / determinant};
  return Integrated(zones, task, task.begin, task.end.ddy, heights, end);
}

// Returns the polynomial of degree 7: position, velocity and acceleration at both ends, jerk 0 there.
Curve Septic(const Task& task) {
  const double h = task.length;
  const Value& begin = task.begin;
  const double y = task.end.y - begin.y - (begin.dy + 0.5 * begin.ddy * h) * h;
  const double v = (task.end.dy - begin.dy - begin.ddy * h) * h;
  const double a = (task.end.ddy - begin.ddy) * h * h;
  Curve unit{.c = {begin.y, begin.dy * h, 0.5 * begin.ddy * h * h, 0, 35 * y - 15 * v + 2.5 * a,
                   -84 * y + 39 * v - 7 * a, 70 * y - 34 * v + 6.5 * a, -20 * y + 10 * v - 2 * a}};
  return unit;
}

// Returns the polynomial of degree 8: u^4 (1 - u)^4, which vanishes at both ends up to the jerk, makes the acceleration
// at the inflection 0.
Curve Octic(const Task& task) {
  Curve unit = Septic(task);
  const Curve vanishing{.c = {0, 0, 0, 0, 1, -4, 6, -4, 1}};
  const double u = task.inflection;
  const double k = -Derivative(Derivative(unit)).At(u) / Derivative(Derivative(vanishing)).At(u);
  return Combined(1, unit, k, vanishing);
}

double PeakOf(const std::vector<LawPiece>& pieces, double length, bool jerk) {
  double peak = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double h = (i + 1 < pieces.size() ? pieces[i + 1].begin : length) - pieces[i].begin;
    const Curve ddy = Derivative(Derivative(pieces[i].curve));
    peak = std::max(peak, LargestMagnitude(jerk ? Derivative(ddy) : ddy, h));
  }
  return peak;
}

}  // namespace

bool ConnectsAny(Law law) noexcept {
  switch (law) {
    case Law::kQuintic:
    case Law::kModifiedTrapezoid:
    case Law::kModifiedSine:
    case Law::kCycloid:
    case Law::kPolynomial345:
    case Law::kPolynomial4567:
    case Law::kSineConstantCosine:
    case Law::kPolynomial8:
      return true;
    default:
      return HasFreeEnds(law);
  }
}

bool HasFreeEnds(Law law) noexcept {
  return law == Law::kQuintic || law == Law::kTask || law == Law::kLeastAcceleration || law == Law::kLeastJerk;
}

Law Resolved(Law law, const Task& task) {
  if (law == Law::kTask) {
    const bool accelerated = task.begin.ddy != 0 || task.end.ddy != 0;
    return accelerated ? Law::kQuintic : Law::kModifiedSine;
  }
  if (law != Law::kLeastAcceleration && law != Law::kLeastJerk) return law;
  Law best = Law::kQuintic;
  double least = 0;
  for (const Law one :
       {Law::kQuintic, Law::kModifiedSine, Law::kModifiedTrapezoid, Law::kCycloid, Law::kPolynomial4567}) {
    const double peak = PeakOf(PiecesOf(one, task), task.length, law == Law::kLeastJerk);
    if (one == Law::kQuintic || peak < least) {
      best = one;
      least = peak;
    }
  }
  return best;
}

std::vector<LawPiece> PiecesOf(Law law, const Task& task) {
  switch (law) {
    case Law::kModifiedTrapezoid:
      return WithPulses(task, 0.25, 0.25);
    case Law::kModifiedSine:
      return WithPulses(task, 0.25, 0.75);
    case Law::kCycloid:
      return WithPulses(task, 0.5, 0.5);
    case Law::kSineConstantCosine:
      return WithPulses(task, task.sine_share, task.cosine_share);
    case Law::kPolynomial4567:
      return {{0, Scaled(Septic(task), task.length, 1)}};
    case Law::kPolynomial8:
      return {{0, Scaled(Octic(task), task.length, 1)}};
    default:
      return {{0, Quintic(task.length, task.begin, task.end)}};
  }
}

}  // namespace takt::cam
