// The complete state of an axis: plain data, so that it can be copied, compared, hashed and replayed.
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

// The motion in progress: a profile and its start.
struct Motion {
  trajectory::Profile profile;
  std::uint64_t start_cycle = 0;  // profile time 0 is `start_offset_s` before this cycle
  double start_offset_s = 0;      // [s]
  double target = 0;              // [u] unwrapped: end of a positioning command
  bool held = false;              // the profile ends where an override holds the axis, not where its command ends
  bool arrived = false;           // the profile is over
  std::uint64_t arrived_cycle = 0;
};

// Effect of an emergency stop (AX-100).
enum class Emergency : std::uint8_t {
  kNone,
  kHeld,     // in force: the axis cannot be powered
  kStopped,  // released; the axis stays off until a command requests power
};

// The deviation of an axis that follows another from load on from the position due by its master (AX-101). [u] own
// minus due.
struct SkewState {
  double commanded = 0;      // of the set points: determined when both loops were closed, kept until straightened
  double measured = 0;       // of the actual positions
  bool known = false;        // the offset is determined, since both loops were closed for the first time
  Ticket ticket = 0;         // of the command that straightens the skew; 0: none
  bool straightens = false;  // the skew is being straightened, with or without a command
  bool stops = false;        // the straightening is being stopped
  std::uint64_t start_cycle = 0;
  trajectory::Profile way;  // from the skew to 0

  // Squaring: the edge of the reference switch that the search of the master looks for.
  double edge = 0;                  // [u] over all turns
  std::uint64_t edge_cycle = 0;     // cycle in which it was found
  std::uint64_t squared_cycle = 0;  // cycle of the master's edge by which it was squared
  bool reference_before = false;
};

// Supervision that was switched off at run time and can be switched on again.
struct DisabledSupervision {
  std::optional<double> lower{}, upper{};  // [u] SW limits
  std::optional<double> lag{};             // [u] largest following error in motion
};

// A voltage pulse (GT_Pulse).
struct Pulse {
  Ticket ticket = 0;
  double voltage = 0;           // [V]
  std::uint64_t end_cycle = 0;  // cycle in which it is 0 V again
};

struct State {
  // In order of use: members that every cycle reads come first and are close together. Positions are unwrapped; only
  // the outputs are taken modulo.
  KinematicState setpoint;
  KinematicState actual;       // the acceleration is not measured: 0
  double due = 0;              // [u] position due now: the set point of the previous cycle
  double following_error = 0;  // [u] due minus actual position

  PlcState plc = PlcState::kDisabled;
  ErrorId error = ErrorId::kNone;
  LimitedBy limited_by = LimitedBy::kNothing;
  bool reported = false;       // that the command in control has reached its goal; it stays in control
  bool passed = false;         // the continuous move in control is beyond its position
  std::int8_t jog_sense = 0;   // 1, -1: sense of the jog in progress; 0: none
  bool jog_armed = false;      // a key may start a motion: a new jog, or both keys were up since the last one
  std::int8_t last_sense = 1;  // sense of the last motion, for Direction::kCurrent
  bool reset_pending = false;
  bool constants_set = false;  // by GT_SetConstant
  bool coupled = false;        // follows a master from load on: its set point is the master's
  bool drive_homes = false;    // the drive homes before it is ready, without the engine
  bool leads = false;          // other axes follow it from load on
  Emergency emergency = Emergency::kNone;
  bool end_of_profile = false;  // the end of a cam was passed in this cycle
  bool pulsing = false;         // a voltage pulse is in progress: see `pulse`
  bool superimposed = false;    // a motion is superimposed: see `overlay`
  std::uint8_t buffered = 0;

  // A drive in another process.
  Sampling sampling;   // of the inputs
  bool blind = false;  // lost with the loop closed: the axis stops as if the drive followed the set points

  // Power.
  bool enable = false;       // the drive is enabled
  bool loop_closed = false;  // the position loop is closed, the brake released

  // Switches behind inversion, and in the previous cycle.
  bool limit_positive = false;
  bool limit_negative = false;
  bool reference = false;
  bool touch_probe = false;
  bool bars_positive = false;  // MC_Power: motion upwards is not enabled
  bool bars_negative = false;  // MC_Power: motion downwards is not enabled
  bool index_pulse = false;    // at least one came since the previous cycle
  bool index_skipped = false;  // more than one did
  bool limit_positive_before = false;
  bool limit_negative_before = false;
  bool switches_known = false;  // they have been read
  bool brake_falls = false;     // being switched off: the brake relay is released, the loop still closed
  bool drive_ready = false;
  bool drive_fault = false;
  std::int32_t drive_error = 0;     // of the drive, for its fault, until the axis has none any more
  bool encoder_error = false;       // the measurement of this cycle is invalid
  bool encoder_line_error = false;  // the encoder itself reports an error
  std::uint32_t index_pulses = 0;
  std::uint32_t index_counts = 0;  // count at the last index pulse
  std::uint32_t cam_outputs = 0;
  std::uint32_t written_outputs = 0;         // by commands, a bit for each output
  std::uint32_t profile_ends = 0;            // how often an end of a cam was passed
  std::array<std::uint32_t, 3> unsettled{};  // cycles for which the inputs LIM+, LIM-, REF have differed
  std::uint64_t brake_cycle = 0;             // when the brake relay was last energised or released
  std::uint64_t enable_cycle = 0;
  std::uint64_t lease_end_cycle = 0;
  std::uint64_t bars_cycle = 0;  // when a power command last set the enabled directions

  double torque_nm = 0;
  double voltage_v = 0;
  double direct_voltage_v = 0;  // [V] output while the axis is Disabled (GT_Analog)
  double origin = 0;            // [u] to be added for positions over all turns: whole turns, renumbering
  double follow_offset = 0;     // [u] own position minus ratio times the master's without a skew
  Override override_factors;    // for the command in control and buffered ones
  EncoderState encoder;
  CorrectionState correction;
  ControlLoopState loop;
  TorqueState torque;
  HomingState homing;
  ProbeState probe;
  CamSwitchState cam_switch;

  Request active;  // in control; kind none: no command is
  Motion motion;
  CouplingState coupling;
  GuidanceState guidance;
  FaultRamp fault_ramp;
  TimeTableState time_table;

  DisabledSupervision dormant;
  Pulse pulse;
  Ticket reset_ticket = 0;
  std::array<Request, kBufferSize> buffer;                       // [0] is next
  std::uint64_t illegal_transitions = 0;                         // always 0: the state table is complete
  double most_torque = std::numeric_limits<double>::infinity();  // [Nm] of the machine file
  trajectory::Limits system;  // of the machine file; those of the application, in the parameters, do not exceed them
  OverlayState overlay;
  StopRequests stops;
  StreamState stream;
  SkewState skew;
  std::uint32_t fault_of = kNoAxis;  // the follower whose fault stopped this axis
};

void describe(Enumeration<Emergency>&);
void describe(Description<SkewState>&);

void describe(Description<Motion>&);
void describe(Description<DisabledSupervision>&);
void describe(Description<Pulse>&);
void describe(Description<State>&);

}  // namespace takt::axis
