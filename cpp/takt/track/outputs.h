// Outputs of a track in every cycle.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/planar/object_state.h"
#include "takt/track/state.h"

namespace takt::track {

struct Outputs {
  planar::ObjectState state = planar::ObjectState::kDisabled;
  OperationMode operation_mode = OperationMode::kUninitialized;
  ErrorId error = ErrorId::kNone;
  double length = 0;  // [mm] 0: no geometry yet
  bool closed_loop = false;
  std::uint32_t element_count = 0;
  std::uint32_t mover_count = 0;
  std::uint32_t previous_tracks = 0;    // tracks that end where it starts
  std::uint32_t subsequent_tracks = 0;  // tracks that start where it ends
  std::uint32_t group = 0;              // group of movers that it is in, from 1; 0: none
};

void describe(Description<Outputs>&);

}  // namespace takt::track
