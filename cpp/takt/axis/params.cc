#include "takt/axis/params.h"

#include "takt/core/describe.h"

namespace takt::axis {

void describe(Enumeration<AxisKind>& e) {
  e.about("How positions of an axis are counted.");
  e.value(AxisKind::kLinear, "linear", "From end to end.");
  e.value(AxisKind::kRotary, "rotary", "Round and round: reported in [0, modulus).");
}

void describe(Description<AxisLimits>& d) {
  using L = AxisLimits;
  d.about("What the axis may do at most. Commands beyond it are refused; the engine's own stops use it in full.");
  d.required<&L::velocity>(unit::u_s, positive, "Largest velocity.");
  d.required<&L::acceleration>(unit::u_s2, positive, "Largest acceleration.");
  d.defaulted<&L::deceleration>(unit::u_s2, positive, "Largest deceleration; unset: as the acceleration.");
  d.required<&L::jerk>(unit::u_s3, not_negative, "Largest jerk; 0: unlimited.");
  d.defaulted<&L::torque>(unit::nm, positive,
                          "Largest torque that the drive is allowed, in N on linear motors (TorqueLimit); unset: all "
                          "that it has.");
  d.defaulted<&L::lower>(unit::u, "Lower SW limit (LimNeg); unset: none.");
  d.defaulted<&L::upper>(unit::u, "Upper SW limit (LimPos); unset: none.");
  d.rule<&L::upper>("must lie above lower", [](const L& l) { return !l.lower || !l.upper || *l.lower < *l.upper; });
}

void describe(Description<Supervision>& d) {
  using S = Supervision;
  d.about("What is watched while the loop is closed.");
  d.defaulted<&S::deviation_moving>(
      unit::u, positive, "Largest following error in motion; beyond it: ErrorStop 2001. Unset: not watched.");
  d.defaulted<&S::deviation_standstill>(unit::u, positive, "The same at rest.");
  d.defaulted<&S::in_position>(
      unit::u, positive,
      "A positioning command is done when the following error is inside this window; unset: with its set point.");
  d.defaulted<&S::encoder_noise_counts>(unit::count, not_negative,
                                        "What a standing encoder may move from one cycle to the next; a change beyond "
                                        "that and four times the axis' velocity is error 3001.");
  d.defaulted<&S::encoders_apart>(
      unit::u, positive,
      "With load_encoder: by which motor and load may get apart since both were first measured, or since reset; beyond "
      "it: ErrorStop 3106, and the loop is opened. Unset: not watched.");
  d.defaulted<&S::in_position_timeout_s>(unit::s, positive,
                                         "How long to wait for that; then the command fails with error 0003.");
}

void describe(Description<TorqueOffset>& d) {
  using T = TorqueOffset;
  d.about("What the drive is told to add to the torque of its own loops: that of the set point.");
  d.defaulted<&T::inertia>(unit::none, between(0, 1e9), "Torque that one u/s2 takes.");
  d.defaulted<&T::coulomb_friction>(unit::nm, between(0, 1e9), "Friction that does not depend on the speed.");
  d.defaulted<&T::viscous_friction>(unit::none, between(0, 1e9), "Torque that one u/s takes.");
  d.defaulted<&T::load_torque>(unit::nm, between(-1e9, 1e9), "Of gravity, constant; positive pushes upwards.");
  d.defaulted<&T::full_at>(unit::u_s, positive, "Set velocity from which on coulomb_friction is added whole.");
}

void describe(Description<Drive>& d) {
  d.about("The drive behind the axis.");
  d.defaulted<&Drive::mode>("What the drive is commanded by.");
  d.rule<&Drive::mode>("must not be cyclic_torque, which only torque control uses",
                       [](const Drive& drive) { return drive.mode != DriveMode::kCyclicTorque; });
  d.defaulted<&Drive::invert>("Inverts the control sense.");
  d.defaulted<&Drive::ready_timeout_s>(unit::s, positive,
                                       "How long the drive may take to get ready; then ErrorStop 3002.");
  d.defaulted<&Drive::brake_opens_s>(
      unit::s, between(0, 10), "How long the brake takes to open: the axis is held meanwhile, and power is done then.");
  d.defaulted<&Drive::brake_closes_s>(
      unit::s, between(0, 10), "How long it takes to close: at power off the loop stays closed as long as that.");
  d.defaulted<&Drive::torque_offset>("Torque that the drive adds, from the set point; unset: none.");
  d.rule<&Drive::torque_offset>("needs a mode other than analog: a voltage tells no torque", [](const Drive& drive) {
    return !drive.torque_offset || drive.mode != DriveMode::kAnalog;
  });
}

void describe(Description<InputSense>& d) {
  using I = InputSense;
  d.about("Which switch inputs are active low (as normally closed contacts are).");
  d.defaulted<&I::invert_limit_positive>("Inverts LIM+.");
  d.defaulted<&I::invert_limit_negative>("Inverts LIM-.");
  d.defaulted<&I::invert_reference>("Inverts REF.");
  d.defaulted<&I::invert_touch_probe>("Inverts TP.");
  d.defaulted<&I::debounce_s>(unit::s, between(0, 1),
                              "How long LIM+, LIM- and REF must have changed before it counts; 0: at once.");
  d.defaulted<&I::touch_probe_of>("The axis whose TP wire captures this axis' position, too; unset: its own.");
}

void describe(Description<Following>& d) {
  using F = Following;
  d.about(
      "The master of an axis that follows another one from load on (gantry, line shaft). It takes no motion commands "
      "of its own.");
  d.required<&F::axis>("Name of the master.");
  d.defaulted<&F::ratio>("Own units per unit of the master; negative: the other way round.");
  d.rule<&F::ratio>("must not be 0", [](const F& f) { return f.ratio != 0; });
  d.defaulted<&F::offset>(unit::u,
                          "Its position where the master's is 0. Unset: as both stand when they are powered for the "
                          "first time. Homing with a switch at each of them finds it anew.");
  d.defaulted<&F::skew_warning>(unit::u, positive, "Measured skew from which the axis says skewed; unset: never.");
  d.defaulted<&F::largest_skew>(unit::u, positive,
                                "Largest difference of the measured skew from the commanded one; beyond it: ErrorStop "
                                "3101, and all members stop. Unset: not watched.");
  d.defaulted<&F::in_step>(unit::u, positive,
                           "Skew up to which master and follower move; beyond it commands are refused with error 3102 "
                           "until it is straightened.");
  d.defaulted<&F::square>(
      "It has a reference switch of its own: step_abs_switch of the master goes on until both switches are found, and "
      "what lies between them is the skew, which is straightened before the step is done.");
}

void describe(Description<StopRamp>& d) {
  d.about("The ramp of a stop that no command asked for. An axis never stops more gently than with its own limits.");
  d.defaulted<&StopRamp::deceleration>(unit::u_s2, positive, "Deceleration; unset: that of the limits.");
  d.defaulted<&StopRamp::jerk>(unit::u_s3, not_negative, "Jerk, 0: unlimited; unset: that of the limits.");
}

void describe(Description<ScrewPoint>& d) {
  using P = ScrewPoint;
  d.about("The error of a lead screw at a position.");
  d.required<&P::position>(unit::u, "Of the axis.");
  d.required<&P::error>(unit::u, "How much further the load is there than the encoder on the motor says.");
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
      "What lies between the encoder on the motor and the load, and is made up for: the motor is told to go so much "
      "further that the load is where the axis shall be.");
  d.defaulted<&C::backlash>(unit::u, between(0, 1e9), "Motion of the motor after a reversal before the load follows.");
  d.defaulted<&C::screw>(
      "Errors of the lead screw, by rising positions, on the line between two of them; beyond the ends as at the ends. "
      "They count while the axis has its reference.");
  d.defaulted<&C::velocity>(unit::u_s, positive,
                            "How fast the correction is made; unset: a tenth of the largest velocity.");
  d.rule<&C::screw>("must have rising positions", [](const C& c) { return Rises(c.screw); });
  d.rule<&C::screw>("must not change by more than a tenth of the distance from one position to the next",
                    [](const C& c) { return IsFlat(c.screw); });
}

