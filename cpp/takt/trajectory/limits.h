// Limits of a motion.
#pragma once

#include "takt/core/describe_fwd.h"

namespace takt::trajectory {

struct Limits {
  double velocity = 0;      // [u/s] > 0
  double acceleration = 0;  // [u/s²] > 0: largest while the speed grows
  double deceleration = 0;  // [u/s²] > 0: largest while the speed falls
  double jerk = 0;          // [u/s³] >= 0; 0: unlimited (trapezoid)
};

// Returns the distance [u] over which the speed changes from `from` to `to`, with no acceleration at both ends.
// Requires: jerk > 0.
double RampLength(double from, double to, double acceleration, double jerk) noexcept;

inline Limits ShareOf(double share, const Limits& l) noexcept {
  return {share * l.velocity, share * l.acceleration, share * l.deceleration, share * l.jerk};
}

void describe(Description<Limits>&);

}  // namespace takt::trajectory
