#include "takt/axis/commands/settings.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Description<SetConstants>& d) {
  using C = SetConstants;
  d.about("Sets the constants of the position loop and the SW limits; unset values are kept (GT_SetConstant).");
  d.defaulted<&C::kp>(not_negative, "Proportional gain.");
  d.defaulted<&C::ki>(not_negative, "Integral gain.");
  d.defaulted<&C::kd>(not_negative, "Derivative gain.");
  d.defaulted<&C::kc>(not_negative, "Anti-windup factor, at most 1.");
  d.defaulted<&C::ff>(not_negative, "Share of the set velocity that is fed forward.");
  d.defaulted<&C::velocity_at_10v>(unit::u_s, positive,
                                   "Velocity limit of the loop, Vmax; analogue drives: the speed at 10 V.");
  d.defaulted<&C::lower>(unit::u, "Lower SW limit, LimNeg.");
  d.defaulted<&C::upper>(unit::u, "Upper SW limit, LimPos.");
}

void describe(Description<SetLoad>& d) {
  using C = SetLoad;
  d.about(
      "Changes the torque feed-forward of the drive, `drive: torque_offset` of the machine file, for instance for a "
      "payload that was gripped; unset values are kept.");
  d.defaulted<&C::inertia>(not_negative, "Torque per u/s².");
  d.defaulted<&C::coulomb_friction>(not_negative, "Friction torque, in the sense of the set velocity.");
  d.defaulted<&C::viscous_friction>(not_negative, "Torque per u/s.");
  d.defaulted<&C::load_torque>("Constant torque.");
}

void describe(Description<WriteParameter>& d) {
  using C = WriteParameter;
  d.about("Sets a parameter by its number (MC_WriteParameter).");
  d.required<&C::number>(
      at_least(1),
      "PLCopen's number, 2 to 7; 9, 13, 15, 17: limits of the application, at most those of the machine file, while "
      "the axis is at rest; 1007: largest following error at rest; 1008: torque limit.");
  d.required<&C::value>("Value in the parameter's unit; booleans as 0 and 1.");
}

void describe(Description<ReadParameter>& d) {
  using C = ReadParameter;
  d.about(
      "Reads a parameter by its number (MC_ReadParameter). Done: the value of the feedback is that of the parameter.");
  d.required<&C::number>(at_least(1),
                         "PLCopen's number, 1 to 17; or 1001 to 1006: kp, ki, kd, kc, ff and Vmax of the position "
                         "loop; 1007: largest following error at rest; 1008: torque limit.");
}

void describe(Description<SetSoftLimits>& d) {
  using C = SetSoftLimits;
  d.about("Sets the SW limits at run time, or switches them off (GT_SWLim).");
  d.defaulted<&C::enable_lower>("Enables the lower SW limit.");
  d.defaulted<&C::enable_upper>("Enables the upper SW limit.");
  d.defaulted<&C::lower>(unit::u,
                         "Lower SW limit, LimNeg; unset: the present one, or the one before it was switched off; none "
                         "if there was never one.");
  d.defaulted<&C::upper>(unit::u, "Upper SW limit, LimPos; unset: likewise.");
}

void describe(Description<DirectOutput>& d) {
  using C = DirectOutput;
  d.about("Outputs a voltage while the axis is Disabled (GT_Analog); analogue drives only.");
  d.required<&C::voltage>(unit::volt, "Voltage from -10 to 10 V.");
}

void describe(Description<PulseOutput>& d) {
  using C = PulseOutput;
  d.about(
      "Outputs a voltage for a time while the axis is Disabled, then 0 V (GT_Pulse); analogue drives only. Aborted by "
      "other commands that output a voltage, by power on and by faults.");
  d.required<&C::voltage>(unit::volt, "Voltage from -10 to 10 V.");
  d.required<&C::duration>(unit::s, positive, "Duration, rounded to whole cycles, at least one.");
}

void describe(Description<WriteOutput>& d) {
  using C = WriteOutput;
  d.about(
      "Switches a digital output (MC_WriteDigitalOutput), independently of the state of the axis. An output is on "
      "while it is switched on by this command or by the track of digital_cam_switch with its number.");
  d.required<&C::number>(between(1, 32), "Number of the output: bit number - 1 of digital_outputs.");
  d.required<&C::value>("True: on.");
}

void describe(Description<SetPosition>& d) {
  using C = SetPosition;
  d.about("Sets the present position to another value without motion (MC_SetPosition).");
  d.required<&C::position>(unit::u, "New position, or the amount added to the present one.");
  d.defaulted<&C::relative>("True: position is added to the present one.");
}

void describe(Description<SetOverride>& d) {
  using C = SetOverride;
  d.about("Scales velocity, ramps and jerk of the motion in progress and of later ones (MC_SetOverride).");
  d.defaulted<&C::velocity_factor>(
      not_negative, "Factor of velocities, up to the axis' limits; 0 holds the axis until the factor is raised.");
  d.defaulted<&C::acceleration_factor>(positive, "Factor of accelerations and decelerations.");
  d.defaulted<&C::jerk_factor>(positive, "Factor of the jerk.");
}

}  // namespace takt::axis
