#include "takt/pickplace/commands.h"

#include "takt/core/describe.h"

namespace takt::pickplace {

namespace {

template <template <typename> class Of>
void DescribeInputs(Description<InputsOf<Of>>& d) {
  using I = InputsOf<Of>;
  d.template defaulted<&I::enable>(
      "True: the module is active. False: the tool comes to rest, its path is discarded and the group is released. "
      "T&P: xEnable.");
  d.template defaulted<&I::internal_control>(
      "The group is released to other commands while the module waits; the stop inputs remain active. T&P: "
      "xEnableInternalControl.");
  d.template defaulted<&I::reset_error>(
      "A rising edge acknowledges errors of module, group and axes. T&P: xResetError.");
  d.template defaulted<&I::regulator_on>("True: all axes are switched on; false: off. T&P: xRegulatorOnALL.");
  d.template defaulted<&I::path_stop>("Stops on the path, with path_stop_deceleration. T&P: xPathStop.");
  d.template defaulted<&I::path_halt>("Stops on the path, with path_halt_deceleration. T&P: xPathHalt.");
  d.template defaulted<&I::stop_all>("Stops each axis individually; the path begins anew afterwards. T&P: xStopALL.");
  d.template defaulted<&I::home_execute>("A rising edge starts homing. T&P: xGroupHomeExecute.");
  d.template defaulted<&I::home_abs_switch>(
      "Reference switches of A1 to A6 and Aux1, in addition to those of the axes. T&P: axHomeAbsSwitch.");
  d.template defaulted<&I::enable_hw_limit>(
      "Enables hw_limit_positive and hw_limit_negative. T&P: xGroupEnableHWLimit.");
  d.template defaulted<&I::hw_limit_positive>(
      "Positive limit switches, in addition to those of the axes: X, Y, Z, A, B, C, A1 to A6, Aux1. T&P: "
      "axHwLimitPos.");
  d.template defaulted<&I::hw_limit_negative>("Negative limit switches, likewise. T&P: axHwLimitNeg.");
  d.template defaulted<&I::select_axis>("Axis that a jog moves; a change applies to the next jog. T&P: eSelectAxis.");
  d.template defaulted<&I::execute>(
      "A rising edge starts a profile, adds one, or continues the path that was stopped. T&P: xExecutePickAndPlace.");
  d.template defaulted<&I::set_target>(
      at_most(kBelts),
      "Target in tracking mode program: a belt of the module's list from 1; 0: the static target. T&P: eSetTarget.");
  d.template defaulted<&I::path_interrupt>("In MOVE_PP: true stops on the path, false continues. T&P: xPathInterrupt.");
  d.template defaulted<&I::abort>(
      "A rising edge at rest discards the path; during a tracking mode it ends the loop after the current profile. "
      "T&P: xAbort.");
  d.template defaulted<&I::override_factor>(
      unit::one, between(0, 1),
      "Factor of speeds, at once, and of accelerations and jerks of profiles that begin meanwhile, for these at least "
      "0.1; 0 holds the path. T&P: lrOverride.");
  d.template defaulted<&I::ack_gripper>(
      "A rising edge ends the time on the workpiece: the tool lifts at once. T&P: xAckGripper.");
  d.template defaulted<&I::return_to_path>("A rising edge moves the tool back to the point where it left its path.");
}

}  // namespace

bool AsksToMove(const Control& c) noexcept {
  return c.enable.value_or(false) || c.regulator_on.value_or(false) || c.home_execute.value_or(false) ||
         c.execute.value_or(false) || c.return_to_path.value_or(false);
}

void describe(Description<Inputs>& d) {
  d.named("PickPlaceInputs");
  d.about("Inputs of a pick and place module, as levels.");
  DescribeInputs(d);
}

void describe(Description<Control>& d) {
  d.named("ControlPickPlace");
  d.about("Changes inputs of a pick and place module; inputs that are not given keep their values.");
  DescribeInputs(d);
}

void describe(Description<Jog>& d) {
  d.named("JogPickPlace");
  d.about("Moves the selected axis for as long as a key is held (T&P: xJogPos, xJogNeg).");
  d.defaulted<&Jog::positive>("In positive direction.");
  d.defaulted<&Jog::negative>("In negative direction; with both the first one counts, both at once are refused.");
}

void describe(Description<ResetCounters>& d) {
  d.about("Sets the counters of picked, placed and missed workpieces to 0.");
}

void describe(Enumeration<SelectAxis>& e) {
  e.about("Axis that a jog moves.");
  e.value(SelectAxis::kNone, "none", "No axis.");
  e.value(SelectAxis::kX, "x", "X of the tool, in the MCS.");
  e.value(SelectAxis::kY, "y", "Y of the tool, in the MCS.");
  e.value(SelectAxis::kZ, "z", "Z of the tool, in the MCS.");
  e.value(SelectAxis::kA, "a", "The tool's orientation A.");
  e.value(SelectAxis::kB, "b", "The tool's orientation B.");
  e.value(SelectAxis::kC, "c", "The tool's orientation C.");
  e.value(SelectAxis::kA1, "a1", "The real axis 1.");
  e.value(SelectAxis::kA2, "a2", "The real axis 2.");
  e.value(SelectAxis::kA3, "a3", "The real axis 3.");
  e.value(SelectAxis::kA4, "a4", "The real axis 4.");
  e.value(SelectAxis::kA5, "a5", "The real axis 5.");
  e.value(SelectAxis::kA6, "a6", "The real axis 6.");
  e.value(SelectAxis::kAux1, "aux1", "The auxiliary axis: the first one after the kinematics.");
}

}  // namespace takt::pickplace
