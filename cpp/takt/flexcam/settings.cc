#include "takt/flexcam/settings.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

// One description for the settings and for the command that changes them.
template <template <typename> class Of>
void DescribeSettings(Description<SettingsOf<Of>>& d) {
  using S = SettingsOf<Of>;
  const Range factor = between(1e-9, 1e12);
  d.template defaulted<&S::stop_deceleration>(unit::u_s2, factor, "Of a stop. Flex Cam: lrStopDec.");
  d.template defaulted<&S::stop_jerk>(unit::u_s3, factor, "Of a stop. Flex Cam: lrStopJerk.");
  d.template defaulted<&S::halt_deceleration>(unit::u_s2, factor, "Of a halt. Flex Cam: lrHaltDec.");
  d.template defaulted<&S::jerk>(unit::u_s3, factor,
                                 "Of offset and scaling ramps, the immediate opening and a halt. Flex Cam: lrJerk.");
  d.template defaulted<&S::jog_velocity>(unit::u_s, factor, "Of a jog. Flex Cam: lrJogVel.");
  d.template defaulted<&S::jog_acceleration>(unit::u_s2, factor, "Of a jog. Flex Cam: lrJogAcc.");
  d.template defaulted<&S::jog_deceleration>(unit::u_s2, factor, "Of a jog. Flex Cam: lrJogDec.");
  d.template defaulted<&S::jog_jerk>(unit::u_s3, factor, "Of a jog. Flex Cam: lrJogJerk.");
  d.template defaulted<&S::home_position>(unit::u, between(-1e12, 1e12),
                                          "What the reference is called. Flex Cam: lrHomePosition.");
  d.template defaulted<&S::home_by_module>(
      "True: homing goes by the module's homing section, not by the axis' own. Flex Cam: xUseHomeExtParameter.");
  d.template defaulted<&S::sync_mode>("How the clutch closes and opens. Flex Cam: eSyncMode.");
  d.template defaulted<&S::sync_direction>(
      "In which direction of the master the clutch may begin to close. Flex Cam: eSyncDirection.");
  d.template defaulted<&S::master_sync_in_distance>(
      between(0, 1e12),
      "Way of the master over which the clutch closes (ramp_pos), in its unit; 0: at once, as fast as "
      "the slave's limits allow. Flex Cam: lrMasterSyncInDist.");
  d.template defaulted<&S::master_sync_in_position>(
      between(-1e12, 1e12),
      "Master's position at which the clutch is closed (ramp_pos), in its unit. Flex Cam: "
      "lrMasterSyncInPos.");
  d.template defaulted<&S::sync_in_passed>(
      "What closing (ramp_pos) does where a master without a turn has no room left before master_sync_in_position. A "
      "rotary master closes a turn later.");
  d.template defaulted<&S::master_sync_out_distance>(
      between(0, 1e12),
      "Way of the master over which the clutch opens (ramp_pos), in its unit; 0: at once. Flex Cam: "
      "lrMasterSyncOutDist.");
  d.template defaulted<&S::slave_sync_out_position>(unit::u, between(-1e12, 1e12),
                                                    "Where the slave stands once the clutch is open (ramp_pos, "
                                                    "ramp_time, ramp_vel_acc). Flex Cam: lrSlaveSyncOutPos.");
  d.template defaulted<&S::sync_in_time_s>(unit::s, between(1e-3, 1e6),
                                           "How long the clutch takes to close (ramp_time). Flex Cam: lrSyncInTime.");
  d.template defaulted<&S::sync_out_time_s>(unit::s, between(1e-3, 1e6),
                                            "How long the clutch takes to open (ramp_time). Flex Cam: lrSyncOutTime.");
  d.template defaulted<&S::sync_out_instant_deceleration>(unit::u_s2, factor,
                                                          "Of the immediate opening. Flex Cam: lrSyncOutInstantDec.");
  d.template defaulted<&S::sync_velocity>(unit::u_s, factor, "Of the clutch (ramp_vel_acc). Flex Cam: lrSyncVel.");
  d.template defaulted<&S::sync_acceleration>(unit::u_s2, factor, "Of the clutch (ramp_vel_acc). Flex Cam: lrSyncAcc.");
  d.template defaulted<&S::sync_deceleration>(unit::u_s2, factor, "Of the clutch (ramp_vel_acc). Flex Cam: lrSyncDec.");
  d.template defaulted<&S::sync_jerk>(unit::u_s3, factor, "Of the clutch (ramp_vel_acc). Flex Cam: lrSyncJerk.");
  d.template defaulted<&S::cam_cyclic>("True: cams are run again and again; false: once. Flex Cam: xCamCyclic.");
  d.template defaulted<&S::master_absolute>(
      "True: X is the master's position when a cam is taken up; false: X begins at the cam's beginning. Flex Cam: "
      "xMasterAbsolute.");
  d.template defaulted<&S::slave_absolute>(
      "True: the slave's position is Y when a cam is taken up; false: Y begins where the slave is. Flex Cam: "
      "xSlaveAbsolute.");
  d.template defaulted<&S::cam_sequence_mode>("Which cams the sequencer runs. Flex Cam: eCamSequenceMode.");
  d.template defaulted<&S::offset_mode_master>("When a master offset is taken over. Flex Cam: eOffsetModeMaster.");
  d.template defaulted<&S::offset_mode_slave>("When a slave offset is taken over. Flex Cam: eOffsetModeSlave.");
  d.template defaulted<&S::scaling_mode_master>(
      "When and how a master factor is taken over. Flex Cam: eScalingModeMaster.");
  d.template defaulted<&S::scaling_mode_slave>(
      "When and how a slave factor is taken over. Flex Cam: eScalingModeSlave.");
  d.template defaulted<&S::offset_scaling_master_velocity>(
      factor, "Of the ramps of X, in its unit per second. Flex Cam: lrOffsetScalingMasterVel.");
  d.template defaulted<&S::offset_scaling_master_acceleration>(
      factor, "Of the ramps of X, in its unit per second squared. Flex Cam: lrOffsetScalingMasterAcc.");
  d.template defaulted<&S::offset_scaling_master_deceleration>(
      factor, "Of the ramps of X, in its unit per second squared. Flex Cam: lrOffsetScalingMasterDec.");
  d.template defaulted<&S::offset_scaling_slave_velocity>(unit::u_s, factor,
                                                          "Of the slave's ramps. Flex Cam: lrOffsetScalingSlaveVel.");
  d.template defaulted<&S::offset_scaling_slave_acceleration>(
      unit::u_s2, factor, "Of the slave's ramps. Flex Cam: lrOffsetScalingSlaveAcc.");
  d.template defaulted<&S::offset_scaling_slave_deceleration>(
      unit::u_s2, factor, "Of the slave's ramps. Flex Cam: lrOffsetScalingSlaveDec.");
  d.template defaulted<&S::position_control>(
      "Whether offsets and factors of both sides and a clutch over the master's displacement may move X and the slave "
      "against the master. Flex Cam: ePosCtrlDirection.");
  d.template defaulted<&S::calculate_bounds>("True: the extreme values are worked out. Flex Cam: xCalcCamBounds.");
  d.template defaulted<&S::master_max_velocity>(
      between(0, 1e12), "Largest speed of the master for the extreme values. Flex Cam: lrMasterMaxVel.");
  d.template defaulted<&S::master_max_acceleration>(
      between(0, 1e12), "Largest acceleration of the master for the extreme values. Flex Cam: lrMasterMaxAcc.");
  d.template defaulted<&S::master_filter_s>(
      unit::s, between(0, 10),
      "Time constant of the filter for measured masters; a constant speed passes without lag. 0: no filter.");
  d.template defaulted<&S::master_dead_time_s>(
      unit::s, between(0, 1), "Measured masters are taken to be so much further on, at their speed and acceleration.");
  d.template defaulted<&S::on_master_fault>("What happens when the master's position is no longer known.");
  d.template defaulted<&S::virtual_acceleration>(factor,
                                                 "Of a master without an axis, in its unit per second squared.");
  d.template defaulted<&S::virtual_jerk>(factor, "Of a master without an axis, in its unit per second cubed.");
}

}  // namespace

