// Outputs of an environment in every cycle.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"

namespace takt::environment {

struct Outputs {
  std::uint32_t stator_count = 0;
  std::uint32_t border_count = 0;  // straight sides of its boundary; 0: no boundary
  std::uint32_t group = 0;         // group that it is in, from 1; 0: none
};

void describe(Description<Outputs>&);

}  // namespace takt::environment
