#include "takt/axis/commands/cam.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Enumeration<CamStart>& e) {
  e.about("How a slave gets onto its cam.");
  e.value(CamStart::kAbsolute, "absolute", "As fast as the axis can.");
  e.value(CamStart::kRelative, "relative", "The cam is shifted to where the slave is: as with slave_absolute false.");
  e.value(CamStart::kRampIn, "ramp_in", "Within the velocity and the ramps of the command.");
}

void describe(Description<CamTableSelect>& d) {
  d.about(
      "Says whether the machine has a cam of this name (MC_CamTableSelect). All are loaded; which one is followed, "
      "cam_in says.");
  d.required<&CamTableSelect::cam>("Name of the cam.");
}

void describe(Description<CamIn>& d) {
  using C = CamIn;
  d.about(
      "Follows a master's position along a cam (MC_CamIn): slave_scaling times the cam's y, plus slave_offset, where x "
      "is master_scaling times the master's position, plus master_offset. Reached when in step. Buffered commands "
      "behind it begin at the end of the cam.");
  d.required<&C::master>("Name of the master axis.");
  d.required<&C::cam>("Name of the cam.");
  d.defaulted<&C::source>("Which of the master's positions is followed.");
  d.defaulted<&C::master_offset>("In the cam's x.");
  d.defaulted<&C::slave_offset>(unit::u, "Added to the cam's y.");
  d.defaulted<&C::master_scaling>("The cam's x per master's unit, not 0.");
  d.defaulted<&C::slave_scaling>("The cam's y is multiplied by it.");
  d.defaulted<&C::master_absolute>(
      "True: x counts from the master's zero. False: the cam begins where the master is when the command takes "
      "control, or at master_sync_position.");
  d.defaulted<&C::slave_absolute>(
      "True: y counts from this axis' zero. False: the cam is shifted to where this axis is when it begins.");
  d.defaulted<&C::periodic>(
      "True: over and over, each time higher by the cam's stroke. False: once, outside its end positions are held. "
      "Unset: periodic where the cam is cyclic.");
  d.defaulted<&C::start_mode>("How this axis gets onto the cam.");
  d.defaulted<&C::master_sync_position>(
      "Where the master is, in its own unit, when both are in step; unset: at the next beginning of the cam if "
      "master_start_distance is given, else at once. A linear master that moves away from there by more than a cycle "
      "of the cam ends the command with error 3110.");
  d.defaulted<&C::master_start_distance>(
      not_negative,
      "How far before that, in the master's unit, getting into step begins. Unset or 0: it begins there, within the "
      "limits of this command.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity of ramping in; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

void describe(Description<CamAdd>& d) {
  using C = CamAdd;
  d.about(
      "Superimposes another cam on that of cam_in, over the same master (MC_CamAdd): slave_scaling times its y, plus "
      "slave_offset, is added to this axis' position. Up to three at a time; what steps is caught up with within the "
      "limits of cam_in. They end with that coupling.");
  d.required<&C::cam>("Name of the cam; each once at a time.");
  d.defaulted<&C::master_offset>("In the cam's x.");
  d.defaulted<&C::slave_offset>(unit::u, "Added to the cam's y.");
  d.defaulted<&C::master_scaling>("The cam's x per master's unit, not 0.");
  d.defaulted<&C::slave_scaling>("The cam's y is multiplied by it.");
  d.defaulted<&C::master_absolute>(
      "True: x counts from the master's zero. False: the cam begins where the master is now.");
  d.defaulted<&C::slave_absolute>("True: y is added as it is. False: less what it is now, without a step.");
  d.defaulted<&C::periodic>(
      "True: over and over. False: once, outside its end positions are held. Unset: periodic where the cam is cyclic.");
}

void describe(Description<CamRemove>& d) {
  d.about(
      "Removes a superimposed cam (MC_CamRemove): this axis goes to the position without it, within the limits of "
      "cam_in.");
  d.required<&CamRemove::cam>("Name of the cam.");
}

void describe(Description<CamOut>& d) {
  d.about("Lets go of the master; the axis goes on with the velocity it has (MC_CamOut).");
}

}  // namespace takt::axis
