// Parameters of one group of movers in the machine file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"

namespace takt::planargroup {

struct PlanarGroupParams {
  std::string name;
  std::vector<std::string> movers;           // members from the start
  std::vector<std::string> tracks;           // members from the start
  std::optional<std::string> environment{};  // member from the start
  bool moves_wait = false;                   // moves wait for their area instead of being refused
};

void describe(Description<PlanarGroupParams>&);

}  // namespace takt::planargroup
