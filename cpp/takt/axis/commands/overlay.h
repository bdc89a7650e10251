// Commands that follow tables over time, or move on top of another motion.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/commands/moves.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"

namespace takt::axis {

struct MoveSuperimposed {  // MC_MoveSuperimposed
  double distance = 0;
  std::optional<double> velocity_difference{}, acceleration{}, deceleration{}, jerk{};
};
struct HaltSuperimposed {  // MC_HaltSuperimposed
  std::optional<double> deceleration{}, jerk{};
};
struct PositionProfile {  // MC_PositionProfile
  Name profile;
  double time_scale = 1;
  double position_scale = 1;
  double offset = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct VelocityProfile {  // MC_VelocityProfile
  Name profile;
  double time_scale = 1;
  double velocity_scale = 1;
  double offset = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
};
struct AccelerationProfile {  // MC_AccelerationProfile
  Name profile;
  double time_scale = 1;
  double acceleration_scale = 1;
  double offset = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
};

void describe(Description<MoveSuperimposed>&);
void describe(Description<HaltSuperimposed>&);
void describe(Description<PositionProfile>&);
void describe(Description<VelocityProfile>&);
void describe(Description<AccelerationProfile>&);

}  // namespace takt::axis
