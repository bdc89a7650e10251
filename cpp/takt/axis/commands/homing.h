// Commands that establish the reference of an axis (PLCopen Part 5).
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/commands/moves.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

// Direction in which a search begins.
enum class HomingDirection : std::uint8_t { kPositive, kNegative, kSwitchPositive, kSwitchNegative };
// State or edge of a switch that ends a search.
enum class SwitchMode : std::uint8_t { kOn, kOff, kEdgeOn, kEdgeOff, kEdgeSwitchPositive, kEdgeSwitchNegative };

struct Home {  // MC_Home
  double position = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct StepAbsSwitch {  // MC_StepAbsSwitch
  HomingDirection direction = HomingDirection::kSwitchNegative;
  SwitchMode switch_mode = SwitchMode::kEdgeOn;
  double velocity = 0;
  std::optional<double> set_position{};  // unset: positions keep their numbers
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  double time_limit = 0;
  double distance_limit = 0;
  std::optional<double> torque_limit{};
};
struct StepLimitSwitch {  // MC_StepLimitSwitch
  HomingDirection direction = HomingDirection::kSwitchNegative;
  SwitchMode switch_mode = SwitchMode::kEdgeOn;
  double velocity = 0;
  std::optional<double> set_position{};  // unset: positions keep their numbers
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  double time_limit = 0;
  double distance_limit = 0;
  std::optional<double> torque_limit{};
};
struct StepBlock {  // MC_StepBlock
  HomingDirection direction = HomingDirection::kNegative;
  double velocity = 0;
  double deviation = 0;
  double set_position = 0;
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  double time_limit = 0;
  double distance_limit = 0;
  std::optional<double> torque_limit{};
};
struct StepRefPulse {  // MC_StepRefPulse
  HomingDirection direction = HomingDirection::kPositive;
  double velocity = 0;
  double set_position = 0;
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  double time_limit = 0;
  double distance_limit = 0;
  std::optional<double> torque_limit{};
};
struct StepDistanceCoded {  // MC_StepDistanceCoded
  HomingDirection direction = HomingDirection::kPositive;
  double velocity = 0;
  std::optional<double> acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  double time_limit = 0;
  double distance_limit = 0;
  std::optional<double> torque_limit{};
};
struct StepDirect {  // MC_StepDirect
  double set_position = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct StepAbsolute {  // MC_StepAbsolute
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct FinishHoming {  // MC_FinishHoming
  double distance = 0;
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct StepRefFlyingSwitch {  // MC_StepRefFlyingSwitch
  SwitchMode switch_mode = SwitchMode::kEdgeOn;
  double set_position = 0;
  double time_limit = 0;
  double distance_limit = 0;
  bool until_halt = false;  // a halt or a stop ends it, too
};
struct StepRefFlyingRefPulse {  // MC_StepRefFlyingRefPulse
  double set_position = 0;
  double time_limit = 0;
  double distance_limit = 0;
  bool until_halt = false;
};
struct AbortPassiveHoming {  // MC_AbortPassiveHoming
};

void describe(Enumeration<HomingDirection>&);
void describe(Enumeration<SwitchMode>&);
void describe(Description<Home>&);
void describe(Description<StepAbsSwitch>&);
void describe(Description<StepLimitSwitch>&);
void describe(Description<StepBlock>&);
void describe(Description<StepRefPulse>&);
void describe(Description<StepDistanceCoded>&);
void describe(Description<StepDirect>&);
void describe(Description<StepAbsolute>&);
void describe(Description<FinishHoming>&);
void describe(Description<StepRefFlyingSwitch>&);
void describe(Description<StepRefFlyingRefPulse>&);
void describe(Description<AbortPassiveHoming>&);

}  // namespace takt::axis
