// CAM-11: every input, output and parameter of the manual's 3.3.2 to 3.3.4 and its signal flow has a counterpart.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "bench.h"
#include "takt/core/describe.h"

namespace takt::flexcam {
namespace {

// Collects the names of the manual to which the fields of a type refer.
void Collect(const Type& type, std::set<std::string>& names) {
  const auto take = [&](std::string_view about) {
    const std::string_view key = "Flex Cam: ";
    const std::size_t at = about.find(key);
    if (at == std::string_view::npos) return;
    std::string rest(about.substr(at + key.size()));
    for (std::size_t i = 0; i < rest.size();) {
      const std::size_t end = rest.find_first_of(",. ", i);
      if (end > i) names.insert(rest.substr(i, end - i));
      i = end == std::string::npos ? rest.size() : end + 1;
    }
  };
  take(type.about);
  for (const Field& field : type.fields) take(field.about);
}

std::set<std::string> Named() {
  std::set<std::string> names;
  for (const Type* type :
       {&TypeOf<Inputs>(), &TypeOf<Jog>(), &TypeOf<SetCam>(), &TypeOf<Settings>(), &TypeOf<Outputs>()}) {
    Collect(*type, names);
  }
  return names;
}

TEST(Names, OfTheManualAreAllThere) {
  const std::set<std::string> named = Named();
  for (const char* name :
       {// Inputs. scCtrlABC: commands of the slave itself (SERVICE); scPar: the settings; eSetCamTable and four tables.
        "xEnableInternalControl", "xEnable", "xResetError", "xRegulatorOn", "xStop", "xHalt", "xJogPos", "xJogNeg",
        "xHomeExecute", "xHomeAbsSwitch", "xEnableHWLimit", "xHWLimitPos", "xHWLimitNeg", "xSyncCam", "xSyncOutInstant",
        "xCamChangeInstant", "lrSetOffsetMaster", "lrSetOffsetSlave", "lrSetScalingMaster", "lrSetScalingSlave",
        "CamTable1", "eSetCamTable", "xCamSequencer",
        // Outputs. scStatusABC: what the slave publishes; scErrorInfo: the text of the error.
        "xInternalControlActive", "eTMState", "xError", "xWarning", "eErrorID", "scSignalFlow", "xAxisEnabled", "xDone",
        "xBusy", "xIsHomed", "lrSetOffsetMasterOut", "lrSetOffsetSlaveOut", "xHwLimitSwitchPos", "xHwLimitSwitchNeg",
        "xSwLimitEnabled", "xSwLimitSwitchActive", "xCamSynchronised", "xAccDecSync", "xEndOfProfile", "lrSetXPosOut",
        "lrSetXVelOut", "lrSetXAccOut", "lrSetYPosOut", "lrSetYVelOut", "lrSetYAccOut", "lrActSlavePos",
        "lrActSlaveVel", "lrSlaveMaxPos", "lrSlaveMinPos", "lrSlaveMaxVel", "lrSlaveMaxAcc", "eSetCamTableOut",
        "xCamSequencerActive",
        // Parameters. scHomeExtParameter: the section homing; scHomeExtTP: the slave's own touch probe.
        "lrStopDec", "lrStopJerk", "lrHaltDec", "lrJerk", "lrJogJerk", "lrJogVel", "lrJogAcc", "lrJogDec",
        "lrHomePosition", "xUseHomeExtParameter", "eSyncMode", "eSyncDirection", "lrMasterSyncInDist",
        "lrMasterSyncInPos", "lrMasterSyncOutDist", "lrSlaveSyncOutPos", "lrSyncInTime", "lrSyncOutTime",
        "lrSyncOutInstantDec", "lrSyncVel", "lrSyncAcc", "lrSyncDec", "lrSyncJerk", "xCamCyclic", "xMasterAbsolute",
        "xSlaveAbsolute", "eOffsetModeMaster", "eOffsetModeSlave", "lrOffsetScalingMasterVel",
        "lrOffsetScalingMasterAcc", "lrOffsetScalingMasterDec", "eScalingModeMaster", "eScalingModeSlave",
        "lrOffsetScalingSlaveVel", "lrOffsetScalingSlaveAcc", "lrOffsetScalingSlaveDec", "xCalcCamBounds",
        "lrMasterMaxVel", "lrMasterMaxAcc", "ePosCtrlDirection", "eCamSequenceMode"}) {
    EXPECT_TRUE(named.contains(name)) << name;
  }
  const Type& outputs = TypeOf<Outputs>();
  for (const char* point : {"ip01_", "ip02_", "ip03_", "ip04_", "ip05_", "ip06_", "ip07_", "ip08_", "ip09_", "ip10_",
                            "ip11_", "mp01_", "mp02_", "mp03_", "mp04_", "mp05_", "mp06_", "op01_", "op02_"}) {
    const bool there = std::ranges::any_of(outputs.fields, [&](const Field& f) { return f.name.starts_with(point); });
    EXPECT_TRUE(there) << point;
  }
}

// CAM-11: initial values.
TEST(Names, InitialValuesAreThoseOfTheManual) {
  const Settings s;
  EXPECT_EQ(s.stop_deceleration, 10000);
  EXPECT_EQ(s.stop_jerk, 100000);
  EXPECT_EQ(s.halt_deceleration, 3600);
  EXPECT_EQ(s.jerk, 100000);
  EXPECT_EQ(s.jog_jerk, 10000);
  EXPECT_EQ(s.jog_velocity, 10);
  EXPECT_EQ(s.jog_acceleration, 100);
  EXPECT_EQ(s.jog_deceleration, 100);
  EXPECT_EQ(s.sync_mode, ClutchMode::kAbsolute);
  EXPECT_EQ(s.sync_direction, ClutchDirection::kCurrent);
  EXPECT_EQ(s.master_sync_in_distance, 100);
  EXPECT_EQ(s.master_sync_out_distance, 100);
  EXPECT_EQ(s.sync_in_time_s, 5);
  EXPECT_EQ(s.sync_out_time_s, 5);
  EXPECT_EQ(s.sync_out_instant_deceleration, 10000);
  EXPECT_EQ(s.sync_velocity, 100);
  EXPECT_EQ(s.sync_acceleration, 1000);
  EXPECT_EQ(s.sync_deceleration, 1000);
  EXPECT_EQ(s.sync_jerk, 1000000);
  EXPECT_TRUE(s.cam_cyclic);
  EXPECT_TRUE(s.master_absolute);
  EXPECT_FALSE(s.slave_absolute);
  EXPECT_EQ(s.offset_mode_master, OffsetMode::kXZero);
  EXPECT_EQ(s.scaling_mode_slave, ScalingMode::kXZero);
  EXPECT_EQ(s.offset_scaling_master_velocity, 100);
  EXPECT_EQ(s.offset_scaling_slave_acceleration, 1000);
  EXPECT_EQ(s.master_max_velocity, 100);
  EXPECT_EQ(s.master_max_acceleration, 1000);
  EXPECT_EQ(s.position_control, PositionControl::kBoth);
  EXPECT_EQ(s.cam_sequence_mode, SequenceMode::kCam1);
  const Inputs in;
  EXPECT_EQ(in.cam_table, 1u);
  EXPECT_EQ(in.scaling_master, 1);
  EXPECT_EQ(in.scaling_slave, 1);
  EXPECT_EQ(in.offset_master, 0);
}

// CAM-11: the points of the signal flow, in order.
TEST(SignalFlow, IsPublished) {
  Settings s;
  s.slave_absolute = true;
  s.sync_mode = ClutchMode::kRampTime;
  s.sync_in_time_s = 0.1;
  Bench b(MachineOf({Onward("index", 40)}, s));
  b.Tell(Control{.offset_master = 10.0, .offset_slave = 3.0, .scaling_master = 2.0, .scaling_slave = 1.5});
  b.Step();
  b.Web(300);
  ASSERT_TRUE(b.Sync());
  b.Run(777);
  const Outputs& o = b.Module();
  EXPECT_EQ(o.ip01_set_scaling_master, 2);
  EXPECT_EQ(o.ip03_set_offset_master, 10);
  EXPECT_EQ(o.ip04_set_offset_slave, 3);
  EXPECT_EQ(o.ip06_set_scaling_slave, 1.5);
  EXPECT_EQ(o.ip08_cam_table1, 1u);
  EXPECT_EQ(o.ip09_cam_table2, 0u);
  EXPECT_EQ(o.mp01_set_master_position, b.TheWeb().set_position);
  EXPECT_EQ(o.mp02_set_slave_position, b.Knife().set_position);
  const double x = 2 * o.mp01_set_master_position + 10;
  EXPECT_NEAR(o.mp03_master_to_x_position - x, 720 * std::round((o.mp03_master_to_x_position - x) / 720), 1e-9);
  EXPECT_EQ(o.op01_set_x_position_out, o.set_x_position);
  EXPECT_NEAR(o.mp04_cam_profiler_position_out, 40 * engine::Polynomial345::Y(o.set_x_position / 360), 1e-9);
  EXPECT_EQ(o.op02_set_y_position_out, o.mp04_cam_profiler_position_out);
  const double strokes = (o.mp05_set_y_position - o.mp04_cam_profiler_position_out) / 40;
  EXPECT_NEAR(strokes, std::round(strokes), 1e-9);
  EXPECT_GE(strokes, 1);
  EXPECT_NEAR(o.mp06_y_to_slave_position, 1.5 * o.mp05_set_y_position + 3, 1e-9);
  EXPECT_NEAR(o.mp02_set_slave_position, o.mp06_y_to_slave_position, 1e-9);
}

}  // namespace
}  // namespace takt::flexcam
