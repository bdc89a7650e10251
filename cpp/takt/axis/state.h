// All memory of an axis: plain, so that it can be copied, compared, hashed and replayed.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "takt/axis/cam_switch.h"
#include "takt/axis/control_loop.h"
#include "takt/axis/correction.h"
#include "takt/axis/coupling.h"
#include "takt/axis/encoder.h"
#include "takt/axis/guidance.h"
#include "takt/axis/homing.h"
#include "takt/axis/overlay.h"
#include "takt/axis/override.h"
#include "takt/axis/probe.h"
#include "takt/axis/request.h"
#include "takt/axis/state_table.h"
#include "takt/axis/stops.h"
#include "takt/axis/stream.h"
#include "takt/axis/time_table.h"
#include "takt/axis/torque.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/ports.h"
#include "takt/core/status.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

inline constexpr int kBufferSize = 8;

// The motion in progress: a profile and when it began.
struct Motion {
  trajectory::Profile profile;
  std::uint64_t start_cycle = 0;  // profile time 0 lies ...
  double start_offset_s = 0;      // ... so long before this cycle
  double target = 0;              // [u] unwrapped: where a positioning command ends
  bool held = false;              // the profile ends where an override stops it, not where its command does
  bool arrived = false;           // the profile is over
  std::uint64_t arrived_cycle = 0;
};

// What an emergency stop has left behind (AX-100).
enum class Emergency : std::uint8_t {
  kNone,
  kHeld,     // it is on: the axis cannot be powered
  kStopped,  // it is over; nothing powers the axis but a command that asks for it
};

// The distance of an axis that follows another from load on to where its master has it (AX-101). u, own minus due.
struct SkewState {
  double commanded = 0;      // of the set points: found when both loops were closed, kept until straightened
  double measured = 0;       // of what is measured
  bool known = false;        // where it belongs: at load, or when both loops were closed for the first time
  Ticket ticket = 0;         // of the command that straightens it; 0: none
  bool straightens = false;  // with or without a command
  bool stops = false;        // it comes to rest on the way
  std::uint64_t start_cycle = 0;
  trajectory::Profile way;  // from the skew to 0

  // Squaring: the edge of the reference switch that its master's search is for.
  double edge = 0;                  // [u] over all turns
  std::uint64_t edge_cycle = 0;     // in which it was found
  std::uint64_t squared_cycle = 0;  // of the master's edge that it was squared by
  bool reference_before = false;
};

// Supervision that was switched off at run time, to be switched on again.
struct Dormant {
  std::optional<double> lower{}, upper{};  // [u] SW limits
  std::optional<double> lag{};             // [u] largest following error in motion
};

// A voltage that is put out for a time (GT_Pulse).
struct Pulse {
  Ticket ticket = 0;
  double voltage = 0;           // [V]
  std::uint64_t end_cycle = 0;  // in which it is 0 V again
};

struct State {
  // In the order of use: what every cycle reads comes first and lies close together.
  // Positions here are unwrapped; only the outputs are taken modulo.
  KinematicState setpoint;
  KinematicState actual;  // acceleration is not measured: 0
  double due =
      0;  // [u] where the axis should be now: the set point of the cycle before, which had this long to be reached
  double following_error = 0;  // [u] due minus what is measured

  PlcState plc = PlcState::kDisabled;
  ErrorId error = ErrorId::kNone;
  LimitedBy limited_by = LimitedBy::kNothing;
  bool reported = false;       // that it has reached what it is for, and stays in control
  bool passed = false;         // the continuous move in control is beyond its position
  std::int8_t jog_sense = 0;   // 1, -1: jogging that way; 0: not
  bool jog_armed = false;      // a key may start a motion: a new jog, or both keys were seen up since the last one
  std::int8_t last_sense = 1;  // sense of the last motion, for Direction::kCurrent
  bool reset_pending = false;
  bool constants_set = false;  // by GT_SetConstant
  bool coupled = false;        // follows a master from load on: its set point is the master's
  bool drive_homes = false;    // the drive homes before it is ready; the engine does not move it
  bool leads = false;          // others follow it from load on
  Emergency emergency = Emergency::kNone;
  bool end_of_profile = false;  // the end of a cam was passed in this cycle
  bool pulsing = false;         // a voltage is put out for a time: see `pulse`
  bool superimposed = false;    // something is on top of the motion in progress: see `overlay`
  std::uint8_t buffered = 0;

