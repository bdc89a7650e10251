// Commands that power an axis and move it by itself.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/core/describe_fwd.h"

namespace takt::axis {

// Sense of travel on a rotary axis; linear axes ignore it.
enum class Direction : std::uint8_t { kCurrent, kPositive, kShortest, kNegative };

// When a command takes over from the previous one, and at which velocity (PLCopen's MC_BufferMode; AX-12).
enum class BufferMode : std::uint8_t {
  kAborting,
  kBuffered,
  kBlendingLow,
  kBlendingPrevious,
  kBlendingNext,
  kBlendingHigh
};

// Velocities, accelerations and jerks that are unset are the axis' own limits.
struct Power {  // MC_Power
  bool enable = true;
  BufferMode buffer_mode = BufferMode::kAborting;
  // True: the axis may move upwards or downwards, from this command on; unset: as before, initially both (AX-111).
  std::optional<bool> enable_positive{}, enable_negative{};
};
struct Reset {};       // MC_Reset
struct MoveAbsolute {  // MC_MoveAbsolute
  double position = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  Direction direction = Direction::kShortest;
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // only changes the command of its kind in control

  bool operator==(const MoveAbsolute&) const = default;
};
struct MoveRelative {  // MC_MoveRelative
  double distance = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;

  bool operator==(const MoveRelative&) const = default;
};
struct MoveAdditive {  // MC_MoveAdditive
  double distance = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // only changes the command of its kind in control

  bool operator==(const MoveAdditive&) const = default;
};
struct MoveVelocity {  // MC_MoveVelocity
  double velocity = 0;
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  Direction direction = Direction::kPositive;  // positive, negative or current
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // only changes the command of its kind in control

  bool operator==(const MoveVelocity&) const = default;
};
struct Halt {  // MC_Halt
  std::optional<double> deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct Straighten {                  // moves the skew of an axis that follows another from load on to 0
  std::optional<double> velocity{};  // [u/s] relative to its master; unset: a tenth of the limit
};
struct Stop {  // MC_Stop
  std::optional<double> deceleration{}, jerk{};
  bool hold = false;                               // stay in Stopping until released (Execute kept true)
  BufferMode buffer_mode = BufferMode::kAborting;  // aborting or buffered
};
struct MoveContinuousAbsolute {  // MC_MoveContinuousAbsolute
  double position = 0;
  double end_velocity = 0;  // in the sense of travel
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  Direction direction = Direction::kShortest;
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // only changes the command of its kind in control

  bool operator==(const MoveContinuousAbsolute&) const = default;
};
struct MoveContinuousRelative {  // MC_MoveContinuousRelative
  double distance = 0;
  double end_velocity = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // of the one in control: the distance counts from its start

  bool operator==(const MoveContinuousRelative&) const = default;
};
struct Inch {  // MC_Inch: one increment a press
  double distance = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
};
struct Jog {  // GT_Jog: level-sensitive; repeat it to change the keys; both false, or a release, end it
  bool forward = false;
  bool backward = false;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
};

void describe(Enumeration<Direction>&);
void describe(Enumeration<BufferMode>&);
void describe(Description<Power>&);
void describe(Description<Reset>&);
void describe(Description<MoveAbsolute>&);
void describe(Description<MoveRelative>&);
void describe(Description<MoveAdditive>&);
void describe(Description<MoveVelocity>&);
void describe(Description<MoveContinuousAbsolute>&);
void describe(Description<MoveContinuousRelative>&);
void describe(Description<Inch>&);
void describe(Description<Halt>&);
void describe(Description<Straighten>&);
void describe(Description<Stop>&);
void describe(Description<Jog>&);

}  // namespace takt::axis
