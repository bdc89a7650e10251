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
  d.internal<&O::actual_velocity>(unit::u_s, "Measured.");
  d.internal<&O::following_error>(unit::u, "Set point of the cycle before minus measured position.");
  d.internal<&O::true_position>(
      unit::u, "Where the load of a simulated servo really is, over all turns; also in a plant; others: nan.");
  d.internal<&O::voltage_v>(unit::volt, "Output of the position loop, analogue drives.");
  d.internal<&O::torque_nm>(unit::nm, "As the drive reports it.");
  d.internal<&O::probe_position>(unit::u, "Where the touch probe was captured last.");
  d.internal<&O::covered_distance>(unit::u, "By the motion on top of the one in progress; 0: there is none.");
  d.internal<&O::phase_shift>(unit::u_m, "How far the master is taken to be ahead of where it is.");
  d.internal<&O::covered_phase_shift>(unit::u_m,
                                      "What of it the last phasing_relative has added; after phasing_absolute: all.");
  d.internal<&O::encoder_correction>(unit::u,
                                     "How far the encoder on the motor is ahead of the axis: backlash and the error "
                                     "of the screw; with load_encoder, the other encoder.");
  d.internal<&O::override_factor>(unit::one, "Velocity factor of the override; 0: held.");
  d.internal<&O::skew>(unit::u,
                       "Measured distance to where its master has it, of an axis that follows another from load on.");
  d.internal<&O::active_command>("Ticket of the command in control; 0: none.");
  d.internal<&O::error>("Fault of the axis, not of a command; 0: none.");
  d.internal<&O::state>("PLCopen state after the cycle; several transitions may lie in one.");
  d.internal<&O::limited_by>("What holds the motion in progress back from what was asked.");
  d.internal<&O::master1>("Number of the axis that it follows, from 1; 0: none.");
  d.internal<&O::master2>("The same of a second one.");
  d.internal<&O::drive_error>(
      "Number that the drive gave for its fault (CiA 402, 0x603F), until the axis has no fault any more; 0: none.");
  d.internal<&O::fault_of>("Number of the axis whose fault stopped this one, its master, from 1; 0: none.");
  d.internal<&O::buffered_commands>("Commands waiting behind the one in control.");
  d.internal<&O::loop_closed>("The position loop is closed and the brake released.");
  d.internal<&O::in_position>("The following error is inside the in-position window.");
  d.internal<&O::in_step>("Follows its masters exactly; measured ones as far as they are known.");
  d.internal<&O::synchronizing>("Is getting into step with its masters; not while it waits for them.");
  d.internal<&O::superimposed>("Another motion is on top of the one in progress.");
  d.internal<&O::end_of_profile>("The end of its cam was passed in this cycle.");
  d.internal<&O::profile_ends>("How often the end of its cam was passed.");
  d.internal<&O::homed>("Its position is known: it has a reference.");
  d.internal<&O::emergency_stopped>("An emergency stop switched it off, and nothing has switched it on since.");
  d.internal<&O::drive_heard>("What is measured is of now; false: a drive in another process is silent.");
  d.internal<&O::drive_ready>("The drive says that it is switched on.");
  d.internal<&O::skewed>("Its skew is beyond follows.skew_warning.");
  d.internal<&O::limit_positive>("LIM+ after inversion.");
  d.internal<&O::limit_negative>("LIM- after inversion.");
  d.internal<&O::reference>("REF after inversion.");
  d.internal<&O::touch_probe>("TP after inversion.");
  d.internal<&O::probe_captures>("How often the touch probe was captured.");
  d.internal<&O::cam_outputs>("Outputs of the cam switches, a bit for each track.");
  d.internal<&O::digital_outputs>("Outputs that are on, written or by cam switches, a bit for each.");
  d.internal<&O::enable_positive>("It may move upwards (enable_positive of power).");
  d.internal<&O::enable_negative>("It may move downwards (enable_negative of power).");
}

}  // namespace takt::axis
