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
      "Of path_stop and path_interrupt, if it is more than that of the path. T&P: lrPathStopDec.");
  d.template defaulted<&S::path_stop_jerk>(unit::mm_s3, kStrong,
                                           "Of path_stop and path_interrupt. T&P: lrPathStopJerk.");
  d.template defaulted<&S::path_halt_deceleration>(
      unit::mm_s2, kStrong, "Of path_halt, if it is more than that of the path. T&P: lrPathHaltDec.");
  d.template defaulted<&S::path_jerk>(unit::mm_s3, kStrong, "Of profiles and of path_halt. T&P: lrPathJerk.");
  d.template defaulted<&S::path_velocity>(unit::mm_s, kStrong, "Largest speed of profiles. T&P: lrPathVel.");
  d.template defaulted<&S::path_acceleration>(unit::mm_s2, kStrong, "Of profiles. T&P: lrPathAcc.");
  d.template defaulted<&S::path_deceleration>(unit::mm_s2, kStrong, "Of profiles. T&P: lrPathDec.");
  d.template defaulted<&S::stop_deceleration>(
      kStrong,
      "Of each axis by itself with stop_all and in errors, u/s²: X, Y, Z, A, B, C, A1 to A6, Aux1; those of real axes "
      "count, no more than the axis' own. T&P: alrStopDec.");
  d.template defaulted<&S::stop_jerk>(kStrong, "The same in u/s³. T&P: alrStopJerk.");
  d.template defaulted<&S::cartesian_jog_velocity>(unit::mm_s, kStrong,
                                                   "Of a jog of X, Y and Z. T&P: lrCartesianJogVel.");
  d.template defaulted<&S::cartesian_jog_acceleration>(unit::mm_s2, kStrong,
                                                       "Of a jog of X, Y and Z. T&P: lrCartesianJogAcc.");
  d.template defaulted<&S::cartesian_jog_deceleration>(unit::mm_s2, kStrong,
                                                       "Of a jog of X, Y and Z. T&P: lrCartesianJogDec.");
  d.template defaulted<&S::cartesian_jog_jerk>(unit::mm_s3, kStrong,
                                               "Of a jog of X, Y and Z. T&P: lrCartesianJogJerk.");
  d.template defaulted<&S::orientation_jog_velocity>(unit::deg_s, kStrong,
                                                     "Of a jog of A, B and C. T&P: lrOrientationJogVel.");
  d.template defaulted<&S::orientation_jog_acceleration>(unit::deg_s2, kStrong,
                                                         "Of a jog of A, B and C. T&P: lrOrientationJogAcc.");
  d.template defaulted<&S::orientation_jog_deceleration>(unit::deg_s2, kStrong,
                                                         "Of a jog of A, B and C. T&P: lrOrientationJogDec.");
  d.template defaulted<&S::orientation_jog_jerk>(unit::deg_s3, kStrong,
                                                 "Of a jog of A, B and C. T&P: lrOrientationJogJerk.");
  d.template defaulted<&S::real_axis_jog_velocity>(unit::u_s, kStrong,
                                                   "Of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogVel.");
  d.template defaulted<&S::real_axis_jog_acceleration>(unit::u_s2, kStrong,
                                                       "Of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogAcc.");
  d.template defaulted<&S::real_axis_jog_deceleration>(unit::u_s2, kStrong,
                                                       "Of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogDec.");
  d.template defaulted<&S::real_axis_jog_jerk>(unit::u_s3, kStrong,
                                               "Of a jog of A1 to A6 and Aux1. T&P: lrRealAxisJogJerk.");
  d.template defaulted<&S::home_position>(
      kPositions, "What the reference of A1 to A6 and Aux1 is called, u. T&P: alrHomePosition.");
  d.template defaulted<&S::homing_order>(at_most(12),
                                         "In which order A1 to A6 and Aux1 look for their references: those with 1 "
                                         "first, together; 0: not at all. T&P: aeHomingOrder.");
  d.template defaulted<&S::home_by_module>(
      "True: homing goes by the module's homing section, not by the axes' own. T&P: xUseHomeExtParameter.");
  d.template defaulted<&S::max_velocity>(
      kFromZero,
      "Of profiles: of the tool along X, Y, Z in mm/s, about them in deg/s, and of Aux1 in u/s, seen from the world; "
      "0: no limit. T&P: lrXMaxVel to lrAux1MaxVel.");
  d.template defaulted<&S::max_acceleration>(kFromZero,
                                             "The same for accelerations. T&P: lrXMaxAccDec to lrAux1MaxAccDec.");
  d.template defaulted<&S::max_jerk>(kFromZero, "The same for jerks. T&P: lrXMaxJerk to lrAux1MaxJerk.");
  d.template defaulted<&S::gripper_closing_time>(
      unit::s, between(0, 60),
      "So long before the end of a profile the gripper gets its pulse; 0: none. T&P: lrGripperClosingTime.");
  d.template defaulted<&S::gripper_open_time>(unit::s, between(0, 60),
                                              "The same where a tracking mode places. T&P: lrGripperOpenTime.");
  d.template defaulted<&S::x_target>(unit::mm, kPositions, "The static target. T&P: lrXTargetPos.");
  d.template defaulted<&S::y_target>(unit::mm, kPositions, "The static target. T&P: lrYTargetPos.");
  d.template defaulted<&S::z_target>(unit::mm, kPositions, "The static target. T&P: lrZTargetPos.");
  d.template defaulted<&S::a_target>(unit::deg, kPositions, "How the tool is turned there. T&P: lrATargetPos.");
  d.template defaulted<&S::b_target>(unit::deg, kPositions, "How the tool is turned there. T&P: lrBTargetPos.");
  d.template defaulted<&S::c_target>(unit::deg, kPositions, "How the tool is turned there. T&P: lrCTargetPos.");
  d.template defaulted<&S::aux1_target>(unit::u, kPositions, "Where Aux1 is there. T&P: lrAux1TargetPos.");
  d.template defaulted<&S::target_coordinate_system>(
      "What the static target is seen from; not acs. T&P: eTargetCoordSystem.");
  d.template defaulted<&S::target_pcs>(between(1, group::kProductSystems),
                                       "Which product coordinate system, with pcs; none that workpieces get.");
  d.template defaulted<&S::z_start_distance>(unit::mm, kFromZero, "A profile first lifts by this. T&P: lrZStartDist.");
  d.template defaulted<&S::z_target_distance>(unit::mm, kFromZero,
                                              "And lowers by this at its end. T&P: lrZTargetDist.");
  d.template defaulted<&S::path_mode>("What lies between. T&P: ePathMode.");
  d.template defaulted<&S::z_elliptical>(
      unit::mm, kFromZero, "Height of the ellipse over the higher of its points. T&P: lrZDistElliptical.");
  d.template defaulted<&S::blending_radius>(
      unit::mm, kFromZero, "Where the rounding of a point begins; 0: the profile stops there. T&P: lrBlendingRadius.");
  d.template defaulted<&S::watch_position_window>("in_position waits for the measured tool. T&P: xPosInWindow.");
  d.template defaulted<&S::position_window>(unit::mm, kFromZero,
                                            "So near to its place must it be ... T&P: lrPosInWindow.");
  d.template defaulted<&S::position_window_ms>(unit::ms, between(0, 60000), "... for so long. T&P: lrTimePosInWindow.");
  d.template defaulted<&S::tracking_mode>("Who chooses targets. T&P: eTrackingMode.");
  d.template defaulted<&S::pick_belt>(
      at_most(kBelts),
      "With from_to: where workpieces are picked: a belt of the module's list from 1; 0: the static target.");
  d.template defaulted<&S::place_belt>(at_most(kBelts), "With from_to: where they are placed, likewise.");
  d.template defaulted<&S::workpiece_rule>("Which of the workpieces that can be reached is next.");
  d.template defaulted<&S::keep_orientation>("Targets do not turn the tool: the mechanism has no wrist.");
  d.template defaulted<&S::workpiece_pcs1>(between(1, group::kProductSystems),
                                           "Product coordinate system that workpieces get ...");
  d.template defaulted<&S::workpiece_pcs2>(between(1, group::kProductSystems), "... in turn with this one.");
}

