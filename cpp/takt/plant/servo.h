// A simulated servo axis: drive, motor, mechanics, switches and encoder behind the same wires as a real one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/core/ports.h"

namespace takt::plant {

// Everything is in the axis' own unit u. Torque is Nm on rotary motors and N on linear ones; inertia is then the torque
// (force) that one u/s² takes, whatever gears lie in between.

// The drive. Its velocity loop is of the first order: dv/dt = (target - v) / velocity_time_constant, as long as the
// torque suffices.
struct ServoDrive {
  double power_up_s = 0.1;                  // s, >= 0: from enable to ready
  double position_gain = 200;               // 1/s: csp, the drive's own position loop
  double velocity_feed_forward = 1;         // csp: share of the set velocity added to the position loop's
  double loop_period_s = 0.0005;            // s: how often the drive's own loops run between two cycles
  double velocity_time_constant_s = 0.001;  // s, > 0
  double load_compensation_s = 0.01;        // s, >= 0: how fast the drive makes up for load and friction; 0: never
  double max_torque = 10;                   // Nm or N, > 0
  double velocity_at_10v = 1000;            // u/s, > 0: analogue input
  double offset_mv = 0;                     // mV the analogue input sees at 0 V
  double dead_band_plus_mv = 0;             // mV, >= 0: so much positive voltage moves nothing
  double dead_band_minus_mv = 0;            // mV, >= 0: so much negative voltage moves nothing
  bool inverted = false;                    // set points of all modes count the other way round

  bool operator==(const ServoDrive&) const = default;
};

// The error of a lead screw: how much further than the motor the load is where the motor is at a position.
struct ServoScrewPoint {
  double position = 0;  // u
  double error = 0;     // u

  bool operator==(const ServoScrewPoint&) const = default;
};

struct ServoMechanics {
  double inertia = 0.0001;      // torque per u/s², > 0
  double coulomb_friction = 0;  // torque, >= 0
  double viscous_friction = 0;  // torque per u/s, >= 0
  double load_torque = 0;       // torque, constant, pulls towards smaller positions when positive
  double brake_torque = 10;     // torque, >= 0, while the brake is not released; 0: no brake
  double backlash = 0;          // u, >= 0: play between motor and load; friction keeps the load where it is meanwhile
  std::vector<ServoScrewPoint> screw;  // rising positions; on the line between two of them
  std::optional<double> lower_stop;    // u: the load cannot get below
  std::optional<double> upper_stop;    // u: nor above
  double start_position = 0;           // u

  bool operator==(const ServoMechanics&) const = default;
};

enum class ServoEncoderType : std::uint8_t { kIncremental, kAbsolute };
enum class ServoEncoderCoding : std::uint8_t { kBinary, kGray };
enum class ServoEncoderPlace : std::uint8_t { kMotor, kLoad };

struct ServoEncoder {
  ServoEncoderType type = ServoEncoderType::kIncremental;
  ServoEncoderPlace place = ServoEncoderPlace::kMotor;
  double increments_per_unit = 1000;  // counts per u, > 0
  bool inverted = false;              // counts fall while the position grows
  std::int32_t offset_counts = 0;     // incremental: the counter at the start; absolute: the word at position 0
  int ssi_bits = 24;                  // absolute: 8 to 32
  ServoEncoderCoding coding = ServoEncoderCoding::kBinary;  // absolute: the word on the wire
  double index_distance = 10;                               // u, >= 0: from one index pulse to the next; 0: none
  double index_offset = 0;                                  // u: position of one of them
  bool index_reversed = false;                              // distance-coded marks count downwards
  double index_step = 0;  // u, >= 0: distance-coded marks, each coded one so much further from the fixed one before it
  double noise_counts = 0;      // counts, >= 0: standard deviation
  std::int32_t noise_seed = 1;  // the same seed gives the same noise, bit for bit

  bool operator==(const ServoEncoder&) const = default;
};

// On while the load is between both positions, ends included; an end left out is open, both left out: never on.
struct ServoSwitch {
  std::optional<double> from;    // u
  std::optional<double> to;      // u
  bool normally_closed = false;  // the wire says the opposite

  bool operator==(const ServoSwitch&) const = default;
};

struct ServoSwitches {
  ServoSwitch limit_positive;
  ServoSwitch limit_negative;
  ServoSwitch reference;
  ServoSwitch touch_probe;
  double revolution = 0;  // u, >= 0: rotary axes: after this distance reference and touch probe come again; 0: linear

  bool operator==(const ServoSwitches&) const = default;
};

struct ServoParams {
  ServoDrive drive;
  ServoMechanics mechanics;
  ServoEncoder encoder;
  std::optional<ServoEncoder> load_encoder{};  // a second one, on the load; its place and index do not matter
  ServoSwitches switches;

