// Smooths the measured position of a moving body and estimates its present state from measurements that are a dead time
// old.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::trajectory {

struct TrackingFilter {
  double filter_s = 0;  // time constant [s]; below 3 cycles: 3 cycles
  // Time constant [s] of a second, fast estimate: it counts as far as it differs by more than `band` in position. 0:
  // none.
  double fast_filter_s = 0;
  double band = 0;
  double dead_time_s = 0;  // age of a measurement [s]
};

// Estimated state at the time of the measurement.
struct TrackingEstimate {
  KinematicState state;
  double jerk = 0;
};

struct TrackingFilterState {
  TrackingEstimate slow, fast;
  KinematicState state;  // result: the estimate for now
  bool running = false;  // a first value has been received
};

// One cycle. Returns the state of a motion with constant jerk in each cycle: its position, velocity and acceleration
// are consistent. Measurements are smoothed by a fading-memory polynomial of degree 3 (N. Morrison, Introduction to
// Sequential Smoothing and Prediction, 1969), extrapolated by the dead time d and followed by three equal poles with
// velocity, acceleration and jerk fed forward: with the time constant `filter_s`, f, or with a second estimate 3.5
// times as fast. So a position that is a polynomial of degree 3 in time passes without lag; a step is overshot by as
// much again, and little of it is left after some 15 f. With one estimate less than 40 w^4 f^2 (f + d)^2 + (w d)^4 / 20
// of the amplitude of a sine of angular frequency w is missed, and steps q of an encoder cause accelerations of up to
// 2.1 q / f^2, from 5 cycles on. With two, `band` at 0.6 q, and the fast one at f / 5 or 0.4 d, they cause up to 7 q /
// f^2 with d of a cycle and 14 q / f^2 with d of f, for a body at rest or at constant speed. (Two estimates are ours.)
// `velocity`: initial velocity.
KinematicState Track(const TrackingFilter& filter, double period_s, double position, double velocity,
                     TrackingFilterState& state) noexcept;

void describe(Description<TrackingEstimate>&);
void describe(Description<TrackingFilterState>&);

}  // namespace takt::trajectory
