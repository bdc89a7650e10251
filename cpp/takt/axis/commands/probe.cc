#include "takt/axis/commands/probe.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Enumeration<ProbeEdge>& e) {
  e.about("Which edge of the probe counts.");
  e.value(ProbeEdge::kRising, "rising", "It goes on.");
  e.value(ProbeEdge::kFalling, "falling", "It goes off.");
}

void describe(Enumeration<TouchMode>& e) {
  e.about("What GT_Touch does.");
  e.value(TouchMode::kCapture, "capture", "Captures, stops and returns to the captured position.");
  e.value(TouchMode::kSlow, "slow", "Slows down while the probe is on.");
}

void describe(Description<TouchProbe>& d) {
  using C = TouchProbe;
  d.about("Captures the position at the touch probe's next edge (MC_TouchProbe).");
  d.defaulted<&C::edge>("Which edge.");
  d.defaulted<&C::window_only>("True: only within the window.");
  d.defaulted<&C::first_position>(unit::u, "Where the window begins.");
  d.defaulted<&C::last_position>(unit::u, "Where it ends.");
}

void describe(Description<AbortTrigger>& d) {
  d.about("Gives up waiting for the touch probe (MC_AbortTrigger).");
}

void describe(Description<Touch>& d) {
  using C = Touch;
  d.about(
      "Captures the position at the touch probe's edge, stops and returns there; or slows down while the probe is on "
      "(GT_Touch).");
  d.defaulted<&C::mode>("Which of both.");
  d.defaulted<&C::edge>("Which edge.");
  d.defaulted<&C::velocity>(unit::u_s, not_negative, "Of the way back, or while the probe is on.");
  DescribeRamps(d);
}

void describe(Description<DigitalCamSwitch>& d) {
  using C = DigitalCamSwitch;
  d.about(
      "Switches outputs on and off by the axis' position (MC_DigitalCamSwitch), until it is given again with enable "
      "false.");
  d.required<&C::switches>("Name of a list of switches of the machine.");
  d.defaulted<&C::enable_mask>("A bit for each track.");
  d.defaulted<&C::enable>("False: all outputs off.");
}

void describe(Description<TorqueControl>& d) {
  using C = TorqueControl;
  d.about("Drives with a torque, no faster than a velocity (MC_TorqueControl). Reached when the torque is.");
  d.required<&C::torque>(unit::nm, "Signed.");
  d.defaulted<&C::torque_ramp>(positive, "Nm/s; unset: at once.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
}

}  // namespace takt::axis
