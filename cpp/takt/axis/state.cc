#include "takt/axis/state.h"

#include "takt/core/describe.h"

namespace takt::axis {

void describe(Description<Motion>& d) {
  using M = Motion;
  d.about("The motion in progress.");
  d.internal<&M::profile>("Set points from its start.");
  d.internal<&M::start_cycle>("Cycle its time counts from.");
  d.internal<&M::start_offset_s>(unit::s, "How long before that cycle it began.");
  d.internal<&M::target>(unit::u, "Where a positioning command ends, unwrapped.");
  d.internal<&M::held>("It ends where an override stops it.");
  d.internal<&M::arrived>("The profile is over.");
  d.internal<&M::arrived_cycle>("Since when.");
}

void describe(Description<DisabledSupervision>& d) {
  d.about("Supervision that was switched off at run time, with the values it comes back with.");
  d.internal<&DisabledSupervision::lower>(unit::u, "SW limit LimNeg.");
  d.internal<&DisabledSupervision::upper>(unit::u, "SW limit LimPos.");
  d.internal<&DisabledSupervision::lag>(unit::u, "Largest following error in motion.");
}

void describe(Description<Pulse>& d) {
  using P = Pulse;
  d.about("A voltage that is put out for a time.");
  d.internal<&P::ticket>("Of the command.");
  d.internal<&P::voltage>(unit::volt, "What is put out.");
  d.internal<&P::end_cycle>("When it is over.");
}

void describe(Enumeration<Emergency>& e) {
  e.about("What an emergency stop has left behind.");
  e.value(Emergency::kNone, "none", "Nothing.");
  e.value(Emergency::kHeld, "held", "It is on.");
  e.value(Emergency::kStopped, "stopped", "It is over, and the axis not powered since.");
}

void describe(Description<SkewState>& d) {
  using K = SkewState;
  d.about("Distance of an axis that follows another from load on to where its master has it.");
  d.internal<&K::commanded>(unit::u, "Of the set points.");
  d.internal<&K::measured>(unit::u, "Of what is measured.");
  d.internal<&K::known>("Where it belongs is known.");
  d.internal<&K::ticket>("Of the command that straightens it.");
  d.internal<&K::straightens>("It is being straightened.");
  d.internal<&K::stops>("That comes to rest on the way.");
  d.internal<&K::start_cycle>("Since when.");
  d.internal<&K::way>("From the skew to 0.");
  d.internal<&K::edge>(unit::u, "Where its reference switch was found.");
  d.internal<&K::edge_cycle>("When.");
  d.internal<&K::squared_cycle>("Of the master's edge that it was squared by.");
  d.internal<&K::reference_before>("Its reference switch a cycle ago.");
}

void describe(Description<State>& d) {
  using S = State;
  d.about("All memory of an axis.");
  d.internal<&S::setpoint>("Set point of this cycle, unwrapped.");
  d.internal<&S::actual>("As measured, unwrapped.");
  d.internal<&S::plc>("PLCopen state.");
  d.internal<&S::error>("Fault.");
  d.internal<&S::limited_by>("What holds the motion back.");
  d.internal<&S::active>("Command in control.");
  d.internal<&S::reported>("That it has reached what it is for is out.");
  d.internal<&S::passed>("A continuous move is beyond its position.");
  d.internal<&S::jog_sense>("Jogging up (1), down (-1) or not.");
  d.internal<&S::jog_armed>("Both keys were seen up.");
  d.internal<&S::last_sense>("Sense of the last motion.");
  d.internal<&S::lease_end_cycle>("When the dead man's lease ends.");
  d.internal<&S::reset_ticket>("Of the reset in progress.");
  d.internal<&S::reset_pending>("A reset waits for standstill.");
  d.internal<&S::end_of_profile>("The end of a cam was passed.");
  d.internal<&S::profile_ends>("How often.");
  d.internal<&S::buffer>("Buffered commands, the next one first.");
  d.internal<&S::buffered>("How many.");
  d.internal<&S::sampling>("When what is measured was sampled.");
  d.internal<&S::blind>("The drive is not heard any more: stops by set points alone.");
  d.internal<&S::override_factors>("Factors of velocity, ramps and jerk.");
  d.internal<&S::enable>("Drive told to be on.");
  d.internal<&S::loop_closed>("Loop closed, brake released.");
  d.internal<&S::enable_cycle>("Since when.");
  d.internal<&S::limit_positive>("LIM+.");
  d.internal<&S::limit_negative>("LIM-.");
  d.internal<&S::reference>("REF.");
  d.internal<&S::touch_probe>("TP.");
  d.internal<&S::bars_positive>("No motion upwards is enabled.");
  d.internal<&S::bars_negative>("No motion downwards is enabled.");
  d.internal<&S::bars_cycle>("When that was said.");
  d.internal<&S::index_pulse>("NI came since the cycle before.");
  d.internal<&S::index_skipped>("Several came.");
  d.internal<&S::index_pulses>("How many came.");
  d.internal<&S::index_counts>("Count at the last one.");
  d.internal<&S::limit_positive_before>("LIM+ a cycle before.");
  d.internal<&S::limit_negative_before>("LIM- a cycle before.");
  d.internal<&S::unsettled>(unit::cycles, "For which LIM+, LIM-, REF have said otherwise.");
  d.internal<&S::switches_known>("They were read once.");
  d.internal<&S::brake_falls>("The brake is closing, the loop still closed.");
  d.internal<&S::brake_cycle>("When its relay was energised or let go of.");
  d.internal<&S::drive_ready>("Drive says ready.");
  d.internal<&S::drive_fault>("Drive says fault.");
  d.internal<&S::drive_error>("Which one, until the axis has no fault any more.");
  d.internal<&S::encoder_error>("The measured position is not to be believed.");
  d.internal<&S::encoder_line_error>("Because the encoder says so.");
  d.internal<&S::torque_nm>(unit::nm, "As the drive says.");
  d.internal<&S::constants_set>("GT_SetConstant was given.");
  d.internal<&S::drive_homes>("The drive homes before it is ready; the engine does not move it.");
  d.internal<&S::dormant>("Supervision switched off.");
  d.internal<&S::direct_voltage_v>(unit::volt, "Put out while Disabled.");
  d.internal<&S::pulsing>("A voltage is put out for a time.");
  d.internal<&S::pulse>("Which, and how long.");
  d.internal<&S::superimposed>("Something is on top of the motion in progress.");
  d.internal<&S::coupled>("Follows its master.");
  d.internal<&S::follow_offset>(unit::u, "Distance to the master's position times the ratio, without a skew.");
  d.internal<&S::leads>("Others follow it from load on.");
  d.internal<&S::most_torque>(unit::nm, "Largest torque of the machine file; infinite: all that the drive has.");
  d.internal<&S::system>("Largest values of the machine file.");
  d.internal<&S::skew>("How far it is from where its master has it.");
  d.internal<&S::emergency>("What an emergency stop has left behind.");
  d.internal<&S::fault_of>("The follower whose fault stopped it.");
  d.internal<&S::origin>(unit::u, "Whole turns taken out of all positions.");
  d.internal<&S::encoder>("Encoder.");
  d.internal<&S::correction>("How far it is ahead of the axis.");
  d.internal<&S::loop>("Position loop.");
  d.internal<&S::voltage_v>(unit::volt, "Output of the position loop.");
  d.internal<&S::due>(unit::u, "Where the axis should be now.");
  d.internal<&S::following_error>(unit::u, "Set minus actual position.");
  d.internal<&S::illegal_transitions>("Always 0.");
  d.internal<&S::motion>("Motion in progress.");
  d.internal<&S::coupling>("Masters it follows.");
  d.internal<&S::guidance>("Set points of another component.");
  d.internal<&S::fault_ramp>("On which it brakes after a fault.");
  d.internal<&S::time_table>("Table over time that it follows.");
  d.internal<&S::stops>("Commands that stop it.");
  d.internal<&S::stream>("Set points from outside.");
  d.internal<&S::overlay>("What is on top of it.");
  d.internal<&S::homing>("Its reference.");
  d.internal<&S::probe>("Touch probe.");
  d.internal<&S::torque>("Torque control.");
  d.internal<&S::cam_switch>("Cam switches.");
  d.internal<&S::cam_outputs>("Their outputs.");
  d.internal<&S::written_outputs>("Outputs that commands switch on.");
}

}  // namespace takt::axis
