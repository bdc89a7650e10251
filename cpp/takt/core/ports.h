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
  kCyclicTorque,    // cst: a torque, no faster than a speed; only while MC_TorqueControl is in control
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
  // Edges of the touch probe's wire since the start, wrap; where they never count, edges are those of the samples.
  std::uint32_t probe_rises = 0;
  std::uint32_t probe_falls = 0;
  // How long before this sample the last of each came; only looked at in a cycle in which it was counted.
  double probe_rise_age_s = 0;
  double probe_fall_age_s = 0;
  bool drive_ready = false;  // power stage on and following its set point
  bool drive_fault = false;
  std::int32_t drive_error = 0;     // what the drive says of its fault (CiA 402, 0x603F); 0: nothing
  double torque_nm = 0;             // Nm; N on linear motors
  std::uint32_t load_counts = 0;    // of a second encoder, on the load
  bool load_encoder_error = false;  // its ERR line, or no answer from it
};

// To the machine, written once a cycle.
struct ServoOutputs {
  double position_counts = 0;    // csp: set point in encoder counts
  double velocity_counts_s = 0;  // csp: feed-forward; csv: set point; cst: largest speed either way, >= 0
  double voltage_v = 0;          // analogue: -10 to 10 V
  double torque_nm = 0;          // cst: set point; csp and csv: added by the drive; N on linear motors
  DriveMode mode = DriveMode::kCyclicPosition;
  bool enable = false;         // power stage on
  bool release_brake = false;  // brake relay energised
  // cst: signed velocity up to which the torque may drive in this cycle; there the drive's velocity loop takes over.
  double torque_until_counts_s = 0;
  double torque_limit_nm = 0;         // all modes: largest torque either way; 0: that of the drive
  std::uint32_t digital_outputs = 0;  // of the axis, a bit for each
};

enum class DriveLink : std::uint8_t {
  kHeard,    // drives in this process always are
  kAwaited,  // nothing has come from the drive yet
  kLost,     // nothing has come from it for too long
};

// When inputs were sampled. As it is here: just now, as those of a drive in this process are.
struct Sampling {
  DriveLink link = DriveLink::kHeard;
  std::uint32_t age = 0;   // cycles that they are older than they should be
  std::uint32_t step = 1;  // cycles since the sample before; 0: they are that sample still
};

void describe(Enumeration<DriveMode>&);
void describe(Enumeration<DriveLink>&);
void describe(Description<Sampling>&);
void describe(Description<ServoInputs>&);
void describe(Description<ServoOutputs>&);

}  // namespace takt
