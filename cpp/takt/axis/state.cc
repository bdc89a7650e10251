#include "takt/axis/state.h"

#include "takt/core/describe.h"

namespace takt::axis {

void describe(Description<Motion>& d) {
  using M = Motion;
  d.about("Motion in progress.");
  d.internal<&M::profile>("Set points from its start.");
  d.internal<&M::start_cycle>("Cycle from which its time counts.");
  d.internal<&M::start_offset_s>(unit::s, "Time by which the motion began before that cycle.");
  d.internal<&M::target>(unit::u, "Target of a positioning command, unwrapped.");
  d.internal<&M::held>("The profile ends where an override holds the axis.");
  d.internal<&M::arrived>("The profile is over.");
  d.internal<&M::arrived_cycle>("Cycle in which the profile ended.");
}

void describe(Description<DisabledSupervision>& d) {
  d.about("Supervision that was switched off at run time, with the values that it had.");
  d.internal<&DisabledSupervision::lower>(unit::u, "SW limit LimNeg.");
  d.internal<&DisabledSupervision::upper>(unit::u, "SW limit LimPos.");
  d.internal<&DisabledSupervision::lag>(unit::u, "Largest following error in motion.");
}

void describe(Description<Pulse>& d) {
  using P = Pulse;
  d.about("A voltage that is output for a time.");
  d.internal<&P::ticket>("Ticket of the command.");
  d.internal<&P::voltage>(unit::volt, "Voltage that is output.");
  d.internal<&P::end_cycle>("Cycle in which the output returns to 0.");
}

void describe(Enumeration<Emergency>& e) {
  e.about("Effect of an emergency stop.");
  e.value(Emergency::kNone, "none", "No emergency stop is in force.");
  e.value(Emergency::kHeld, "held", "In force: the axis cannot be powered.");
  e.value(Emergency::kStopped, "stopped", "Released, and the axis has not been powered since.");
}

void describe(Description<SkewState>& d) {
  using K = SkewState;
  d.about("Deviation of an axis that follows another from load on from the position due by its master.");
  d.internal<&K::commanded>(unit::u, "Skew of the set points.");
  d.internal<&K::measured>(unit::u, "Skew of the measured positions.");
  d.internal<&K::known>("The position due by the master is known.");
  d.internal<&K::ticket>("Ticket of the command that straightens it; 0: none.");
  d.internal<&K::straightens>("It is being straightened.");
  d.internal<&K::stops>("The straightening is being stopped.");
  d.internal<&K::start_cycle>("Cycle in which the straightening began.");
  d.internal<&K::way>("Motion from the skew to 0.");
  d.internal<&K::edge>(unit::u, "Position at which its reference switch was found.");
  d.internal<&K::edge_cycle>("Cycle in which the switch was found.");
  d.internal<&K::squared_cycle>("Cycle of the master's edge by which it was squared.");
  d.internal<&K::reference_before>("Its reference switch in the previous cycle.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("All memory of an axis.");
  d.internal<&S::setpoint>("Set point of this cycle, unwrapped.");
  d.internal<&S::actual>("Measured state, unwrapped.");
  d.internal<&S::plc>("PLCopen state.");
  d.internal<&S::error>("Fault.");
  d.internal<&S::limited_by>("Limit that restricts the motion.");
  d.internal<&S::active>("Command in control.");
  d.internal<&S::reported>("It has been reported that the command in control has reached its goal.");
  d.internal<&S::passed>("A continuous move is beyond its position.");
  d.internal<&S::jog_sense>("Sense of the jog: up (1), down (-1), none (0).");
  d.internal<&S::jog_armed>("A key may start a motion.");
  d.internal<&S::last_sense>("Sense of the last motion.");
  d.internal<&S::lease_end_cycle>("Cycle in which the dead man's lease ends.");
  d.internal<&S::reset_ticket>("Ticket of the reset in progress.");
  d.internal<&S::reset_pending>("A reset waits for standstill.");
  d.internal<&S::end_of_profile>("The end of a cam was passed.");
  d.internal<&S::profile_ends>("Number of ends of a cam that were passed.");
  d.internal<&S::buffer>("Buffered commands, the next one first.");
  d.internal<&S::buffered>("Number of buffered commands.");
  d.internal<&S::sampling>("Sampling of the measured values.");
  d.internal<&S::blind>("The drive is silent while its loop is closed: the axis stops by set points alone.");
  d.internal<&S::override_factors>("Factors of velocity, ramps and jerk.");
  d.internal<&S::enable>("The drive is enabled.");
  d.internal<&S::loop_closed>("Loop closed, brake released.");
  d.internal<&S::enable_cycle>("Cycle in which the drive was enabled.");
  d.internal<&S::limit_positive>("LIM+.");
  d.internal<&S::limit_negative>("LIM-.");
  d.internal<&S::reference>("REF.");
  d.internal<&S::touch_probe>("TP.");
  d.internal<&S::bars_positive>("No motion upwards is enabled.");
  d.internal<&S::bars_negative>("No motion downwards is enabled.");
  d.internal<&S::bars_cycle>("Cycle in which a power command last set the enabled directions.");
  d.internal<&S::index_pulse>("An index pulse came since the previous cycle.");
  d.internal<&S::index_skipped>("Several index pulses came.");
  d.internal<&S::index_pulses>("Number of index pulses.");
  d.internal<&S::index_counts>("Count at the last index pulse.");
  d.internal<&S::limit_positive_before>("LIM+ in the previous cycle.");
  d.internal<&S::limit_negative_before>("LIM- in the previous cycle.");
  d.internal<&S::unsettled>(unit::cycles,
                            "Cycles for which the inputs LIM+, LIM-, REF have differed from the values in use.");
  d.internal<&S::switches_known>("The switches have been read.");
  d.internal<&S::brake_falls>("The brake is closing while the loop is still closed.");
  d.internal<&S::brake_cycle>("Cycle in which the brake relay was last energised or released.");
  d.internal<&S::drive_ready>("The drive reports ready.");
  d.internal<&S::drive_fault>("The drive reports a fault.");
  d.internal<&S::drive_error>("Number of that fault, until the fault of the axis is reset.");
  d.internal<&S::encoder_error>("The measured position is invalid.");
  d.internal<&S::encoder_line_error>("The encoder itself reports an error.");
  d.internal<&S::torque_nm>(unit::nm, "Torque as reported by the drive.");
  d.internal<&S::constants_set>("GT_SetConstant was given.");
  d.internal<&S::drive_homes>("The drive homes by itself before it is ready.");
  d.internal<&S::dormant>("Supervision switched off.");
  d.internal<&S::direct_voltage_v>(unit::volt, "Voltage that is output while Disabled.");
  d.internal<&S::pulsing>("A voltage is output for a time.");
  d.internal<&S::pulse>("That voltage and its end.");
  d.internal<&S::superimposed>("A motion is superimposed on the motion in progress.");
  d.internal<&S::coupled>("The axis follows its master from load on.");
  d.internal<&S::follow_offset>(unit::u, "Own position minus the master's position times the ratio, without a skew.");
  d.internal<&S::leads>("Other axes follow it from load on.");
  d.internal<&S::most_torque>(unit::nm, "Largest torque of the machine file; infinite: as much as the drive can give.");
  d.internal<&S::system>("Limits of the machine file.");
  d.internal<&S::skew>("Deviation from the position due by its master.");
  d.internal<&S::emergency>("Effect of an emergency stop.");
  d.internal<&S::fault_of>("The follower whose fault stopped it.");
  d.internal<&S::origin>(unit::u, "Whole turns taken out of all positions.");
  d.internal<&S::encoder>("Encoder.");
  d.internal<&S::correction>("Difference between the encoder on the motor and the axis.");
  d.internal<&S::loop>("Position loop.");
  d.internal<&S::voltage_v>(unit::volt, "Output of the position loop.");
  d.internal<&S::due>(unit::u, "Position due now.");
  d.internal<&S::following_error>(unit::u, "Set minus actual position.");
  d.internal<&S::illegal_transitions>("Always 0.");
  d.internal<&S::motion>("Motion in progress.");
  d.internal<&S::coupling>("Coupling to masters.");
  d.internal<&S::guidance>("Set points of another component.");
  d.internal<&S::fault_ramp>("Ramp on which it brakes after a fault.");
  d.internal<&S::time_table>("Table over time that is followed.");
  d.internal<&S::stops>("Commands that stop it.");
  d.internal<&S::stream>("Set points from outside.");
  d.internal<&S::overlay>("Superimposed motion.");
  d.internal<&S::homing>("Homing and reference.");
  d.internal<&S::probe>("Touch probe.");
  d.internal<&S::torque>("Torque control.");
  d.internal<&S::cam_switch>("Cam switches.");
  d.internal<&S::cam_outputs>("Outputs of the cam switches.");
  d.internal<&S::written_outputs>("Outputs that commands have switched on.");
}

}  // namespace takt::axis
