#include "takt/flexcam/outputs.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

void describe(Enumeration<ModuleState>& e) {
  e.about("State of a cam module.");
  e.value(ModuleState::kInit, "Init", "Not enabled.");
  e.value(ModuleState::kReady, "Ready", "Waiting for a request.");
  e.value(ModuleState::kService, "Service", "The slave carries out commands of its own.");
  e.value(ModuleState::kJogPos, "JogPos", "Jogs upwards.");
  e.value(ModuleState::kJogNeg, "JogNeg", "Jogs downwards.");
  e.value(ModuleState::kHoming, "Homing", "Searching the reference.");
  e.value(ModuleState::kSync, "Sync", "The clutch is closed, closes or opens.");
  e.value(ModuleState::kStop, "Stop", "Stopping, halting, or kept at rest.");
  e.value(ModuleState::kError, "Error", "In error; waiting for a reset.");
}

void describe(Enumeration<ClutchPhase>& e) {
  e.about("Phase of the clutch.");
  e.value(ClutchPhase::kOpen, "open", "Open; the slave does not follow the cam.");
  e.value(ClutchPhase::kWaitingIn, "waiting_in", "To be closed; waiting for the begin.");
  e.value(ClutchPhase::kClosing, "closing", "Closing: the slave moves onto the cam.");
  e.value(ClutchPhase::kClosed, "closed", "Closed: the slave is on the cam.");
  e.value(ClutchPhase::kWaitingOut, "waiting_out", "To be opened; the slave is still on the cam.");
  e.value(ClutchPhase::kOpening, "opening", "Opening: the slave moves to its rest position.");
  e.value(ClutchPhase::kReleased, "released", "Opened at once; the slave comes to rest.");
}

