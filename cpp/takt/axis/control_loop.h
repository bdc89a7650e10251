// The position loop: from a set point and the measured position to what the drive is told.
#pragma once

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/ports.h"

namespace takt::axis {

// A numeric PID in the form of sampled loops, sampled once a cycle of T seconds. All gains are plain numbers: the three
// terms are positions, their sum is what the axis shall make up for within one cycle, so sum / T is a speed. (kp = T
// Kv with a speed gain Kv in 1/s.)
struct ControlLoop {
  double kp = 0.05;  // >= 0: P = kp e
  double ki = 0;     // >= 0: I = sum of ki e over the cycles; T / Ti
  double kd = 0;     // >= 0: D = kd (e - e of the cycle before); Td / T
  double kc = 0.9;  // 0 to 1: share of what the limiters cut off that is taken back from I, as far as I has it; 0: none
  double ff = 1;    // share of the set velocity that is fed forward
  double velocity_at_10v = 1000;  // u/s, > 0: Vmax. Largest speed the loop asks for, and analogue: the speed at 10 V
  double offset_mv = 0;           // mV, analogue: added always, against the drive's own offset
  double dead_band_plus_mv = 0;   // mV, >= 0, analogue: added to positive voltages that the drive would not feel
  double dead_band_minus_mv = 0;  // mV, >= 0, analogue: taken from negative ones

  bool operator==(const ControlLoop&) const = default;
};

struct ControlLoopInputs {
  DriveMode mode = DriveMode::kAnalog;  // kAnalog or kCyclicVelocity; csp drives close the loop themselves
  bool closed = false;
  bool invert = false;        // the drive moves the other way round
  double model_position = 0;  // u, set point of this cycle
  double model_velocity = 0;  // u/s
  double feedback = 0;        // u, measured
};

// The signals of the block diagram, in its order. All but the last two are one cycle's values, kept to be looked at.
struct ControlLoopState {
  double error = 0;         // u
  double p = 0;             // u
  double i = 0;             // u
  double d = 0;             // u
  double sum = 0;           // u
  double limited = 0;       // u, sum within what Vmax allows
  double converted = 0;     // V, or u/s (csv)
  double feed_forward = 0;  // V, or u/s (csv)
  double compensated = 0;   // V behind dead band and offset, or u/s (csv)
  double output = 0;        // V, limited and in steps of the converter; or u/s, limited (csv)
  double integral = 0;      // u, what the next cycle's I starts from
  bool closed = false;      // the loop was closed in the cycle before

  bool operator==(const ControlLoopState&) const = default;
};

struct ControlLoopOutputs {
  double voltage_v = 0;  // analogue: -10 to 10 V, 0 while the loop is open
  double velocity = 0;   // csv: u/s, 0 while the loop is open
};

// The converter: 13 bits with sign, 8192 steps over -10 to +10 V, so codes -4096 to 4095 and +10 V falls one step
// short.
inline constexpr double kVoltageLimit = 10;  // V
inline constexpr int kVoltageSteps = 8192;
inline constexpr double kVoltageStep = 2 * kVoltageLimit / kVoltageSteps;  // V
// The voltage that the converter can put out and that is nearest.
double InConverterSteps(double volts) noexcept;

// Closing begins without a bump: in the first closed cycle D is 0, and I starts from the state's `integral`, which an
// open loop sets to 0. With inputs that are not finite the outputs are not finite either: the caller opens the loop.
void Step(const ControlLoop& params, const ControlLoopInputs& inputs, Cycle cycle, ControlLoopState& state,
          ControlLoopOutputs& outputs) noexcept;

void describe(Description<ControlLoop>&);
void describe(Description<ControlLoopState>&);

}  // namespace takt::axis
