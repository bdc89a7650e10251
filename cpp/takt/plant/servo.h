// A simulated servo axis: drive, motor, mechanics, switches and encoder behind the same interface as a real one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/core/ports.h"

namespace takt::plant {

// All quantities are in the axis' own unit u. Torque is [Nm] on rotary motors and [N] on linear ones; inertia is the
// torque (force) per u/s², gears included.

// The drive. Its velocity loop is of first order: dv/dt = (target - v) / velocity_time_constant, within the torque
// limit.
struct ServoDrive {
  double power_up_s = 0.1;                  // [s] >= 0: from enable to ready
  double position_gain = 200;               // [1/s] csp: gain of the drive's own position loop
  double velocity_feed_forward = 1;         // csp: share of the set velocity that is fed forward
  double loop_period_s = 0.0005;            // [s] period of the drive's own loops within a cycle
  double velocity_time_constant_s = 0.001;  // [s] > 0
  double load_compensation_s = 0.01;        // [s] >= 0: time constant of the compensation of load and friction; 0: none
  double max_torque = 10;                   // [Nm] or [N] > 0
  double velocity_at_10v = 1000;            // [u/s] > 0: analogue input
  double offset_mv = 0;                     // [mV] offset of the analogue input
  double dead_band_plus_mv = 0;             // [mV] >= 0: dead band for positive voltages
  double dead_band_minus_mv = 0;            // [mV] >= 0: dead band for negative voltages
  bool inverted = false;                    // set points of all modes have the opposite sign

  bool operator==(const ServoDrive&) const = default;
};

// The error of a lead screw: displacement of the load relative to the motor at a motor position.
struct ServoScrewPoint {
  double position = 0;  // [u]
  double error = 0;     // [u]

  bool operator==(const ServoScrewPoint&) const = default;
};

struct ServoMechanics {
  double inertia = 0.0001;             // [torque per u/s²] > 0
  double coulomb_friction = 0;         // [torque] >= 0
  double viscous_friction = 0;         // [torque per u/s] >= 0
  double load_torque = 0;              // [torque] constant; if positive, towards smaller positions
  double brake_torque = 10;            // [torque] >= 0, while the brake is not released; 0: no brake
  double backlash = 0;                 // [u] >= 0: play between motor and load; within it friction holds the load
  std::vector<ServoScrewPoint> screw;  // positions in ascending order; interpolated linearly
  std::optional<double> lower_stop;    // [u] mechanical stop of the load; unset: none
  std::optional<double> upper_stop;    // [u] likewise
  double start_position = 0;           // [u]

  bool operator==(const ServoMechanics&) const = default;
};

enum class ServoEncoderType : std::uint8_t { kIncremental, kAbsolute };
enum class ServoEncoderCoding : std::uint8_t { kBinary, kGray };
enum class ServoEncoderPlace : std::uint8_t { kMotor, kLoad };

struct ServoEncoder {
  ServoEncoderType type = ServoEncoderType::kIncremental;
  ServoEncoderPlace place = ServoEncoderPlace::kMotor;
  double increments_per_unit = 1000;  // [counts per u] > 0
  bool inverted = false;              // counts decrease while the position increases
  std::int32_t offset_counts = 0;     // incremental: the counter at the start; absolute: the word at position 0
  int ssi_bits = 24;                  // absolute: 8 to 32
  ServoEncoderCoding coding = ServoEncoderCoding::kBinary;  // absolute: the word on the wire
  double index_distance = 10;                               // [u] >= 0: distance of index pulses; 0: none
  double index_offset = 0;                                  // [u] position of one index pulse
  bool index_reversed = false;                              // distance-coded marks count downwards
  // [u] >= 0: distance-coded marks: increment of the distance from a fixed mark to the next coded one; 0: not coded
  double index_step = 0;
  double noise_counts = 0;      // [counts] >= 0: standard deviation
  std::int32_t noise_seed = 1;  // equal seeds give bit-identical noise

  bool operator==(const ServoEncoder&) const = default;
};

// On while the load is between both positions, limits included; without one of them the range is open, without both the
// switch is never on.
struct ServoSwitch {
  std::optional<double> from;    // [u]
  std::optional<double> to;      // [u]
  bool normally_closed = false;  // the signal is inverted

  bool operator==(const ServoSwitch&) const = default;
};

struct ServoSwitches {
  ServoSwitch limit_positive;
  ServoSwitch limit_negative;
  ServoSwitch reference;
  ServoSwitch touch_probe;
  double revolution = 0;  // [u] >= 0: rotary axes: period of reference and touch probe; 0: linear

