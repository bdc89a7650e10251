#include "takt/flexcam/outputs.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

void describe(Enumeration<ModuleState>& e) {
  e.about("State of a cam module.");
  e.value(ModuleState::kInit, "Init", "Not enabled.");
  e.value(ModuleState::kReady, "Ready", "Waits for a request.");
  e.value(ModuleState::kService, "Service", "The slave carries out commands of its own.");
  e.value(ModuleState::kJogPos, "JogPos", "Jogs upwards.");
  e.value(ModuleState::kJogNeg, "JogNeg", "Jogs downwards.");
  e.value(ModuleState::kHoming, "Homing", "Looks for the reference.");
  e.value(ModuleState::kSync, "Sync", "The clutch is closed, closes or opens.");
  e.value(ModuleState::kStop, "Stop", "Stops or halts, or is kept so.");
  e.value(ModuleState::kError, "Error", "Waits for a reset.");
}

void describe(Enumeration<ClutchPhase>& e) {
  e.about("How far the clutch is.");
  e.value(ClutchPhase::kOpen, "open", "The slave is on its own.");
  e.value(ClutchPhase::kWaitingIn, "waiting_in", "It is to close, and waits to begin.");
  e.value(ClutchPhase::kClosing, "closing", "On the way onto the cam.");
  e.value(ClutchPhase::kClosed, "closed", "On the cam.");
  e.value(ClutchPhase::kWaitingOut, "waiting_out", "On the cam, and waits to leave it.");
  e.value(ClutchPhase::kOpening, "opening", "On the way to where the slave is to rest.");
  e.value(ClutchPhase::kReleased, "released", "Opened at once; the slave comes to rest.");
}

