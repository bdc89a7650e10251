// What a homing command carries beyond the common part of a request: its search.
#pragma once

#include "takt/axis/commands/homing.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct HomingRequest {
  double placeholder = 0;
};

void describe(Description<HomingRequest>&);

}  // namespace takt::axis
