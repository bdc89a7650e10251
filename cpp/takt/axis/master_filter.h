// Smoothing of a measured master (AX-110).
#pragma once

#include <cstdint>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"

namespace takt::axis {

struct MasterFilter {
  KinematicState estimate;   // [master's u] over all turns
  std::uint32_t cycles = 0;  // since the first sample, until the memory is full
};

// Runs one cycle: predicts the master with its set acceleration, and corrects the prediction by the measured position,
// which is known to within half of `increment` [master's u]. Returns the estimate. Requires: time_constant_s > 0.
const KinematicState& Filter(double time_constant_s, double increment, Cycle cycle, const KinematicState& measured,
                             MasterFilter& filter) noexcept;

void describe(Description<MasterFilter>&);

}  // namespace takt::axis
