#include "takt/flexcam/commands.h"

#include "takt/core/describe.h"

namespace takt::flexcam {

namespace {

template <template <typename> class Of>
void DescribeInputs(Description<InputsOf<Of>>& d) {
  using I = InputsOf<Of>;
  const Range position = between(-1e12, 1e12);
  d.template defaulted<&I::enable>(
      "Enables the module; false: it takes the slave off the cam, brings it to rest and releases it. Flex Cam: "
      "xEnable.");
  d.template defaulted<&I::internal_control>(
      "The slave accepts commands of its own while the module waits; stop still acts. Flex Cam: "
      "xEnableInternalControl.");
  d.template defaulted<&I::reset_error>(
      "A rising edge acknowledges errors of module and slave. Flex Cam: xResetError.");
  d.template defaulted<&I::regulator_on>("Switches the slave on. Flex Cam: xRegulatorOn.");
  d.template defaulted<&I::stop>("Stops the slave and keeps it stopped. Flex Cam: xStop.");
  d.template defaulted<&I::halt>("Brings the slave to rest and keeps it there. Flex Cam: xHalt.");
  d.template defaulted<&I::home_execute>("A rising edge starts homing. Flex Cam: xHomeExecute.");
  d.template defaulted<&I::home_abs_switch>(
      "Reference switch in addition to that of the slave. Flex Cam: xHomeAbsSwitch.");
  d.template defaulted<&I::enable_hw_limit>("Enables the two limit switch inputs below. Flex Cam: xEnableHWLimit.");
  d.template defaulted<&I::hw_limit_positive>(
      "Positive limit switch in addition to those of the slave. Flex Cam: xHWLimitPos.");
  d.template defaulted<&I::hw_limit_negative>(
      "Negative limit switch in addition to those of the slave. Flex Cam: xHWLimitNeg.");
  d.template defaulted<&I::sync_cam>("A rising edge closes the clutch, a falling one opens it. Flex Cam: xSyncCam.");
  d.template defaulted<&I::sync_out_instant>(
      "Opens the clutch at once and stops the slave; the clutch stays open while it is true. Flex Cam: "
      "xSyncOutInstant.");
  d.template defaulted<&I::cam_change_instant>(
      "A rising edge changes at once to the cam that is set. Flex Cam: xCamChangeInstant.");
  d.template defaulted<&I::cam_sequencer>("Runs the sequence of cam_sequence_mode. Flex Cam: xCamSequencer.");
  d.template defaulted<&I::offset_master>(position, "Added to X, in its unit. Flex Cam: lrSetOffsetMaster.");
  d.template defaulted<&I::offset_slave>(unit::u, position, "Added to Y. Flex Cam: lrSetOffsetSlave.");
  d.template defaulted<&I::scaling_master>(unit::one, between(1e-9, 1e9),
                                           "Factor from the master's position to X. Flex Cam: lrSetScalingMaster.");
  d.template defaulted<&I::scaling_slave>(unit::one, between(0, 1e9), "Factor of Y. Flex Cam: lrSetScalingSlave.");
  d.template defaulted<&I::cam_table>(between(1, kSlots), "Slot of the cam to run. Flex Cam: eSetCamTable.");
  d.template defaulted<&I::virtual_velocity>(position, "Velocity of the virtual master, in its unit per second.");
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
  d.about("Levels of the inputs of a cam module.");
  DescribeInputs(d);
}

void describe(Description<Control>& d) {
  d.named("Control");
  d.about(
      "Changes inputs of a cam module; unset inputs are kept. If it closes or opens the clutch or starts homing, the "
      "command is done when that is done.");
  DescribeInputs(d);
}

void describe(Description<Jog>& d) {
  d.about("Jogs the slave as long as a key is held; the first of two keys has priority. Flex Cam: xJogPos, xJogNeg.");
  d.defaulted<&Jog::positive>("State of the key for upwards.");
  d.defaulted<&Jog::negative>("State of the key for downwards.");
}

void describe(Description<SetCam>& d) {
  d.about(
      "Puts another cam into a slot, from the machine file or made at run time. If the slot is running, the cam "
      "changes as if another slot was set.");
  d.required<&SetCam::slot>(between(1, kSlots), "Slot to fill.");
  d.required<&SetCam::cam>("Name of the cam. Flex Cam: CamTable1 to CamTable4.");
}

void describe(Description<ChangeCam>& d) {
  d.about(
      "Changes the cam at a position or event; done when it has changed. Up to eight changes can be pending; they are "
      "carried out in order.");
  d.required<&ChangeCam::cam_table>(between(1, kSlots), "Slot of the cam to run after the change.");
  d.defaulted<&ChangeCam::when>("Event at which the cam changes.");
  d.defaulted<&ChangeCam::position>(
      between(-1e12, 1e12),
      "Position of the master (in its turn) or of X at which the cam changes, for events that need one.");
  d.defaulted<&ChangeCam::align>("Shift that makes both cams meet.");
}

void describe(Description<WithdrawChanges>& d) {
  d.about("Withdraws the pending changes of cam.");
}

void describe(Enumeration<ChangeWhen>& e) {
  e.about("Event at which a cam changes.");
  e.value(ChangeWhen::kAtOnce, "at_once", "In this cycle.");
  e.value(ChangeWhen::kMasterPosition, "master_position", "The master passes a position.");
  e.value(ChangeWhen::kCamPosition, "cam_position", "X passes a position.");
  e.value(ChangeWhen::kNextCycle, "next_cycle", "The end of the cam is reached.");
  e.value(ChangeWhen::kWithoutJump, "without_jump", "Both cams meet with the shift of align.");
}

void describe(Enumeration<ChangeAlign>& e) {
  e.about("Shift at a change of cam.");
  e.value(ChangeAlign::kNothing, "nothing", "No shift.");
  e.value(ChangeAlign::kPosition, "position", "Y is shifted, so that the position does not jump.");
  e.value(ChangeAlign::kVelocity, "velocity",
          "X is shifted to the nearest position of the new cam with the same slope, then Y: neither position nor "
          "velocity jumps. From an end that is held: to the beginning of the cam, whatever its slope; only the "
          "position does not jump.");
}

}  // namespace takt::flexcam
