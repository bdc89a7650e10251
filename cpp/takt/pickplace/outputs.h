// Outputs that a pick and place module publishes every cycle: those of the manual's 3.6.4, and counters.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/pickplace/places.h"
#include "takt/pickplace/state_table.h"

namespace takt::pickplace {

// Results since the start or the last reset_counters.
struct Counters {
  std::uint32_t picked = 0;       // profiles completed at a workpiece to pick ...
  std::uint32_t placed = 0;       // ... and at a point to place
  std::uint32_t missed = 0;       // workpieces that were not reached; of these:
  std::uint32_t too_late = 0;     // left the range before they could be reached
  std::uint32_t interrupted = 0;  // the path to them was stopped or aborted
  std::uint32_t refused = 0;      // there was no path to them
};

// A value for each axis.
struct AxisNumbers {
  double x = 0, y = 0, z = 0;                             // [mm]
  double a = 0, b = 0, c = 0;                             // [deg]
  double a1 = 0, a2 = 0, a3 = 0, a4 = 0, a5 = 0, a6 = 0;  // [u]
  double aux1 = 0;                                        // [u]
};

// In masks of axes bit 0 is X, followed by Y, Z, A, B, C, A1 to A6 and Aux1.
struct Outputs {
  PickPlaceState state = PickPlaceState::kInit;
  ErrorId error = ErrorId::kNone;
  ErrorId warning = ErrorId::kNone;
  std::uint32_t error_axes = 0;           // mask; the reason is in the state of each axis
  double set_path_velocity = 0;           // [mm/s]
  double path_preparation_time = 0;       // [s]
  double precalculated_profile_time = 0;  // [s]; 0: not known yet
  AxisNumbers position;                   // actual values
  AxisNumbers velocity;
  std::uint32_t profile_point_passed = 0;  // 0: the start; the last one is the target
  std::uint32_t target = 0;                // approached now: a belt from 1; 0: the static target
  std::uint32_t workpiece = 0;             // number of the approached workpiece on its belt; 0: none
  std::uint32_t profiles = 0;              // accepted and not yet done
  std::uint32_t picked = 0;                // counters
  std::uint32_t placed = 0;
  std::uint32_t missed = 0;
  std::uint32_t missed_too_late = 0;
  std::uint32_t missed_interrupted = 0;
  std::uint32_t missed_refused = 0;
  std::uint32_t warning_belt = 0;  // belt that the warning refers to, from 1; 0: none
  std::uint32_t held = 0;          // products picked and not placed yet; attributes of the oldest one:
  std::uint32_t held_kind = 0;
  std::uint32_t held_colour = 0;
  double held_quality = 0;
  double picks_per_minute = 0;  // over the last picks
  bool internal_control_active = false;
  bool axes_enabled = false;
  bool axes_group_enabled = false;
  bool done = false;
  bool busy = false;
  bool axes_group_homed = false;
  bool in_position = false;
  bool hw_limit_switch_active = false;
  bool sw_limit_switch_active = false;
  std::uint32_t hw_limit_switches_positive = 0;  // masks
  std::uint32_t hw_limit_switches_negative = 0;
  std::uint32_t sw_limits_enabled = 0;
  std::uint32_t sw_limit_switches = 0;
  bool path_hold = false;  // the tool rests on a path that can be continued
  bool off_path = false;   // the tool was moved away from that path: return_to_path moves it back
  bool gripper_control_active = false;
  bool pulse_gripper = false;  // true for one cycle
  bool profile_in_preparation = false;
  bool acc_dec_sync = false;
  bool synchronised = false;
  bool in_target = false;
  bool in_park_position = false;
};

void describe(Description<Counters>&);
void describe(Description<AxisNumbers>&);
void describe(Description<Outputs>&);

}  // namespace takt::pickplace
