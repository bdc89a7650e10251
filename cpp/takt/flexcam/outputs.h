// The outputs that a cam module publishes every cycle: those of the manual's 3.3.3 and its signal flow (3.5.1).
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/flexcam/settings.h"

namespace takt::flexcam {

enum class ModuleState : std::uint8_t { kInit, kReady, kService, kJogPos, kJogNeg, kHoming, kSync, kStop, kError };

enum class ClutchPhase : std::uint8_t {
  kOpen,
  kWaitingIn,  // the master has not reached the begin of the curve
  kClosing,
  kClosed,
  kWaitingOut,  // still on the cam: the master is stationary, or no curve serves
  kOpening,
  kReleased,  // opened at once; the slave comes to rest on its own
};

// The reason why the clutch waits.
enum class ClutchWait : std::uint8_t {
  kNothing,
  kMasterStands,
  kDirection,
  kPosition,
  kAway,
  kRamps,
  kSlave,
  kReverse,
  kLimits,
};

struct Outputs {
  double set_offset_master = 0;   // [x] in force
  double set_offset_slave = 0;    // [u] in force
  double set_scaling_master = 1;  // in force
  double set_scaling_slave = 1;   // in force
  double set_x_position = 0;      // [x]
  double set_x_velocity = 0;      // [x/s]
  double set_x_acceleration = 0;  // [x/s²]
  double set_y_position = 0;      // [y]
  double set_y_velocity = 0;      // [y/s]
  double set_y_acceleration = 0;  // [y/s²]
  double actual_slave_position = 0;
  double actual_slave_velocity = 0;
  double slave_max_position = 0;
  double slave_min_position = 0;
  double slave_max_velocity = 0;
  double slave_max_acceleration = 0;
  // The signal flow: inputs (IP), intermediate points (MP) and outputs (OP) between the master and the slave.
  double ip01_set_scaling_master = 1;
  ScalingMode ip02_scaling_mode_master = ScalingMode::kXZero;
  double ip03_set_offset_master = 0;  // [x]
  double ip04_set_offset_slave = 0;   // [u]
  OffsetMode ip05_offset_mode_slave = OffsetMode::kXZero;
  double ip06_set_scaling_slave = 1;
  ScalingMode ip07_scaling_mode_slave = ScalingMode::kXZero;
  std::uint32_t ip08_cam_table1 = 0;  // Table::number of the cam in each slot; 0: none
  std::uint32_t ip09_cam_table2 = 0;
  std::uint32_t ip10_cam_table3 = 0;
  std::uint32_t ip11_cam_table4 = 0;
  double mp01_set_master_position = 0;        // [master's u] as the module takes it
  double mp02_set_slave_position = 0;         // [u] set point of the slave
  double mp03_master_to_x_position = 0;       // [x] the master's position on the X axis
  double mp04_cam_profiler_position_out = 0;  // [y] value of the cam there
  double mp05_set_y_position = 0;             // [y] with the strokes of earlier cycles added
  double mp06_y_to_slave_position = 0;        // [u] position of the slave by Y
  double op01_set_x_position_out = 0;         // [x] in the cam's cycle
  double op02_set_y_position_out = 0;         // [y]
  double clutch_position = 0;                 // [master's u] position at which the clutch will be closed, or open
  double clutch_distance = 0;                 // [master's u] distance to that position
  double clutch_master_velocity = 0;          // [master's u/s] largest steady speed on the clutch's curve
  ErrorId error = ErrorId::kNone;
  ErrorId warning = ErrorId::kNone;
  ModuleState state = ModuleState::kInit;
  ClutchPhase clutch = ClutchPhase::kOpen;
  ClutchWait clutch_waits = ClutchWait::kNothing;
  std::uint32_t cam_table = 1;        // slot of the running cam
  std::uint32_t cam_number = 0;       // Table::number of that cam
  std::uint32_t next_cam_table = 0;   // slot of the next cam; 0: the same
  std::uint32_t pending_changes = 0;  // of change_cam
  std::uint32_t cam_ends = 0;         // number of cam ends passed
  bool internal_control_active = false;
  bool axis_enabled = false;
  bool done = false;
  bool busy = false;
  bool is_homed = false;
  bool hw_limit_switch_positive = false;
  bool hw_limit_switch_negative = false;
  bool sw_limit_enabled = false;
  bool sw_limit_switch_active = false;
  bool cam_synchronised = false;
  bool acc_dec_sync = false;
  bool end_of_profile = false;
  bool sequencer_active = false;
  bool bounds_valid = false;
  bool master_lost = false;
  bool offset_master_busy = false;
  bool offset_slave_busy = false;
  bool scaling_master_busy = false;
  bool scaling_slave_busy = false;
  bool offset_master_done = false;
  bool offset_slave_done = false;
  bool scaling_master_done = false;
  bool scaling_slave_done = false;
};

void describe(Enumeration<ModuleState>&);
void describe(Enumeration<ClutchPhase>&);
void describe(Enumeration<ClutchWait>&);
void describe(Description<Outputs>&);

}  // namespace takt::flexcam
