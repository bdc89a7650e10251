// The parameters of one axis in a machine file.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/axis/control_loop.h"
#include "takt/axis/encoder.h"
#include "takt/axis/homing_params.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/ports.h"
#include "takt/trajectory/limits.h"

namespace takt::axis {

enum class AxisKind : std::uint8_t { kLinear, kRotary };

// AX-05. Commands beyond these are rejected; motions that the engine decides on itself (faults) use them in full.
struct AxisLimits {
  double velocity = 0;                   // [u/s]
  double acceleration = 0;               // [u/s²]
  std::optional<double> deceleration{};  // [u/s²] unset: as acceleration
  double jerk = 0;                       // [u/s³] 0: unlimited
  std::optional<double> torque{};        // [Nm] ([N] on linear motors) that the drive may use; unset: all it has
  std::optional<double> lower{};         // [u] SW limit LimNeg; unset: none
  std::optional<double> upper{};         // [u] SW limit LimPos; unset: none
};

struct Supervision {
  std::optional<double> deviation_moving{};      // [u] largest following error in motion; unset: not supervised
  std::optional<double> deviation_standstill{};  // [u] largest one at rest; unset: as in motion
  std::optional<double> in_position{};           // [u] window to be done in; unset: the set point alone decides
  // [counts] Noise of an encoder at rest from one cycle to the next. A step of more than this plus four times the
  // largest displacement of the axis is a jump.
  double encoder_noise_counts = 16;
  std::optional<double> encoders_apart{};  // [u] largest change of motor minus load; unset: not supervised
  double in_position_timeout_s = 1.0;  // [s] from the arrival of the set point; then the command fails with error 0003
};

// Torque feed-forward from the set point, which the drive adds to the torque of its own loops: a torque offset (CiA 402
// 0x60B2).
struct TorqueOffset {
  double inertia = 0;           // torque per u/s²
  double coulomb_friction = 0;  // torque, in the sense of the set velocity
  double viscous_friction = 0;  // torque per u/s
  double load_torque = 0;       // torque, constant
  double full_at = 1;           // [u/s] from which on coulomb_friction acts in full
};

struct Drive {
  DriveMode mode = DriveMode::kCyclicPosition;
  bool invert = false;                          // AX-03: invert the control sense
  double ready_timeout_s = 1.0;                 // [s] from enabling to ready
  double brake_opens_s = 0;                     // [s] from energising the brake relay until the brake is open (AX-115)
  double brake_closes_s = 0;                    // [s] from releasing the relay until the brake holds
  std::optional<TorqueOffset> torque_offset{};  // csp and csv
};

// AX-03: which of the switch inputs are active low.
struct InputSense {
  bool invert_limit_positive = false;
  bool invert_limit_negative = false;
  bool invert_reference = false;
  bool invert_touch_probe = false;
  double debounce_s = 0;       // [s] for which a change of LIM+, LIM- and REF must last before it counts (AX-115)
  std::string touch_probe_of;  // name of the axis whose TP wire is used here, too; empty: its own
};

// A second axis on the same mechanics (gantry, line shaft): it follows a master from load on.
struct Following {
  std::string axis;                      // name of the master
  double ratio = 1;                      // [u per master's u] not 0
  std::optional<double> offset{};        // [u] own position at the master's 0; unset: as when both are first powered
  std::optional<double> skew_warning{};  // [u] of the measured skew; unset: none
  std::optional<double> largest_skew{};  // [u] measured minus commanded skew; unset: not supervised
  double in_step = 0.1;                  // [u] skew of the set points up to which members may move
  bool square = false;  // while the master homes by its reference switch, this axis is squared by its own
};

// Ramps of their own for stops that are not commanded (AX-112). Unset: as the limits of the axis.
struct StopRamp {
  std::optional<double> deceleration{};  // [u/s²]
  std::optional<double> jerk{};          // [u/s³] 0: unlimited
};

struct ScrewPoint {
  double position = 0;  // [u]
  double error = 0;     // [u] load minus encoder on the motor

  bool operator==(const ScrewPoint&) const = default;
};

// Default of Compensation::velocity, as a share of the axis' velocity limit.
inline constexpr double kCorrectionShare = 0.1;

// Errors between motor and load that are compensated (AX-115).
struct Compensation {
  double backlash = 0;               // [u] >= 0: displacement of the motor after a reversal before the load follows
  std::vector<ScrewPoint> screw;     // rising positions
  std::optional<double> velocity{};  // [u/s] > 0: at which the correction changes; unset: kCorrectionShare

  bool any() const { return backlash > 0 || !screw.empty(); }
};

struct AxisParams {
  std::string name;
  std::string unit = "mm";  // the axis' own unit u, for display
  AxisKind kind = AxisKind::kLinear;
  double modulus = 360;  // [u] rotary axes: positions are reported in [0, modulus)
  AxisLimits limits;
  Supervision supervision;
  Encoder encoder;
  std::optional<Encoder> load_encoder{};  // on the load (AX-115): gives the axis position; `encoder`: on the motor
  Compensation compensation;
  Drive drive;
  InputSense inputs;
  ControlLoop loop;
  bool requires_reference = false;  // absolute moves need a reference: error 0009 without one (AX-71)
  bool await_constants = false;     // no motion before GT_SetConstant: error 0012 (AX-27)
  std::optional<Following> follows;
  StopRamp fault_stop;  // faults
  StopRamp limit_stop;  // limit switches
  HomingParams homing;

  bool rotary() const { return kind == AxisKind::kRotary; }
  // [u] distance after which positions repeat; linear axes: 0.
  double turn() const { return rotary() ? modulus : 0; }
  // The encoder that gives the position of the axis.
  const Encoder& position_encoder() const { return load_encoder ? *load_encoder : encoder; }
  // The limits in the form that the planner takes.
  trajectory::Limits planner_limits() const {
    return {limits.velocity, limits.acceleration, limits.deceleration.value_or(limits.acceleration), limits.jerk};
  }
};

// Returns a position as it is published: rotary axes in [0, modulus).
inline double Reported(const AxisParams& params, double position) noexcept {
  if (!params.rotary()) return position;
  const double turns = std::floor(position / params.modulus);
  const double inside = position - turns * params.modulus;
  return inside >= 0 && inside < params.modulus ? inside : 0;
}

inline constexpr std::uint32_t kNoAxis = 0xffffffff;

// Returns the index of the axis of this name; kNoAxis if there is none.
inline std::uint32_t FindAxis(std::span<const AxisParams> axes, std::string_view name) noexcept {
  for (std::uint32_t i = 0; i < axes.size(); ++i) {
    if (axes[i].name == name) return i;
  }
  return kNoAxis;
}

void describe(Enumeration<AxisKind>&);
void describe(Description<AxisLimits>&);
void describe(Description<Supervision>&);
void describe(Description<TorqueOffset>&);
void describe(Description<Drive>&);
void describe(Description<InputSense>&);
void describe(Description<Following>&);
void describe(Description<StopRamp>&);
void describe(Description<ScrewPoint>&);
void describe(Description<Compensation>&);
void describe(Description<AxisParams>&);

}  // namespace takt::axis
