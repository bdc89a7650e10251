// Builds a checked table from the description of a cam (CAM-03). Not for use within the cycle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/cam/params.h"
#include "takt/cam/table.h"

namespace takt::cam {

// An error or a warning about one value.
struct Finding {
  std::string path;     // "points[3].x"; empty: the whole cam
  std::string message;  // "expected ..., found ..."
};

struct Built {
  std::optional<Table> table;  // set only if there are no errors
  std::vector<Finding> errors;
  std::vector<Finding> warnings;
};

// Requires: `params.file` has been read already (csv.h).
Built Build(const CamParams& params);

}  // namespace takt::cam