template <template <typename> class Of>
void DescribeBelt(Description<BeltSettingsOf<Of>>& d) {
  using S = BeltSettingsOf<Of>;
  d.template defaulted<&S::belt>(between(1, kBelts),
                                 "Which belt of the module's list, from 1; the list itself says it.");
  d.template defaulted<&S::park_x>(unit::mm, kPositions, "The parking position, in the MCS. T&P: alrParkPos.");
  d.template defaulted<&S::park_y>(unit::mm, kPositions, "The parking position, in the MCS. T&P: alrParkPos.");
  d.template defaulted<&S::park_z>(unit::mm, kPositions, "The parking position, in the MCS. T&P: alrParkPos.");
  d.template defaulted<&S::park_a>(unit::deg, kPositions, "How the tool is turned there. T&P: alrParkPos.");
  d.template defaulted<&S::park_b>(unit::deg, kPositions, "How the tool is turned there. T&P: alrParkPos.");
  d.template defaulted<&S::park_c>(unit::deg, kPositions, "How the tool is turned there. T&P: alrParkPos.");
  d.template defaulted<&S::z_distance>(
      unit::mm, kFromZero,
      "Height over a workpiece from which the tool lowers and to which it lifts. T&P: lrZDistBelt.");
  d.template defaulted<&S::sync_time>(unit::s, between(0, 600),
                                      "So long it stays on the workpiece; 0: one cycle. T&P: lrSyncTimeOnBelt.");
  d.template defaulted<&S::lower_limit>(
      unit::mm, kPositions,
      "Where the work range begins along X of the belt, deg on a table; both limits 0: that of the belt alone. T&P: "
      "lrLowerSyncLimit.");
  d.template defaulted<&S::upper_limit>(unit::mm, kPositions,
                                        "Where it ends; above lower_limit. T&P: lrUpperSyncLimit.");
  d.template defaulted<&S::lowest_speed>(
      unit::mm_s, kPositions,
      "The belt may come down to this speed along its X while a workpiece is gone for, deg/s on a table; below 0: turn "
      "back. No more than its present speed counts.");
  d.template defaulted<&S::highest_speed>(unit::mm_s, kPositions,
                                          "It may come up to this speed meanwhile. No less than its present speed "
                                          "counts.");
  d.template defaulted<&S::sudden_acceleration>(
      unit::mm_s2, kFromZero,
      "The belt may change its speed so fast without notice: the tool goes down only where it could be up again within "
      "the range all the same. Not beyond highest_speed or lowest_speed where these are set. 0: no change is reckoned "
      "with before it shows.");
  d.template defaulted<&S::kind>("Workpieces of this kind are taken; 0: of any.");
  d.template defaulted<&S::colour>("Workpieces of this colour are taken; 0: of any.");
  d.template defaulted<&S::least_quality>(unit::one, kPositions, "Workpieces that are at least as good are taken.");
  d.template defaulted<&S::every>(between(1, 1000),
                                  "How modules share a belt: of so many workpieces one behind the other, as the belt "
                                  "numbers them, ...");
  d.template defaulted<&S::turn>(between(1, 1000), "... this module takes those from this one on, from 1, ...");
  d.template defaulted<&S::turns>(between(1, 1000),
                                  "... so many. 2 of 3 for one and 1 of 3 for the other share 2 : 1.");
  d.template defaulted<&S::most_per_minute>(Unit{"1/min", ""}, kFromZero,
                                            "It takes no more workpieces a minute than this, evenly; 0: any number.");
  d.template defaulted<&S::leave>(
      at_most(conveyor::kObjects),
      "It takes one only while so many free ones lie behind its range, for modules further on; 0: it does not look. "
      "With lower_limit and upper_limit, which lies below that of the belt.");
  d.template defaulted<&S::same_within>(
      unit::mm, kFromZero,
      "What lies so near to a workpiece that was fetched is the same one, seen twice, as where pictures of a camera "
      "overlap: it is deleted with it. 0: nothing is.");
  d.template defaulted<&S::grip_x>(unit::mm, kPositions,
                                   "Where the tool stands on a workpiece, in its coordinate system.");
  d.template defaulted<&S::grip_y>(unit::mm, kPositions,
                                   "Where the tool stands on a workpiece, in its coordinate system.");
  d.template defaulted<&S::grip_z>(unit::mm, kPositions,
                                   "Where the tool stands on a workpiece, in its coordinate system.");
  d.template defaulted<&S::grip_a>(unit::deg, kPositions, "How it is turned there.");
  d.template defaulted<&S::grip_b>(unit::deg, kPositions, "How it is turned there.");
  d.template defaulted<&S::grip_c>(unit::deg, kPositions, "How it is turned there.");
  d.template defaulted<&S::aux1_target>(unit::u, kPositions,
                                        "Where Aux1 is on a workpiece. T&P: ascBeltInput.lrAux1TargetPos.");
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
  d.about("What is set of a pick and place module.");
  DescribeSettings(d);
  d.rule<&Settings::target_coordinate_system>("must not be acs: targets are places of the tool",
                                              [](const Settings& s) { return TargetFits(s); });
}

