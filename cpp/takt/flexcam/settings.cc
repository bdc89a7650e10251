#include "takt/flexcam/settings.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

// One description for the settings and for the command that changes them.
template <template <typename> class Of>
void DescribeSettings(Description<SettingsOf<Of>>& d) {
  using S = SettingsOf<Of>;
  const Range factor = between(1e-9, 1e12);
  d.template defaulted<&S::stop_deceleration>(unit::u_s2, factor, "Deceleration of a stop. Flex Cam: lrStopDec.");
  d.template defaulted<&S::stop_jerk>(unit::u_s3, factor, "Jerk of a stop. Flex Cam: lrStopJerk.");
  d.template defaulted<&S::halt_deceleration>(unit::u_s2, factor, "Deceleration of a halt. Flex Cam: lrHaltDec.");
  d.template defaulted<&S::jerk>(
      unit::u_s3, factor,
      "Jerk of offset and scaling ramps, of the immediate opening and of a halt. Flex Cam: lrJerk.");
  d.template defaulted<&S::jog_velocity>(unit::u_s, factor, "Velocity of a jog. Flex Cam: lrJogVel.");
  d.template defaulted<&S::jog_acceleration>(unit::u_s2, factor, "Acceleration of a jog. Flex Cam: lrJogAcc.");
  d.template defaulted<&S::jog_deceleration>(unit::u_s2, factor, "Deceleration of a jog. Flex Cam: lrJogDec.");
  d.template defaulted<&S::jog_jerk>(unit::u_s3, factor, "Jerk of a jog. Flex Cam: lrJogJerk.");
  d.template defaulted<&S::home_position>(unit::u, between(-1e12, 1e12),
                                          "Position to be set at the reference. Flex Cam: lrHomePosition.");
  d.template defaulted<&S::home_by_module>(
      "True: homing uses the homing section of the module instead of the axis' own. Flex Cam: xUseHomeExtParameter.");
  d.template defaulted<&S::sync_mode>("Mode in which the clutch closes and opens. Flex Cam: eSyncMode.");
  d.template defaulted<&S::sync_direction>(
      "Direction of the master in which the clutch may begin to close. Flex Cam: eSyncDirection.");
  d.template defaulted<&S::master_sync_in_distance>(
      between(0, 1e12),
      "Displacement of the master over which the clutch closes (ramp_pos), in its unit; 0: at once, as fast as the "
      "slave's limits allow. Flex Cam: lrMasterSyncInDist.");
  d.template defaulted<&S::master_sync_in_position>(
      between(-1e12, 1e12),
      "Master's position at which the clutch is closed (ramp_pos), in its unit. Flex Cam: "
      "lrMasterSyncInPos.");
  d.template defaulted<&S::sync_in_passed>(
      "Reaction (ramp_pos) if a master without a turn has less than master_sync_in_distance left to "
      "master_sync_in_position. With a rotary master the clutch closes a turn later.");
  d.template defaulted<&S::master_sync_out_distance>(
      between(0, 1e12),
      "Displacement of the master over which the clutch opens (ramp_pos), in its unit; 0: at once. Flex Cam: "
      "lrMasterSyncOutDist.");
  d.template defaulted<&S::slave_sync_out_position>(unit::u, between(-1e12, 1e12),
                                                    "Position of the slave at rest once the clutch is open (ramp_pos, "
                                                    "ramp_time, ramp_vel_acc). Flex Cam: lrSlaveSyncOutPos.");
  d.template defaulted<&S::sync_in_time_s>(unit::s, between(1e-3, 1e6),
                                           "Duration of closing the clutch (ramp_time). Flex Cam: lrSyncInTime.");
  d.template defaulted<&S::sync_out_time_s>(unit::s, between(1e-3, 1e6),
                                            "Duration of opening the clutch (ramp_time). Flex Cam: lrSyncOutTime.");
  d.template defaulted<&S::sync_out_instant_deceleration>(
      unit::u_s2, factor, "Deceleration of the immediate opening. Flex Cam: lrSyncOutInstantDec.");
  d.template defaulted<&S::sync_velocity>(unit::u_s, factor,
                                          "Velocity of the clutch (ramp_vel_acc). Flex Cam: lrSyncVel.");
  d.template defaulted<&S::sync_acceleration>(unit::u_s2, factor,
                                              "Acceleration of the clutch (ramp_vel_acc). Flex Cam: lrSyncAcc.");
  d.template defaulted<&S::sync_deceleration>(unit::u_s2, factor,
                                              "Deceleration of the clutch (ramp_vel_acc). Flex Cam: lrSyncDec.");
  d.template defaulted<&S::sync_jerk>(unit::u_s3, factor, "Jerk of the clutch (ramp_vel_acc). Flex Cam: lrSyncJerk.");
  d.template defaulted<&S::cam_cyclic>("True: cams run repeatedly; false: once. Flex Cam: xCamCyclic.");
  d.template defaulted<&S::master_absolute>(
      "True: X is the master's position when a cam is started; false: X begins at the beginning of the cam. Flex Cam: "
      "xMasterAbsolute.");
  d.template defaulted<&S::slave_absolute>(
      "True: the slave's position is Y when a cam is started; false: Y begins at the position of the slave. Flex Cam: "
      "xSlaveAbsolute.");
  d.template defaulted<&S::cam_sequence_mode>("Cams that the sequencer runs. Flex Cam: eCamSequenceMode.");
  d.template defaulted<&S::offset_mode_master>(
      "Mode in which a master offset takes effect. Flex Cam: eOffsetModeMaster.");
  d.template defaulted<&S::offset_mode_slave>("Mode in which a slave offset takes effect. Flex Cam: eOffsetModeSlave.");
  d.template defaulted<&S::scaling_mode_master>(
      "Mode in which a master factor takes effect. Flex Cam: eScalingModeMaster.");
  d.template defaulted<&S::scaling_mode_slave>(
      "Mode in which a slave factor takes effect. Flex Cam: eScalingModeSlave.");
  d.template defaulted<&S::offset_scaling_master_velocity>(
      factor, "Velocity of the ramps of X, in its unit per second. Flex Cam: lrOffsetScalingMasterVel.");
  d.template defaulted<&S::offset_scaling_master_acceleration>(
      factor, "Acceleration of the ramps of X, in its unit per second squared. Flex Cam: lrOffsetScalingMasterAcc.");
  d.template defaulted<&S::offset_scaling_master_deceleration>(
      factor, "Deceleration of the ramps of X, in its unit per second squared. Flex Cam: lrOffsetScalingMasterDec.");
  d.template defaulted<&S::offset_scaling_slave_velocity>(
      unit::u_s, factor, "Velocity of the slave's ramps. Flex Cam: lrOffsetScalingSlaveVel.");
  d.template defaulted<&S::offset_scaling_slave_acceleration>(
      unit::u_s2, factor, "Acceleration of the slave's ramps. Flex Cam: lrOffsetScalingSlaveAcc.");
  d.template defaulted<&S::offset_scaling_slave_deceleration>(
      unit::u_s2, factor, "Deceleration of the slave's ramps. Flex Cam: lrOffsetScalingSlaveDec.");
  d.template defaulted<&S::position_control>(
      "Whether ramps of offsets and factors, and a clutch over the master's displacement, may move X and the slave "
      "against the motion of the master. Flex Cam: ePosCtrlDirection.");
  d.template defaulted<&S::calculate_bounds>("True: the extreme values are computed. Flex Cam: xCalcCamBounds.");
  d.template defaulted<&S::master_max_velocity>(
      between(0, 1e12), "Largest speed of the master for the extreme values. Flex Cam: lrMasterMaxVel.");
  d.template defaulted<&S::master_max_acceleration>(
      between(0, 1e12), "Largest acceleration of the master for the extreme values. Flex Cam: lrMasterMaxAcc.");
  d.template defaulted<&S::master_filter_s>(
      unit::s, between(0, 10),
      "Time constant of the filter of a measured master, which has no lag at constant velocity; 0: no filter.");
  d.template defaulted<&S::master_dead_time_s>(
      unit::s, between(0, 1),
      "Dead time of measured masters: their position is extrapolated over it with their velocity and acceleration.");
  d.template defaulted<&S::on_master_fault>("Reaction when the master's position is no longer known.");
  d.template defaulted<&S::virtual_acceleration>(factor,
                                                 "Acceleration of the virtual master, in its unit per second squared.");
  d.template defaulted<&S::virtual_jerk>(factor, "Jerk of the virtual master, in its unit per second cubed.");
}

}  // namespace

