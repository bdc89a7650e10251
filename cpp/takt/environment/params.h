// Parameters of one environment in the machine file: the surface that movers float on.
#pragma once

#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/point.h"

namespace takt::environment {

struct EnvironmentParams {
  std::string name;
  std::vector<planar::Place> stators;  // lower left corners; empty: no boundary
};

void describe(Description<EnvironmentParams>&);

}  // namespace takt::environment
