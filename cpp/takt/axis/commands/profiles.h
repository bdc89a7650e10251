// Commands that follow tables over time. The tables are cams of the machine whose x is the time in s.
#pragma once

#include "takt/axis/commands/moves.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"

namespace takt::axis {

// At t seconds after the start, x = begin of the table + t / time_scale: scale * y(x) + offset.
struct PositionProfile {  // MC_PositionProfile
  Name profile;
  double time_scale = 1;
  double position_scale = 1;
  double offset = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // changes the one in control: continues at its present time in the table

  bool operator==(const PositionProfile&) const = default;
};
struct VelocityProfile {  // MC_VelocityProfile
  Name profile;
  double time_scale = 1;
  double velocity_scale = 1;
  double offset = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // changes the one in control: continues at its present time in the table

  bool operator==(const VelocityProfile&) const = default;
};
struct AccelerationProfile {  // MC_AccelerationProfile
  Name profile;
  double time_scale = 1;
  double acceleration_scale = 1;
  double offset = 0;
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // changes the one in control: continues at its present time in the table

  bool operator==(const AccelerationProfile&) const = default;
};

void describe(Description<PositionProfile>&);
void describe(Description<VelocityProfile>&);
void describe(Description<AccelerationProfile>&);

}  // namespace takt::axis
