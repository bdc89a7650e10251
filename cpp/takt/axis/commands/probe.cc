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
  e.value(TouchMode::kCapture, "capture",
          "Waits for the edge, then ends the motion in progress and stops at the position captured.");
  e.value(TouchMode::kSlow, "slow", "Slows any move, velocity motion or jog down while the probe is on.");
}

void describe(Description<TouchProbe>& d) {
  using C = TouchProbe;
  d.about(
      "Captures the position at the touch probe's next edge (MC_TouchProbe). Up to 8 wait at once, each for its edge "
      "and window.");
  d.defaulted<&C::edge>("Which edge.");
  d.defaulted<&C::window_only>("True: only within the window.");
  d.defaulted<&C::first_position>(unit::u, "Lower end of the window.");
  d.defaulted<&C::last_position>(unit::u, "Upper end; below the first on rotary axes: across 0.");
}

void describe(Description<AbortTrigger>& d) {
  d.about("Ends the commands that wait for the touch probe, as aborted (MC_AbortTrigger).");
  d.defaulted<&AbortTrigger::edge>("Only those that wait for this edge; unset: all.");
}

void describe(Description<Touch>& d) {
  using C = Touch;
  d.about(
      "Captures the position at the touch probe's edge, stops and returns there; or slows down while the probe is on "
      "(GT_Touch).");
  d.defaulted<&C::mode>("Which of both.");
  d.defaulted<&C::edge>("Which edge; slow: rising is while the probe is on, falling while it is off.");
  d.defaulted<&C::velocity>(unit::u_s, positive,
                            "Largest velocity of the way back, or while the probe is on; unset: the axis' limit.");
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
  d.defaulted<&C::source>("Set point or measured position.");
}

void describe(Description<TorqueControl>& d) {
  using C = TorqueControl;
  d.about(
      "Drives with a torque, within limits of velocity and acceleration (MC_TorqueControl). Reached when the set point "
      "of the torque is.");
  d.required<&C::torque>(unit::nm, "Signed.");
  d.defaulted<&C::torque_ramp>(positive, "Nm/s; unset: at once.");
  d.defaulted<&C::velocity>(unit::u_s, positive, "Largest velocity, either way; unset: the axis' limit.");
  DescribeRamps(d);
  d.defaulted<&C::buffer_mode>(kBufferMode);
  d.defaulted<&C::update>(kChange);
}

}  // namespace takt::axis
