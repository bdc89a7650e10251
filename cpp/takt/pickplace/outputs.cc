#include "takt/pickplace/outputs.h"

#include "takt/core/describe.h"

namespace takt::pickplace {

void describe(Enumeration<PickPlaceState>& e) {
  using S = PickPlaceState;
  e.about("States of a pick and place module.");
  e.value(S::kInit, "init", "Not enabled.");
  e.value(S::kReady, "ready", "Waits; a path that was stopped may be held.");
  e.value(S::kService, "service", "The group is moved by other commands, or released to them.");
  e.value(S::kHoming, "homing", "Axes are homing.");
  e.value(S::kJogPos, "jog_pos", "Jog in positive direction, until the axis is at rest.");
  e.value(S::kJogNeg, "jog_neg", "Jog in negative direction, until the axis is at rest.");
  e.value(S::kPreparingPath, "preparing_path", "A profile is being planned.");
  e.value(S::kMovePp, "move_pp", "A profile is being executed, or the tool waits at a belt.");
  e.value(S::kPathInterrupt, "path_interrupt", "At rest on the path while path_interrupt is true.");
  e.value(S::kStop, "stop", "Stopping, or at rest, while path_stop, path_halt or stop_all is true.");
  e.value(S::kError, "error", "An error, until it is reset.");
}

void describe(Description<Counters>& d) {
  using C = Counters;
  d.named("PickPlaceCounters");
  d.about("Counts of workpieces.");
  d.internal<&C::picked>("Profiles completed at a workpiece to pick.");
  d.internal<&C::placed>("Profiles completed at a target to place.");
  d.internal<&C::missed>("Workpieces that were not reached; of these:");
  d.internal<&C::too_late>("Workpieces that left the range first.");
  d.internal<&C::interrupted>("Workpieces the path to which was stopped or aborted.");
  d.internal<&C::refused>("Workpieces to which there was no path.");
}

void describe(Description<AxisNumbers>& d) {
  using N = AxisNumbers;
  d.about("A value for each axis.");
  d.internal<&N::x>(unit::mm, "Value of the tool along X.");
  d.internal<&N::y>(unit::mm, "Value along Y.");
  d.internal<&N::z>(unit::mm, "Value along Z.");
  d.internal<&N::a>(unit::deg, "Value of the tool about X.");
  d.internal<&N::b>(unit::deg, "Value about Y.");
  d.internal<&N::c>(unit::deg, "Value about Z.");
  d.internal<&N::a1>(unit::u, "Value of axis 1.");
  d.internal<&N::a2>(unit::u, "Value of axis 2.");
  d.internal<&N::a3>(unit::u, "Value of axis 3.");
  d.internal<&N::a4>(unit::u, "Value of axis 4.");
  d.internal<&N::a5>(unit::u, "Value of axis 5.");
  d.internal<&N::a6>(unit::u, "Value of axis 6.");
  d.internal<&N::aux1>(unit::u, "Value of the auxiliary axis.");
}

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.named("PickPlaceOutputs");
  d.about("Outputs of a pick and place module.");
  d.internal<&O::state>("State of the module. T&P: eTMState.");
  d.internal<&O::error>("Reason for the error state. T&P: xError, eErrorID.");
  d.internal<&O::warning>("Reason why a request was not carried out as given. T&P: xWarning, eErrorID.");
  d.internal<&O::error_axes>(
      "Axes in error, a mask: bit 0 is X, then Y, Z, A, B, C, A1 to A6, Aux1; the reason is published by each axis. "
      "T&P: ascErrorInfo.");
  d.internal<&O::set_path_velocity>(unit::mm_s, "Commanded velocity along the path. T&P: lrSetPathVelOut.");
  d.internal<&O::path_preparation_time>(
      unit::s, "Time from the edge of execute to the first set point of the profile. T&P: lrPathPreparationTime.");
  d.internal<&O::precalculated_profile_time>(unit::s,
                                             "Duration of the profile; 0: not known yet. T&P: lrPreCalcProfileTime.");
  d.internal<&O::position>("Actual positions. T&P: alrActPos.");
  d.internal<&O::velocity>(unit::one_s, "Actual velocities, in the units of the positions per s. T&P: alrActVel.");
  d.internal<&O::profile_point_passed>("Number of the last point passed; 0: the start. T&P: iProfilePointPassed.");
  d.internal<&O::target>("Target being approached: a belt, from 1; 0: the static target. T&P: eSetTargetOut.");
  d.internal<&O::workpiece>("Number of the workpiece being approached; 0: none.");
  d.internal<&O::profiles>("Profiles accepted and not yet done.");
  d.internal<&O::picked>("Profiles completed at a workpiece to pick, since the start or reset_counters.");
  d.internal<&O::placed>("Profiles completed at a target to place.");
  d.internal<&O::missed>("Workpieces that were not reached; of these:");
  d.internal<&O::missed_too_late>("Workpieces that left the range first.");
  d.internal<&O::missed_interrupted>("Workpieces the path to which was stopped or aborted.");
  d.internal<&O::missed_refused>("Workpieces to which there was no path.");
  d.internal<&O::warning_belt>("Belt that the warning refers to, from 1; 0: none. T&P: ascErrorInfo.");
  d.internal<&O::held>("Products picked and not placed yet, counted by completed profiles.");
  d.internal<&O::held_kind>("Kind of the oldest of them, which is placed next; 0: none, or no kind.");
  d.internal<&O::held_colour>("Colour of the oldest of them; 0: none.");
  d.internal<&O::held_quality>(unit::one, "Quality of the oldest of them; 0: none is held.");
  d.internal<&O::picks_per_minute>(Unit{"1/min", ""}, "Picking rate, from the times between the last picks.");
  d.internal<&O::internal_control_active>("The group is released to other commands. T&P: xInternalControlActive.");
  d.internal<&O::axes_enabled>("All axes are on. T&P: xAxesEnabled.");
  d.internal<&O::axes_group_enabled>("The group is enabled. T&P: xAxesGroupEnabled.");
  d.internal<&O::done>("The last request is done. T&P: xDone.");
  d.internal<&O::busy>("A request is in progress. T&P: xBusy.");
  d.internal<&O::axes_group_homed>("All axes are homed. T&P: xAxesGroupHomed.");
  d.internal<&O::in_position>(
      "The target is reached, with watch_position_window also by the actual tool. T&P: xInPosition.");
  d.internal<&O::hw_limit_switch_active>("A limit switch is active. T&P: xHwLimitSwitchActive.");
  d.internal<&O::sw_limit_switch_active>("An axis was stopped by a SW limit. T&P: xSwLimitSwitchActive.");
  d.internal<&O::hw_limit_switches_positive>(
      "Axes with an active positive limit switch, a mask as above. T&P: axHwLimitSwitchPos.");
  d.internal<&O::hw_limit_switches_negative>(
      "Axes with an active negative limit switch, a mask. T&P: axHwLimitSwitchNeg.");
  d.internal<&O::sw_limits_enabled>("Axes with SW limits, a mask. T&P: axSwLimitEnabled.");
  d.internal<&O::sw_limit_switches>("Axes that were stopped by SW limits, a mask. T&P: axSwLimitSwitchActive.");
  d.internal<&O::path_hold>("The tool is at rest on a path that can be continued. T&P: xPathHold.");
  d.internal<&O::off_path>("The tool was moved away from the held path: return_to_path moves it back.");
  d.internal<&O::gripper_control_active>(
      "The current profile gives the gripper a pulse before its end. T&P: xGripperCtrlActive.");
  d.internal<&O::pulse_gripper>("Pulse for the gripper, of one cycle. T&P: xPulseGripper.");
  d.internal<&O::profile_in_preparation>("No further profile can be added at present. T&P: xProfileInPreparation.");
  d.internal<&O::acc_dec_sync>("The tool is getting into sync with a belt, or out of it. T&P: xAccDecSync.");
  d.internal<&O::synchronised>("The tool is in sync with a belt. T&P: xSynchronised.");
  d.internal<&O::in_target>("The target is reached. T&P: xInTarget.");
  d.internal<&O::in_park_position>("The parking position is reached. T&P: xInParkPos.");
}

}  // namespace takt::pickplace
