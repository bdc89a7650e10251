#include "takt/pickplace/outputs.h"

#include "takt/core/describe.h"

namespace takt::pickplace {

void describe(Enumeration<PickPlaceState>& e) {
  using S = PickPlaceState;
  e.about("States of a pick and place module.");
  e.value(S::kInit, "init", "It is not enabled.");
  e.value(S::kReady, "ready", "It waits; a path that was stopped may be held.");
  e.value(S::kService, "service", "The group moves by itself, or is given to others.");
  e.value(S::kHoming, "homing", "Axes look for their references.");
  e.value(S::kJogPos, "jog_pos", "Jog in positive direction.");
  e.value(S::kJogNeg, "jog_neg", "Jog in negative direction.");
  e.value(S::kPreparingPath, "preparing_path", "A profile is being planned.");
  e.value(S::kMovePp, "move_pp", "A profile is gone, or the tool waits at a belt.");
  e.value(S::kPathInterrupt, "path_interrupt", "It rests on the path while path_interrupt is there.");
  e.value(S::kStop, "stop", "It stops, or stands, while path_stop, path_halt or stop_all is there.");
  e.value(S::kError, "error", "An error, until it is reset.");
}

void describe(Description<Counters>& d) {
  using C = Counters;
  d.named("PickPlaceCounters");
  d.about("What became of workpieces.");
  d.internal<&C::picked>("Profiles that ended at a place to pick.");
  d.internal<&C::placed>("Profiles that ended at a place to put something.");
  d.internal<&C::missed>("Workpieces that were chosen and not reached, of these:");
  d.internal<&C::too_late>("They left the range first.");
  d.internal<&C::interrupted>("The path to them was stopped or aborted.");
  d.internal<&C::refused>("There was no path to them.");
}

void describe(Description<AxisNumbers>& d) {
  using N = AxisNumbers;
  d.about("A number of each axis.");
  d.internal<&N::x>(unit::mm, "Of the tool along X.");
  d.internal<&N::y>(unit::mm, "Along Y.");
  d.internal<&N::z>(unit::mm, "Along Z.");
  d.internal<&N::a>(unit::deg, "Of the tool about X.");
  d.internal<&N::b>(unit::deg, "About Y.");
  d.internal<&N::c>(unit::deg, "About Z.");
  d.internal<&N::a1>(unit::u, "Of axis 1.");
  d.internal<&N::a2>(unit::u, "Of axis 2.");
  d.internal<&N::a3>(unit::u, "Of axis 3.");
  d.internal<&N::a4>(unit::u, "Of axis 4.");
  d.internal<&N::a5>(unit::u, "Of axis 5.");
  d.internal<&N::a6>(unit::u, "Of axis 6.");
  d.internal<&N::aux1>(unit::u, "Of the auxiliary axis.");
}

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("PickPlaceOutputs");
  d.about("What a pick and place module is doing.");
  d.internal<&O::state>("State of the module. T&P: eTMState.");
  d.internal<&O::error>("Why it is in error. T&P: xError, eErrorID.");
  d.internal<&O::warning>("What was not done as asked. T&P: xWarning, eErrorID.");
  d.internal<&O::error_axes>(
      "Axes in error, a mask: bit 0 is X, then Y, Z, A, B, C, A1 to A6, Aux1; each axis says why. T&P: ascErrorInfo.");
  d.internal<&O::set_path_velocity>(unit::mm_s, "Along the path, as commanded. T&P: lrSetPathVelOut.");
  d.internal<&O::path_preparation_time>(
      unit::s, "From the edge to the first set point of the profile. T&P: lrPathPreparationTime.");
  d.internal<&O::precalculated_profile_time>(unit::s,
                                             "The profile takes so long; 0: not known yet. T&P: lrPreCalcProfileTime.");
  d.internal<&O::position>("As measured. T&P: alrActPos.");
  d.internal<&O::velocity>(unit::one_s, "As measured, the same per s. T&P: alrActVel.");
  d.internal<&O::profile_point_passed>("Number of the last point passed; 0: the start. T&P: iProfilePointPassed.");
  d.internal<&O::target>("What is approached: a belt, from 1; 0: the static target. T&P: eSetTargetOut.");
  d.internal<&O::workpiece>("Number of the workpiece that is approached; 0: none.");
  d.internal<&O::profiles>("Profiles accepted and not yet done.");
  d.internal<&O::picked>("Profiles that ended at a place to pick, since the start or reset_counters.");
  d.internal<&O::placed>("Profiles that ended at a place to put something.");
  d.internal<&O::missed>("Workpieces that were not reached, of these:");
  d.internal<&O::missed_too_late>("They left the range.");
  d.internal<&O::missed_interrupted>("The path to them was stopped or aborted.");
  d.internal<&O::missed_refused>("There was no path to them.");
  d.internal<&O::warning_belt>("The belt that the warning is about, from 1; 0: none. T&P: ascErrorInfo.");
  d.internal<&O::held>("Products that were picked and not placed yet, as far as profiles tell.");
  d.internal<&O::held_kind>("Kind of the oldest of them, which is placed next; 0: none, or of no kind.");
  d.internal<&O::held_colour>("Its colour, likewise.");
  d.internal<&O::held_quality>(unit::one, "Its quality; 0: there is none.");
  d.internal<&O::picks_per_minute>(Unit{"1/min", ""}, "By the time between the last picks.");
  d.internal<&O::internal_control_active>("The group is given to others. T&P: xInternalControlActive.");
  d.internal<&O::axes_enabled>("All axes are on. T&P: xAxesEnabled.");
  d.internal<&O::axes_group_enabled>("The group is enabled. T&P: xAxesGroupEnabled.");
  d.internal<&O::done>("What was asked for last is done. T&P: xDone.");
  d.internal<&O::busy>("It is in progress. T&P: xBusy.");
  d.internal<&O::axes_group_homed>("All axes know their references. T&P: xAxesGroupHomed.");
  d.internal<&O::in_position>("The tool is where it was to go. T&P: xInPosition.");
  d.internal<&O::hw_limit_switch_active>("A limit switch is on. T&P: xHwLimitSwitchActive.");
  d.internal<&O::sw_limit_switch_active>("A SW limit stopped an axis. T&P: xSwLimitSwitchActive.");
  d.internal<&O::hw_limit_switches_positive>("Which, a mask as above. T&P: axHwLimitSwitchPos.");
  d.internal<&O::hw_limit_switches_negative>("Which, a mask. T&P: axHwLimitSwitchNeg.");
  d.internal<&O::sw_limits_enabled>("Axes with SW limits, a mask. T&P: axSwLimitEnabled.");
  d.internal<&O::sw_limit_switches>("Axes that were stopped by them, a mask. T&P: axSwLimitSwitchActive.");
  d.internal<&O::path_hold>("It rests on a path that can be gone on with. T&P: xPathHold.");
  d.internal<&O::off_path>("The tool was moved away from that path: return_to_path moves it back.");
  d.internal<&O::gripper_control_active>("The gripper gets its pulse. T&P: xGripperCtrlActive.");
  d.internal<&O::pulse_gripper>("The gripper is to act; for one cycle. T&P: xPulseGripper.");
  d.internal<&O::profile_in_preparation>("No other profile can be added now. T&P: xProfileInPreparation.");
  d.internal<&O::acc_dec_sync>("The tool comes into step with a belt, or leaves it. T&P: xAccDecSync.");
  d.internal<&O::synchronised>("The tool goes along with a belt. T&P: xSynchronised.");
  d.internal<&O::in_target>("The target is reached. T&P: xInTarget.");
  d.internal<&O::in_park_position>("The parking position is reached. T&P: xInParkPos.");
}

}  // namespace takt::pickplace
