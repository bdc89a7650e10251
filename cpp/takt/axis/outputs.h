// The outputs that an axis publishes every cycle.
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
  double following_error = 0;   // [u] previous set point minus the position measured now; 0 while the loop is open
  // [u] over all turns: true position of the load when `actual_position` was measured, if the engine simulates the
  // drive, whatever the encoder says; NaN: not known.
  double true_position = std::numeric_limits<double>::quiet_NaN();
  double voltage_v = 0;            // [V] output of the position loop
  double torque_nm = 0;            // [Nm] as reported by the drive
  double probe_position = 0;       // [u] of the last touch probe capture
  double covered_distance = 0;     // [u] by the superimposed motion; 0: none
  double phase_shift = 0;          // [master's u] added to the master's position
  double covered_phase_shift = 0;  // [master's u] by the last shift; absolute shift: in all
  double encoder_correction = 0;   // [u] encoder on the motor minus axis
  double override_factor = 1;      // of the velocity; 0: held
  double skew = 0;  // [u] measured deviation from the position due by the master; axes that follow one from load on
  Ticket active_command = 0;       // 0: none
  ErrorId error = ErrorId::kNone;  // of the axis, not of a command
  PlcState state = PlcState::kDisabled;
  LimitedBy limited_by = LimitedBy::kNothing;  // the limit that restricts the motion in progress
  std::uint32_t master1 = 0;                   // number, from 1, of the axis that it follows; 0: none
  std::uint32_t master2 = 0;
  std::int32_t drive_error = 0;  // of the drive, for its fault (CiA 402, 0x603F); 0: none
  std::uint32_t fault_of = 0;    // number, from 1, of the follower whose fault stopped this axis, its master; 0: none
  std::uint32_t probe_captures = 0;
  std::uint32_t profile_ends = 0;     // how often an end of its cam was passed
  std::uint32_t cam_outputs = 0;      // of the cam switches, a bit for each track
  std::uint32_t digital_outputs = 0;  // written outputs and those of the cam switches, a bit for each
  std::uint8_t buffered_commands = 0;
  bool loop_closed = false;
  bool in_position = false;
  bool in_step = false;            // follows its source exactly; measured masters as far as they are known
  bool synchronizing = false;      // getting into step
  bool superimposed = false;       // a superimposed motion is in progress
  bool end_of_profile = false;     // an end of its cam was passed in this cycle
  bool homed = false;              // has a reference
  bool emergency_stopped = false;  // by an emergency stop, and not powered since
  bool drive_heard = true;         // measurements are current; false: a drive in another process is silent
  bool drive_ready = false;        // as reported by the drive
  bool skewed = false;             // its skew exceeds follows.skew_warning
  bool limit_positive = false;     // switches are behind inversion
  bool limit_negative = false;
  bool reference = false;
  bool touch_probe = false;
  bool enable_positive = true;  // motion in this direction is enabled (MC_Power)
  bool enable_negative = true;
};

void describe(Description<Outputs>&);

}  // namespace takt::axis
