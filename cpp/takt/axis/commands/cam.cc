#include "takt/axis/commands/cam.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Enumeration<CamStart>& e) {
  e.about("How a slave synchronises to its cam.");
  e.value(CamStart::kAbsolute, "absolute", "As fast as the limits of the axis allow.");
  e.value(CamStart::kRelative, "relative",
          "The cam is shifted to the position of the slave, as with slave_absolute false.");
  e.value(CamStart::kRampIn, "ramp_in", "Within the velocity and the ramps of the command.");
}

void describe(Description<CamTableSelect>& d) {
  d.about(
      "Checks that the machine has a cam of this name (MC_CamTableSelect). All cams are loaded; cam_in chooses the one "
      "to follow.");
  d.required<&CamTableSelect::cam>("Name of the cam.");
}

void describe(Description<CamIn>& d) {
  using C = CamIn;
  d.about(
      "Follows a master's position along a cam (MC_CamIn): slave_scaling times the cam's y, plus slave_offset, at x = "
      "master_scaling times the master's position, plus master_offset. Reached when in step. Buffered commands begin "
      "at the end of the cam.");
  d.required<&C::master>("Name of the master axis.");
  d.required<&C::cam>("Name of the cam.");
  d.defaulted<&C::source>("Position of the master that is followed.");
  d.defaulted<&C::master_offset>("Added to the scaled master's position, in the cam's x.");
  d.defaulted<&C::slave_offset>(unit::u, "Added to the cam's y.");
  d.defaulted<&C::master_scaling>("The cam's x per master's unit, not 0.");
  d.defaulted<&C::slave_scaling>("Factor of the cam's y.");
  d.defaulted<&C::master_absolute>(
      "True: x counts from the master's zero. False: the cam begins at the master's position when the command takes "
      "control, or at master_sync_position.");
  d.defaulted<&C::slave_absolute>(
      "True: y counts from this axis' zero. False: the cam is shifted to the position of this axis when it begins.");
  d.defaulted<&C::periodic>(
      "True: the cam repeats, raised by its stroke each time. False: it runs once, and its end positions are held "
      "outside. Unset: true for a cyclic cam.");
  d.defaulted<&C::start_mode>("How this axis synchronises to the cam.");
  d.defaulted<&C::master_sync_position>(
      "Position of the master, in its own unit, at which both are in step; unset: the next beginning of the cam if "
      "master_start_distance is given, else the present position. If a linear master moves away from there by more "
      "than a cycle of the cam, the command ends with error 3110.");
  d.defaulted<&C::master_start_distance>(
      not_negative,
      "Distance of the master, in its own unit, before that position at which synchronisation begins. Unset or 0: "
      "synchronisation begins at that position, within the limits of this command.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity of ramping in; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kUpdate);
}

void describe(Description<CamAdd>& d) {
  using C = CamAdd;
  d.about(
      "Superimposes another cam on that of cam_in, over the same master (MC_CamAdd): slave_scaling times its y, plus "
      "slave_offset, is added to the position of this axis. Up to three at a time; steps are caught up within the "
      "limits of cam_in. Added cams end with that coupling.");
  d.required<&C::cam>("Name of the cam; the same cam can be added only once at a time.");
  d.defaulted<&C::master_offset>("Added to the scaled master's position, in the cam's x.");
  d.defaulted<&C::slave_offset>(unit::u, "Added to the cam's y.");
  d.defaulted<&C::master_scaling>("The cam's x per master's unit, not 0.");
  d.defaulted<&C::slave_scaling>("Factor of the cam's y.");
  d.defaulted<&C::master_absolute>(
      "True: x counts from the master's zero. False: the cam begins at the present position of the master.");
  d.defaulted<&C::slave_absolute>(
      "True: y is added as it is. False: the present y is subtracted, so that there is no step.");
  d.defaulted<&C::periodic>(
      "True: the cam repeats. False: it runs once, and its end positions are held outside. Unset: true for a cyclic "
      "cam.");
}

void describe(Description<CamRemove>& d) {
  d.about(
      "Removes a superimposed cam (MC_CamRemove): this axis moves to the position without it, within the limits of "
      "cam_in.");
  d.required<&CamRemove::cam>("Name of the cam.");
}

void describe(Description<CamOut>& d) {
  d.about("Releases the axis from the master; it keeps its velocity (MC_CamOut).");
}

}  // namespace takt::axis