  bool operator==(const ServoSwitches&) const = default;
};

struct ServoParams {
  ServoDrive drive;
  ServoMechanics mechanics;
  ServoEncoder encoder;
  std::optional<ServoEncoder> load_encoder{};  // a second encoder, on the load; its `place` and index are not used
  ServoSwitches switches;

  bool operator==(const ServoParams&) const = default;
};

// Faults that a test can inject, at any time.
struct ServoFaults {
  bool encoder_error = false;   // the ERR line is set
  bool encoder_frozen = false;  // counts and index pulses are frozen
  bool drive_fault = false;     // power is off and a fault reported while this is true
  bool stuck = false;           // the mechanics are blocked
  double extra_load = 0;        // [torque] added to load_torque

  bool operator==(const ServoFaults&) const = default;
};

struct ServoState {
  ServoFaults faults;               // set from outside
  double motor_position = 0;        // [u]
  double velocity = 0;              // [u/s] of the motor
  double load_position = 0;         // [u]
  double torque = 0;                // of the motor
  double compensation = 0;          // [u/s²] acceleration that the drive adds against load and friction
  double enabled_s = 0;             // [s] since the drive was enabled
  bool following = false;           // the set point of the previous cycle is valid for csp interpolation
  double set_position = 0;          // [u] csp: in the previous cycle
  double set_velocity = 0;          // [u/s] csp: in the previous cycle
  std::int64_t counter_origin = 0;  // value of the unwrapped counter at position 0
  std::int64_t index_cell = 0;      // number of the last index mark below the encoder's position
  std::uint32_t index_counts = 0;
  std::uint32_t index_pulses = 0;
  std::uint32_t counts = 0;  // last reading
  std::int64_t load_counter_origin = 0;
  std::uint32_t load_counts = 0;
  bool probe = false;  // signal of the touch probe
  std::uint32_t probe_rises = 0;
  std::uint32_t probe_falls = 0;
  double probe_rise_age_s = 0;  // [s] before the end of the cycle in which it occurred
  double probe_fall_age_s = 0;
  std::uint64_t noise = 0;  // state of the noise generator
  // Cached exponential for (rate, time), which is the same every cycle while nothing changes.
  double reach_rate = 0;         // [1/s]
  double reach_time = 0;         // [s]
  double reach_to_velocity = 0;  // [s]
  double reach_to_distance = 0;  // [s²]

  bool operator==(const ServoState&) const = default;
};

// Returns the state at power-on: at the start position, at rest, without faults. Call once before the first Step.
ServoState MakeServoState(const ServoParams& params) noexcept;

// Simulates one cycle of `period_s` (250 µs to 20 ms). `commanded` applies from its begin; a csp set point is
// interpolated linearly and reached at its end. `measured` holds the signals at its end. Set points in counts have the
// encoder's sense; positions are modulo the range of its counter.
void Step(const ServoParams& params, const ServoOutputs& commanded, double period_s, ServoState& state,
          ServoInputs& measured) noexcept;

// --- a servo with the mechanics of another physics engine ---
// Drive, encoder and switches of the servo above; the mechanics are elsewhere and have their own steps: in each cycle
// call BeginCycle, AskTorque for every step, and Sense at the end. ServoMechanics gives the inertia for which the
// drive's gain is tuned, start_position and brake_torque; its other members, including backlash and stops, are not
// used.

struct MovedServo {
  ServoState servo;
  double expected_velocity = 0;  // [u/s] after this step, by the drive's own model of the load ...
  bool expects = false;          // ... if it applies
  bool braked = false;           // the brake is applied ...
  double brake_position = 0;     // [u] ... and holds this position
  double brake = 0;              // [torque] of the brake in this step
  bool limited = false;          // the motor's torque limit was active in the last step

  // Of the cycle:
  ServoOutputs commanded{};
  bool powered = false;
  int steps = 1;
  double time = 0;  // [s] of each step
  double start_position = 0;
  double start_velocity = 0;
  double end_position = 0;
  double end_velocity = 0;
};

MovedServo MakeMovedServo(const ServoParams& params) noexcept;
// Begins a cycle with `steps` steps of the physics.
void BeginCycle(const ServoParams& params, const ServoOutputs& commanded, double period_s, int steps,
                MovedServo& servo) noexcept;
// Returns the torque of motor and brake during step `i`, which begins at this position and velocity. `feed_forward`:
// torque that the motor adds.
double AskTorque(const ServoParams& params, int i, double position, double velocity, double feed_forward,
                 MovedServo& servo) noexcept;
// Returns the signals at the end of the cycle.
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
