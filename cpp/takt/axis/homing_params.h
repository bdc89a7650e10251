// How MC_Home homes an axis: PLCopen leaves that to the axis' parameters.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/commands/homing.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

enum class HomingMethod : std::uint8_t {
  kDirect,         // the present position is the reference
  kAbsolute,       // by the absolute encoder
  kSwitch,         // the reference switch
  kLimitSwitch,    // a limit switch
  kBlock,          // an end stop
  kPulse,          // the next index pulse
  kDistanceCoded,  // two coded marks
};

struct HomingParams {
  HomingMethod method = HomingMethod::kDirect;
  HomingDirection direction = HomingDirection::kNegative;  // in which the search begins; kSwitch...: switches only
  SwitchMode switch_mode = SwitchMode::kEdgeOn;
  double velocity = 0;                     // [u/s] of the search; more than 0 for methods that search
  std::optional<double> pulse_velocity{};  // [u/s] of a further search for the index pulse, after a switch
  HomingDirection pulse_direction = HomingDirection::kPositive;  // of that search; not kSwitch...
  double deviation = 0;                  // [u] following error at an end stop; more than 0 for kBlock
  double time_limit = 0;                 // [s] for the whole homing; 0: none
  double distance_limit = 0;             // [u] for the whole homing; 0: none
  std::optional<double> torque_limit{};  // [Nm] of the search; unset: as the axis
};

inline bool Searches(HomingMethod method) noexcept {
  return method != HomingMethod::kDirect && method != HomingMethod::kAbsolute;
}

void describe(Enumeration<HomingMethod>&);
void describe(Description<HomingParams>&);

}  // namespace takt::axis
