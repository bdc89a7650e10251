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
  e.about("What the simulated encoder sends.");
  e.value(ServoEncoderType::kIncremental, "incremental", "A 32-bit counter that begins at the start.");
  e.value(ServoEncoderType::kAbsolute, "absolute", "An SSI word that stands for the position.");
}

void describe(Enumeration<ServoEncoderCoding>& e) {
  e.about("How an absolute position is written as a word.");
  e.value(ServoEncoderCoding::kBinary, "binary", "As a binary number.");
  e.value(ServoEncoderCoding::kGray, "gray", "In Gray code: one bit changes from one count to the next.");
}

void describe(Enumeration<ServoEncoderPlace>& e) {
  e.about("Where the simulated encoder sits.");
  e.value(ServoEncoderPlace::kMotor, "motor", "On the motor, before the backlash.");
  e.value(ServoEncoderPlace::kLoad, "load", "On the load, behind the backlash.");
}

void describe(Description<ServoDrive>& d) {
  using D = ServoDrive;
  d.about(
      "The simulated drive: a velocity loop of the first order under an own position loop (csp), a digital or an "
      "analogue set point.");
  d.defaulted<&D::power_up_s>(unit::s, between(0, 1000), "Time from enabling the drive until it is ready.");
  d.defaulted<&D::position_gain>(unit::one_s, between(0, 1000), "csp: gain of the drive's own position loop.");
  d.defaulted<&D::velocity_feed_forward>(between(0, 2), "csp: share of the set velocity that is fed forward.");
  d.defaulted<&D::loop_period_s>(unit::s, between(0.00005, 0.001), "How often the drive's own loops run.");
  d.defaulted<&D::velocity_time_constant_s>(unit::s, between(0.00001, 10), "Time constant of the velocity loop.");
  d.defaulted<&D::load_compensation_s>(
      unit::s, between(0, 1000), "Time constant with which the drive makes up for load and friction; 0: it does not.");
  d.defaulted<&D::max_torque>(kTorque, kAboveZero, "Largest torque of the motor.");
  d.defaulted<&D::velocity_at_10v>(unit::u_s, kAboveZero, "Analogue input: speed at 10 V.");
  d.defaulted<&D::offset_mv>(kMillivolt, between(-10000, 10000), "Analogue input: what the drive sees at 0 V.");
  d.defaulted<&D::dead_band_plus_mv>(kMillivolt, between(0, 10000),
                                     "Analogue input: so much positive voltage moves nothing.");
  d.defaulted<&D::dead_band_minus_mv>(kMillivolt, between(0, 10000),
                                      "Analogue input: so much negative voltage moves nothing.");
  d.defaulted<&D::inverted>("Set points of all modes count the other way round.");
}

void describe(Description<ServoScrewPoint>& d) {
  using P = ServoScrewPoint;
  d.about("The error of the lead screw at a position of the motor.");
  d.required<&P::position>(unit::u, kPlace, "Of the motor.");
  d.required<&P::error>(unit::u, kPlace, "How much further the load is.");
}

void describe(Description<ServoMechanics>& d) {
  using M = ServoMechanics;
  d.about("What the simulated motor has to move.");
  d.defaulted<&M::inertia>(kInertia, between(1e-9, 1e9),
                           "Torque that an acceleration of 1 takes, motor and load together.");
  d.defaulted<&M::coulomb_friction>(kTorque, kAnySize, "Friction that does not depend on the speed.");
  d.defaulted<&M::viscous_friction>(kViscosity, kAnySize, "Friction that grows with the speed.");
  d.defaulted<&M::load_torque>(kTorque, kPlace, "Constant load; positive: pulls towards smaller positions.");
  d.defaulted<&M::brake_torque>(kTorque, kAnySize, "Torque of the brake while it is not released; 0: no brake.");
  d.defaulted<&M::backlash>(unit::u, kAnySize, "Play between motor and load.");
  d.defaulted<&M::screw>("Errors of the lead screw, by rising positions of the motor; none if left out.");
  d.rule<&M::screw>("must have rising positions", [](const M& m) {
    for (std::size_t i = 1; i < m.screw.size(); ++i) {
      if (!(m.screw[i].position > m.screw[i - 1].position)) return false;
    }
    return true;
  });
  d.defaulted<&M::lower_stop>(unit::u, kPlace, "End stop: the load cannot get below; none if left out.");
  d.defaulted<&M::upper_stop>(unit::u, kPlace, "End stop: the load cannot get above; none if left out.");
  d.defaulted<&M::start_position>(unit::u, kPlace, "Where the axis stands at the start.");
  d.rule<&M::upper_stop>("must lie above lower_stop",
                         [](const M& m) { return !m.lower_stop || !m.upper_stop || *m.lower_stop < *m.upper_stop; });
}

