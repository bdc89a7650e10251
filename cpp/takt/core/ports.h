// The signals between the engine and drives, encoders and switches: the whole interface between a plant (simulated or
// real) and the control code.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt {

enum class DriveMode : std::uint8_t {
  kCyclicPosition,  // csp: the drive closes the position loop
  kCyclicVelocity,  // csv: the engine's position loop commands a velocity
  kAnalog,          // the engine's position loop commands ±10 V
  kCyclicTorque,    // cst: a torque, up to a velocity limit; only while MC_TorqueControl is in control
};

// From the machine, sampled once a cycle. Positions are raw counts; the axis scales them.
struct ServoInputs {
  std::uint32_t counts = 0;  // incremental: quadrature counter, wraps at 2^32; absolute: the SSI word, right-aligned
  std::uint32_t index_counts = 0;  // counter latched at the last index pulse (NI)
  std::uint32_t index_pulses = 0;  // number of index pulses seen, wraps
  bool encoder_error = false;      // the encoder's ERR line is set, or it does not answer
  bool limit_positive = false;
  bool limit_negative = false;
  bool reference = false;
  bool touch_probe = false;
  // Edges of the touch probe's wire since the start, wrap; if they never count, edges are taken from the samples.
  std::uint32_t probe_rises = 0;
  std::uint32_t probe_falls = 0;
  // [s] age of the last edge of each kind at this sample; only read in a cycle in which the edge was counted.
  double probe_rise_age_s = 0;
  double probe_fall_age_s = 0;
  bool drive_ready = false;  // power stage on and following its set point
  bool drive_fault = false;
  std::int32_t drive_error = 0;     // error code of the drive's fault (CiA 402, 0x603F); 0: none
  double torque_nm = 0;             // [Nm]; [N] on linear motors
  std::uint32_t load_counts = 0;    // of a second encoder, on the load
  bool load_encoder_error = false;  // its ERR line is set, or it does not answer
};

// To the machine, written once a cycle.
struct ServoOutputs {
  double position_counts = 0;    // csp: set point in encoder counts
  double velocity_counts_s = 0;  // csp: feed-forward; csv: set point; cst: largest velocity in both directions, >= 0
  double voltage_v = 0;          // analogue: -10 to 10 [V]
  double torque_nm = 0;          // cst: set point; csp and csv: added by the drive; [N] on linear motors
  DriveMode mode = DriveMode::kCyclicPosition;
  bool enable = false;         // power stage on
  bool release_brake = false;  // brake relay energised
  // cst: signed velocity up to which the torque may drive in this cycle; from there the drive's velocity loop takes
  // over.
  double torque_until_counts_s = 0;
  double torque_limit_nm = 0;         // all modes: largest torque in both directions; 0: the drive's own limit
  std::uint32_t digital_outputs = 0;  // of the axis, one bit each
};

enum class DriveLink : std::uint8_t {
  kHeard,    // always, for drives in this process
  kAwaited,  // no sample has come from the drive yet
  kLost,     // no sample has come from it for too long
};

// When inputs were sampled. Default: in this cycle (drive in this process).
struct Sampling {
  DriveLink link = DriveLink::kHeard;
  std::uint32_t age = 0;   // [cycles] delay beyond the regular one
  std::uint32_t step = 1;  // [cycles] since the sample before; 0: still the same sample
};

void describe(Enumeration<DriveMode>&);
void describe(Enumeration<DriveLink>&);
void describe(Description<Sampling>&);
void describe(Description<ServoInputs>&);
void describe(Description<ServoOutputs>&);

}  // namespace takt
