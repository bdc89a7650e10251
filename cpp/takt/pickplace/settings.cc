#include "takt/pickplace/settings.h"

#include "takt/conveyor/state.h"
#include "takt/core/describe.h"

namespace takt::pickplace {

namespace {

constexpr Range kStrong = between(1e-6, 1e12);
constexpr Range kFromZero = between(0, 1e12);
constexpr Range kPositions = between(-1e9, 1e9);

// Described once, for the settings and for the command that changes them.
template <template <typename> class Of>
void DescribeSettings(Description<SettingsOf<Of>>& d) {
  using S = SettingsOf<Of>;
  d.template defaulted<&S::path_stop_deceleration>(
      unit::mm_s2, kStrong,
      "Deceleration of path_stop and path_interrupt, if it is larger than that of the path. T&P: lrPathStopDec.");
  d.template defaulted<&S::path_stop_jerk>(unit::mm_s3, kStrong,
                                           "Jerk of path_stop and path_interrupt. T&P: lrPathStopJerk.");
  d.template defaulted<&S::path_halt_deceleration>(
      unit::mm_s2, kStrong, "Deceleration of path_halt, if it is larger than that of the path. T&P: lrPathHaltDec.");
  d.template defaulted<&S::path_jerk>(unit::mm_s3, kStrong, "Jerk of profiles and of path_halt. T&P: lrPathJerk.");
  d.template defaulted<&S::path_velocity>(unit::mm_s, kStrong, "Largest speed of profiles. T&P: lrPathVel.");
  d.template defaulted<&S::path_acceleration>(unit::mm_s2, kStrong, "Acceleration of profiles. T&P: lrPathAcc.");
  d.template defaulted<&S::path_deceleration>(unit::mm_s2, kStrong, "Deceleration of profiles. T&P: lrPathDec.");
  d.template defaulted<&S::stop_deceleration>(
      kStrong,
      "Individual deceleration of each axis with stop_all and at the module's limit switches, u/s²: X, Y, Z, A, B, C, "
      "A1 to A6, Aux1; only those of real axes apply, up to the axis' own limit. T&P: alrStopDec.");
  d.template defaulted<&S::stop_jerk>(kStrong, "Jerk likewise, u/s³. T&P: alrStopJerk.");
  d.template defaulted<&S::cartesian_jog_velocity>(unit::mm_s, kStrong,
                                                   "Velocity of a jog of X, Y and Z. T&P: lrCartesianJogVel.");
  d.template defaulted<&S::cartesian_jog_acceleration>(unit::mm_s2, kStrong,
                                                       "Acceleration of a jog of X, Y and Z. T&P: lrCartesianJogAcc.");
  d.template defaulted<&S::cartesian_jog_deceleration>(unit::mm_s2, kStrong,
                                                       "Deceleration of a jog of X, Y and Z. T&P: lrCartesianJogDec.");
  d.template defaulted<&S::cartesian_jog_jerk>(unit::mm_s3, kStrong,
                                               "Jerk of a jog of X, Y and Z. T&P: lrCartesianJogJerk.");
  d.template defaulted<&S::orientation_jog_velocity>(unit::deg_s, kStrong,
                                                     "Velocity of a jog of A, B and C. T&P: lrOrientationJogVel.");
  d.template defaulted<&S::orientation_jog_acceleration>(
      unit::deg_s2, kStrong, "Acceleration of a jog of A, B and C. T&P: lrOrientationJogAcc.");
  d.template defaulted<&S::orientation_jog_deceleration>(
      unit::deg_s2, kStrong, "Deceleration of a jog of A, B and C. T&P: lrOrientationJogDec.");
  d.template defaulted<&S::orientation_jog_jerk>(unit::deg_s3, kStrong,
                                                 "Jerk of a jog of A, B and C. T&P: lrOrientationJogJerk.");
  d.template defaulted<&S::real_axis_jog_velocity>(unit::u_s, kStrong,
                                                   "Velocity of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogVel.");
  d.template defaulted<&S::real_axis_jog_acceleration>(
      unit::u_s2, kStrong, "Acceleration of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogAcc.");
  d.template defaulted<&S::real_axis_jog_deceleration>(
      unit::u_s2, kStrong, "Deceleration of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogDec.");
  d.template defaulted<&S::real_axis_jog_jerk>(unit::u_s3, kStrong,
                                               "Jerk of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogJerk.");
  d.template defaulted<&S::home_position>(
      kPositions, "Positions assigned to the references of A1 to A6 and Aux1, u. T&P: alrHomePosition.");
  d.template defaulted<&S::homing_order>(
      at_most(12),
      "Order in which A1 to A6 and Aux1 are homed: those with 1 first, together; 0: not homed. T&P: aeHomingOrder.");
  d.template defaulted<&S::home_by_module>(
      "True: homing uses the module's homing section instead of the axes' own parameters. T&P: xUseHomeExtParameter.");
  d.template defaulted<&S::max_velocity>(
      kFromZero,
      "Limits of profiles, in the world: of the tool along X, Y, Z in mm/s, about them in deg/s, and of Aux1 in u/s; "
      "0: no limit. T&P: lrXMaxVel to lrAux1MaxVel.");
  d.template defaulted<&S::max_acceleration>(
      kFromZero, "Limits of the accelerations, likewise. T&P: lrXMaxAccDec to lrAux1MaxAccDec.");
  d.template defaulted<&S::max_jerk>(kFromZero, "Limits of the jerks, likewise. T&P: lrXMaxJerk to lrAux1MaxJerk.");
  d.template defaulted<&S::gripper_closing_time>(
      unit::s, between(0, 60),
      "Time from the gripper's pulse to the end of a profile; 0: no pulse. T&P: lrGripperClosingTime.");
  d.template defaulted<&S::gripper_open_time>(
      unit::s, between(0, 60), "Time likewise for profiles of a tracking mode that place. T&P: lrGripperOpenTime.");
  d.template defaulted<&S::x_target>(unit::mm, kPositions, "X of the static target. T&P: lrXTargetPos.");
  d.template defaulted<&S::y_target>(unit::mm, kPositions, "Y of the static target. T&P: lrYTargetPos.");
  d.template defaulted<&S::z_target>(unit::mm, kPositions, "Z of the static target. T&P: lrZTargetPos.");
  d.template defaulted<&S::a_target>(unit::deg, kPositions,
                                     "Rotation of the static target about X. T&P: lrATargetPos.");
  d.template defaulted<&S::b_target>(unit::deg, kPositions,
                                     "Rotation of the static target about Y. T&P: lrBTargetPos.");
  d.template defaulted<&S::c_target>(unit::deg, kPositions,
                                     "Rotation of the static target about Z. T&P: lrCTargetPos.");
  d.template defaulted<&S::aux1_target>(unit::u, kPositions,
                                        "Position of Aux1 at the static target. T&P: lrAux1TargetPos.");
  d.template defaulted<&S::target_coordinate_system>(
      "Coordinate system of the static target; not acs. T&P: eTargetCoordSystem.");
  d.template defaulted<&S::target_pcs>(
      between(1, group::kProductSystems),
      "Number of the product coordinate system, with pcs; none of those assigned to workpieces.");
  d.template defaulted<&S::z_start_distance>(unit::mm, kFromZero,
                                             "Distance by which a profile lifts first. T&P: lrZStartDist.");
  d.template defaulted<&S::z_target_distance>(unit::mm, kFromZero,
                                              "Distance by which a profile lowers at its end. T&P: lrZTargetDist.");
  d.template defaulted<&S::path_mode>("Shape of a profile between lifting and lowering. T&P: ePathMode.");
  d.template defaulted<&S::z_elliptical>(unit::mm, kFromZero,
                                         "Height of the ellipse over the higher of its ends. T&P: lrZDistElliptical.");
  d.template defaulted<&S::blending_radius>(
      unit::mm, kFromZero,
      "Distance from a point at which its rounding begins; 0: the profile stops there. T&P: lrBlendingRadius.");
  d.template defaulted<&S::watch_position_window>(
      "The output in_position waits for the actual tool. T&P: xPosInWindow.");
  d.template defaulted<&S::position_window>(
      unit::mm, kFromZero, "Largest distance of the actual tool from its commanded position ... T&P: lrPosInWindow.");
  d.template defaulted<&S::position_window_ms>(unit::ms, between(0, 60000),
                                               "... for at least this time. T&P: lrTimePosInWindow.");
  d.template defaulted<&S::tracking_mode>("Selection of targets. T&P: eTrackingMode.");
  d.template defaulted<&S::pick_belt>(
      at_most(kBelts), "Belt of the module's list from which from_to picks, from 1; 0: the static target.");
  d.template defaulted<&S::place_belt>(
      at_most(kBelts), "Belt of the module's list onto which from_to places, from 1; 0: the static target.");
  d.template defaulted<&S::workpiece_rule>("Choice among the workpieces that can be reached.");
  d.template defaulted<&S::keep_orientation>("Targets do not turn the tool, for a mechanism without a wrist.");
  d.template defaulted<&S::workpiece_pcs1>(between(1, group::kProductSystems),
                                           "Product coordinate system assigned to workpieces ...");
  d.template defaulted<&S::workpiece_pcs2>(between(1, group::kProductSystems), "... alternately with this one.");
}

template <template <typename> class Of>
void DescribeBelt(Description<BeltSettingsOf<Of>>& d) {
  using S = BeltSettingsOf<Of>;
  d.template defaulted<&S::belt>(
      between(1, kBelts), "Number of the belt in the module's list, from 1; for the list itself its order counts.");
  d.template defaulted<&S::park_x>(unit::mm, kPositions, "X of the parking position, in the MCS. T&P: alrParkPos.");
  d.template defaulted<&S::park_y>(unit::mm, kPositions, "Y of the parking position, in the MCS. T&P: alrParkPos.");
  d.template defaulted<&S::park_z>(unit::mm, kPositions, "Z of the parking position, in the MCS. T&P: alrParkPos.");
  d.template defaulted<&S::park_a>(unit::deg, kPositions, "Rotation of the parking position about X. T&P: alrParkPos.");
  d.template defaulted<&S::park_b>(unit::deg, kPositions, "Rotation of the parking position about Y. T&P: alrParkPos.");
  d.template defaulted<&S::park_c>(unit::deg, kPositions, "Rotation of the parking position about Z. T&P: alrParkPos.");
  d.template defaulted<&S::z_distance>(
      unit::mm, kFromZero,
      "Height over a workpiece from which the tool lowers and to which it lifts. T&P: lrZDistBelt.");
  d.template defaulted<&S::sync_time>(unit::s, between(0, 600),
                                      "Time on the workpiece; 0: one cycle. T&P: lrSyncTimeOnBelt.");
  d.template defaulted<&S::lower_limit>(unit::mm, kPositions,
                                        "Start of the module's work range along X of the belt, deg on a table; both "
                                        "limits 0: that of the belt alone. T&P: lrLowerSyncLimit.");
  d.template defaulted<&S::upper_limit>(unit::mm, kPositions,
                                        "End of the module's work range; above lower_limit. T&P: lrUpperSyncLimit.");
  d.template defaulted<&S::lowest_speed>(
      unit::mm_s, kPositions,
      "Lowest speed along X of the belt, deg/s on a table, that is expected while a workpiece is approached; negative: "
      "the belt may reverse. Values above its present speed have no effect.");
  d.template defaulted<&S::highest_speed>(
      unit::mm_s, kPositions,
      "Highest speed that is expected meanwhile. Values below the present speed have no effect.");
  d.template defaulted<&S::sudden_acceleration>(
      unit::mm_s2, kFromZero,
      "Acceleration with which the belt may change its speed without notice: the tool lowers only if it could lift "
      "again within the range all the same. Not beyond highest_speed or lowest_speed if these are set. 0: changes are "
      "considered only once they show.");
  d.template defaulted<&S::kind>("Kind of the workpieces that are taken; 0: any.");
  d.template defaulted<&S::colour>("Colour of the workpieces that are taken; 0: any.");
  d.template defaulted<&S::least_quality>(unit::one, kPositions, "Least quality of the workpieces that are taken.");
  d.template defaulted<&S::every>(
      between(1, 1000),
      "Sharing of a belt between modules: of this many consecutive workpieces, by their numbers on the belt, ...");
  d.template defaulted<&S::turn>(between(1, 1000), "... the module takes those from this one on, from 1, ...");
  d.template defaulted<&S::turns>(between(1, 1000),
                                  "... this many. 2 of 3 for one and 1 of 3 for the other share 2 : 1.");
  d.template defaulted<&S::most_per_minute>(Unit{"1/min", ""}, kFromZero,
                                            "Largest rate at which workpieces are taken, evenly; 0: unlimited.");
  d.template defaulted<&S::leave>(
      at_most(conveyor::kObjects),
      "Free workpieces that must lie beyond the module's range, for modules downstream, before one is taken; 0: not "
      "checked. Requires lower_limit and upper_limit, below that of the belt.");
  d.template defaulted<&S::same_within>(
      unit::mm, kFromZero,
      "Distance within which an object counts as a second detection of a fetched workpiece, e.g. in overlapping camera "
      "images: it is deleted with it. 0: none is.");
  d.template defaulted<&S::grip_x>(unit::mm, kPositions,
                                   "X of the tool on a workpiece, in the workpiece's coordinate system.");
  d.template defaulted<&S::grip_y>(unit::mm, kPositions,
                                   "Y of the tool on a workpiece, in the workpiece's coordinate system.");
  d.template defaulted<&S::grip_z>(unit::mm, kPositions,
                                   "Z of the tool on a workpiece, in the workpiece's coordinate system.");
  d.template defaulted<&S::grip_a>(unit::deg, kPositions, "Rotation of the tool on a workpiece about X.");
  d.template defaulted<&S::grip_b>(unit::deg, kPositions, "Rotation of the tool on a workpiece about Y.");
  d.template defaulted<&S::grip_c>(unit::deg, kPositions, "Rotation of the tool on a workpiece about Z.");
  d.template defaulted<&S::aux1_target>(unit::u, kPositions,
                                        "Position of Aux1 on a workpiece. T&P: ascBeltInput.lrAux1TargetPos.");
}

}  // namespace

bool WorkpieceSystemsFit(const Settings& s) noexcept {
  return s.workpiece_pcs1 != s.workpiece_pcs2;
}

bool TargetSystemFits(const Settings& s) noexcept {
  const bool in_pcs = s.target_coordinate_system == group::CoordinateSystem::kPcs;
  return !in_pcs || (s.target_pcs != s.workpiece_pcs1 && s.target_pcs != s.workpiece_pcs2);
}

bool TargetFits(const Settings& s) noexcept {
  return s.target_coordinate_system != group::CoordinateSystem::kAcs;
}

bool TurnsFit(const BeltSettings& s) noexcept {
  return s.turn <= s.every && s.turns <= s.every - s.turn + 1;
}

bool HasRange(const BeltSettings& s) noexcept {
  return s.lower_limit != 0 || s.upper_limit != 0;
}

bool RangeFits(const BeltSettings& s) noexcept {
  return !HasRange(s) || s.lower_limit < s.upper_limit;
}

bool LeaveFits(const BeltSettings& s) noexcept {
  return s.leave == 0 || HasRange(s);
}

bool LeaveMeets(const BeltSettings& s, const conveyor::BeltParams& belt) noexcept {
  return s.leave == 0 || !HasRange(s) || !belt.upper_limit || s.upper_limit < *belt.upper_limit;
}

bool RangeMeets(const BeltSettings& s, const conveyor::BeltParams& belt) noexcept {
  if (!HasRange(s) || !RangeFits(s)) return true;
  return !(belt.lower_limit && s.upper_limit < *belt.lower_limit) &&
         !(belt.upper_limit && s.lower_limit > *belt.upper_limit);
}

void describe(Description<Settings>& d) {
  d.named("PickPlaceSettings");
  d.about("Settings of a pick and place module.");
  DescribeSettings(d);
  d.rule<&Settings::target_coordinate_system>("must not be acs: targets are places of the tool",
                                              [](const Settings& s) { return TargetFits(s); });
}

void describe(Description<Configure>& d) {
  d.named("ConfigurePickPlace");
  d.about(
      "Changes settings of a pick and place module; settings that are not given keep their values. Accepted profiles "
      "are not changed.");
  DescribeSettings(d);
}

void describe(Description<BeltSettings>& d) {
  d.named("PickPlaceBeltSettings");
  d.about("Settings for one belt of a pick and place module.");
  DescribeBelt(d);
  d.rule<&BeltSettings::turns>("must not lead beyond every: turn + turns - 1 is at most every",
                               [](const BeltSettings& s) { return TurnsFit(s); });
  d.rule<&BeltSettings::upper_limit>("must lie above lower_limit, or both must be 0: the range of the belt alone",
                                     [](const BeltSettings& s) { return RangeFits(s); });
  d.rule<&BeltSettings::leave>("must be 0 without lower_limit and upper_limit: it counts workpieces behind that range",
                               [](const BeltSettings& s) { return LeaveFits(s); });
}

void describe(Description<ConfigureBelt>& d) {
  d.named("ConfigurePickPlaceBelt");
  d.about("Changes settings for one belt; settings that are not given keep their values.");
  DescribeBelt(d);
}

void describe(Enumeration<PathMode>& e) {
  e.about("Shape of a profile between its points.");
  e.value(PathMode::kLinear, "linear", "A straight line.");
  e.value(PathMode::kElliptical, "elliptical", "Half an ellipse.");
}

void describe(Enumeration<TrackingMode>& e) {
  e.about("Selection of targets.");
  e.value(TrackingMode::kProgram, "program", "Each rising edge of execute gives the next target.");
  e.value(TrackingMode::kStaticToBelt1, "static_to_belt1", "From the static target onto belt 1, repeatedly.");
  e.value(TrackingMode::kBelt1ToStatic, "belt1_to_static", "From belt 1 to the static target, repeatedly.");
  e.value(TrackingMode::kBelt1ToBelt2, "belt1_to_belt2", "From belt 1 onto belt 2, repeatedly.");
  e.value(TrackingMode::kBelt2ToBelt1, "belt2_to_belt1", "From belt 2 onto belt 1, repeatedly.");
  e.value(TrackingMode::kFromTo, "from_to", "From pick_belt to place_belt, repeatedly.");
}

void describe(Enumeration<WorkpieceRule>& e) {
  e.about("Choice among the workpieces that can be reached.");
  e.value(WorkpieceRule::kFirst, "first", "The workpiece farthest along the belt, in its last direction of motion.");
  e.value(WorkpieceRule::kNearest, "nearest", "The workpiece nearest to the tool.");
  e.value(WorkpieceRule::kLatest, "latest", "The workpiece least far along the belt, in its last direction of motion.");
}

}  // namespace takt::pickplace
