// What a machine file says about one environment: the surface that movers float on.
#pragma once

#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/point.h"

namespace takt::environment {

struct EnvironmentParams {
  std::string name;
  std::vector<planar::Place> stators;  // their lower left corners; it has a boundary, if there are any
};

void describe(Description<EnvironmentParams>&);

}  // namespace takt::environment
