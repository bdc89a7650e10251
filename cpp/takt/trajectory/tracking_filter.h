// Smooths the measured position of something that moves, and says where it is now although it was measured a while ago.
#pragma once

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::trajectory {

struct TrackingFilterState {
  KinematicState state;
  bool running = false;  // it has seen a first value
};

// One cycle. The filter is a motion of constant jerk in each cycle: its position, velocity and acceleration fit one
// another. A standing target and one of constant speed pass without lag; of a step, what is left after some `filter_s`
// is small. The answer is `dead_time_s` further on, with velocity and acceleration as they are. With `filter_s` < 3
// cycles the filter is as fast as it can be.
KinematicState Track(double filter_s, double dead_time_s, double period_s, double position, double velocity,
                     TrackingFilterState& state) noexcept;

void describe(Description<TrackingFilterState>&);

}  // namespace takt::trajectory
