// What a machine file says about one axis.
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

// AX-05. Commands beyond these are refused; motion the engine decides on itself (faults) uses them in full.
struct AxisLimits {
  double velocity = 0;                   // [u/s]
  double acceleration = 0;               // [u/s²]
  std::optional<double> deceleration{};  // [u/s²] unset: as acceleration
  double jerk = 0;                       // [u/s³] 0: unlimited
  std::optional<double> torque{};        // Nm (N on linear motors), that the drive may use; unset: all that it has
  std::optional<double> lower{};         // [u] SW limit LimNeg; unset: none
  std::optional<double> upper{};         // [u] SW limit LimPos; unset: none
};

struct Supervision {
  std::optional<double> deviation_moving{};      // [u] largest following error in motion; unset: not watched
  std::optional<double> deviation_standstill{};  // [u] the same at rest
  std::optional<double>
      in_position{};  // [u] window in which a positioning command is done; unset: set point alone decides
  double encoder_noise_counts = 16;  // counts a standing encoder may move from one cycle to the next; more than that
                                     // and four times what the axis can move is a jump
  std::optional<double> encoders_apart{};  // [u] by which motor and load may get apart; unset: not watched
  double in_position_timeout_s = 1.0;      // s after the set point's arrival; then the command fails with error 0003
};

// What the drive is told to add to the torque of its own loops, from the set point: a torque offset (CiA 402 0x60B2).
struct TorqueOffset {
  double inertia = 0;           // torque per u/s²
  double coulomb_friction = 0;  // torque, in the sense of the set velocity
  double viscous_friction = 0;  // torque per u/s
  double load_torque = 0;       // torque, constant
  double full_at = 1;           // [u/s] from which on coulomb_friction is added whole
};

struct Drive {
  DriveMode mode = DriveMode::kCyclicPosition;
  bool invert = false;                          // AX-03: invert the control sense
  double ready_timeout_s = 1.0;                 // s from enabling to ready
  double brake_opens_s = 0;                     // s from energising the brake relay until the brake is open (AX-115)
  double brake_closes_s = 0;                    // s from letting it go until the brake holds
  std::optional<TorqueOffset> torque_offset{};  // csp and csv
};

// AX-03: which of the switch inputs are active low.
struct InputSense {
  bool invert_limit_positive = false;
  bool invert_limit_negative = false;
  bool invert_reference = false;
  bool invert_touch_probe = false;
  double debounce_s = 0;       // [s] for which LIM+, LIM- and REF must have changed before that counts (AX-115)
  std::string touch_probe_of;  // name of the axis whose TP wire counts here, too; empty: its own
};

// A second axis on the same mechanics (gantry, line shaft): it follows a master from load on.
struct Following {
  std::string axis;                      // name of the master
  double ratio = 1;                      // own u per master's u, not 0
  std::optional<double> offset{};        // [u] own position where the master's is 0; unset: as both are first powered
  std::optional<double> skew_warning{};  // [u] of what is measured
  std::optional<double> largest_skew{};  // [u] of what is measured against what is commanded; unset: not watched
  double in_step = 0.1;                  // [u] a skew of the set points up to which members may move
  bool square = false;                   // homing the master by its reference switch squares by this axis' own
};

// Ramps of their own for stops that are not asked for (AX-112). Unset: as the limits of the axis.
struct StopRamp {
  std::optional<double> deceleration{};  // [u/s²]
  std::optional<double> jerk{};          // [u/s³] 0: unlimited
};

struct ScrewPoint {
  double position = 0;  // [u]
  double error = 0;     // [u] load less what the motor's encoder says

  bool operator==(const ScrewPoint&) const = default;
};

// Of a velocity that is not given: a share of the axis' largest.
inline constexpr double kCorrectionShare = 0.1;

// What lies between motor and load and is made up for (AX-115).
struct Compensation {
  double backlash = 0;               // [u] >= 0: motion of the motor after a reversal before the load follows
  std::vector<ScrewPoint> screw;     // rising positions
  std::optional<double> velocity{};  // [u/s] > 0: with which the correction is made

  bool any() const { return backlash > 0 || !screw.empty(); }
};

struct AxisParams {
  std::string name;
  std::string unit = "mm";  // the axis' own unit u, for people and columns
  AxisKind kind = AxisKind::kLinear;
  double modulus = 360;  // [u] rotary axes: positions are reported in [0, modulus)
  AxisLimits limits;
  Supervision supervision;
  Encoder encoder;
  std::optional<Encoder> load_encoder{};  // on the load (AX-115): where the axis is; `encoder` stays that of the drive
  Compensation compensation;
  Drive drive;
  InputSense inputs;
  ControlLoop loop;
  bool requires_reference = false;  // absolute moves need a reference: error 0009 without one (AX-71)
  bool await_constants = false;     // no motion before GT_SetConstant: error 0012 (AX-27)
  std::optional<Following> follows;
  StopRamp fault_stop;  // faults
  StopRamp limit_stop;  // hardware and SW limits
  HomingParams homing;

  bool rotary() const { return kind == AxisKind::kRotary; }
  // [u] after which positions repeat; linear axes: 0.
  double turn() const { return rotary() ? modulus : 0; }
  // The encoder that says where the axis is.
  const Encoder& position_encoder() const { return load_encoder ? *load_encoder : encoder; }
  // The limits as the planner takes them.
  trajectory::Limits planner_limits() const {
    return {limits.velocity, limits.acceleration, limits.deceleration.value_or(limits.acceleration), limits.jerk};
  }
};

// A position as it is reported: rotary axes in [0, modulus).
inline double Reported(const AxisParams& params, double position) noexcept {
  if (!params.rotary()) return position;
  const double turns = std::floor(position / params.modulus);
  const double inside = position - turns * params.modulus;
  return inside >= 0 && inside < params.modulus ? inside : 0;
}

inline constexpr std::uint32_t kNoAxis = 0xffffffff;

// Its index among all axes; kNoAxis: none is called so.
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
