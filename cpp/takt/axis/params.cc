#include "takt/axis/params.h"

#include "takt/core/describe.h"

namespace takt::axis {

void describe(Enumeration<AxisKind>& e) {
  e.about("How the positions of an axis are counted.");
  e.value(AxisKind::kLinear, "linear", "Bounded travel; positions do not repeat.");
  e.value(AxisKind::kRotary, "rotary",
          "Endless travel: positions repeat after the modulus and are reported in [0, modulus).");
}

void describe(Description<AxisLimits>& d) {
  using L = AxisLimits;
  d.about("Limits of the axis. Commands beyond them are refused; the engine's own stops use them in full.");
  d.required<&L::velocity>(unit::u_s, positive, "Largest velocity.");
  d.required<&L::acceleration>(unit::u_s2, positive, "Largest acceleration.");
  d.defaulted<&L::deceleration>(unit::u_s2, positive, "Largest deceleration; unset: as the acceleration.");
  d.required<&L::jerk>(unit::u_s3, not_negative, "Largest jerk; 0: unlimited.");
  d.defaulted<&L::torque>(unit::nm, positive,
                          "Largest torque of the drive, a force in N on linear motors (TorqueLimit); unset: as much as "
                          "the drive can give.");
  d.defaulted<&L::lower>(unit::u, "Lower SW limit (LimNeg); unset: none.");
  d.defaulted<&L::upper>(unit::u, "Upper SW limit (LimPos); unset: none.");
  d.rule<&L::upper>("must lie above lower", [](const L& l) { return !l.lower || !l.upper || *l.lower < *l.upper; });
}

void describe(Description<Supervision>& d) {
  using S = Supervision;
  d.about("Supervision while the loop is closed.");
  d.defaulted<&S::deviation_moving>(
      unit::u, positive, "Largest following error in motion; beyond it: ErrorStop 2001. Unset: not supervised.");
  d.defaulted<&S::deviation_standstill>(unit::u, positive,
                                        "Largest following error at rest, from in_position_timeout_s after the end of "
                                        "the motion; beyond it: ErrorStop 2001. Unset: as in motion.");
  d.defaulted<&S::in_position>(unit::u, positive,
                               "Window of the following error in which a positioning command is done; unset: it is "
                               "done when its set point has arrived.");
  d.defaulted<&S::encoder_noise_counts>(
      unit::count, not_negative,
      "Noise of an encoder at rest from one cycle to the next; a larger change than this plus four times the "
      "displacement at the axis' velocity limit is error 3001.");
  d.defaulted<&S::encoders_apart>(
      unit::u, positive,
      "With load_encoder: largest change of the distance between motor and load since both were first measured, or "
      "since reset; beyond it: ErrorStop 3106, and the loop is opened. Unset: not supervised.");
  d.defaulted<&S::in_position_timeout_s>(unit::s, positive,
                                         "Longest time from the arrival of the set point to the in-position window; "
                                         "then the command fails with error 0003.");
}

void describe(Description<TorqueOffset>& d) {
  using T = TorqueOffset;
  d.about("Torque feed-forward computed from the set point, which the drive adds to the torque of its own loops.");
  d.defaulted<&T::inertia>(unit::none, between(0, 1e9), "Torque per u/s2 of acceleration.");
  d.defaulted<&T::coulomb_friction>(unit::nm, between(0, 1e9), "Friction that is independent of the speed.");
  d.defaulted<&T::viscous_friction>(unit::none, between(0, 1e9), "Torque per u/s of velocity.");
  d.defaulted<&T::load_torque>(unit::nm, between(-1e9, 1e9),
                               "Constant torque of the load (gravity); positive acts upwards.");
  d.defaulted<&T::full_at>(unit::u_s, positive,
                           "Set velocity from which on coulomb_friction acts in full; below it, in proportion.");
}

void describe(Description<Drive>& d) {
  d.about("Drive of the axis.");
  d.defaulted<&Drive::mode>("Quantity that commands the drive.");
  d.rule<&Drive::mode>("must not be cyclic_torque, which only torque control uses",
                       [](const Drive& drive) { return drive.mode != DriveMode::kCyclicTorque; });
  d.defaulted<&Drive::invert>("Inverts the control sense.");
  d.defaulted<&Drive::ready_timeout_s>(unit::s, positive,
                                       "Longest time from enabling the drive until it is ready; then ErrorStop 3002.");
  d.defaulted<&Drive::brake_opens_s>(
      unit::s, between(0, 10),
      "Time that the brake takes to open: the axis is held until then, and only then is power done.");
  d.defaulted<&Drive::brake_closes_s>(
      unit::s, between(0, 10), "Time that the brake takes to close: at power off the loop stays closed for this time.");
  d.defaulted<&Drive::torque_offset>("Torque feed-forward from the set point, added by the drive; unset: none.");
  d.rule<&Drive::torque_offset>("needs a mode other than analog: a voltage tells no torque", [](const Drive& drive) {
    return !drive.torque_offset || drive.mode != DriveMode::kAnalog;
  });
}

void describe(Description<InputSense>& d) {
  using I = InputSense;
  d.about("Switch inputs that are active low (such as normally closed contacts).");
  d.defaulted<&I::invert_limit_positive>("Inverts LIM+.");
  d.defaulted<&I::invert_limit_negative>("Inverts LIM-.");
  d.defaulted<&I::invert_reference>("Inverts REF.");
  d.defaulted<&I::invert_touch_probe>("Inverts TP.");
  d.defaulted<&I::debounce_s>(
      unit::s, between(0, 1),
      "Time for which a change of LIM+, LIM- or REF must last before it counts; 0: it counts at once.");
  d.defaulted<&I::touch_probe_of>(
      "Name of the axis whose TP input also captures the position of this axis; unset: its own input.");
}

void describe(Description<Following>& d) {
  using F = Following;
  d.about(
      "The master of an axis that follows another from load on (gantry, line shaft). The follower takes no motion "
      "commands of its own.");
  d.required<&F::axis>("Name of the master.");
  d.defaulted<&F::ratio>("Own units per unit of the master; negative: in the opposite sense.");
  d.rule<&F::ratio>("must not be 0", [](const F& f) { return f.ratio != 0; });
  d.defaulted<&F::offset>(unit::u,
                          "Own position at position 0 of the master. Unset: from the positions of both at the first "
                          "power on. Homing with a switch at each of them determines it anew.");
  d.defaulted<&F::skew_warning>(unit::u, positive,
                                "Measured skew from which on the axis reports skewed; unset: never.");
  d.defaulted<&F::largest_skew>(unit::u, positive,
                                "Largest difference between measured and commanded skew; beyond it: ErrorStop 3101, "
                                "and all members stop. Unset: not supervised.");
  d.defaulted<&F::in_step>(unit::u, positive,
                           "Largest skew with which master and follower may move; beyond it commands are refused with "
                           "error 3102 until the skew is straightened.");
  d.defaulted<&F::square>(
      "The axis has a reference switch of its own: step_abs_switch of the master continues until both switches are "
      "found; the distance between them is the skew, which is straightened before the step is done.");
}

void describe(Description<StopRamp>& d) {
  d.about("Ramp of a stop that no command requested. Values weaker than the axis' own limits have no effect.");
  d.defaulted<&StopRamp::deceleration>(unit::u_s2, positive, "Deceleration; unset: as in the limits.");
  d.defaulted<&StopRamp::jerk>(unit::u_s3, not_negative, "Jerk, 0: unlimited; unset: as in the limits.");
}

void describe(Description<ScrewPoint>& d) {
  using P = ScrewPoint;
  d.about("Error of a lead screw at one position.");
  d.required<&P::position>(unit::u, "Position of the axis.");
  d.required<&P::error>(unit::u,
                        "Distance by which the load is ahead of the position that the encoder on the motor gives.");
}

namespace {
constexpr double kSteepestScrew = 0.1;  // [u per u] more is not the error of a screw

bool Rises(const std::vector<ScrewPoint>& screw) {
  for (std::size_t i = 1; i < screw.size(); ++i) {
    if (!(screw[i].position > screw[i - 1].position)) return false;
  }
  return true;
}

bool IsFlat(const std::vector<ScrewPoint>& screw) {
  for (std::size_t i = 1; i < screw.size(); ++i) {
    const double apart = screw[i].position - screw[i - 1].position;
    if (std::abs(screw[i].error - screw[i - 1].error) > kSteepestScrew * apart) return false;
  }
  return true;
}
}  // namespace

void describe(Description<Compensation>& d) {
  using C = Compensation;
  d.about(
      "Compensation of errors between the encoder on the motor and the load: the set point of the drive is corrected "
      "so that the load reaches the position of the axis.");
  d.defaulted<&C::backlash>(unit::u, between(0, 1e9),
                            "Displacement of the motor after a reversal before the load follows.");
  d.defaulted<&C::screw>(
      "Errors of the lead screw, by rising positions; linear between two of them, constant beyond the ends. They are "
      "compensated while the axis has its reference.");
  d.defaulted<&C::velocity>(unit::u_s, positive,
                            "Velocity at which the correction changes; unset: a tenth of the axis' velocity limit.");
  d.rule<&C::screw>("must have rising positions", [](const C& c) { return Rises(c.screw); });
  d.rule<&C::screw>("must not change by more than a tenth of the distance from one position to the next",
                    [](const C& c) { return IsFlat(c.screw); });
}

void describe(Description<AxisParams>& d) {
  using A = AxisParams;
  d.about("One axis. Positions in its own unit u, velocities in u/s, accelerations in u/s², jerk in u/s³.");
  d.required<&A::name>("Name of the axis in commands and channels.");
  d.defaulted<&A::unit>("The unit u, for display: mm, deg, rev ...");
  d.defaulted<&A::kind>("linear or rotary.");
  d.defaulted<&A::modulus>(unit::u, positive, "Rotary axes: distance after which positions repeat, one turn.");
  d.required<&A::limits>("Limits of velocity, acceleration, jerk, torque and position.");
  d.defaulted<&A::supervision>("Supervision of following errors and encoders.");
  d.defaulted<&A::encoder>("Encoder of the axis.");
  d.defaulted<&A::load_encoder>(
      "A second encoder, on the load, which gives the position of the axis. The drive keeps the encoder on its motor, "
      "to which index pulses belong. Unset: none.");
  d.rule<&A::load_encoder>("must have no coded_marks: index pulses are those of encoder",
                           [](const A& a) { return !a.load_encoder || !a.load_encoder->coded_marks; });
  d.rule<&A::load_encoder>(
      "must not be given with drive.mode cyclic_position, where the drive closes the loop with its own encoder",
      [](const A& a) { return !a.load_encoder || a.drive.mode != DriveMode::kCyclicPosition; });
  d.defaulted<&A::compensation>("Compensation of backlash and lead screw errors.");
  d.rule<&A::compensation>("must not be given beside load_encoder, which measures the load",
                           [](const A& a) { return !a.load_encoder || !a.compensation.any(); });
  d.rule<&A::compensation>("must be made no faster than the axis' largest velocity",
                           [](const A& a) { return a.compensation.velocity.value_or(0) <= a.limits.velocity; });
  d.defaulted<&A::drive>("The drive.");
  d.defaulted<&A::inputs>("The switch inputs.");
  d.defaulted<&A::loop>("Position loop, for drives that do not close it themselves.");
  d.defaulted<&A::requires_reference>("True: absolute moves are refused with error 0009 until the axis is homed.");
  d.defaulted<&A::await_constants>("True: motion is refused with error 0012 until GT_SetConstant was given.");
  d.defaulted<&A::follows>("Axis that this axis follows from load on; unset: none.");
  d.defaulted<&A::fault_stop>("Ramp of the stop after a fault that leaves the loop closed.");
  d.defaulted<&A::limit_stop>("Ramp of the stop on a limit switch.");
  d.defaulted<&A::homing>("Method of MC_Home and its parameters.");
  d.rule<&A::homing>("must search no faster than the axis' largest velocity", [](const A& a) {
    return a.homing.velocity <= a.limits.velocity && a.homing.pulse_velocity.value_or(0) <= a.limits.velocity;
  });
  d.rule<&A::homing>("must lag behind at its end stop by no more than supervision.deviation_moving", [](const A& a) {
    return a.homing.deviation <= a.supervision.deviation_moving.value_or(a.homing.deviation);
  });
  d.rule<&A::homing>("must have an absolute encoder for method absolute", [](const A& a) {
    return a.homing.method != HomingMethod::kAbsolute || a.position_encoder().type == EncoderType::kAbsoluteSsi;
  });
  d.rule<&A::homing>("must have encoder.coded_marks for method distance_coded", [](const A& a) {
    return a.homing.method != HomingMethod::kDistanceCoded || a.encoder.coded_marks;
  });
  d.rule<&A::limits>("must have no lower and upper on a rotary axis",
                     [](const A& a) { return !a.rotary() || (!a.limits.lower && !a.limits.upper); });
}

}  // namespace takt::axis
