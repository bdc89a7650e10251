// How far the encoder on the motor is ahead of the axis (AX-115): backlash and the error of a lead screw, which are
// made up for, or what an encoder on the load says.
//
// The set point of an axis is where its load shall be. The drive is told that plus the correction, and what is measured
// is taken less the correction of the cycle before, which was told with the set point that it is held against: a
// following error is one of the drive, as without. Backlash is half of it up or down, by the sense of the motion, as
// the flanks are then in touch; the screw's error is that of its table. The correction follows them with a velocity and
// an acceleration of its own, so that turning round asks for no step.
//
// With an encoder on the load nothing is made up for: the correction is what lies between the two. It may change by no
// more than supervision.encoders_apart, or what is between motor and load has come loose.
#pragma once

#include "takt/axis/encoder.h"

namespace takt::axis {

struct Context;
struct State;

struct CorrectionState {
  double now = 0;         // u, motor less axis
  double rate = 0;        // u/s, by which it changes in this cycle
  std::int8_t sense = 0;  // of the last motion; 0: there was none
  EncoderState load;      // of the encoder on the load
  bool load_known = false;
  double load_offset = 0;  // u, motor less load when both were first measured

  bool operator==(const CorrectionState&) const = default;
};

// sense: with an encoder on the load. What is measured on the motor gets the load's error, too.
void SenseLoad(const Context& context, const ServoInputs& inputs, std::uint32_t cycles, double largest_step,
               EncoderOutputs& motor, State& state) noexcept;

// control: the correction of the set point that was just made.
void Correct(const Context& context, State& state) noexcept;

void describe(Description<CorrectionState>&);

}  // namespace takt::axis