void describe(Description<Settings>& d) {
  d.named("FlexCamSettings");
  d.about("Settings of a cam module.");
  DescribeSettings(d);
}

void describe(Description<Configure>& d) {
  d.named("Configure");
  d.about("Changes settings of a cam module; unset settings are kept.");
  DescribeSettings(d);
}

void describe(Enumeration<ClutchMode>& e) {
  e.about("Mode in which the clutch between a cam and its slave closes and opens.");
  e.value(ClutchMode::kAbsolute, "absolute", "At once: the slave moves to Y as fast as its limits allow.");
  e.value(ClutchMode::kRelative, "relative", "At once, with the distance between the slave and Y as an offset.");
  e.value(ClutchMode::kRampPos, "ramp_pos", "On a curve of the fifth degree over a displacement of the master.");
  e.value(ClutchMode::kRampTime, "ramp_time", "On a curve of the fifth degree over a time.");
  e.value(ClutchMode::kRampVelAcc, "ramp_vel_acc",
          "With velocity, ramps and jerk of its own, superimposed on the motion of the cam.");
}

void describe(Enumeration<ClutchDirection>& e) {
  e.about("Direction of the master in which the clutch may begin to close.");
  e.value(ClutchDirection::kNegative, "negative", "Downwards only.");
  e.value(ClutchDirection::kCurrent, "current", "The direction in which it moves.");
  e.value(ClutchDirection::kPositive, "positive", "Upwards only.");
}