void describe(Enumeration<ClutchWait>& e) {
  e.about("Condition for which a clutch waits.");
  e.value(ClutchWait::kNothing, "nothing", "No condition; it does not wait.");
  e.value(ClutchWait::kMasterStands, "master_stands", "The master must move.");
  e.value(ClutchWait::kDirection, "direction", "The master must move in sync_direction.");
  e.value(ClutchWait::kPosition, "position", "The master must reach the begin of the curve.");
  e.value(ClutchWait::kAway, "away", "The master has turned away from the sync position and must come back.");
  e.value(ClutchWait::kRamps, "ramps", "Ramps of offset and scaling must end.");
  e.value(ClutchWait::kSlave, "slave", "The slave must be in step with its demand, or at rest.");
  e.value(ClutchWait::kReverse, "reverse", "There must be a curve on which the slave does not reverse.");
  e.value(ClutchWait::kLimits, "limits",
          "There must be a curve that the slave's limits allow at the speed of the master.");
}

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.about("State of a cam module; ip, mp and op are points of its signal flow. Flex Cam: scSignalFlow.");
  d.internal<&O::set_offset_master>(unit::x,
                                    "Master offset in force, a ramp included. Flex Cam: lrSetOffsetMasterOut.");
  d.internal<&O::set_offset_slave>(unit::u, "Slave offset in force, a ramp included. Flex Cam: lrSetOffsetSlaveOut.");
  d.internal<&O::set_scaling_master>(unit::one, "Master factor in force, a ramp included.");
  d.internal<&O::set_scaling_slave>(unit::one, "Slave factor in force, a ramp included.");
  d.internal<&O::set_x_position>(unit::x, "X in the cycle of the cam. Flex Cam: lrSetXPosOut.");
  d.internal<&O::set_x_velocity>(unit::x_s, "Velocity of X. Flex Cam: lrSetXVelOut.");
  d.internal<&O::set_x_acceleration>(unit::x_s2, "Acceleration of X. Flex Cam: lrSetXAccOut.");
  d.internal<&O::set_y_position>(unit::y, "Y. Flex Cam: lrSetYPosOut.");
  d.internal<&O::set_y_velocity>(unit::y_s, "Velocity of Y. Flex Cam: lrSetYVelOut.");
  d.internal<&O::set_y_acceleration>(unit::y_s2, "Acceleration of Y. Flex Cam: lrSetYAccOut.");
  d.internal<&O::actual_slave_position>(unit::u, "Measured position of the slave. Flex Cam: lrActSlavePos.");
  d.internal<&O::actual_slave_velocity>(unit::u_s, "Measured velocity of the slave. Flex Cam: lrActSlaveVel.");
  d.internal<&O::slave_max_position>(unit::u,
                                     "Largest position of the slave, see bounds_valid. Flex Cam: lrSlaveMaxPos.");
  d.internal<&O::slave_min_position>(unit::u,
                                     "Smallest position of the slave, see bounds_valid. Flex Cam: lrSlaveMinPos.");
  d.internal<&O::slave_max_velocity>(unit::u_s,
                                     "Largest velocity of the slave, see bounds_valid. Flex Cam: lrSlaveMaxVel.");
  d.internal<&O::slave_max_acceleration>(
      unit::u_s2, "Largest acceleration of the slave, see bounds_valid. Flex Cam: lrSlaveMaxAcc.");
  d.internal<&O::ip01_set_scaling_master>(unit::one, "Factor of the master, as set.");
  d.internal<&O::ip02_scaling_mode_master>("Mode of the master's factor.");
  d.internal<&O::ip03_set_offset_master>(unit::x, "Offset of the master, as set.");
  d.internal<&O::ip04_set_offset_slave>(unit::u, "Offset of the slave, as set.");
  d.internal<&O::ip05_offset_mode_slave>("Mode of the slave's offset.");
  d.internal<&O::ip06_set_scaling_slave>(unit::one, "Factor of the slave, as set.");
  d.internal<&O::ip07_scaling_mode_slave>("Mode of the slave's factor.");
  d.internal<&O::ip08_cam_table1>(
      "Number of the cam in slot 1: from 1 in the order of the machine file, then in the order in which cams are made "
      "at run time; 0: none.");
  d.internal<&O::ip09_cam_table2>("Number of the cam in slot 2, as in ip08_cam_table1.");
  d.internal<&O::ip10_cam_table3>("Number of the cam in slot 3, as in ip08_cam_table1.");
  d.internal<&O::ip11_cam_table4>("Number of the cam in slot 4, as in ip08_cam_table1.");
  d.internal<&O::mp01_set_master_position>(unit::u_m, "Master's position in its turn, as used by the module.");
  d.internal<&O::mp02_set_slave_position>(unit::u, "Set point of the slave.");
  d.internal<&O::mp03_master_to_x_position>(unit::x, "Master's position on the X axis, over all cycles of the cam.");
  d.internal<&O::mp04_cam_profiler_position_out>(unit::y, "Y of the cam at that position.");
  d.internal<&O::mp05_set_y_position>(unit::y, "Y with the strokes of earlier cycles added.");
  d.internal<&O::mp06_y_to_slave_position>(unit::u, "Demand of Y on the slave.");
  d.internal<&O::op01_set_x_position_out>(unit::x, "X in the cycle of the cam.");
  d.internal<&O::op02_set_y_position_out>(unit::y, "Y.");
  d.internal<&O::clutch_position>(
      unit::u_m, "Master's position in its turn at which the clutch is closed, or open (ramp_pos); 0: not known.");
  d.internal<&O::clutch_distance>(unit::u_m, "Displacement of the master until that position; 0: not known.");
  d.internal<&O::clutch_master_velocity>(unit::u_m_s,
                                         "Largest steady speed of the master at which the slave keeps its limits on "
                                         "the clutch's curve; 0: there is no curve.");
  d.internal<&O::error>("Error of the module. Flex Cam: xError, eErrorID.");
  d.internal<&O::warning>("Warning: the last request was not carried out as set. Flex Cam: xWarning, eErrorID.");
  d.internal<&O::state>("State of the module. Flex Cam: eTMState.");
  d.internal<&O::clutch>("Phase of the clutch.");
  d.internal<&O::clutch_waits>("Condition for which the clutch waits.");
  d.internal<&O::cam_table>("Slot of the cam that runs. Flex Cam: eSetCamTableOut.");
  d.internal<&O::cam_number>("Number of the cam that runs, as in ip08_cam_table1.");
  d.internal<&O::next_cam_table>("Slot of the cam to run next; 0: the same.");
  d.internal<&O::pending_changes>("Number of pending changes of cam.");
  d.internal<&O::cam_ends>("Number of ends of a cam that were passed.");
  d.internal<&O::internal_control_active>("The slave accepts commands of its own. Flex Cam: xInternalControlActive.");
  d.internal<&O::axis_enabled>("The slave is switched on. Flex Cam: xAxisEnabled.");
  d.internal<&O::done>("The last request is done. Flex Cam: xDone.");
  d.internal<&O::busy>("A request is being carried out. Flex Cam: xBusy.");
  d.internal<&O::is_homed>("The slave has a reference. Flex Cam: xIsHomed.");
  d.internal<&O::hw_limit_switch_positive>("The positive limit switch is on. Flex Cam: xHwLimitSwitchPos.");
  d.internal<&O::hw_limit_switch_negative>("The negative limit switch is on. Flex Cam: xHwLimitSwitchNeg.");
  d.internal<&O::sw_limit_enabled>("The slave has SW limits. Flex Cam: xSwLimitEnabled.");
  d.internal<&O::sw_limit_switch_active>("A SW limit has stopped the slave. Flex Cam: xSwLimitSwitchActive.");
  d.internal<&O::cam_synchronised>("The slave is in step with the cam. Flex Cam: xCamSynchronised.");
  d.internal<&O::acc_dec_sync>("The clutch is closing or opening. Flex Cam: xAccDecSync.");
  d.internal<&O::end_of_profile>("This is the last cycle before the end of the cam. Flex Cam: xEndOfProfile.");
  d.internal<&O::sequencer_active>("A sequence of cams is being run. Flex Cam: xCamSequencerActive.");
  d.internal<&O::bounds_valid>("The extreme values are valid for the present settings.");
  d.internal<&O::master_lost>("The master's position is not known: the master is off, or has a fault.");
  d.internal<&O::offset_master_busy>("A new master offset waits or is being ramped.");
  d.internal<&O::offset_slave_busy>("A new slave offset waits or is being ramped.");
  d.internal<&O::scaling_master_busy>("A new master factor waits or is being ramped.");
  d.internal<&O::scaling_slave_busy>("A new slave factor waits or is being ramped.");
  d.internal<&O::offset_master_done>("The master offset that is set is in force.");
  d.internal<&O::offset_slave_done>("The slave offset that is set is in force.");
  d.internal<&O::scaling_master_done>("The master factor that is set is in force.");
  d.internal<&O::scaling_slave_done>("The slave factor that is set is in force.");
}

}  // namespace takt::flexcam
