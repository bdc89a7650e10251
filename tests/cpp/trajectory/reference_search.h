// The quickest motion to a position by another method than the planner's: towards the velocity limit for some time,
// then the quickest ramp to the end velocity, and the time found by bisection. Slow and plain. For an end velocity of 0
// it is the time-optimal motion.
#pragma once

#include <algorithm>
#include <cmath>

#include "problems.h"
#include "takt/trajectory/ramp.h"

namespace takt::trajectory::testing {

// Returns the duration [s].
inline double ReferenceDuration(const Problem& p) {
  const Bounds bounds{p.limits.acceleration, p.limits.deceleration, p.limits.jerk};
  const double distance = p.position - p.from.position;
  const auto duration = [](const Ramp& ramp) { return ramp[0].duration + ramp[1].duration + ramp[2].duration; };
  const auto advance = [](KinematicState state, const Ramp& ramp, double time) {
    for (Stretch s : ramp) {
      s.duration = std::min(s.duration, std::max(time, 0.0));
      time -= s.duration;
      if (s.duration > 0) state = Advance(state, s);
    }
    return state;
  };
  const KinematicState start{0, p.from.velocity, p.from.acceleration};
  const auto ramp_to_end = [&](const KinematicState& s) {
    return QuickestRamp(s.velocity, s.acceleration, p.end_velocity, bounds);
  };
  const Ramp at_once = ramp_to_end(start);
  const double sign = distance >= advance(start, at_once, duration(at_once)).position ? 1 : -1;
  const Ramp to_limit = QuickestRamp(start.velocity, start.acceleration, sign * p.limits.velocity, bounds);
  const auto missing_after = [&](double time) {
    const KinematicState turn = advance(start, to_limit, time);
    const Ramp ramp = ramp_to_end(turn);
    return sign * (distance - advance(turn, ramp, duration(ramp)).position);
  };
  double low = 0;
  double high = duration(to_limit);
  double cruise = std::max(0.0, missing_after(high)) / p.limits.velocity;
  if (cruise == 0) {
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (missing_after(middle) > 0 ? low : high) = middle;
    }
  }
  return high + cruise + duration(ramp_to_end(advance(start, to_limit, high)));
}

}  // namespace takt::trajectory::testing
