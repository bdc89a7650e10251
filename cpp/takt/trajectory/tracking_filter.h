// Smooths the measured position of something that moves, and says where it is now although it was measured a while ago.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::trajectory {

struct TrackingFilter {
  double filter_s = 0;  // time constant; below 3 cycles: as fast as can be
  // Of a second estimate, a fast one: it counts as far as it differs by more than `band` in position. 0: none.
  double fast_filter_s = 0;
  double band = 0;
  double dead_time_s = 0;  // what is measured is so much older
};

// Where it was when it was measured, as estimated.
struct TrackingEstimate {
  KinematicState state;
  double jerk = 0;
};

struct TrackingFilterState {
  TrackingEstimate slow, fast;
  KinematicState state;  // the answer
  bool running = false;  // it has seen a first value
};

// One cycle. Returns a motion of constant jerk in each cycle: its position, velocity and acceleration fit one
// another. What is measured is smoothed by a fading-memory polynomial of degree 3 (N. Morrison, Introduction to
// Sequential Smoothing and Prediction, 1969), taken forward by the dead time d and followed by three equal poles
// with its velocity, acceleration and jerk fed forward: those of `filter_s`, f, or with a second estimate 3.5 times
// as fast. So a position that is a polynomial of degree 3 in time passes without lag; of a step, which is overshot
// by as much again, what is left after some 15 f is small. With one estimate less than 40 w^4 f^2 (f + d)^2 + (w
// d)^4 / 20 of the amplitude of a sine of angular frequency w is missed, and steps q of an encoder make
// accelerations of up to 2.1 q / f^2, from 5 cycles on. With two, `band` at 0.6 q, and the fast one at f / 5 or 0.4
// d, they make up to 7 q / f^2 with d of a cycle and 14 q / f^2 with d of f, of something that stands or keeps its
// speed. (Two estimates are ours.) `velocity`: with which it begins.
KinematicState Track(const TrackingFilter& filter, double period_s, double position, double velocity,
                     TrackingFilterState& state) noexcept;

void describe(Description<TrackingEstimate>&);
void describe(Description<TrackingFilterState>&);

}  // namespace takt::trajectory
