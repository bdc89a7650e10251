// The wires between the engine and drives, encoders and switches: all that a plant (simulated or real) and the control
// code know of one another.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt {

enum class DriveMode : std::uint8_t {
  kCyclicPosition,  // csp: the drive closes the position loop
  kCyclicVelocity,  // csv: the engine's position loop commands a speed
  kAnalog,          // the engine's position loop commands ±10 V
};

// From the machine, sampled once a cycle. Positions are raw counts: what a count means is the axis' business.
struct ServoInputs {
  std::uint32_t counts = 0;  // incremental: quadrature counter, wraps at 2^32; absolute: the SSI word, right-aligned
  std::uint32_t index_counts = 0;  // counter latched at the last index pulse (NI)
  std::uint32_t index_pulses = 0;  // number of index pulses seen, wraps
  bool encoder_error = false;      // the encoder's ERR line, or no answer from it
  bool limit_positive = false;
  bool limit_negative = false;
  bool reference = false;
  bool touch_probe = false;
  bool drive_ready = false;  // power stage on and following its set point
  bool drive_fault = false;
  double torque_nm = 0;  // Nm; N on linear motors
};

// To the machine, written once a cycle.
struct ServoOutputs {
  double position_counts = 0;    // csp: set point in encoder counts
  double velocity_counts_s = 0;  // csp: feed-forward; csv: set point
  double voltage_v = 0;          // analogue: -10 to 10 V
  DriveMode mode = DriveMode::kCyclicPosition;
  bool enable = false;         // power stage on
  bool release_brake = false;  // brake relay energised
};

void describe(Enumeration<DriveMode>&);
void describe(Description<ServoInputs>&);
void describe(Description<ServoOutputs>&);

}  // namespace takt
