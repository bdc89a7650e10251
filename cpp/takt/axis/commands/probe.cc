#include "takt/axis/commands/probe.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Enumeration<ProbeEdge>& e) {
  e.about("Edge of the touch probe that captures.");
  e.value(ProbeEdge::kRising, "rising", "The probe switches on.");
  e.value(ProbeEdge::kFalling, "falling", "The probe switches off.");
}

void describe(Enumeration<TouchMode>& e) {
  e.about("Mode of GT_Touch.");
  e.value(TouchMode::kCapture, "capture",
          "Waits for the edge, then ends the motion in progress, stops and returns to the captured position.");
  e.value(TouchMode::kSlow, "slow", "Reduces the velocity of any move, velocity motion or jog while the probe is on.");
}

void describe(Description<TouchProbe>& d) {
  using C = TouchProbe;
  d.about(
      "Captures the position at the next edge of the touch probe (MC_TouchProbe). Up to 8 commands wait at once, each "
      "for its own edge and window.");
  d.defaulted<&C::edge>("Edge that captures.");
  d.defaulted<&C::window_only>("True: only edges within the window count.");
  d.defaulted<&C::first_position>(unit::u, "Lower end of the window.");
  d.defaulted<&C::last_position>(
      unit::u, "Upper end of the window; below first_position on rotary axes: the window includes 0.");
}

void describe(Description<AbortTrigger>& d) {
  d.about("Ends the commands that wait for the touch probe, as aborted (MC_AbortTrigger).");
  d.defaulted<&AbortTrigger::edge>("Edge of the commands to end; unset: all commands.");
}

void describe(Description<Touch>& d) {
  using C = Touch;
  d.about(
      "Captures the position at an edge of the touch probe, stops and returns there; or slows down while the probe is "
      "on (GT_Touch).");
  d.defaulted<&C::mode>("Capture or slow.");
  d.defaulted<&C::edge>("Edge that captures; in slow mode rising: while the probe is on, falling: while it is off.");
  d.defaulted<&C::velocity>(unit::u_s, positive,
                            "Largest velocity of the return, or while the probe is on; unset: the axis' limit.");
  DescribeRamps(d);
}

void describe(Description<DigitalCamSwitch>& d) {
  using C = DigitalCamSwitch;
  d.about(
      "Switches outputs by the position of the axis (MC_DigitalCamSwitch), until the command is repeated with enable "
      "false.");
  d.required<&C::switches>("Name of a list of cam switches of the machine.");
  d.defaulted<&C::enable_mask>("Tracks that are enabled, a bit for each.");
  d.defaulted<&C::enable>("False: all outputs are off.");
  d.defaulted<&C::source>("Set point or measured position.");
}

void describe(Description<TorqueControl>& d) {
  using C = TorqueControl;
  d.about(
      "Drives with a torque, within limits of velocity and acceleration (MC_TorqueControl). Reached when the set "
      "torque is reached.");
  d.required<&C::torque>(unit::nm, "Torque, signed.");
  d.defaulted<&C::torque_ramp>(positive, "Rate of change of the torque in Nm/s; unset: the torque is set at once.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity in both directions; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kChange);
}

}  // namespace takt::axis