void describe(Enumeration<ClutchWait>& e) {
  e.about("For what a clutch waits.");
  e.value(ClutchWait::kNothing, "nothing", "It does not wait.");
  e.value(ClutchWait::kMasterStands, "master_stands", "For the master to move.");
  e.value(ClutchWait::kDirection, "direction", "For the master to move in sync_direction.");
  e.value(ClutchWait::kPosition, "position", "For the master to come to the begin of the curve.");
  e.value(ClutchWait::kAway, "away", "The master has turned away from the sync position; for it to come back.");
  e.value(ClutchWait::kRamps, "ramps", "For the end of offset and scaling ramps.");
  e.value(ClutchWait::kSlave, "slave", "For the slave to be in step with what it follows, or at rest.");
  e.value(ClutchWait::kReverse, "reverse", "For a curve on which the slave does not reverse.");
  e.value(ClutchWait::kLimits, "limits", "For a curve that the slave's limits allow at the speed of the master.");
}

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.about("What a cam module publishes; ip, mp and op are points of its signal flow. Flex Cam: scSignalFlow.");
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
  d.internal<&O::actual_slave_position>(unit::u, "As measured. Flex Cam: lrActSlavePos.");
  d.internal<&O::actual_slave_velocity>(unit::u_s, "As measured. Flex Cam: lrActSlaveVel.");
  d.internal<&O::slave_max_position>(unit::u, "Extreme value. Flex Cam: lrSlaveMaxPos.");
  d.internal<&O::slave_min_position>(unit::u, "Extreme value. Flex Cam: lrSlaveMinPos.");
  d.internal<&O::slave_max_velocity>(unit::u_s, "Extreme value. Flex Cam: lrSlaveMaxVel.");
  d.internal<&O::slave_max_acceleration>(unit::u_s2, "Extreme value. Flex Cam: lrSlaveMaxAcc.");
  d.internal<&O::ip01_set_scaling_master>(unit::one, "Factor of the master, as set.");
  d.internal<&O::ip02_scaling_mode_master>("Its mode.");
  d.internal<&O::ip03_set_offset_master>(unit::x, "Offset of the master, as set.");
  d.internal<&O::ip04_set_offset_slave>(unit::u, "Offset of the slave, as set.");
  d.internal<&O::ip05_offset_mode_slave>("Its mode.");
  d.internal<&O::ip06_set_scaling_slave>(unit::one, "Factor of the slave, as set.");
  d.internal<&O::ip07_scaling_mode_slave>("Its mode.");
  d.internal<&O::ip08_cam_table1>(
      "Number of the cam in slot 1: from 1 in the order of the machine file, then in the order in which cams are made "
      "at run time; 0: none.");
  d.internal<&O::ip09_cam_table2>("In slot 2.");
  d.internal<&O::ip10_cam_table3>("In slot 3.");
  d.internal<&O::ip11_cam_table4>("In slot 4.");
  d.internal<&O::mp01_set_master_position>(unit::u_m, "Master's position in its turn, as the module takes it.");
  d.internal<&O::mp02_set_slave_position>(unit::u, "Set point of the slave.");
  d.internal<&O::mp03_master_to_x_position>(unit::x, "Master's position on the X axis.");
  d.internal<&O::mp04_cam_profiler_position_out>(unit::y, "What the cam says for it.");
  d.internal<&O::mp05_set_y_position>(unit::y, "The same with the strokes of earlier cycles.");
  d.internal<&O::mp06_y_to_slave_position>(unit::u, "Where Y wants the slave.");
  d.internal<&O::op01_set_x_position_out>(unit::x, "X in the cycle of the cam.");
  d.internal<&O::op02_set_y_position_out>(unit::y, "Y.");
  d.internal<&O::clutch_position>(
      unit::u_m, "Master's position in its turn at which the clutch is closed, or open (ramp_pos); 0: not known.");
  d.internal<&O::clutch_distance>(unit::u_m, "Master's displacement until there; 0: not known.");
  d.internal<&O::clutch_master_velocity>(unit::u_m_s,
                                         "Largest steady speed of the master at which the slave keeps its limits on "
                                         "the clutch's curve; 0: it is on none.");
  d.internal<&O::error>("Why the module is in error. Flex Cam: xError, eErrorID.");
  d.internal<&O::warning>("What was not done as asked last. Flex Cam: xWarning, eErrorID.");
  d.internal<&O::state>("State of the module. Flex Cam: eTMState.");
  d.internal<&O::clutch>("How far the clutch is.");
  d.internal<&O::clutch_waits>("For what it waits.");
  d.internal<&O::cam_table>("Slot of the cam that runs. Flex Cam: eSetCamTableOut.");
  d.internal<&O::cam_number>("Number of the cam that runs, as in ip08_cam_table1.");
  d.internal<&O::next_cam_table>("Slot of the cam that is to run next; 0: the same.");
  d.internal<&O::pending_changes>("Changes of cam that wait.");
  d.internal<&O::cam_ends>("How often the end of a cam was passed.");
  d.internal<&O::internal_control_active>("The slave takes commands of its own. Flex Cam: xInternalControlActive.");
  d.internal<&O::axis_enabled>("The slave is switched on. Flex Cam: xAxisEnabled.");
  d.internal<&O::done>("What was asked for last is done. Flex Cam: xDone.");
  d.internal<&O::busy>("It is being done. Flex Cam: xBusy.");
  d.internal<&O::is_homed>("The slave has a reference. Flex Cam: xIsHomed.");
  d.internal<&O::hw_limit_switch_positive>("On the positive limit switch. Flex Cam: xHwLimitSwitchPos.");
  d.internal<&O::hw_limit_switch_negative>("On the negative limit switch. Flex Cam: xHwLimitSwitchNeg.");
  d.internal<&O::sw_limit_enabled>("The slave has SW limits. Flex Cam: xSwLimitEnabled.");
  d.internal<&O::sw_limit_switch_active>("It was stopped by one. Flex Cam: xSwLimitSwitchActive.");
  d.internal<&O::cam_synchronised>("The slave is where the cam wants it. Flex Cam: xCamSynchronised.");
  d.internal<&O::acc_dec_sync>("The clutch closes or opens. Flex Cam: xAccDecSync.");
  d.internal<&O::end_of_profile>("The last cycle of the cam. Flex Cam: xEndOfProfile.");
  d.internal<&O::sequencer_active>("A sequence of cams is being run. Flex Cam: xCamSequencerActive.");
  d.internal<&O::bounds_valid>("The extreme values are those of what is set.");
  d.internal<&O::master_lost>("The master's position is not known: it is off, or has a fault.");
  d.internal<&O::offset_master_busy>("A new master offset is waited for, or ramped.");
  d.internal<&O::offset_slave_busy>("A new slave offset is waited for, or ramped.");
  d.internal<&O::scaling_master_busy>("A new master factor is waited for, or ramped.");
  d.internal<&O::scaling_slave_busy>("A new slave factor is waited for, or ramped.");
  d.internal<&O::offset_master_done>("The master offset that is set is in force.");
  d.internal<&O::offset_slave_done>("The slave offset that is set is in force.");
  d.internal<&O::scaling_master_done>("The master factor that is set is in force.");
  d.internal<&O::scaling_slave_done>("The slave factor that is set is in force.");
}

}  // namespace takt::flexcam