void describe(Description<AxisParams>& d) {
  using A = AxisParams;
  d.about("One axis. Positions in its own unit u, velocities u/s, accelerations u/s², jerk u/s³.");
  d.required<&A::name>("How commands and channels call it.");
  d.defaulted<&A::unit>("The unit u, for people: mm, deg, rev ...");
  d.defaulted<&A::kind>("linear or rotary.");
  d.defaulted<&A::modulus>(unit::u, positive, "Rotary axes: one turn.");
  d.required<&A::limits>("What the axis may do at most.");
  d.defaulted<&A::supervision>("What is watched.");
  d.defaulted<&A::encoder>("How the position is measured.");
  d.defaulted<&A::load_encoder>(
      "A second encoder, on the load: where the axis is. The drive keeps the other one, on its motor, to which index "
      "pulses belong. Unset: none.");
  d.rule<&A::load_encoder>("must have no coded_marks: index pulses are those of encoder",
                           [](const A& a) { return !a.load_encoder || !a.load_encoder->coded_marks; });
  d.rule<&A::load_encoder>(
      "must not be given with drive.mode cyclic_position, where the drive closes the loop with its own encoder",
      [](const A& a) { return !a.load_encoder || a.drive.mode != DriveMode::kCyclicPosition; });
  d.defaulted<&A::compensation>("Backlash and errors of the lead screw that are made up for.");
  d.rule<&A::compensation>("must not be given beside load_encoder, which sees the load",
                           [](const A& a) { return !a.load_encoder || !a.compensation.any(); });
  d.rule<&A::compensation>("must be made no faster than the axis' largest velocity",
                           [](const A& a) { return a.compensation.velocity.value_or(0) <= a.limits.velocity; });
  d.defaulted<&A::drive>("The drive.");
  d.defaulted<&A::inputs>("The switch inputs.");
  d.defaulted<&A::loop>("The position loop, for drives that do not close it themselves.");
  d.defaulted<&A::requires_reference>("Refuse absolute moves with error 0009 until the axis is homed.");
  d.defaulted<&A::await_constants>("Refuse motion with error 0012 until GT_SetConstant was given.");
  d.defaulted<&A::follows>("The axis it follows, if any.");
  d.defaulted<&A::fault_stop>("How it stops in a fault that leaves the loop closed.");
  d.defaulted<&A::limit_stop>("How it stops on a limit switch or in front of a SW limit.");
  d.defaulted<&A::homing>("What MC_Home does.");
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
