// From what was written down to a table, checked (CAM-03). Not for the cycle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/cam/params.h"
#include "takt/cam/table.h"

namespace takt::cam {

// Something wrong, or worth knowing, about one value.
struct Finding {
  std::string path;     // "points[3].x"; empty: the cam as a whole
  std::string message;  // "expected ..., found ..."
};

struct Built {
  std::optional<Table> table;  // only without errors
  std::vector<Finding> errors;
  std::vector<Finding> warnings;
};

// `params.file` must have been read already (csv.h).
Built Build(const CamParams& params);

}  // namespace takt::cam