  bool operator==(const ServoParams&) const = default;
};

// What a test can break, at any time.
struct ServoFaults {
  bool encoder_error = false;   // ERR line on
  bool encoder_frozen = false;  // counts and index pulses stay as they are
  bool drive_fault = false;     // power off, fault reported, as long as it lasts
  bool stuck = false;           // the mechanics are jammed
  double extra_load = 0;        // torque beside load_torque, the same sign

  bool operator==(const ServoFaults&) const = default;
};

struct ServoState {
  ServoFaults faults;               // set from outside
  double motor_position = 0;        // u
  double velocity = 0;              // u/s, of the motor
  double load_position = 0;         // u
  double torque = 0;                // of the motor
  double compensation = 0;          // u/s²: acceleration the drive adds against load and friction
  double enabled_s = 0;             // s since the drive was enabled
  bool following = false;           // csp: the last set point is one to go on from
  double set_position = 0;          // u: csp, of the cycle before
  double set_velocity = 0;          // u/s: csp, of the cycle before
  std::int64_t counter_origin = 0;  // what the unwrapped counter shows at position 0
  std::int64_t index_cell = 0;      // number of the index distance the encoder is in
  std::uint32_t index_counts = 0;
  std::uint32_t index_pulses = 0;
  std::uint32_t counts = 0;  // as last read
  std::int64_t load_counter_origin = 0;
  std::uint32_t load_counts = 0;
  bool probe = false;  // the touch probe's wire
  std::uint32_t probe_rises = 0;
  std::uint32_t probe_falls = 0;
  double probe_rise_age_s = 0;  // s before the end of the cycle in which it came
  double probe_fall_age_s = 0;
  std::uint64_t noise = 0;  // state of the noise generator
  // An exponential that is the same every cycle while nothing changes, kept for its price: that of (rate, time).
  double reach_rate = 0;         // 1/s
  double reach_time = 0;         // s
  double reach_to_velocity = 0;  // s
  double reach_to_distance = 0;  // s²

  bool operator==(const ServoState&) const = default;
};

// The axis as it stands when power comes on: at its start position, at rest, without faults. Once before the first
// Step.
ServoState MakeServoState(const ServoParams& params) noexcept;

// One cycle of `period_s` (250 µs to 20 ms). `commanded` holds from its beginning; a csp set point is approached in a
// straight line and reached at its end. `measured` is what the wires say at its end. Set points in counts have the
// encoder's sense; positions are taken modulo the range of its counter.
void Step(const ServoParams& params, const ServoOutputs& commanded, double period_s, ServoState& state,
          ServoInputs& measured) noexcept;

// --- a servo whose mechanics are another physics' ---
// Drive, encoder and switches of the servo above; what moves is elsewhere and goes in steps of its own: in each cycle
// BeginCycle, for every step AskTorque, and Sense at the end. ServoMechanics gives the inertia that the drive's gain
// fits, start_position and brake_torque; the rest of it, backlash and the noise of stops included, is not used.

struct MovedServo {
  ServoState servo;
  double expected_velocity = 0;  // u/s: after this step, by the drive's own model of the load ...
  bool expects = false;          // ... if it has one
  bool braked = false;           // the brake has fallen ...
  double brake_position = 0;     // u: ... here
  double brake = 0;              // torque of the brake in this step
  bool limited = false;          // the motor's torque limit held the last step back

  // Of the cycle.
  ServoOutputs commanded{};
  bool powered = false;
  int steps = 1;
  double time = 0;  // s, of each step
  double start_position = 0;
  double start_velocity = 0;
  double end_position = 0;
  double end_velocity = 0;
};

MovedServo MakeMovedServo(const ServoParams& params) noexcept;
// `steps` of the physics to a cycle.
void BeginCycle(const ServoParams& params, const ServoOutputs& commanded, double period_s, int steps,
                MovedServo& servo) noexcept;
// Torque of motor and brake during step `i`, at whose beginning the axis is there. `feed_forward`: what the motor is
// told to add.
double AskTorque(const ServoParams& params, int i, double position, double velocity, double feed_forward,
                 MovedServo& servo) noexcept;
// What the wires say at the end of the cycle.
void Sense(const ServoParams& params, double position, double velocity, MovedServo& servo,
           ServoInputs& measured) noexcept;

void describe(Description<ServoDrive>&);
void describe(Description<ServoScrewPoint>&);
void describe(Description<ServoMechanics>&);
void describe(Description<ServoEncoder>&);
void describe(Description<ServoSwitch>&);
void describe(Description<ServoSwitches>&);
void describe(Description<ServoParams>&);
void describe(Description<ServoFaults>&);
void describe(Description<ServoState>&);
void describe(Enumeration<ServoEncoderType>&);
void describe(Enumeration<ServoEncoderCoding>&);
void describe(Enumeration<ServoEncoderPlace>&);

}  // namespace takt::plant
