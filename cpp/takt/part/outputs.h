// Outputs of a part in every cycle.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/planar/object_state.h"

namespace takt::part {

struct Outputs {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  ErrorId error = ErrorId::kNone;
  bool disable_forced = false;
  std::uint32_t position_index = 0;     // from 1; 0: away
  std::uint32_t commanded_index = 0;    // from 1
  std::uint32_t coordinate_system = 0;  // from 1; 0: away
  double x = 0, y = 0;                  // [mm] its origin in the coordinate system
  std::uint32_t mover_count = 0;        // movers whose centre is on it
};

void describe(Description<Outputs>&);

}  // namespace takt::part