void describe(Description<Settings>& d) {
  d.named("FlexCamSettings");
  d.about("What is set of a cam module.");
  DescribeSettings(d);
}

void describe(Description<Configure>& d) {
  d.named("Configure");
  d.about("Changes settings of a cam module; what is not given stays.");
  DescribeSettings(d);
}

void describe(Enumeration<ClutchMode>& e) {
  e.about("How the clutch between a cam and its slave closes and opens.");
  e.value(ClutchMode::kAbsolute, "absolute", "At once: the slave gets to Y as fast as its limits allow.");
  e.value(ClutchMode::kRelative, "relative", "At once, with what lies between the slave and Y as an offset.");
  e.value(ClutchMode::kRampPos, "ramp_pos", "On a curve of the fifth degree over a way of the master.");
  e.value(ClutchMode::kRampTime, "ramp_time", "On a curve of the fifth degree over a time.");
  e.value(ClutchMode::kRampVelAcc, "ramp_vel_acc",
          "With velocity, ramps and jerk of its own on top of the cam's motion.");
}

void describe(Enumeration<ClutchDirection>& e) {
  e.about("A direction of the master.");
  e.value(ClutchDirection::kNegative, "negative", "Downwards only.");
  e.value(ClutchDirection::kCurrent, "current", "The one in which it moves.");
  e.value(ClutchDirection::kPositive, "positive", "Upwards only.");
}

