#include "takt/axis/commands/settings.h"

#include "takt/axis/commands/texts.h"

namespace takt::axis {

void describe(Description<SetConstants>& d) {
  using C = SetConstants;
  d.about("Sets the constants of the position loop and the SW limits; what is left out stays (GT_SetConstant).");
  d.defaulted<&C::kp>(not_negative, "Gain of P.");
  d.defaulted<&C::ki>(not_negative, "Gain of I.");
  d.defaulted<&C::kd>(not_negative, "Gain of D.");
  d.defaulted<&C::kc>(not_negative, "Anti-windup, at most 1.");
  d.defaulted<&C::ff>(not_negative, "Share of the velocity that is fed forward.");
  d.defaulted<&C::velocity_at_10v>(unit::u_s, positive, "Vmax.");
  d.defaulted<&C::lower>(unit::u, "LimNeg.");
  d.defaulted<&C::upper>(unit::u, "LimPos.");
}

void describe(Description<SetLoad>& d) {
  using C = SetLoad;
  d.about(
      "Says what the drive moves from now on (a payload that was gripped): the torque that it adds from the set point, "
      "`drive: torque_offset` of the machine file; what is left out stays.");
  d.defaulted<&C::inertia>(not_negative, "Torque per u/s².");
  d.defaulted<&C::coulomb_friction>(not_negative, "Torque, in the sense of the set velocity.");
  d.defaulted<&C::viscous_friction>(not_negative, "Torque per u/s.");
  d.defaulted<&C::load_torque>("Torque, constant.");
}

void describe(Description<WriteParameter>& d) {
  using C = WriteParameter;
  d.about("Sets a parameter by its number (MC_WriteParameter).");
  d.required<&C::number>(at_least(1),
                         "PLCopen's number, 2 to 7; 9, 13, 15, 17: limits of the application, at most those of the "
                         "machine file, while the "
                         "axis rests; or 1007: largest following error at rest.");
  d.required<&C::value>("In the parameter's unit; 0 and 1 of yes and no.");
}

void describe(Description<ReadParameter>& d) {
  using C = ReadParameter;
  d.about("Reads a parameter by its number (MC_ReadParameter); the value of the feedback once done.");
  d.required<&C::number>(
      at_least(1),
      "PLCopen's number, 1 to 17; or 1001 to 1006: kp, ki, kd, kc, ff and Vmax of the position loop; "
      "1007: largest following error at rest.");
}

void describe(Description<SetSoftLimits>& d) {
  using C = SetSoftLimits;
  d.about("Sets the SW limits or switches them off at run time (GT_SWLim).");
  d.defaulted<&C::enable_lower>("Whether the lower one holds.");
  d.defaulted<&C::enable_upper>("Whether the upper one holds.");
  d.defaulted<&C::lower>(unit::u,
                         "LimNeg; unset: as it is, or was when it was switched off; none, where there never was one.");
  d.defaulted<&C::upper>(unit::u, "LimPos; unset: likewise.");
}

void describe(Description<DirectOutput>& d) {
  using C = DirectOutput;
  d.about("Puts a voltage out while the axis is Disabled (GT_Analog); analogue drives only.");
  d.required<&C::voltage>(unit::volt, "-10 to 10 V.");
}

void describe(Description<PulseOutput>& d) {
  using C = PulseOutput;
  d.about(
      "Puts a voltage out for a time while the axis is Disabled, and 0 V after it (GT_Pulse); analogue drives only. "
      "Aborted by whatever else puts out a voltage, by power on and by faults.");
  d.required<&C::voltage>(unit::volt, "-10 to 10 V.");
  d.required<&C::duration>(unit::s, positive, "How long, to the nearest cycle, one at least.");
}

void describe(Description<WriteOutput>& d) {
  using C = WriteOutput;
  d.about(
      "Switches a digital output (MC_WriteDigitalOutput), which stays so whatever the axis does. An output is on while "
      "it is written so, or a track of digital_cam_switch with its number is on.");
  d.required<&C::number>(between(1, 32), "Which output: bit number - 1 of digital_outputs.");
  d.required<&C::value>("On or off.");
}

void describe(Description<SetPosition>& d) {
  using C = SetPosition;
  d.about("Calls the position the axis is at by another number, without any motion (MC_SetPosition).");
  d.required<&C::position>(unit::u, "The new number, or what is added to the old one.");
  d.defaulted<&C::relative>("True: added.");
}

void describe(Description<SetOverride>& d) {
  using C = SetOverride;
  d.about("Scales velocity, ramps and jerk of the motion in progress and of those to come (MC_SetOverride).");
  d.defaulted<&C::velocity_factor>(not_negative,
                                   "Of velocities; 0 holds the axis until the factor is more. Up to the axis' limits.");
  d.defaulted<&C::acceleration_factor>(positive, "Of accelerations and decelerations.");
  d.defaulted<&C::jerk_factor>(positive, "Of the jerk.");
}

}  // namespace takt::axis
