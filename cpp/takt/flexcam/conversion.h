// Scaling and offset from the master to X and from Y to the slave (Flex Cam manual, 3.17 and 3.18).
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
  // At its start the ramp made up for these differences, value in force minus value set; what was left of an earlier
  // ramp is included.
  double offset_left = 0;
  double factor_left = 0;
  bool by_speed = false;  // the ramp blends the velocity only, else the position
  double ramp_begin = 0;  // position shift of the ramp at its start, or its velocity if by_speed
};

// The target of a conversion, and how it is approached.
struct ConversionTarget {
  double factor = 1;
  double offset = 0;
  ScalingMode scaling_mode = ScalingMode::kXZero;
  OffsetMode offset_mode = OffsetMode::kXZero;
  trajectory::Limits ramps;  // of the output
  bool with_master = false;  // the output never moves against the input: what would step is ramped, too
  double absolute_zero = 0;  // input that absolute scaling counts from
};

// Returns the output for `in`, ramp included.
KinematicState Convert(const Conversion& conversion, const Cycle& cycle, const KinematicState& in) noexcept;
// Returns the input whose output is `out`; in_zero if the factor is 0. Requires: no ramp in progress.
double InverseOf(const Conversion& conversion, double out) noexcept;
// Moves the reference point of the input to `in_zero` without changing the output.
void CountFrom(double in_zero, Conversion& conversion) noexcept;

// The input of a conversion in the previous cycle, for planning ramps. `ride_before`: the same; on the slave's side
// with velocity and acceleration negated where Y moves against X, so that they have the sense of X.
struct ConversionInputs {
  KinematicState before;
  KinematicState ride_before;
};

// Each cycle, before Approach: drops a finished ramp; a master running backwards would otherwise reverse it.
void EndRamp(const Cycle& cycle, Conversion& conversion) noexcept;
// Each cycle: applies changes of factor and offset whose mode is not kXZero, or starts the ramp to them, from the
// input of the previous cycle on.
void Approach(const ConversionTarget& target, const Cycle& cycle, const ConversionInputs& in,
              trajectory::Planner& planner, Conversion& conversion) noexcept;
// At the begin or end of the cam, at the input `at`: applies the changes whose mode is kXZero.
void ApproachAtZero(const ConversionTarget& target, double at, const Cycle& cycle, const ConversionInputs& in,
                    trajectory::Planner& planner, Conversion& conversion) noexcept;

// Offset and factor in force in this cycle. Only the offset ramped: its setting plus the shift. Only the factor ramped:
// output by input about in_zero (by_speed: of the velocities), limited to between the old and the new factor. Both:
// each keeps of its change the share of the ramp that is left.
double OffsetInForce(const Conversion& conversion, const Cycle& cycle) noexcept;
double FactorInForce(const Conversion& conversion, const Cycle& cycle, const KinematicState& in) noexcept;

void describe(Description<Conversion>&);

}  // namespace takt::flexcam
