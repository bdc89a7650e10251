#include "takt/axis/outputs.h"

#include "takt/core/describe.h"

namespace takt::axis {

void describe(Description<Outputs>& d) {
  using O = Outputs;
  d.about("State of an axis after a cycle.");
  d.internal<&O::set_position>(unit::u, "Set point; rotary axes: in [0, modulus).");
  d.internal<&O::set_velocity>(unit::u_s, "Velocity of the set point.");
  d.internal<&O::set_acceleration>(unit::u_s2, "Acceleration of the set point.");
  d.internal<&O::actual_position>(unit::u, "Measured; rotary axes: in [0, modulus).");
  d.internal<&O::actual_velocity>(unit::u_s, "Measured velocity.");
  d.internal<&O::following_error>(unit::u, "Set point of the previous cycle minus measured position.");
  d.internal<&O::true_position>(unit::u,
                                "True position of the load of a servo that is simulated in the process of the engine, "
                                "over all turns; otherwise nan.");
  d.internal<&O::voltage_v>(unit::volt, "Output of the position loop; analogue drives only.");
  d.internal<&O::torque_nm>(unit::nm, "Torque as reported by the drive.");
  d.internal<&O::probe_position>(unit::u, "Position of the last touch probe capture.");
  d.internal<&O::covered_distance>(unit::u, "Distance covered by the superimposed motion; 0: there is none.");
  d.internal<&O::phase_shift>(unit::u_m, "Shift that is added to the master's position.");
  d.internal<&O::covered_phase_shift>(
      unit::u_m,
      "Part of the phase shift that the last phasing_relative has added; after phasing_absolute: the whole shift.");
  d.internal<&O::encoder_correction>(unit::u,
                                     "Distance by which the encoder on the motor is ahead of the axis: backlash and "
                                     "lead screw error; with load_encoder, the difference between both encoders.");
  d.internal<&O::override_factor>(unit::one, "Velocity factor of the override; 0: the axis is held.");
  d.internal<&O::skew>(
      unit::u,
      "Measured deviation from the position due by the master, for an axis that follows another from load on.");
  d.internal<&O::active_command>("Ticket of the command in control; 0: none.");
  d.internal<&O::error>("Fault of the axis, not of a command; 0: none.");
  d.internal<&O::state>("PLCopen state after the cycle; several transitions may lie in one.");
  d.internal<&O::limited_by>("Limit that restricts the motion in progress.");
  d.internal<&O::master1>("Number of the axis that this axis follows, from 1; 0: none.");
  d.internal<&O::master2>("Number of the second axis that this axis follows, from 1; 0: none.");
  d.internal<&O::drive_error>(
      "Number of the fault as reported by the drive (CiA 402, 0x603F), until the fault of the axis is reset; 0: none.");
  d.internal<&O::fault_of>("Number, from 1, of the follower whose fault stopped this axis, its master; 0: none.");
  d.internal<&O::buffered_commands>("Number of commands buffered behind the one in control.");
  d.internal<&O::loop_closed>("The position loop is closed and the brake is released.");
  d.internal<&O::in_position>(
      "The axis is at rest, with its loop closed and the following error inside the in-position window.");
  d.internal<&O::in_step>("The axis follows its masters exactly; measured ones as far as their positions are known.");
  d.internal<&O::synchronizing>(
      "The axis is synchronising with its masters; false while it waits for the start of synchronisation.");
  d.internal<&O::superimposed>("A superimposed motion is in progress.");
  d.internal<&O::end_of_profile>("An end of the cam was passed in this cycle.");
  d.internal<&O::profile_ends>("Number of times that an end of the cam was passed.");
  d.internal<&O::homed>("The axis has a reference.");
  d.internal<&O::emergency_stopped>("The axis was switched off by an emergency stop and has not been powered since.");
  d.internal<&O::drive_heard>("Measured values are current; false: a drive in another process is silent.");
  d.internal<&O::drive_ready>("The drive reports that it is switched on.");
  d.internal<&O::skewed>("The skew exceeds follows.skew_warning.");
  d.internal<&O::limit_positive>("LIM+ after inversion.");
  d.internal<&O::limit_negative>("LIM- after inversion.");
  d.internal<&O::reference>("REF after inversion.");
  d.internal<&O::touch_probe>("TP after inversion.");
  d.internal<&O::probe_captures>("Number of captures of the touch probe.");
  d.internal<&O::cam_outputs>("Outputs of the cam switches, a bit for each track.");
  d.internal<&O::digital_outputs>("Outputs that are on, written by commands or by cam switches, a bit for each.");
  d.internal<&O::enable_positive>("Motion upwards is enabled (enable_positive of power).");
  d.internal<&O::enable_negative>("Motion downwards is enabled (enable_negative of power).");
}

}  // namespace takt::axis
