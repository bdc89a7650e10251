// Commands that change parameters of an axis.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct SetConstants {  // GT_SetConstant
  std::optional<double> kp{}, ki{}, kd{}, kc{}, ff{};
  std::optional<double> velocity_at_10v{};
  std::optional<double> lower{}, upper{};
};
struct SetLoad {  // `drive: torque_offset`, from now on; unset: as before
  std::optional<double> inertia{}, coulomb_friction{}, viscous_friction{}, load_torque{};
};
struct WriteParameter {  // MC_WriteParameter, MC_WriteBoolParameter
  std::int32_t number = 0;
  double value = 0;
};
struct ReadParameter {  // MC_ReadParameter, MC_ReadBoolParameter
  std::int32_t number = 0;
};
struct SetSoftLimits {  // GT_SWLim
  bool enable_lower = true;
  bool enable_upper = true;
  std::optional<double> lower{}, upper{};
};
struct DirectOutput {  // GT_Analog
  double voltage = 0;
};
struct PulseOutput {  // GT_Pulse
  double voltage = 0;
  double duration = 0;
};
struct WriteOutput {  // MC_WriteDigitalOutput
  std::int32_t number = 1;
  bool value = false;
};
struct SetPosition {  // MC_SetPosition
  double position = 0;
  bool relative = false;
};
struct SetOverride {  // MC_SetOverride
  double velocity_factor = 1;
  double acceleration_factor = 1;
  double jerk_factor = 1;

  bool operator==(const SetOverride&) const = default;
};

void describe(Description<SetConstants>&);
void describe(Description<SetLoad>&);
void describe(Description<WriteParameter>&);
void describe(Description<ReadParameter>&);
void describe(Description<SetSoftLimits>&);
void describe(Description<DirectOutput>&);
void describe(Description<PulseOutput>&);
void describe(Description<WriteOutput>&);
void describe(Description<SetPosition>&);
void describe(Description<SetOverride>&);

}  // namespace takt::axis