void describe(Description<Configure>& d) {
  d.named("ConfigurePickPlace");
  d.about(
      "Changes settings of a pick and place module; what is not given stays. Profiles that were accepted stay as they "
      "are.");
  DescribeSettings(d);
}

void describe(Description<BeltSettings>& d) {
  d.named("PickPlaceBeltSettings");
  d.about("What is set for one belt of a pick and place module.");
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
  d.about("Changes what is set for one belt; what is not given stays.");
  DescribeBelt(d);
}

void describe(Enumeration<PathMode>& e) {
  e.about("How a profile goes from point to point.");
  e.value(PathMode::kLinear, "linear", "Straight.");
  e.value(PathMode::kElliptical, "elliptical", "Along half an ellipse.");
}

void describe(Enumeration<TrackingMode>& e) {
  e.about("Who chooses targets.");
  e.value(TrackingMode::kProgram, "program", "Each rising edge of execute brings the next one.");
  e.value(TrackingMode::kStaticToBelt1, "static_to_belt1", "From the static target onto belt 1, again and again.");
  e.value(TrackingMode::kBelt1ToStatic, "belt1_to_static", "From belt 1 to the static target, again and again.");
  e.value(TrackingMode::kBelt1ToBelt2, "belt1_to_belt2", "From belt 1 onto belt 2, again and again.");
  e.value(TrackingMode::kBelt2ToBelt1, "belt2_to_belt1", "From belt 2 onto belt 1, again and again.");
  e.value(TrackingMode::kFromTo, "from_to", "From pick_belt to place_belt, again and again.");
}

void describe(Enumeration<WorkpieceRule>& e) {
  e.about("Which of the workpieces that can be reached is next.");
  e.value(WorkpieceRule::kFirst, "first", "The one that leaves the range first.");
  e.value(WorkpieceRule::kNearest, "nearest", "The one nearest to the tool.");
  e.value(WorkpieceRule::kLatest, "latest", "The one that leaves the range last: it can wait longest.");
}

}  // namespace takt::pickplace
