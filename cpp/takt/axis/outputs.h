// What an axis publishes every cycle.
#pragma once

#include <cstdint>
#include <limits>

#include "takt/axis/state_table.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"

namespace takt::axis {

struct Outputs {
  double set_position = 0;      // [u] rotary: in [0, modulus)
  double set_velocity = 0;      // [u/s]
  double set_acceleration = 0;  // [u/s²]
  double actual_position = 0;   // [u] rotary: in [0, modulus)
  double actual_velocity = 0;   // [u/s]
  double following_error = 0;   // [u] set point of the cycle before minus what is measured now
  // [u] over all turns: where a drive simulated in the engine has really brought the load when `actual_position` was
  // measured, whatever the encoder makes of it; NaN: not known.
  double true_position = std::numeric_limits<double>::quiet_NaN();
  double voltage_v = 0;            // [V] output of the position loop
  double torque_nm = 0;            // [Nm] as the drive reports it
  double probe_position = 0;       // [u] where the touch probe was captured last
  double covered_distance = 0;     // [u] by the motion on top of the one in progress; 0: there is none
  double phase_shift = 0;          // [master's u] that it is taken to be ahead of where it is
  double covered_phase_shift = 0;  // [master's u] by the last shift; one to an amount: in all
  double encoder_correction = 0;   // [u] that the encoder on the motor is ahead of the axis
  double override_factor = 1;      // of the velocity; 0: held
  double skew = 0;                 // [u] of an axis that follows another from load on: off where its master has it
  Ticket active_command = 0;       // 0: none
  ErrorId error = ErrorId::kNone;  // fault of the axis (not of a command)
  PlcState state = PlcState::kDisabled;
  LimitedBy limited_by = LimitedBy::kNothing;  // what holds the motion in progress back
  std::uint32_t master1 = 0;                   // numbers of the axes that it follows, from 1; 0: none
  std::uint32_t master2 = 0;
  std::int32_t drive_error = 0;  // number that the drive gave for its fault (CiA 402, 0x603F); 0: none
  std::uint32_t fault_of = 0;    // number of the axis whose fault stopped this one, its master, from 1; 0: none
  std::uint32_t probe_captures = 0;
  std::uint32_t profile_ends = 0;     // how often the end of its cam was passed
  std::uint32_t cam_outputs = 0;      // of the cam switches, a bit for each track
  std::uint32_t digital_outputs = 0;  // written ones and those of the cam switches, a bit for each
  std::uint8_t buffered_commands = 0;
  bool loop_closed = false;
  bool in_position = false;
  bool in_step = false;            // follows its masters exactly; measured ones as far as they are known
  bool synchronizing = false;      // is getting into step
  bool superimposed = false;       // another motion is on top of the one in progress
  bool end_of_profile = false;     // the end of its cam was passed in this cycle
  bool homed = false;              // has a reference
  bool emergency_stopped = false;  // an emergency stop switched it off, and nothing has switched it on since
  bool drive_heard = true;         // what is measured is of now; false: a drive in another process is silent
  bool drive_ready = false;        // the drive says that it is switched on
  bool skewed = false;             // its skew is beyond follows.skew_warning
  bool limit_positive = false;     // switches after inversion
  bool limit_negative = false;
  bool reference = false;
  bool touch_probe = false;
  bool enable_positive = true;  // directions in which it may move (MC_Power)
  bool enable_negative = true;
};

void describe(Description<Outputs>&);

}  // namespace takt::axis
