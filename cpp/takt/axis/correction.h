// How far the encoder on the motor is ahead of the axis (AX-115): backlash and lead screw error, which are compensated,
// or the difference to an encoder on the load.
//
// The set point of an axis is the desired position of its load. The drive gets the set point plus the correction. From
// the measured position the correction of the previous cycle is subtracted, the one that was commanded together with
// the set point it is compared with: so the following error is that of the drive, as without correction. Backlash
// contributes plus or minus half of it by the sense of motion, as the flanks are then in contact; the screw error comes
// from its table. The correction approaches their sum with a velocity and an acceleration limit of its own, so that a
// reversal commands no step.
//
// With an encoder on the load nothing is compensated: the correction is the difference between both encoders. If it
// changes by more than supervision.encoders_apart, motor and load have come apart: a fault.
#pragma once

#include "takt/axis/encoder.h"

namespace takt::axis {

struct Context;
struct State;

struct CorrectionState {
  double now = 0;         // [u] motor minus axis
  double rate = 0;        // [u/s] rate of change in this cycle
  std::int8_t sense = 0;  // of the last motion; 0: none so far
  EncoderState load;      // of the encoder on the load
  bool load_known = false;
  double load_offset = 0;  // [u] motor minus load when both were first measured

  bool operator==(const CorrectionState&) const = default;
};

// sense: reads the encoder on the load. Its error also becomes that of the motor's measurement.
void SenseLoad(const Context& context, const ServoInputs& inputs, std::uint32_t cycles, double largest_step,
               EncoderOutputs& motor, State& state) noexcept;

// control: updates the correction for the new set point.
void Correct(const Context& context, State& state) noexcept;

void describe(Description<CorrectionState>&);

}  // namespace takt::axis
