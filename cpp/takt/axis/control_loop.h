// The position loop: from a set point and the measured position to the command of the drive.
#pragma once

#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/ports.h"

namespace takt::axis {

// A numeric PID in the form of sampled loops, sampled once a cycle of T seconds. All gains are plain numbers: the three
// terms are positions, their sum is the displacement to be made up for within one cycle, so sum / T is a velocity. (kp
// = T Kv with a velocity gain Kv in 1/s.)
struct ControlLoop {
  double kp = 0.05;  // >= 0: P = kp e
  double ki = 0;     // >= 0: I = sum of ki e over the cycles; T / Ti
  double kd = 0;     // >= 0: D = kd (e - e of the cycle before); Td / T
  double kc = 0.9;   // 0 to 1: share of what the limiters cut off that is subtracted from I, at most down to 0; 0: none
  double ff = 1;     // share of the set velocity that is fed forward
  double velocity_at_10v = 1000;  // [u/s] > 0: Vmax, the velocity limit of the loop; analogue drives: the speed at 10 V
  double offset_mv = 0;           // [mV] analogue: always added, against the drive's own offset
  double dead_band_plus_mv = 0;   // [mV] >= 0; analogue: added to positive voltages, which the drive would not react to
  double dead_band_minus_mv = 0;  // [mV] >= 0; analogue: subtracted from negative ones

  bool operator==(const ControlLoop&) const = default;
};

struct ControlLoopInputs {
  DriveMode mode = DriveMode::kAnalog;  // kAnalog or kCyclicVelocity; csp drives close the loop themselves
  bool closed = false;
  bool invert = false;        // the drive moves in the opposite sense
  double model_position = 0;  // [u] set point that `feedback` is compared with
  double model_velocity = 0;  // [u/s] fed forward
  double feedback = 0;        // [u] measured
};

// The signals of the block diagram, in its order: values of one cycle, kept for inspection. Only `error`, `integral`
// and `closed` are used in the next cycle.
struct ControlLoopState {
  double error = 0;         // [u]
  double p = 0;             // [u]
  double i = 0;             // [u]
  double d = 0;             // [u]
  double sum = 0;           // [u]
  double limited = 0;       // [u] sum, limited to Vmax
  double converted = 0;     // [V]; csv: [u/s]
  double feed_forward = 0;  // [V]; csv: [u/s]
  double compensated = 0;   // [V] behind dead band and offset; csv: [u/s]
  double output = 0;        // [V] limited, in steps of the converter; csv: [u/s] limited
  double integral = 0;      // [u] start value of the next cycle's I
  bool closed = false;      // the loop was closed in the previous cycle

  bool operator==(const ControlLoopState&) const = default;
};

struct ControlLoopOutputs {
  double voltage_v = 0;  // [V] analogue: -10 to 10; 0 while the loop is open
  double velocity = 0;   // [u/s] csv; 0 while the loop is open
};

// The converter: 13 bits with sign, 8192 steps over -10 to +10 V, so codes -4096 to 4095 and +10 V falls one step
// short.
inline constexpr double kVoltageLimit = 10;  // [V]
inline constexpr int kVoltageSteps = 8192;
inline constexpr double kVoltageStep = 2 * kVoltageLimit / kVoltageSteps;  // [V]
// Returns the nearest voltage [V] that the converter can output.
double InConverterSteps(double volts) noexcept;

// Runs one cycle. Closing the loop causes no step: in the first closed cycle D is 0, and I starts from the state's
// `integral`, which an open loop sets to 0. If inputs are not finite, the outputs are not finite either: the caller
// must open the loop.
void Step(const ControlLoop& params, const ControlLoopInputs& inputs, Cycle cycle, ControlLoopState& state,
          ControlLoopOutputs& outputs) noexcept;

void describe(Description<ControlLoop>&);
void describe(Description<ControlLoopState>&);

}  // namespace takt::axis
