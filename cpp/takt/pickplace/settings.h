// What can be set of a pick and place module at run time: the parameters of the manual's 3.6.5 and 3.6.6 with its
// initial values; "T&P:" in the doc strings is the name there.
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
// Who chooses targets.
enum class TrackingMode : std::uint8_t {
  kProgram,        // each edge of execute brings one
  kStaticToBelt1,  // the others go round and round by themselves
  kBelt1ToStatic,
  kBelt1ToBelt2,
  kBelt2ToBelt1,
  kFromTo,  // from pick_belt to place_belt
};
// Which workpiece of those that can be reached.
enum class WorkpieceRule : std::uint8_t {
  kFirst,    // furthest along the belt
  kNearest,  // to the tool
  kLatest,   // the last one that can still be reached: the others get further on meanwhile
};

template <template <typename> class Of>
struct SettingsOf {
  // Stops along the path; a deceleration below that of the path counts for nothing.
  Of<double> path_stop_deceleration = Preset<Of>(10'000.0);
  Of<double> path_stop_jerk = Preset<Of>(100'000.0);
  Of<double> path_halt_deceleration = Preset<Of>(100.0);
  Of<double> path_jerk = Preset<Of>(100'000.0);
  Of<double> path_velocity = Preset<Of>(10.0);
  Of<double> path_acceleration = Preset<Of>(100.0);
  Of<double> path_deceleration = Preset<Of>(100.0);
  // Of each axis by itself.
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

  // Of the tool along X, Y, Z and about them, and of Aux1, on profiles; 0: none.
  Of<std::array<double, kProfileAxes>> max_velocity = Preset<Of>(Filled<double, kProfileAxes>(10.0));
  Of<std::array<double, kProfileAxes>> max_acceleration = Preset<Of>(Filled<double, kProfileAxes>(100.0));
  Of<std::array<double, kProfileAxes>> max_jerk = Preset<Of>(Filled<double, kProfileAxes>(10'000.0));

  Of<double> gripper_closing_time = Preset<Of>(0.0);  // s
  Of<double> gripper_open_time = Preset<Of>(0.0);     // s

  // The static target, and how profiles run.
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
  Of<double> position_window = Preset<Of>(0.5);  // mm
  Of<double> position_window_ms = Preset<Of>(50.0);

  Of<TrackingMode> tracking_mode = Preset<Of>(TrackingMode::kProgram);

  // Beyond the manual.
  Of<std::uint32_t> pick_belt = Preset<Of>(std::uint32_t{0});   // of from_to; 0: the static place
  Of<std::uint32_t> place_belt = Preset<Of>(std::uint32_t{0});  // likewise
  Of<WorkpieceRule> workpiece_rule = Preset<Of>(WorkpieceRule::kFirst);
  Of<bool> keep_orientation = Preset<Of>(false);                     // targets do not turn the tool: it has no wrist
  Of<std::uint32_t> workpiece_pcs1 = Preset<Of>(std::uint32_t{15});  // the two that workpieces get in turn
  Of<std::uint32_t> workpiece_pcs2 = Preset<Of>(std::uint32_t{16});
};
using Settings = SettingsOf<Plain>;
// The command that changes what is given of them.
using Configure = SettingsOf<std::optional>;

// Of one belt. Its origin is the belt's own.
template <template <typename> class Of>
struct BeltSettingsOf {
  Of<std::uint32_t> belt = Preset<Of>(std::uint32_t{1});  // of the module's list, from 1
  Of<double> park_x = Preset<Of>(0.0);
  Of<double> park_y = Preset<Of>(0.0);
  Of<double> park_z = Preset<Of>(0.0);
  Of<double> park_a = Preset<Of>(0.0);
  Of<double> park_b = Preset<Of>(0.0);
  Of<double> park_c = Preset<Of>(0.0);
  Of<double> z_distance = Preset<Of>(0.0);   // mm
  Of<double> sync_time = Preset<Of>(0.0);    // s
  Of<double> lower_limit = Preset<Of>(0.0);  // mm, along X of the belt
  Of<double> upper_limit = Preset<Of>(0.0);
  // What the belt may do while a workpiece is gone for, mm/s along its X: at least from its present speed to 0.
  Of<double> lowest_speed = Preset<Of>(0.0);
  Of<double> highest_speed = Preset<Of>(0.0);
  Of<double> sudden_acceleration = Preset<Of>(0.0);  // mm/s², of the belt without notice
  // Which workpieces are taken; beyond the manual.
  Of<std::uint32_t> kind = Preset<Of>(std::uint32_t{0});    // 0: any
  Of<std::uint32_t> colour = Preset<Of>(std::uint32_t{0});  // 0: any
  Of<double> least_quality = Preset<Of>(-1e9);
  // How several modules share a belt: which of its workpieces are this one's.
  Of<std::uint32_t> every = Preset<Of>(std::uint32_t{1});  // of so many one behind the other ...
  Of<std::uint32_t> turn = Preset<Of>(std::uint32_t{1});   // ... those from this one on, from 1, ...
  Of<std::uint32_t> turns = Preset<Of>(std::uint32_t{1});  // ... so many
  Of<double> most_per_minute = Preset<Of>(0.0);            // 0: any number
  Of<std::uint32_t> leave = Preset<Of>(std::uint32_t{0});  // so many lie free behind its range before it takes one
  Of<double> same_within = Preset<Of>(2.0);  // mm: what lies so near to a workpiece that was fetched is that one
  // How the tool stands on a workpiece; beyond the manual.
  Of<double> grip_x = Preset<Of>(0.0);
  Of<double> grip_y = Preset<Of>(0.0);
  Of<double> grip_z = Preset<Of>(0.0);
  Of<double> grip_a = Preset<Of>(0.0);
  Of<double> grip_b = Preset<Of>(0.0);
  Of<double> grip_c = Preset<Of>(0.0);
  Of<double> aux1_target = Preset<Of>(0.0);
};
using BeltSettings = BeltSettingsOf<Plain>;
// The command that changes what is given of them.
using ConfigureBelt = BeltSettingsOf<std::optional>;

// workpiece_pcs1 and workpiece_pcs2 differ.
bool WorkpieceSystemsFit(const Settings& settings) noexcept;
// The static target does not lie in a product coordinate system that workpieces get.
bool TargetSystemFits(const Settings& settings) noexcept;
// The static target is not seen from the axes.
bool TargetFits(const Settings& settings) noexcept;
// The workpieces that a module takes in turn are among those of a round.
bool TurnsFit(const BeltSettings& settings) noexcept;
// It has a work range of its own; else that of the belt alone counts.
bool HasRange(const BeltSettings& settings) noexcept;
// It has none, or lower_limit lies below upper_limit.
bool RangeFits(const BeltSettings& settings) noexcept;
// It counts free workpieces behind its range and has a range of its own, or does not count them.
bool LeaveFits(const BeltSettings& settings) noexcept;
// It counts none, or counts them between the end of its range and that of the belt, which deletes what lies beyond.
bool LeaveMeets(const BeltSettings& settings, const conveyor::BeltParams& belt) noexcept;
// It has none that fits, or one that overlaps the belt's own.
bool RangeMeets(const BeltSettings& settings, const conveyor::BeltParams& belt) noexcept;

void describe(Enumeration<PathMode>&);
void describe(Enumeration<TrackingMode>&);
void describe(Enumeration<WorkpieceRule>&);
void describe(Description<Settings>&);
void describe(Description<Configure>&);
void describe(Description<BeltSettings>&);
void describe(Description<ConfigureBelt>&);

}  // namespace takt::pickplace