void describe(Enumeration<OffsetMode>& e) {
  e.about("Mode in which a new offset takes effect.");
  e.value(OffsetMode::kXZero, "x_zero", "At the beginning of the cam (at its end if the master moves backwards).");
  e.value(OffsetMode::kDirect, "direct", "At once; the slave follows as fast as its limits allow.");
  e.value(OffsetMode::kRampIn, "ramp_in", "With velocity, ramps and jerk of its own.");
}

void describe(Enumeration<ScalingMode>& e) {
  e.about("Mode in which a new scaling factor takes effect.");
  e.value(ScalingMode::kXZero, "x_zero", "At the beginning of the cam (at its end if the master moves backwards).");
  e.value(ScalingMode::kAbsolute, "absolute", "At once, for the whole position.");
  e.value(ScalingMode::kRelative, "relative", "At once, for motion from now on.");
  e.value(ScalingMode::kRampAbsolute, "ramp_absolute",
          "For the whole position, with velocity, ramps and jerk of its own.");
  e.value(ScalingMode::kRampRelative, "ramp_relative", "For motion from now on, with ramps and jerk of its own.");
}

void describe(Enumeration<PositionControl>& e) {
  e.about("Directions in which the slave may be shifted.");
  e.value(PositionControl::kBoth, "both", "In both directions.");
  e.value(PositionControl::kMasterDirection, "master_direction", "Never against the master's motion.");
}

void describe(Enumeration<PassedSync>& e) {
  e.about("Reaction when a master has passed the sync position.");
  e.value(PassedSync::kRefuse, "refuse", "Closing fails with error 3110.");
  e.value(PassedSync::kNextCycle, "next_cycle", "It closes a whole number of cycles of the cam later.");
  e.value(PassedSync::kHere, "here", "It closes over the whole distance from where the master is.");
}

void describe(Enumeration<SequenceMode>& e) {
  e.about("Cams that the sequencer runs.");
  e.value(SequenceMode::kCam1, "cam1", "Cam 1 repeatedly.");
  e.value(SequenceMode::kCam3, "cam3", "Cam 3 repeatedly.");
  e.value(SequenceMode::kCam1Cam3, "cam1_cam3", "Cam 1 once, cam 3 repeatedly; at the end cam 1 once.");
  e.value(SequenceMode::kCam1Cam2Cam3, "cam1_cam2_cam3",
          "Cams 1 and 2 once each, cam 3 repeatedly; at the end cam 4 once, then cam 1 repeatedly.");
}

void describe(Enumeration<MasterFault>& e) {
  e.about("Reaction of a slave when its master's position is no longer known.");
  e.value(MasterFault::kStop, "stop", "It stops along the stop ramp; the module is in error.");
  e.value(MasterFault::kCoast, "coast",
          "The slave continues as if the master kept its last velocity (a decelerating master comes to rest), until "
          "the clutch is opened.");
}

}  // namespace takt::flexcam
