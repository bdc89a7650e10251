// Commands that couple an axis to a master by a cam.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/axis/commands/coupling.h"
#include "takt/axis/commands/moves.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/name.h"

namespace takt::axis {

// How a slave gets into step with its cam.
enum class CamStart : std::uint8_t { kAbsolute, kRelative, kRampIn };

struct CamTableSelect {  // MC_CamTableSelect
  Name cam;
};

// x = master_scaling * master's position + master_offset, slave's position = slave_scaling * y(x) + slave_offset.
struct CamIn {  // MC_CamIn
  Name master;
  Name cam;
  MasterSource source = MasterSource::kSetValue;
  double master_offset = 0;
  double slave_offset = 0;
  double master_scaling = 1;
  double slave_scaling = 1;
  bool master_absolute = true;
  bool slave_absolute = true;
  std::optional<bool> periodic{};
  CamStart start_mode = CamStart::kRampIn;
  std::optional<double> master_sync_position{};
  std::optional<double> master_start_distance{};
  std::optional<double> velocity{}, acceleration{}, deceleration{}, jerk{};
  BufferMode buffer_mode = BufferMode::kAborting;
  bool update = false;  // changes the one in control: the cam keeps its beginning, except for what changes

  bool operator==(const CamIn&) const = default;
};

// Adds another cam to that of cam_in, over the same master: slave_scaling * y(master_scaling * master's position +
// master_offset) is added to the slave's position.
struct CamAdd {  // MC_CamAdd
  Name cam;
  double master_offset = 0;
  double slave_offset = 0;
  double master_scaling = 1;
  double slave_scaling = 1;
  bool master_absolute = true;
  bool slave_absolute = false;
  std::optional<bool> periodic{};
};
struct CamRemove {  // MC_CamRemove
  Name cam;
};

struct CamOut {  // MC_CamOut
};

void describe(Enumeration<CamStart>&);
void describe(Description<CamTableSelect>&);
void describe(Description<CamIn>&);
void describe(Description<CamAdd>&);
void describe(Description<CamRemove>&);
void describe(Description<CamOut>&);

}  // namespace takt::axis