  // A drive in another process.
  Sampling sampling;   // of what is measured
  bool blind = false;  // it was lost with the loop closed: stops as if the drive did what it is told

  // Power.
  bool enable = false;       // the drive is told to be on
  bool loop_closed = false;  // and the position loop is closed, the brake released

  // Switches after inversion, and as they were in the cycle before.
  bool limit_positive = false;
  bool limit_negative = false;
  bool reference = false;
  bool touch_probe = false;
  bool bars_positive = false;  // MC_Power: no motion upwards ...
  bool bars_negative = false;  // ... and downwards
  bool index_pulse = false;    // one came since the cycle before ...
  bool index_skipped = false;  // ... and others before it
  bool limit_positive_before = false;
  bool limit_negative_before = false;
  bool switches_known = false;  // they were read once
  bool brake_falls = false;     // being switched off: the relay is let go of, the loop still closed
  bool drive_ready = false;
  bool drive_fault = false;
  std::int32_t drive_error = 0;     // that the drive gave for its fault, until the axis has none any more
  bool encoder_error = false;       // not to be believed this cycle
  bool encoder_line_error = false;  // because the encoder says so
  std::uint32_t index_pulses = 0;
  std::uint32_t index_counts = 0;  // ... at this count
  std::uint32_t cam_outputs = 0;
  std::uint32_t written_outputs = 0;         // by commands, a bit for each output
  std::uint32_t profile_ends = 0;            // how often the end of a cam was passed
  std::array<std::uint32_t, 3> unsettled{};  // cycles for which LIM+, LIM-, REF have said otherwise
  std::uint64_t brake_cycle = 0;             // when the brake relay was energised or let go of
  std::uint64_t enable_cycle = 0;
  std::uint64_t lease_end_cycle = 0;
  std::uint64_t bars_cycle = 0;  // when a power command last said in which directions the axis may move

  double torque_nm = 0;
  double voltage_v = 0;
  double direct_voltage_v = 0;  // [V] put out while the axis is Disabled (GT_Analog)
  double origin = 0;            // rotary axes: whole turns taken out of all positions, so that they stay small (in u)
  double follow_offset = 0;     // [u] own position minus ratio times the master's without a skew
  Override override_factors;    // of commands in control and waiting
  EncoderState encoder;
  CorrectionState correction;
  ControlLoopState loop;
  TorqueState torque;
  HomingState homing;
  ProbeState probe;
  CamSwitchState cam_switch;

  Request active;  // in control; kind none: nothing is
  Motion motion;
  CouplingState coupling;
  GuidanceState guidance;
  FaultRamp fault_ramp;
  TimeTableState time_table;

  Dormant dormant;
  Pulse pulse;
  Ticket reset_ticket = 0;
  std::array<Request, kBufferSize> buffer;                       // [0] is next
  std::uint64_t illegal_transitions = 0;                         // always 0: the state table holds
  double most_torque = std::numeric_limits<double>::infinity();  // [Nm] of the machine file
  trajectory::Limits system;  // of the machine file; those of the application, in the parameters, keep within them
  OverlayState overlay;
  StopOrders stops;
  StreamState stream;
  SkewState skew;
  std::uint32_t fault_of = kNoAxis;  // the axis that follows this one and whose fault stopped it
};

void describe(Enumeration<Emergency>&);
void describe(Description<SkewState>&);

void describe(Description<Motion>&);
void describe(Description<Dormant>&);
void describe(Description<Pulse>&);
void describe(Description<State>&);

}  // namespace takt::axis
