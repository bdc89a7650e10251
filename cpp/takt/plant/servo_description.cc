#include "takt/core/describe.h"
#include "takt/plant/servo.h"

namespace takt::plant {

namespace {

// Wide enough for any machine, narrow enough that products do not overflow.
constexpr Range kAnySize = between(0, 1e9);
constexpr Range kAboveZero{.min = 0, .max = 1e9, .without_min = true};
constexpr Range kPlace = between(-1e9, 1e9);
constexpr Unit kTorque{"Nm", "N on linear motors"};
constexpr Unit kInertia{"Nm s2/u", "torque per acceleration"};
constexpr Unit kViscosity{"Nm s/u", "torque per speed"};
constexpr Unit kMillivolt{"mV", ""};

}  // namespace

void describe(Enumeration<ServoEncoderType>& e) {
  e.about("Kind of signal of the simulated encoder.");
  e.value(ServoEncoderType::kIncremental, "incremental", "A 32-bit counter that counts from the start.");
  e.value(ServoEncoderType::kAbsolute, "absolute", "An SSI word that represents the position.");
}

void describe(Enumeration<ServoEncoderCoding>& e) {
  e.about("Coding of an absolute position.");
  e.value(ServoEncoderCoding::kBinary, "binary", "Binary number.");
  e.value(ServoEncoderCoding::kGray, "gray", "Gray code: one bit changes from one count to the next.");
}

void describe(Enumeration<ServoEncoderPlace>& e) {
  e.about("Mounting of the simulated encoder.");
  e.value(ServoEncoderPlace::kMotor, "motor", "On the motor, before the backlash.");
  e.value(ServoEncoderPlace::kLoad, "load", "On the load, behind the backlash.");
}

void describe(Description<ServoDrive>& d) {
  using D = ServoDrive;
  d.about(
      "The simulated drive: a first-order velocity loop behind its own position loop (csp), or behind a digital or an "
      "analogue velocity set point.");
  d.defaulted<&D::power_up_s>(unit::s, between(0, 1000), "Time from enabling the drive until it is ready.");
  d.defaulted<&D::position_gain>(unit::one_s, between(0, 1000), "csp: gain of the drive's own position loop.");
  d.defaulted<&D::velocity_feed_forward>(between(0, 2), "csp: share of the set velocity that is fed forward.");
  d.defaulted<&D::loop_period_s>(unit::s, between(0.00005, 0.001), "Period of the drive's own loops.");
  d.defaulted<&D::velocity_time_constant_s>(unit::s, between(0.00001, 10), "Time constant of the velocity loop.");
  d.defaulted<&D::load_compensation_s>(
      unit::s, between(0, 1000),
      "Time constant with which the drive compensates load and friction; 0: no compensation.");
  d.defaulted<&D::max_torque>(kTorque, kAboveZero, "Largest torque of the motor.");
  d.defaulted<&D::velocity_at_10v>(unit::u_s, kAboveZero, "Analogue input: speed at 10 V.");
  d.defaulted<&D::offset_mv>(kMillivolt, between(-10000, 10000),
                             "Analogue input: voltage that the drive measures at 0 V.");
  d.defaulted<&D::dead_band_plus_mv>(kMillivolt, between(0, 10000),
                                     "Analogue input: dead band for positive voltages, which cause no motion.");
  d.defaulted<&D::dead_band_minus_mv>(kMillivolt, between(0, 10000),
                                      "Analogue input: dead band for negative voltages, which cause no motion.");
  d.defaulted<&D::inverted>("Set points of all modes count in the opposite sense.");
}

void describe(Description<ServoScrewPoint>& d) {
  using P = ServoScrewPoint;
  d.about("Error of the lead screw at one position of the motor.");
  d.required<&P::position>(unit::u, kPlace, "Position of the motor.");
  d.required<&P::error>(unit::u, kPlace, "Distance by which the load is ahead of the motor.");
}

void describe(Description<ServoMechanics>& d) {
  using M = ServoMechanics;
  d.about("Motor and load of the simulated servo.");
  d.defaulted<&M::inertia>(kInertia, between(1e-9, 1e9), "Torque per unit of acceleration, motor and load together.");
  d.defaulted<&M::coulomb_friction>(kTorque, kAnySize, "Friction that is independent of the speed.");
  d.defaulted<&M::viscous_friction>(kViscosity, kAnySize, "Friction that is proportional to the speed.");
  d.defaulted<&M::load_torque>(kTorque, kPlace, "Constant load; positive pulls towards smaller positions.");
  d.defaulted<&M::brake_torque>(kTorque, kAnySize, "Torque of the brake while it is not released; 0: no brake.");
  d.defaulted<&M::backlash>(unit::u, kAnySize, "Play between motor and load.");
  d.defaulted<&M::screw>("Errors of the lead screw, by rising positions of the motor; unset: none.");
  d.rule<&M::screw>("must have rising positions", [](const M& m) {
    for (std::size_t i = 1; i < m.screw.size(); ++i) {
      if (!(m.screw[i].position > m.screw[i - 1].position)) return false;
    }
    return true;
  });
  d.defaulted<&M::lower_stop>(unit::u, kPlace, "Lower end stop of the load; unset: none.");
  d.defaulted<&M::upper_stop>(unit::u, kPlace, "Upper end stop of the load; unset: none.");
  d.defaulted<&M::start_position>(unit::u, kPlace, "Position of the axis at the start.");
  d.rule<&M::upper_stop>("must lie above lower_stop",
                         [](const M& m) { return !m.lower_stop || !m.upper_stop || *m.lower_stop < *m.upper_stop; });
}

void describe(Description<ServoEncoder>& d) {
  using E = ServoEncoder;
  d.about("The simulated encoder, which must match the encoder in the axis' section.");
  d.defaulted<&E::type>("Kind of signal.");
  d.defaulted<&E::place>("Mounting.");
  d.defaulted<&E::increments_per_unit>(unit::count_u, between(1e-6, 1e9), "Counts per unit of the axis.");
  d.defaulted<&E::inverted>("Counts fall while the position grows.");
  d.defaulted<&E::offset_counts>(unit::count,
                                 "Incremental: the counter at the start; absolute: the word at position 0.");
  d.defaulted<&E::ssi_bits>(between(8, 32), "Absolute: number of bits of the word.");
  d.defaulted<&E::coding>("Absolute: coding of the word.");
  d.defaulted<&E::index_distance>(unit::u, kAnySize, "Distance from one index pulse to the next; 0: none.");
  d.defaulted<&E::index_offset>(unit::u, kPlace, "Position of one of the index pulses.");
  d.defaulted<&E::index_step>(
      unit::u, kAnySize,
      "Distance-coded marks: beyond fixed marks, index_distance apart from index_offset on, lie coded marks, in the "
      "middle and 1, 2, 3 ... index_step beyond it; 0: all index pulses are alike.");
  d.defaulted<&E::index_reversed>("Distance-coded marks count downwards from index_offset.");
  d.rule<&E::index_step>("must be less than half of index_distance",
                         [](const E& e) { return e.index_step == 0 || e.index_step < e.index_distance / 2; });
  d.defaulted<&E::noise_counts>(unit::count, between(0, 1e6), "Standard deviation of the noise; 0: none.");
  d.defaulted<&E::noise_seed>("Seed of the noise: the same number gives the same noise.");
}

void describe(Description<ServoSwitch>& d) {
  using S = ServoSwitch;
  d.about("A switch that the load actuates: on between two positions, or beyond one; never on if neither is given.");
  d.defaulted<&S::from>(unit::u, kPlace, "Lower end of the range; unset: unbounded.");
  d.defaulted<&S::to>(unit::u, kPlace, "Upper end of the range; unset: unbounded.");
  d.defaulted<&S::normally_closed>("The output of the switch is inverted.");
  d.rule<&S::to>("must not lie below from", [](const S& s) { return !s.from || !s.to || *s.from <= *s.to; });
}

void describe(Description<ServoSwitches>& d) {
  using S = ServoSwitches;
  d.about("The switches of a simulated axis.");
  d.defaulted<&S::limit_positive>("The limit switch LIM+.");
  d.defaulted<&S::limit_negative>("The limit switch LIM-.");
  d.defaulted<&S::reference>("The reference switch REF.");
  d.defaulted<&S::touch_probe>("The touch probe TP.");
  d.defaulted<&S::revolution>(unit::u, kAnySize,
                              "Rotary axes: distance after which reference switch and touch probe repeat; 0: never.");
}

void describe(Description<ServoParams>& d) {
  using P = ServoParams;
  d.about("A simulated servo axis, in the unit of its axis.");
  d.defaulted<&P::drive>("The drive.");
  d.defaulted<&P::mechanics>("Motor and load.");
  d.defaulted<&P::encoder>("The encoder.");
  d.defaulted<&P::load_encoder>("A second encoder, on the load; unset: none.");
  d.defaulted<&P::switches>("The switches.");
}

void describe(Description<ServoFaults>& d) {
  using F = ServoFaults;
  d.about("Present faults of a simulated axis.");
  d.defaulted<&F::encoder_error>("The encoder's error line is on.");
  d.defaulted<&F::encoder_frozen>("Counts and index pulses keep their values.");
  d.defaulted<&F::drive_fault>("The drive reports a fault and has no power.");
  d.defaulted<&F::stuck>("The mechanics are jammed.");
  d.defaulted<&F::extra_load>(kTorque, kPlace, "Load in addition to load_torque, with the same sign.");
}

void describe(Description<ServoState>& d) {
  using S = ServoState;
  d.about("State of a simulated axis.");
  d.internal<&S::faults>("Present faults.");
  d.internal<&S::motor_position>(unit::u, "Position of the motor.");
  d.internal<&S::velocity>(unit::u_s, "Speed of the motor.");
  d.internal<&S::load_position>(unit::u, "Position of the load.");
  d.internal<&S::torque>(kTorque, "Torque of the motor.");
  d.internal<&S::compensation>(unit::u_s2, "Acceleration that the drive adds against load and friction.");
  d.internal<&S::enabled_s>(unit::s, "Time since the drive was enabled.");
  d.internal<&S::following>("csp: the last set point can be continued.");
  d.internal<&S::set_position>(unit::u, "csp: last set point.");
  d.internal<&S::set_velocity>(unit::u_s, "csp: set velocity of the last set point.");
  d.internal<&S::counter_origin>(unit::count, "Value of the unwrapped counter at position 0.");
  d.internal<&S::index_cell>("Number of index pulses from position 0 to the present position.");
  d.internal<&S::index_counts>(unit::count, "Counter at the last index pulse.");
  d.internal<&S::index_pulses>("Index pulses since the start.");
  d.internal<&S::counts>(unit::count, "Counter as last read.");
  d.internal<&S::load_counter_origin>(unit::count, "Value of the counter on the load at position 0.");
  d.internal<&S::load_counts>(unit::count, "Counter on the load as last read.");
  d.internal<&S::probe>("Level of the touch probe.");
  d.internal<&S::probe_rises>("Rising edges of the touch probe.");
  d.internal<&S::probe_falls>("Falling edges of the touch probe.");
  d.internal<&S::probe_rise_age_s>(unit::s, "Time from the last rising edge to the end of its cycle.");
  d.internal<&S::probe_fall_age_s>(unit::s, "Time from the last falling edge to the end of its cycle.");
  d.internal<&S::noise>("State of the noise generator.");
  d.internal<&S::reach_rate>(unit::one_s, "Rate of the exponential kept below.");
  d.internal<&S::reach_time>(unit::s, "Time of the exponential kept below.");
  d.internal<&S::reach_to_velocity>(unit::s, "Speed gained in that time by an acceleration of 1.");
  d.internal<&S::reach_to_distance>("Distance gained in that time by an acceleration of 1, in s2.");
}

}  // namespace takt::plant
