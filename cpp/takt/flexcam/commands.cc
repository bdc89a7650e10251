#include "takt/flexcam/commands.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

template <template <typename> class Of>
void DescribeInputs(Description<InputsOf<Of>>& d) {
  using I = InputsOf<Of>;
  const Range position = between(-1e12, 1e12);
  d.template defaulted<&I::enable>(
      "The module works; false: it takes the slave off the cam, lets it come to rest and leaves it alone. Flex Cam: "
      "xEnable.");
  d.template defaulted<&I::internal_control>(
      "The slave takes commands of its own, the module waits; stop works on. Flex Cam: xEnableInternalControl.");
  d.template defaulted<&I::reset_error>(
      "A rising edge acknowledges errors of module and slave. Flex Cam: xResetError.");
  d.template defaulted<&I::regulator_on>("The slave is switched on. Flex Cam: xRegulatorOn.");
  d.template defaulted<&I::stop>("Stops the slave and keeps it so. Flex Cam: xStop.");
  d.template defaulted<&I::halt>("Brings the slave to rest and keeps it so. Flex Cam: xHalt.");
  d.template defaulted<&I::home_execute>("A rising edge starts homing. Flex Cam: xHomeExecute.");
  d.template defaulted<&I::home_abs_switch>("A reference switch beside that of the slave. Flex Cam: xHomeAbsSwitch.");
  d.template defaulted<&I::enable_hw_limit>("The two inputs below are looked at. Flex Cam: xEnableHWLimit.");
  d.template defaulted<&I::hw_limit_positive>("A limit switch beside those of the slave. Flex Cam: xHWLimitPos.");
  d.template defaulted<&I::hw_limit_negative>("A limit switch beside those of the slave. Flex Cam: xHWLimitNeg.");
  d.template defaulted<&I::sync_cam>("A rising edge closes the clutch, a falling one opens it. Flex Cam: xSyncCam.");
  d.template defaulted<&I::sync_out_instant>(
      "Opens the clutch at once and stops the slave; it stays open as long. Flex Cam: xSyncOutInstant.");
  d.template defaulted<&I::cam_change_instant>(
      "A rising edge changes to the cam that is set at once. Flex Cam: xCamChangeInstant.");
  d.template defaulted<&I::cam_sequencer>("Runs the sequence of cam_sequence_mode. Flex Cam: xCamSequencer.");
  d.template defaulted<&I::offset_master>(position, "Added to X, in its unit. Flex Cam: lrSetOffsetMaster.");
  d.template defaulted<&I::offset_slave>(unit::u, position, "Added to Y. Flex Cam: lrSetOffsetSlave.");
  d.template defaulted<&I::scaling_master>(unit::one, between(1e-9, 1e9),
                                           "X per the master's unit. Flex Cam: lrSetScalingMaster.");
  d.template defaulted<&I::scaling_slave>(unit::one, between(0, 1e9), "Of Y. Flex Cam: lrSetScalingSlave.");
  d.template defaulted<&I::cam_table>(between(1, kSlots), "The slot of the cam to run. Flex Cam: eSetCamTable.");
  d.template defaulted<&I::virtual_velocity>(position, "Of a master without an axis, in its unit per second.");
}

}  // namespace

bool AsksToMove(const Control& c) noexcept {
  return c.enable.value_or(false) || c.regulator_on.value_or(false) || c.home_execute.value_or(false) ||
         c.sync_cam.value_or(false);
}

std::string Diagnose(const Command& command) {
  const auto* set = std::get_if<SetCam>(&command);
  return set && set->cam.empty() ? "cam: expected the name of a cam, found an empty text" : std::string();
}

void describe(Description<Inputs>& d) {
  d.named("FlexCamInputs");
  d.about("The levels at a cam module's inputs.");
  DescribeInputs(d);
}

void describe(Description<Control>& d) {
  d.named("Control");
  d.about(
      "Changes inputs of a cam module; what is not given stays. Where it closes or opens the clutch or starts homing, "
      "it "
      "is done when that is.");
  DescribeInputs(d);
}

void describe(Description<Jog>& d) {
  d.about("Jogs the slave as long as a key is held; the first of two keys counts. Flex Cam: xJogPos, xJogNeg.");
  d.defaulted<&Jog::positive>("The key for upwards.");
  d.defaulted<&Jog::negative>("The key for downwards.");
}

void describe(Description<SetCam>& d) {
  d.about(
      "Puts another cam into a slot, one of the machine file or made at run time. Where that slot runs, the cam "
      "changes "
      "as when another slot is set.");
  d.required<&SetCam::slot>(between(1, kSlots), "Which one.");
  d.required<&SetCam::cam>("Name of the cam. Flex Cam: CamTable1 to CamTable4.");
}

void describe(Description<ChangeCam>& d) {
  d.about("Changes the cam at a given place; done when it has. Up to eight changes wait for one another.");
  d.required<&ChangeCam::cam_table>(between(1, kSlots), "The slot of the cam to run then.");
  d.defaulted<&ChangeCam::when>("Where it takes place.");
  d.defaulted<&ChangeCam::position>(between(-1e12, 1e12),
                                    "Of the master (in its turn) or X, where it takes place at one.");
  d.defaulted<&ChangeCam::align>("What is shifted so that both cams meet.");
}

void describe(Description<WithdrawChanges>& d) {
  d.about("Withdraws the changes of cam that have not taken place.");
}

void describe(Enumeration<ChangeWhen>& e) {
  e.about("Where a change of cam takes place.");
  e.value(ChangeWhen::kAtOnce, "at_once", "In this cycle.");
  e.value(ChangeWhen::kMasterPosition, "master_position", "Where the master passes a position.");
  e.value(ChangeWhen::kCamPosition, "cam_position", "Where X passes a position.");
  e.value(ChangeWhen::kNextCycle, "next_cycle", "At the end of the cam.");
  e.value(ChangeWhen::kWithoutJump, "without_jump", "As soon as both cams meet after what is shifted.");
}

void describe(Enumeration<ChangeAlign>& e) {
  e.about("What is shifted at a change of cam.");
  e.value(ChangeAlign::kNothing, "nothing", "Nothing.");
  e.value(ChangeAlign::kPosition, "position", "Y, so that the position does not jump.");
  e.value(
      ChangeAlign::kVelocity, "velocity",
      "X to the nearest place of the new cam with the same slope, then Y: neither position nor velocity jumps. From an "
      "end that is held: from the cam's beginning, whatever its slope; the position does not jump.");
}

}  // namespace takt::flexcam
