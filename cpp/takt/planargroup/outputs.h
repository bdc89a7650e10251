// Outputs of a group of movers in every cycle.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/planar/object_state.h"

namespace takt::planargroup {

struct Outputs {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  ErrorId error = ErrorId::kNone;
  std::uint32_t mover_count = 0;
  std::uint32_t track_count = 0;
  std::uint32_t environment = 0;  // from 1; 0: none
};

void describe(Description<Outputs>&);

}  // namespace takt::planargroup
