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
  e.about("What kind of component is in the way.");
  e.value(K::kNone, "none", "Nothing.");
  e.value(K::kMover, "mover", "A mover, or what it has reserved.");
  e.value(K::kTrack, "track", "A track.");
  e.value(K::kGroup, "planar_group", "A group of movers.");
  e.value(K::kEnvironment, "environment", "The border of an environment.");
  e.value(K::kPart, "part", "A part of the surface.");
  e.value(K::kCoordinateSystem, "coordinate_system", "A coordinate system.");
  e.value(K::kAxis, "axis", "An axis: one that follows this one, and failed.");
}

void describe(Description<ObjectInfo>& d) {
  d.about("Which component is in the way.");
  d.internal<&ObjectInfo::kind>("Of what kind it is.");
  d.internal<&ObjectInfo::number>("Which of them, from 1; 0: none.");
}

void describe(Enumeration<FeedbackState>& e) {
  e.about("What has become of a command.");
  e.value(FeedbackState::kBusy, "busy", "Accepted, waiting for its turn.");
  e.value(FeedbackState::kActive, "active", "In control of its component.");
  e.value(FeedbackState::kDone, "done", "Reached what it was for.");
  e.value(FeedbackState::kAborted, "aborted", "Another command or a fault took over.");
  e.value(FeedbackState::kError, "error", "Refused or failed.");
}

void describe(Description<FeedbackEvent>& d) {
  using F = FeedbackEvent;
  d.about("One step of a command's life.");
  d.internal<&F::ticket>("Which command.");
  d.internal<&F::cycle>(unit::cycles, "When.");
  d.internal<&F::state>("What became of it.");
  d.internal<&F::reached>("A command that never ends by itself has what it was given for.");
  d.internal<&F::error>("Why it failed.");
  d.internal<&F::value>("What it found out; active: s its motion takes.");
  d.internal<&F::object>("What is in the way.");
  d.internal<&F::detail>("Of the error, for its sentence.");
}

void describe(Enumeration<DriveMode>& e) {
  e.about("What a drive is commanded by.");
  e.value(DriveMode::kCyclicPosition, "cyclic_position",
          "A position every cycle (csp); the drive closes the position loop.");
  e.value(DriveMode::kCyclicVelocity, "cyclic_velocity",
          "A velocity every cycle (csv); the position loop is closed here.");
  e.value(DriveMode::kAnalog, "analog", "A voltage of -10 to 10 V; the position loop is closed here.");
  e.value(DriveMode::kCyclicTorque, "cyclic_torque", "A torque every cycle (cst) and a largest speed.");
}

void describe(Enumeration<DriveLink>& e) {
  e.about("Whether a drive in another process is heard.");
  e.value(DriveLink::kHeard, "heard", "It is.");
  e.value(DriveLink::kAwaited, "awaited", "Not yet.");
  e.value(DriveLink::kLost, "lost", "Not any more.");
}

void describe(Description<Sampling>& d) {
  using S = Sampling;
  d.about("When the inputs of an axis were sampled.");
  d.internal<&S::link>("Whether its drive is heard.");
  d.internal<&S::age>(unit::cycles, "How much older they are than they should be.");
  d.internal<&S::step>(unit::cycles, "Since the sample before; 0: they are that one still.");
}

void describe(Description<ServoInputs>& d) {
  using S = ServoInputs;
  d.about("What comes from a drive, its encoder and switches in a cycle.");
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
  d.internal<&S::probe_rise_age_s>(unit::s, "How long before this sample the last rising edge came.");
  d.internal<&S::probe_fall_age_s>(unit::s, "The same of the last falling edge.");
  d.internal<&S::drive_ready>("Power stage on and following its set point.");
  d.internal<&S::drive_fault>("The drive reports a fault.");
  d.internal<&S::drive_error>("What the drive says of it (CiA 402, 0x603F); 0: nothing.");
  d.internal<&S::torque_nm>(unit::nm, "Torque; the force in N on linear motors.");
  d.internal<&S::load_counts>(unit::count, "Encoder on the load, if there is one.");
  d.internal<&S::load_encoder_error>("That reports an error or does not answer.");
}

void describe(Description<ServoOutputs>& d) {
  using S = ServoOutputs;
  d.about("What goes to a drive in a cycle.");
  d.internal<&S::position_counts>(unit::count, "Position set point (csp).");
  d.internal<&S::velocity_counts_s>(unit::count_s,
                                    "Velocity: feed-forward (csp), set point (csv) or largest speed (cst).");
  d.internal<&S::voltage_v>(unit::volt, "Analogue set point.");
  d.internal<&S::torque_nm>(
      unit::nm, "Torque set point (cst), or torque that the drive adds (csp, csv); a force in N on linear motors.");
  d.internal<&S::mode>("Which of these the drive follows.");
  d.internal<&S::enable>("Power stage on.");
  d.internal<&S::release_brake>("Brake relay energised.");
  d.internal<&S::torque_until_counts_s>(unit::count_s, "Velocity at which the torque ends in this cycle (cst).");
  d.internal<&S::torque_limit_nm>(unit::nm, "Largest torque either way; 0: that of the drive.");
  d.internal<&S::digital_outputs>("Outputs of the axis, a bit for each.");
}

}  // namespace takt
