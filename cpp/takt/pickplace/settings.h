// Settings of a pick and place module at run time: the parameters of the manual's 3.6.5 and 3.6.6 with its initial
// values; "T&P:" in the doc strings gives their names there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "takt/conveyor/params.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/patch.h"
#include "takt/group/commands.h"
#include "takt/pickplace/places.h"

namespace takt::pickplace {

inline constexpr std::size_t kBelts = 16;

enum class PathMode : std::uint8_t { kLinear, kElliptical };
// How targets are chosen.
enum class TrackingMode : std::uint8_t {
  kProgram,        // each rising edge of execute gives one
  kStaticToBelt1,  // this and the following modes repeat by themselves
  kBelt1ToStatic,
  kBelt1ToBelt2,
  kBelt2ToBelt1,
  kFromTo,  // from pick_belt to place_belt
};
// Choice among the workpieces that can be reached.
enum class WorkpieceRule : std::uint8_t {
  kFirst,    // furthest along the belt
  kNearest,  // nearest to the tool
  kLatest,   // least far along the belt: the others move on meanwhile
};

template <template <typename> class Of>
struct SettingsOf {
  // Stops along the path; a deceleration below that of the path has no effect.
  Of<double> path_stop_deceleration = Preset<Of>(10'000.0);
  Of<double> path_stop_jerk = Preset<Of>(100'000.0);
  Of<double> path_halt_deceleration = Preset<Of>(100.0);
  Of<double> path_jerk = Preset<Of>(100'000.0);
  Of<double> path_velocity = Preset<Of>(10.0);
  Of<double> path_acceleration = Preset<Of>(100.0);
  Of<double> path_deceleration = Preset<Of>(100.0);
  // Stop of each axis by itself.
  Of<std::array<double, kAllAxes>> stop_deceleration = Preset<Of>(Filled<double, kAllAxes>(10'000.0));
  Of<std::array<double, kAllAxes>> stop_jerk = Preset<Of>(Filled<double, kAllAxes>(100'000.0));

  Of<double> cartesian_jog_velocity = Preset<Of>(10.0);
  Of<double> cartesian_jog_acceleration = Preset<Of>(100.0);
  Of<double> cartesian_jog_deceleration = Preset<Of>(100.0);
  Of<double> cartesian_jog_jerk = Preset<Of>(10'000.0);
  Of<double> orientation_jog_velocity = Preset<Of>(10.0);
  Of<double> orientation_jog_acceleration = Preset<Of>(100.0);
  Of<double> orientation_jog_deceleration = Preset<Of>(100.0);
  Of<double> orientation_jog_jerk = Preset<Of>(10'000.0);
  Of<double> real_axis_jog_velocity = Preset<Of>(10.0);
  Of<double> real_axis_jog_acceleration = Preset<Of>(100.0);
  Of<double> real_axis_jog_deceleration = Preset<Of>(100.0);
  Of<double> real_axis_jog_jerk = Preset<Of>(10'000.0);

  Of<std::array<double, kRealAxes>> home_position = Preset<Of>(std::array<double, kRealAxes>{});
  Of<std::array<std::uint32_t, kRealAxes>> homing_order = Preset<Of>(std::array<std::uint32_t, kRealAxes>{});
  Of<bool> home_by_module = Preset<Of>(false);

  // Limits of the tool along and about X, Y, Z, and of Aux1, on profiles; 0: no limit.
  Of<std::array<double, kProfileAxes>> max_velocity = Preset<Of>(Filled<double, kProfileAxes>(10.0));
  Of<std::array<double, kProfileAxes>> max_acceleration = Preset<Of>(Filled<double, kProfileAxes>(100.0));
  Of<std::array<double, kProfileAxes>> max_jerk = Preset<Of>(Filled<double, kProfileAxes>(10'000.0));

  Of<double> gripper_closing_time = Preset<Of>(0.0);  // [s]
  Of<double> gripper_open_time = Preset<Of>(0.0);     // [s]

  // The static target, and the parameters of profiles.
  Of<double> x_target = Preset<Of>(0.0);
  Of<double> y_target = Preset<Of>(0.0);
  Of<double> z_target = Preset<Of>(0.0);
  Of<double> a_target = Preset<Of>(180.0);
  Of<double> b_target = Preset<Of>(0.0);
  Of<double> c_target = Preset<Of>(0.0);
  Of<double> aux1_target = Preset<Of>(0.0);
  Of<group::CoordinateSystem> target_coordinate_system = Preset<Of>(group::CoordinateSystem::kMcs);
  Of<std::uint32_t> target_pcs = Preset<Of>(std::uint32_t{1});
  Of<double> z_start_distance = Preset<Of>(0.0);
  Of<double> z_target_distance = Preset<Of>(0.0);
  Of<PathMode> path_mode = Preset<Of>(PathMode::kLinear);
  Of<double> z_elliptical = Preset<Of>(0.0);
  Of<double> blending_radius = Preset<Of>(0.0);

  Of<bool> watch_position_window = Preset<Of>(false);
  Of<double> position_window = Preset<Of>(0.5);  // [mm]
  Of<double> position_window_ms = Preset<Of>(50.0);

  Of<TrackingMode> tracking_mode = Preset<Of>(TrackingMode::kProgram);

  // Not in the manual.
  Of<std::uint32_t> pick_belt = Preset<Of>(std::uint32_t{0});   // from_to: belt to pick from; 0: the static target
  Of<std::uint32_t> place_belt = Preset<Of>(std::uint32_t{0});  // from_to: belt to place on; 0: the static target
  Of<WorkpieceRule> workpiece_rule = Preset<Of>(WorkpieceRule::kFirst);
  Of<bool> keep_orientation = Preset<Of>(false);  // targets do not turn the tool: it has no wrist
  // The two systems assigned to workpieces alternately.
  Of<std::uint32_t> workpiece_pcs1 = Preset<Of>(std::uint32_t{15});
  Of<std::uint32_t> workpiece_pcs2 = Preset<Of>(std::uint32_t{16});
};
using Settings = SettingsOf<Plain>;
// The command that changes those settings that are given.
using Configure = SettingsOf<std::optional>;

// Settings of one belt. Its origin is the belt's own.
template <template <typename> class Of>
struct BeltSettingsOf {
  Of<std::uint32_t> belt = Preset<Of>(std::uint32_t{1});  // index in the module's list, from 1
  Of<double> park_x = Preset<Of>(0.0);
  Of<double> park_y = Preset<Of>(0.0);
  Of<double> park_z = Preset<Of>(0.0);
  Of<double> park_a = Preset<Of>(0.0);
  Of<double> park_b = Preset<Of>(0.0);
  Of<double> park_c = Preset<Of>(0.0);
  Of<double> z_distance = Preset<Of>(0.0);   // [mm]
  Of<double> sync_time = Preset<Of>(0.0);    // [s]
  Of<double> lower_limit = Preset<Of>(0.0);  // [mm] along X of the belt
  Of<double> upper_limit = Preset<Of>(0.0);
  // Range of speeds that the belt may take while a workpiece is approached [mm/s along its X]; extended to the present
  // speed.
  Of<double> lowest_speed = Preset<Of>(0.0);
  Of<double> highest_speed = Preset<Of>(0.0);
  Of<double> sudden_acceleration = Preset<Of>(0.0);  // [mm/s²] of the belt without notice
  // Workpieces that are taken; not in the manual.
  Of<std::uint32_t> kind = Preset<Of>(std::uint32_t{0});    // 0: any
  Of<std::uint32_t> colour = Preset<Of>(std::uint32_t{0});  // 0: any
  Of<double> least_quality = Preset<Of>(-1e9);
  // Sharing a belt with other modules: the workpieces of this module.
  Of<std::uint32_t> every = Preset<Of>(std::uint32_t{1});  // of this many consecutive workpieces ...
  Of<std::uint32_t> turn = Preset<Of>(std::uint32_t{1});   // ... those from this one on, from 1, ...
  Of<std::uint32_t> turns = Preset<Of>(std::uint32_t{1});  // ... this many
  Of<double> most_per_minute = Preset<Of>(0.0);            // 0: any number
  // Takes a workpiece only while this many free ones are behind its range.
  Of<std::uint32_t> leave = Preset<Of>(std::uint32_t{0});
  Of<double> same_within = Preset<Of>(2.0);  // [mm] objects this close to a fetched workpiece are the same one
  // Pose of the tool on a workpiece; not in the manual.
  Of<double> grip_x = Preset<Of>(0.0);
  Of<double> grip_y = Preset<Of>(0.0);
  Of<double> grip_z = Preset<Of>(0.0);
  Of<double> grip_a = Preset<Of>(0.0);
  Of<double> grip_b = Preset<Of>(0.0);
  Of<double> grip_c = Preset<Of>(0.0);
  Of<double> aux1_target = Preset<Of>(0.0);
};
using BeltSettings = BeltSettingsOf<Plain>;
// The command that changes those settings that are given.
using ConfigureBelt = BeltSettingsOf<std::optional>;

// Returns true if workpiece_pcs1 and workpiece_pcs2 differ.
bool WorkpieceSystemsFit(const Settings& settings) noexcept;
// Returns true if the static target is not given in a product coordinate system of workpieces.
bool TargetSystemFits(const Settings& settings) noexcept;
// Returns true if the static target is not given in ACS.
bool TargetFits(const Settings& settings) noexcept;
// Returns true if the workpieces that a module takes in turn are among those of a round.
bool TurnsFit(const BeltSettings& settings) noexcept;
// Returns true if the module has a work range of its own; else only that of the belt counts.
bool HasRange(const BeltSettings& settings) noexcept;
// Returns true if lower_limit lies below upper_limit, or there is no range.
bool RangeFits(const BeltSettings& settings) noexcept;
// Returns true if `leave` is 0, or the module has a range of its own behind which it counts free workpieces.
bool LeaveFits(const BeltSettings& settings) noexcept;
// Returns true if free workpieces need not be counted, or are counted between the end of the module's range and that of
// the belt, which deletes objects beyond it.
bool LeaveMeets(const BeltSettings& settings, const conveyor::BeltParams& belt) noexcept;
// Returns true if the range overlaps the belt's own; also if there is none, or an invalid one (RangeFits).
bool RangeMeets(const BeltSettings& settings, const conveyor::BeltParams& belt) noexcept;

void describe(Enumeration<PathMode>&);
void describe(Enumeration<TrackingMode>&);
void describe(Enumeration<WorkpieceRule>&);
void describe(Description<Settings>&);
void describe(Description<Configure>&);
void describe(Description<BeltSettings>&);
void describe(Description<ConfigureBelt>&);

}  // namespace takt::pickplace
