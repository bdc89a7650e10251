// What a machine file says about one group of movers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"

namespace takt::planargroup {

struct PlanarGroupParams {
  std::string name;
  std::vector<std::string> movers;           // in it from the start
  std::vector<std::string> tracks;           // likewise
  std::optional<std::string> environment{};  // likewise
  bool moves_wait = false;                   // for their area, instead of being refused
};

void describe(Description<PlanarGroupParams>&);

}  // namespace takt::planargroup
