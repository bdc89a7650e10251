#include "takt/pickplace/commands.h"

#include "takt/core/describe.h"

namespace takt::pickplace {

namespace {

template <template <typename> class Of>
void DescribeInputs(Description<InputsOf<Of>>& d) {
  using I = InputsOf<Of>;
  d.template defaulted<&I::enable>(
      "The module works; false: it lets the tool come to rest, forgets its path and leaves the group alone. T&P: "
      "xEnable.");
  d.template defaulted<&I::internal_control>(
      "The group takes commands of its own, the module waits; stop_all works on. T&P: xEnableInternalControl.");
  d.template defaulted<&I::reset_error>(
      "A rising edge acknowledges errors of module, group and axes. T&P: xResetError.");
  d.template defaulted<&I::regulator_on>("All axes are switched on. T&P: xRegulatorOnALL.");
  d.template defaulted<&I::path_stop>("Stops on the path, with path_stop_deceleration. T&P: xPathStop.");
  d.template defaulted<&I::path_halt>("Stops on the path, with path_halt_deceleration. T&P: xPathHalt.");
  d.template defaulted<&I::stop_all>("Stops each axis by itself; the path begins anew afterwards. T&P: xStopALL.");
  d.template defaulted<&I::home_execute>("A rising edge starts homing. T&P: xGroupHomeExecute.");
  d.template defaulted<&I::home_abs_switch>(
      "Reference switches of A1 to A6 and Aux1 beside those of the axes. T&P: axHomeAbsSwitch.");
  d.template defaulted<&I::enable_hw_limit>("The two inputs below are looked at. T&P: xGroupEnableHWLimit.");
  d.template defaulted<&I::hw_limit_positive>(
      "Limit switches beside those of the axes: X, Y, Z, A, B, C, A1 to A6, Aux1. T&P: axHwLimitPos.");
  d.template defaulted<&I::hw_limit_negative>("The others. T&P: axHwLimitNeg.");
  d.template defaulted<&I::select_axis>("What a jog moves; a change counts for the next one. T&P: eSelectAxis.");
  d.template defaulted<&I::execute>(
      "A rising edge starts a profile, adds one, or goes on with the path that was stopped. T&P: "
      "xExecutePickAndPlace.");
  d.template defaulted<&I::set_target>(
      at_most(kBelts),
      "Where to, in tracking mode program: a belt of the module's list from 1; 0: the static target. T&P: eSetTarget.");
  d.template defaulted<&I::path_interrupt>("In MOVE_PP: stops on the path; false again: goes on. T&P: xPathInterrupt.");
  d.template defaulted<&I::abort>(
      "A rising edge at rest forgets the path; in a tracking mode on the way it ends the loop behind this profile. "
      "T&P: xAbort.");
  d.template defaulted<&I::override_factor>(unit::one, between(0, 1),
                                            "Of speeds at once, and of accelerations and jerks of profiles that begin "
                                            "meanwhile, 0.1 at least; 0 holds the path. T&P: lrOverride.");
  d.template defaulted<&I::ack_gripper>(
      "A rising edge ends the time on the workpiece: the tool lifts at once. T&P: xAckGripper.");
  d.template defaulted<&I::return_to_path>("A rising edge moves the tool back to where it left its path.");
}

}  // namespace

bool AsksToMove(const Control& c) noexcept {
  return c.enable.value_or(false) || c.regulator_on.value_or(false) || c.home_execute.value_or(false) ||
         c.execute.value_or(false) || c.return_to_path.value_or(false);
}

void describe(Description<Inputs>& d) {
  d.named("PickPlaceInputs");
  d.about("Inputs of a pick and place module, as they stand.");
  DescribeInputs(d);
}

void describe(Description<Control>& d) {
  d.named("ControlPickPlace");
  d.about("Changes inputs of a pick and place module; what is not given stays as it is.");
  DescribeInputs(d);
}

void describe(Description<Jog>& d) {
  d.named("JogPickPlace");
  d.about("Moves the selected axis for as long as a key is held (T&P: xJogPos, xJogNeg).");
  d.defaulted<&Jog::positive>("In positive direction.");
  d.defaulted<&Jog::negative>("In negative direction; with both the one that came first counts.");
}

void describe(Description<ResetCounters>& d) {
  d.about("Sets what was picked, placed and missed to 0.");
}

void describe(Enumeration<SelectAxis>& e) {
  e.about("What a jog moves.");
  e.value(SelectAxis::kNone, "none", "Nothing.");
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
  e.value(SelectAxis::kAux1, "aux1", "The auxiliary axis: the one behind the kinematics.");
}

}  // namespace takt::pickplace
