#include "takt/flexcam/clutch_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "takt/cam/roots.h"
#include "takt/core/describe.h"
#include "takt/core/maths.h"

namespace takt::flexcam {

namespace {

using trajectory::Quintic;

constexpr double kRounding = 1e-9;

// Largest magnitudes of the derivatives.
struct Peaks {
  double first = 0, second = 0, third = 0;
};

cam::Curve CurveOf(const Quintic& q) {
  cam::Curve curve;
  double power = 1;
  for (std::size_t i = 0; i < q.c.size(); ++i, power *= q.length) curve.c[i] = q.c[i] / power;
  return curve;
}

Peaks PeaksOf(const Quintic& q) {
  const cam::Curve first = cam::Derivative(CurveOf(q));
  const cam::Curve second = cam::Derivative(first);
  const cam::Curve third = cam::Derivative(second);
  return {cam::LargestMagnitude(first, q.length), cam::LargestMagnitude(second, q.length),
          cam::LargestMagnitude(third, q.length)};
}

double Weaker(const trajectory::Limits& limits) {
  return std::min(limits.acceleration, limits.deceleration);
}

// The n-th derivative over time is the one over the master's position times the n-th power of the master's speed.
double FastestOn(const Quintic& q, const trajectory::Limits& limits) {
  const Peaks peaks = PeaksOf(q);
  double fastest = std::numeric_limits<double>::max();
  if (peaks.first > 0) fastest = std::min(fastest, limits.velocity / peaks.first);
  if (peaks.second > 0) fastest = std::min(fastest, std::sqrt(Weaker(limits) / peaks.second));
  if (peaks.third > 0 && limits.jerk > 0) fastest = std::min(fastest, maths::Cbrt(limits.jerk / peaks.third));
  return fastest;
}

KinematicState Mirrored(const KinematicState& over, double sense) {
  return {over.position, sense * over.velocity, over.acceleration};
}

}  // namespace

ClutchCurve MakeCurve(double begin, double length, double sense, bool closes, const KinematicState& from,
                      const KinematicState& to, const trajectory::Limits& slave) noexcept {
  ClutchCurve curve;
  curve.over = trajectory::Connect(length, Mirrored(from, sense), Mirrored(to, sense));
  curve.begin = begin;
  curve.sense = sense;
  curve.closes = closes;
  curve.fastest = FastestOn(curve.over, slave);
  return curve;
}

KinematicState OverMaster(const ClutchCurve& curve, double master) noexcept {
  return Mirrored(curve.over.At(On(curve, master)), curve.sense);
}

bool Monotone(const ClutchCurve& curve) noexcept {
  const Quintic& q = curve.over;
  const cam::Curve slope = cam::Derivative(CurveOf(q));
  double least = HUGE_VAL;
  for (const double x : cam::ExtremePlaces(slope, q.length)) least = std::min(least, curve.sense * slope.At(x));
  return least >= -kRounding * (std::abs(q.c[1]) + std::abs(q.At(q.length).position - q.c[0])) / q.length;
}

bool Within(const Quintic& over_time, const trajectory::Limits& limits) noexcept {
  return FastestOn(over_time, limits) >= 1 - kRounding;
}

void describe(Description<ClutchCurve>& d) {
  using C = ClutchCurve;
  d.about("A curve of the clutch over the master's displacement.");
  d.internal<&C::over>("Curve from its begin on.");
  d.internal<&C::begin>("Position of the master at which the curve begins.");
  d.internal<&C::sense>("Sense of the master on the curve.");
  d.internal<&C::closes>("The curve closes the clutch; else it opens it.");
  d.internal<&C::slave_zero>("Zero of the conversion to the slave at the begin of the curve.");
  d.internal<&C::fastest>("Largest steady speed of the master at which the slave follows.");
}

}  // namespace takt::flexcam
