// Scaling and offset, on the way from the master to X and from Y to the slave (the manual's 3.17 and 3.18): pure, but
// for the ramps it plans.
//
//   out = factor * (in - in_zero) + out_zero + offset + ramp
#pragma once

#include <cstdint>

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/flexcam/ramp.h"
#include "takt/flexcam/settings.h"
#include "takt/trajectory/planner.h"

namespace takt::flexcam {

struct Conversion {
  double factor = 1;  // > 0 on the master's side, >= 0 on the slave's
  double offset = 0;
  double in_zero = 0;
  double out_zero = 0;
  Ramp ramp;
  // What the ramp takes over: at its begin so much more was in force than is set. What is left of an earlier ramp is
  // part of it.
  double offset_left = 0;
  double factor_left = 0;
  bool by_speed = false;  // the ramp is one of the speed
  double ramp_begin = 0;  // its shift then, or the speed of that
};

// What is wanted of it, and how it gets there.
struct ConversionTarget {
  double factor = 1;
  double offset = 0;
  ScalingMode scaling_mode = ScalingMode::kXZero;
  OffsetMode offset_mode = OffsetMode::kXZero;
  trajectory::Limits ramps;  // of the output
  bool with_master = false;  // the output never moves against the input: what would step is ramped, too
  bool at_once = false;      // nothing follows the output: no modes, no ramps
  double absolute_zero = 0;  // input that absolute scaling counts from
};

KinematicState Convert(const Conversion& conversion, const Cycle& cycle, const KinematicState& in) noexcept;
// The input at which the output is `out`, while no ramp is in progress.
double InverseOf(const Conversion& conversion, double out) noexcept;
// Counts from another input; the output stays what it is.
void CountFrom(double in_zero, Conversion& conversion) noexcept;

// The inputs that a conversion's ramps go by: of the cycle before and this one. `ride`: the same, with the sense of the
// master where the input has another one.
struct ConversionInputs {
  KinematicState before;
  KinematicState ride_before;
};

// Each cycle, before Approach: a ramp that is over is gone. One with the master would come back with it else.
void EndRamp(const Cycle& cycle, Conversion& conversion) noexcept;
// Each cycle: takes over what has changed and may be taken over anywhere, from the input of the cycle before on.
void Approach(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in,
              trajectory::Planner& planner, Conversion& conversion) noexcept;
// Where the cam begins or ends, at the input `at`: takes over what waits for that (x_zero).
void ApproachAtZero(const ConversionTarget& target, double at, const Cycle& cycle, const ConversionInputs& in,
                    trajectory::Planner& planner, Conversion& conversion) noexcept;

// What is in force in this cycle, ramps included, never beyond the value before a ramp and the one that is set for a
// factor. An offset ramped by itself: the sum. A factor ramped by itself: what the output has of the input (of a ramped
// speed: its velocity of the input's velocity). Both in one ramp: each has the share of its change that is left of it.
double OffsetInForce(const Conversion& conversion, const Cycle& cycle) noexcept;
double FactorInForce(const Conversion& conversion, const Cycle& cycle, const KinematicState& in) noexcept;

void describe(Description<Conversion>&);

}  // namespace takt::flexcam