void describe(Enumeration<OffsetMode>& e) {
  e.about("How a new offset is taken over.");
  e.value(OffsetMode::kXZero, "x_zero", "Where the cam begins (ends, if the master moves backwards).");
  e.value(OffsetMode::kDirect, "direct", "At once; the slave follows as fast as its limits allow.");
  e.value(OffsetMode::kRampIn, "ramp_in", "With velocity, ramps and jerk of its own.");
}

void describe(Enumeration<ScalingMode>& e) {
  e.about("How a new scaling factor is taken over.");
  e.value(ScalingMode::kXZero, "x_zero", "Where the cam begins (ends, if the master moves backwards).");
  e.value(ScalingMode::kAbsolute, "absolute", "At once, for the whole position.");
  e.value(ScalingMode::kRelative, "relative", "At once, for what is moved from now on.");
  e.value(ScalingMode::kRampAbsolute, "ramp_absolute",
          "For the whole position, with velocity, ramps and jerk of its own.");
  e.value(ScalingMode::kRampRelative, "ramp_relative",
          "For what is moved from now on, with ramps and jerk of its own.");
}

void describe(Enumeration<PositionControl>& e) {
  e.about("How the slave may move while it is being shifted.");
  e.value(PositionControl::kBoth, "both", "Either way.");
  e.value(PositionControl::kMasterDirection, "master_direction", "Never against the master's motion.");
}

void describe(Enumeration<PassedSync>& e) {
  e.about("What happens where a master has passed the sync position.");
  e.value(PassedSync::kRefuse, "refuse", "Closing fails with error 3110.");
  e.value(PassedSync::kNextCycle, "next_cycle", "It closes a whole number of cycles of the cam later.");
  e.value(PassedSync::kHere, "here", "It closes over the whole distance from where the master is.");
}

void describe(Enumeration<SequenceMode>& e) {
  e.about("What the sequencer runs.");
  e.value(SequenceMode::kCam1, "cam1", "Cam 1 again and again.");
  e.value(SequenceMode::kCam3, "cam3", "Cam 3 again and again.");
  e.value(SequenceMode::kCam1Cam3, "cam1_cam3", "Cam 1 once, cam 3 again and again; at the end cam 1 once.");
  e.value(SequenceMode::kCam1Cam2Cam3, "cam1_cam2_cam3",
          "Cams 1 and 2 once each, cam 3 again and again; at the end cam 4 once, then cam 1 again and again.");
}

void describe(Enumeration<MasterFault>& e) {
  e.about("What a slave does whose master is no longer known.");
  e.value(MasterFault::kStop, "stop", "It stops along the stop ramp; the module is in error.");
  e.value(MasterFault::kCoast, "coast",
          "It goes on as if the master kept its last velocity, until the clutch is opened.");
}

}  // namespace takt::flexcam
