// What MC_Home does on an axis: PLCopen leaves that to the axis' parameters.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/commands/homing.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

enum class HomingMethod : std::uint8_t {
  kDirect,         // where the axis stands is the reference
  kAbsolute,       // as the absolute encoder says
  kSwitch,         // the reference switch
  kLimitSwitch,    // a limit switch
  kBlock,          // an end stop
  kPulse,          // the next index pulse
  kDistanceCoded,  // two coded marks
};

struct HomingParams {
  HomingMethod method = HomingMethod::kDirect;
  HomingDirection direction = HomingDirection::kNegative;  // where to search first; not SwitchX for block and pulse
  SwitchMode switch_mode = SwitchMode::kEdgeOn;
  double velocity = 0;                                           // u/s, of the search; more than 0 where there is one
  std::optional<double> pulse_velocity{};                        // u/s; after a switch on to the next index pulse
  HomingDirection pulse_direction = HomingDirection::kPositive;  // ... this way; not SwitchX
  double deviation = 0;                                          // u, following error at an end stop; more than 0
  double time_limit = 0;                                         // s, of all of it; 0: any
  double distance_limit = 0;                                     // u, of all of it; 0: any
  std::optional<double> torque_limit{};                          // Nm, of the search; unset: that of the axis
};

inline bool Searches(HomingMethod method) noexcept {
  return method != HomingMethod::kDirect && method != HomingMethod::kAbsolute;
}

void describe(Enumeration<HomingMethod>&);
void describe(Description<HomingParams>&);

}  // namespace takt::axis
