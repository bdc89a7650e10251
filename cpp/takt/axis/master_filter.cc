// A g-h filter (alpha-beta filter: Brookner, Tracking and Kalman Filtering Made Easy, chapter 1), fed forward with the
// known acceleration. It has no lag at constant velocity, nor at a constant known acceleration. g is that of the
// critically damped filter with both poles at exp(-T / tau), h half of its own: overdamped. In its first cycles its
// memory grows up to tau, so that it starts well from a rough first velocity; and it spans a few increments, also if
// the master is slow.
//
// What is ours: the correcting error is the distance of the prediction from the measured increment, not from its
// middle. A prediction inside the increment agrees with the measurement and is not corrected; so at constant velocity
// the estimate ends in a straight line through all increments. With less damping it would oscillate between their
// borders.
#include "takt/axis/master_filter.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"
#include "takt/core/maths.h"

namespace takt::axis {

namespace {

constexpr double kDamping = 0.5;   // of the critically damped h
constexpr double kIncrements = 4;  // spanned by the memory
constexpr double kLongest = 10;    // times the time constant

}  // namespace

const KinematicState& Filter(double time_constant_s, double increment, Cycle cycle, const KinematicState& measured,
                             MasterFilter& filter) noexcept {
  KinematicState& e = filter.estimate;
  if (filter.cycles == 0) {
    filter.cycles = 1;
    return e = measured;
  }
  const double period = cycle.period_s;
  const double increments_s = kIncrements * increment / (std::abs(e.velocity) + increment);
  const double wanted_s = std::clamp(increments_s, time_constant_s, kLongest * time_constant_s);
  const double memory_s = std::min(wanted_s, filter.cycles * period);
  if (filter.cycles * period < kLongest * time_constant_s) ++filter.cycles;
  const double pole = maths::Exp(-period / memory_s);
  const double acceleration = measured.acceleration;
  e.position += (e.velocity + 0.5 * acceleration * period) * period;
  e.velocity += acceleration * period;
  e.acceleration = acceleration;
  const double away = measured.position - e.position;
  const double error = away - std::clamp(away, -0.5 * increment, 0.5 * increment);
  e.position += (1 - pole * pole) * error;
  e.velocity += kDamping * (1 - pole) * (1 - pole) * error / period;
  return e;
}

void describe(Description<MasterFilter>& d) {
  d.about("Smoothed state of a measured master.");
  d.internal<&MasterFilter::estimate>("Estimate over all turns.");
  d.internal<&MasterFilter::cycles>(unit::cycles, "Cycles since the first sample of the master.");
}

}  // namespace takt::axis
