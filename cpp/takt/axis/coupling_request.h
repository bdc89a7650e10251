// What a coupling command carries beyond the common part of a request: its masters.
#pragma once

#include "takt/axis/commands/coupling.h"
#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct CouplingRequest {
  double placeholder = 0;
};

void describe(Description<CouplingRequest>&);

}  // namespace takt::axis
