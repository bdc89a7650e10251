// The settings of a cam module, which may change at any time: the parameters of the manual's 3.3.4. In doc strings
// "Flex Cam:" gives the name used there. A change takes effect when the setting is next read: that of a clutch mode,
// for instance, when the clutch next closes or opens.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/core/describe_fwd.h"
#include "takt/core/patch.h"

namespace takt::flexcam {

enum class ClutchMode : std::uint8_t { kAbsolute, kRelative, kRampPos, kRampTime, kRampVelAcc };
// Sense of the master in which the clutch may close.
enum class ClutchDirection : std::uint8_t { kNegative, kCurrent, kPositive };
enum class OffsetMode : std::uint8_t { kXZero, kDirect, kRampIn };
enum class ScalingMode : std::uint8_t { kXZero, kAbsolute, kRelative, kRampAbsolute, kRampRelative };
// How ramps of the X axis and a clutch over the master's displacement may move.
enum class PositionControl : std::uint8_t { kBoth, kMasterDirection };
// Behaviour of a clutch over the master's displacement if a linear master has passed the sync position.
enum class PassedSync : std::uint8_t { kRefuse, kNextCycle, kHere };
enum class SequenceMode : std::uint8_t { kCam1, kCam3, kCam1Cam3, kCam1Cam2Cam3 };
// Reaction of the slave when its master's position is lost.
enum class MasterFault : std::uint8_t { kStop, kCoast };

template <template <typename> class Of>
struct SettingsOf {
  // Ramps [u/s²] and [u/s³], limited to the slave's own limits.
  Of<double> stop_deceleration = Preset<Of>(10'000.0);
  Of<double> stop_jerk = Preset<Of>(100'000.0);
  Of<double> halt_deceleration = Preset<Of>(3'600.0);
  Of<double> jerk = Preset<Of>(100'000.0);
  Of<double> jog_velocity = Preset<Of>(10.0);
  Of<double> jog_acceleration = Preset<Of>(100.0);
  Of<double> jog_deceleration = Preset<Of>(100.0);
  Of<double> jog_jerk = Preset<Of>(10'000.0);

  Of<double> home_position = Preset<Of>(0.0);  // [u]
  Of<bool> home_by_module = Preset<Of>(false);

  // The clutch.
  Of<ClutchMode> sync_mode = Preset<Of>(ClutchMode::kAbsolute);
  Of<ClutchDirection> sync_direction = Preset<Of>(ClutchDirection::kCurrent);
  Of<double> master_sync_in_distance = Preset<Of>(100.0);  // [master's u]
  Of<double> master_sync_in_position = Preset<Of>(0.0);    // [master's u]
  Of<PassedSync> sync_in_passed = Preset<Of>(PassedSync::kRefuse);
  Of<double> master_sync_out_distance = Preset<Of>(100.0);  // [master's u]
  Of<double> slave_sync_out_position = Preset<Of>(0.0);     // [u]
  Of<double> sync_in_time_s = Preset<Of>(5.0);
  Of<double> sync_out_time_s = Preset<Of>(5.0);
  Of<double> sync_out_instant_deceleration = Preset<Of>(10'000.0);  // [u/s²]
  Of<double> sync_velocity = Preset<Of>(100.0);                     // [u/s]
  Of<double> sync_acceleration = Preset<Of>(1'000.0);
  Of<double> sync_deceleration = Preset<Of>(1'000.0);
  Of<double> sync_jerk = Preset<Of>(1'000'000.0);

  // The cam.
  Of<bool> cam_cyclic = Preset<Of>(true);
  Of<bool> master_absolute = Preset<Of>(true);
  Of<bool> slave_absolute = Preset<Of>(false);
  Of<SequenceMode> cam_sequence_mode = Preset<Of>(SequenceMode::kCam1);

  // Scaling and offset.
  Of<OffsetMode> offset_mode_master = Preset<Of>(OffsetMode::kXZero);
  Of<OffsetMode> offset_mode_slave = Preset<Of>(OffsetMode::kXZero);
  Of<ScalingMode> scaling_mode_master = Preset<Of>(ScalingMode::kXZero);
  Of<ScalingMode> scaling_mode_slave = Preset<Of>(ScalingMode::kXZero);
  Of<double> offset_scaling_master_velocity = Preset<Of>(100.0);  // [x/s] ...
  Of<double> offset_scaling_master_acceleration = Preset<Of>(1'000.0);
  Of<double> offset_scaling_master_deceleration = Preset<Of>(1'000.0);
  Of<double> offset_scaling_slave_velocity = Preset<Of>(100.0);  // [u/s] ...
  Of<double> offset_scaling_slave_acceleration = Preset<Of>(1'000.0);
  Of<double> offset_scaling_slave_deceleration = Preset<Of>(1'000.0);
  Of<PositionControl> position_control = Preset<Of>(PositionControl::kBoth);

  // Extreme values.
  Of<bool> calculate_bounds = Preset<Of>(false);
  Of<double> master_max_velocity = Preset<Of>(100.0);        // [master's u/s]
  Of<double> master_max_acceleration = Preset<Of>(1'000.0);  // master's u/s²

  // The master. Not in the manual.
  Of<double> master_filter_s = Preset<Of>(0.0);     // [s] time constant for measured positions; 0: no filter
  Of<double> master_dead_time_s = Preset<Of>(0.0);  // [s] age of measured positions, which is compensated
  Of<MasterFault> on_master_fault = Preset<Of>(MasterFault::kStop);
  Of<double> virtual_acceleration = Preset<Of>(1'000.0);  // of a master without an axis, master's u/s²
  Of<double> virtual_jerk = Preset<Of>(10'000.0);
};
using Settings = SettingsOf<Plain>;
// The command that changes the settings that are given.
using Configure = SettingsOf<std::optional>;

void describe(Enumeration<ClutchMode>&);
void describe(Enumeration<ClutchDirection>&);
void describe(Enumeration<OffsetMode>&);
void describe(Enumeration<ScalingMode>&);
void describe(Enumeration<PositionControl>&);
void describe(Enumeration<PassedSync>&);
void describe(Enumeration<SequenceMode>&);
void describe(Enumeration<MasterFault>&);
void describe(Description<Settings>&);
void describe(Description<Configure>&);

}  // namespace takt::flexcam