void describe(Description<ServoEncoder>& d) {
  using E = ServoEncoder;
  d.about("The simulated encoder, which has to match the one the axis is told of.");
  d.defaulted<&E::type>("What it sends.");
  d.defaulted<&E::place>("Where it sits.");
  d.defaulted<&E::increments_per_unit>(unit::count_u, between(1e-6, 1e9), "Counts per unit of the axis.");
  d.defaulted<&E::inverted>("Counts fall while the position grows.");
  d.defaulted<&E::offset_counts>(unit::count,
                                 "Incremental: the counter at the start; absolute: the word at position 0.");
  d.defaulted<&E::ssi_bits>(between(8, 32), "Absolute: bits of the word.");
  d.defaulted<&E::coding>("Absolute: how the word is written.");
  d.defaulted<&E::index_distance>(unit::u, kAnySize, "Distance from one index pulse to the next; 0: none.");
  d.defaulted<&E::index_offset>(unit::u, kPlace, "Position of one of the index pulses.");
  d.defaulted<&E::index_step>(unit::u, kAnySize,
                              "Distance-coded marks: behind fixed ones index_distance apart, from index_offset on, lie "
                              "coded ones, in the middle and 1, 2, 3 ... index_step beyond it; 0: all are alike.");
  d.defaulted<&E::index_reversed>("Distance-coded marks count downwards from index_offset.");
  d.rule<&E::index_step>("must be less than half of index_distance",
                         [](const E& e) { return e.index_step == 0 || e.index_step < e.index_distance / 2; });
  d.defaulted<&E::noise_counts>(unit::count, between(0, 1e6), "Standard deviation of the noise; 0: none.");
  d.defaulted<&E::noise_seed>("Where the noise begins: the same number gives the same noise.");
}

void describe(Description<ServoSwitch>& d) {
  using S = ServoSwitch;
  d.about("A switch that the load works: on between two positions, or beyond one; never on where neither is given.");
  d.defaulted<&S::from>(unit::u, kPlace, "Lower end of the range; open if left out.");
  d.defaulted<&S::to>(unit::u, kPlace, "Upper end of the range; open if left out.");
  d.defaulted<&S::normally_closed>("The wire says the opposite.");
  d.rule<&S::to>("must not lie below from", [](const S& s) { return !s.from || !s.to || *s.from <= *s.to; });
}

void describe(Description<ServoSwitches>& d) {
  using S = ServoSwitches;
  d.about("The switches of a simulated axis.");
  d.defaulted<&S::limit_positive>("The limit switch LIM+.");
  d.defaulted<&S::limit_negative>("The limit switch LIM-.");
  d.defaulted<&S::reference>("The reference switch REF.");
  d.defaulted<&S::touch_probe>("The touch probe TP.");
  d.defaulted<&S::revolution>(
      unit::u, kAnySize, "Rotary axes: distance after which reference switch and touch probe come again; 0: never.");
}

void describe(Description<ServoParams>& d) {
  using P = ServoParams;
  d.about("A simulated servo axis, in the unit of its axis.");
  d.defaulted<&P::drive>("The drive.");
  d.defaulted<&P::mechanics>("What the motor has to move.");
  d.defaulted<&P::encoder>("The encoder.");
  d.defaulted<&P::load_encoder>("A second encoder, on the load; none if left out.");
  d.defaulted<&P::switches>("The switches.");
}

void describe(Description<ServoFaults>& d) {
  using F = ServoFaults;
  d.about("What is broken in a simulated axis at the moment.");
  d.defaulted<&F::encoder_error>("The encoder's error line is on.");
  d.defaulted<&F::encoder_frozen>("Counts and index pulses stay as they are.");
  d.defaulted<&F::drive_fault>("The drive reports a fault and is without power.");
  d.defaulted<&F::stuck>("The mechanics are jammed.");
  d.defaulted<&F::extra_load>(kTorque, kPlace, "Load beside load_torque, with the same sign.");
}

void describe(Description<ServoState>& d) {
  using S = ServoState;
  d.about("All that a simulated axis remembers from one cycle to the next.");
  d.internal<&S::faults>("What is broken.");
  d.internal<&S::motor_position>(unit::u, "Position of the motor.");
  d.internal<&S::velocity>(unit::u_s, "Speed of the motor.");
  d.internal<&S::load_position>(unit::u, "Position of the load.");
  d.internal<&S::torque>(kTorque, "Torque of the motor.");
  d.internal<&S::compensation>(unit::u_s2, "Acceleration the drive adds against load and friction.");
  d.internal<&S::enabled_s>(unit::s, "How long the drive has been powering up.");
  d.internal<&S::following>("csp: the last set point is one to go on from.");
  d.internal<&S::set_position>(unit::u, "csp: last set point.");
  d.internal<&S::set_velocity>(unit::u_s, "csp: set velocity of the last set point.");
  d.internal<&S::counter_origin>(unit::count, "What the counter, unwrapped, shows at position 0.");
  d.internal<&S::index_cell>("Index pulses between position 0 and here.");
  d.internal<&S::index_counts>(unit::count, "Counter at the last index pulse.");
  d.internal<&S::index_pulses>("Index pulses since the start.");
  d.internal<&S::counts>(unit::count, "Counter as last read.");
  d.internal<&S::load_counter_origin>(unit::count, "What the counter on the load shows at position 0.");
  d.internal<&S::load_counts>(unit::count, "Counter on the load as last read.");
  d.internal<&S::probe>("The touch probe's wire.");
  d.internal<&S::probe_rises>("Rising edges of the touch probe.");
  d.internal<&S::probe_falls>("Falling edges of the touch probe.");
  d.internal<&S::probe_rise_age_s>(unit::s, "How long before the end of its cycle the last rising edge came.");
  d.internal<&S::probe_fall_age_s>(unit::s, "The same of the last falling edge.");
  d.internal<&S::noise>("State of the noise generator.");
  d.internal<&S::reach_rate>(unit::one_s, "What the exponential below belongs to: its rate.");
  d.internal<&S::reach_time>(unit::s, "What the exponential below belongs to: its time.");
  d.internal<&S::reach_to_velocity>(unit::s, "Speed gained in that time by an acceleration of 1.");
  d.internal<&S::reach_to_distance>("Distance gained in that time by an acceleration of 1, in s2.");
}

}  // namespace takt::plant
