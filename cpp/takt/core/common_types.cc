// Descriptions of the small types of this folder that all components share.
#include "takt/core/describe.h"
#include "takt/core/feedback.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/object.h"
#include "takt/core/ports.h"

namespace takt {

void describe(Description<KinematicState>& d) {
  using K = KinematicState;
  d.about("Position, velocity and acceleration at one instant.");
  d.internal<&K::position>(unit::u, "Position.");
  d.internal<&K::velocity>(unit::u_s, "Velocity.");
  d.internal<&K::acceleration>(unit::u_s2, "Acceleration.");
}

void describe(Enumeration<ObjectKind>& e) {
  using K = ObjectKind;
  e.about("Kind of a component that blocks a motion.");
  e.value(K::kNone, "none", "None.");
  e.value(K::kMover, "mover", "A mover, or an area that it has reserved.");
  e.value(K::kTrack, "track", "A track.");
  e.value(K::kGroup, "planar_group", "A group of movers.");
  e.value(K::kEnvironment, "environment", "The border of an environment.");
  e.value(K::kPart, "part", "A part of the surface.");
  e.value(K::kCoordinateSystem, "coordinate_system", "A coordinate system.");
  e.value(K::kAxis, "axis", "An axis that follows this one and has failed.");
}

void describe(Description<ObjectInfo>& d) {
  d.about("Component that blocks a motion.");
  d.internal<&ObjectInfo::kind>("Kind of the component.");
  d.internal<&ObjectInfo::number>("Number of the component among its kind, from 1; 0: none.");
}

void describe(Enumeration<FeedbackState>& e) {
  e.about("State of a command.");
  e.value(FeedbackState::kBusy, "busy", "Accepted, waiting to take control.");
  e.value(FeedbackState::kActive, "active", "In control of its component.");
  e.value(FeedbackState::kDone, "done", "Completed.");
  e.value(FeedbackState::kAborted, "aborted", "Ended by another command or a fault.");
  e.value(FeedbackState::kError, "error", "Refused or failed.");
}

void describe(Description<FeedbackEvent>& d) {
  using F = FeedbackEvent;
  d.about("A change of state of a command.");
  d.internal<&F::ticket>("Ticket of the command.");
  d.internal<&F::cycle>(unit::cycles, "Cycle of the change.");
  d.internal<&F::state>("State of the command.");
  d.internal<&F::reached>("A command that never ends by itself has reached its goal.");
  d.internal<&F::error>("Error; none unless it failed.");
  d.internal<&F::value>("Result of the command; active: duration of its motion in s.");
  d.internal<&F::object>("Component that blocks the motion.");
  d.internal<&F::detail>("Detail of the error, for its sentence.");
}

void describe(Enumeration<DriveMode>& e) {
  e.about("Kind of set point that commands a drive.");
  e.value(DriveMode::kCyclicPosition, "cyclic_position",
          "A position every cycle (csp); the drive closes the position loop.");
  e.value(DriveMode::kCyclicVelocity, "cyclic_velocity",
          "A velocity every cycle (csv); the engine closes the position loop.");
  e.value(DriveMode::kAnalog, "analog", "A voltage of -10 to 10 V; the engine closes the position loop.");
  e.value(DriveMode::kCyclicTorque, "cyclic_torque", "A torque every cycle (cst) and a largest speed.");
}

void describe(Enumeration<DriveLink>& e) {
  e.about("Connection to a drive in another process.");
  e.value(DriveLink::kHeard, "heard", "The drive is heard.");
  e.value(DriveLink::kAwaited, "awaited", "The drive has not been heard yet.");
  e.value(DriveLink::kLost, "lost", "The drive is no longer heard.");
}

void describe(Description<Sampling>& d) {
  using S = Sampling;
  d.about("Age of the inputs of an axis.");
  d.internal<&S::link>("Connection to the drive.");
  d.internal<&S::age>(unit::cycles, "Cycles by which the inputs are older than they should be.");
  d.internal<&S::step>(unit::cycles, "Cycles since the previous sample; 0: no new sample.");
}

void describe(Description<ServoInputs>& d) {
  using S = ServoInputs;
  d.about("Inputs from a drive, its encoder and switches in a cycle.");
  d.internal<&S::counts>(unit::count, "Encoder: quadrature counter or SSI word.");
  d.internal<&S::index_counts>(unit::count, "Counter latched at the last index pulse.");
  d.internal<&S::index_pulses>("Index pulses seen, wraps.");
  d.internal<&S::encoder_error>("The encoder reports an error or does not answer.");
  d.internal<&S::limit_positive>("Positive limit switch.");
  d.internal<&S::limit_negative>("Negative limit switch.");
  d.internal<&S::reference>("Reference switch.");
  d.internal<&S::touch_probe>("Touch probe.");
  d.internal<&S::probe_rises>("Rising edges of the touch probe, wraps.");
  d.internal<&S::probe_falls>("Falling edges of the touch probe, wraps.");
  d.internal<&S::probe_rise_age_s>(unit::s, "Time from the last rising edge to this sample.");
  d.internal<&S::probe_fall_age_s>(unit::s, "Time from the last falling edge to this sample.");
  d.internal<&S::drive_ready>("The power stage is on and follows its set point.");
  d.internal<&S::drive_fault>("The drive reports a fault.");
  d.internal<&S::drive_error>("Number that the drive gives for its fault (CiA 402, 0x603F); 0: none.");
  d.internal<&S::torque_nm>(unit::nm, "Torque; the force in N on linear motors.");
  d.internal<&S::load_counts>(unit::count, "Counts of the encoder on the load, if there is one.");
  d.internal<&S::load_encoder_error>("The encoder on the load reports an error or does not answer.");
}

void describe(Description<ServoOutputs>& d) {
  using S = ServoOutputs;
  d.about("Outputs to a drive in a cycle.");
  d.internal<&S::position_counts>(unit::count, "Position set point (csp).");
  d.internal<&S::velocity_counts_s>(unit::count_s,
                                    "Velocity: feed-forward (csp), set point (csv) or largest speed (cst).");
  d.internal<&S::voltage_v>(unit::volt, "Analogue set point.");
  d.internal<&S::torque_nm>(
      unit::nm, "Torque set point (cst), or torque that the drive adds (csp, csv); a force in N on linear motors.");
  d.internal<&S::mode>("Set point that the drive follows.");
  d.internal<&S::enable>("The power stage is to be on.");
  d.internal<&S::release_brake>("The brake relay is energised.");
  d.internal<&S::torque_until_counts_s>(unit::count_s, "Velocity up to which the torque acts in this cycle (cst).");
  d.internal<&S::torque_limit_nm>(unit::nm, "Largest torque in both directions; 0: the limit of the drive.");
  d.internal<&S::digital_outputs>("Outputs of the axis, a bit for each.");
}

}  // namespace takt
