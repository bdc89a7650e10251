#include "takt/trajectory/tracking_filter.h"

#include <algorithm>

#include "takt/core/describe.h"

namespace takt::trajectory {

namespace {

// Cycles; with 2.2 it would no longer settle, since its jerk changes once a cycle only.
constexpr double kFastest = 3;

KinematicState After(const KinematicState& x, double t) {
  return {x.position + t * (x.velocity + 0.5 * t * x.acceleration), x.velocity + t * x.acceleration, x.acceleration};
}

}  // namespace

// Three equal poles at w. A velocity fed forward takes the lag away that they would have.
KinematicState Track(double filter_s, double dead_time_s, double period_s, double position, double velocity,
                     TrackingFilterState& f) noexcept {
  const double t = period_s;
  if (!f.running) {
    f.running = true;
    f.state = {position, velocity, 0};
  } else {
    const double w = 1 / std::max(filter_s, kFastest * t);
    // What is measured now was there one cycle of the filter's motion after its state of the cycle before.
    const KinematicState expected = After(f.state, t);
    const double jerk = w * w * w * (position - expected.position) + 3 * w * w * (velocity - expected.velocity) -
                        3 * w * expected.acceleration;
    f.state = {expected.position + jerk * t * t * t / 6, expected.velocity + 0.5 * jerk * t * t,
               expected.acceleration + jerk * t};
  }
  return After(f.state, dead_time_s);
}

void describe(Description<TrackingFilterState>& d) {
  d.about("A filter for a measured position.");
  d.internal<&TrackingFilterState::state>("Where it is.");
  d.internal<&TrackingFilterState::running>("It has seen a first value.");
}

}  // namespace takt::trajectory
