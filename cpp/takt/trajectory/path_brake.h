// How a motion is to come to rest on its path.
#pragma once

#include "takt/core/describe_fwd.h"

namespace takt::trajectory {

// Along the path; 0: as the path says.
struct PathBrake {
  double deceleration = 0;  // mm/s²
  double jerk = 0;          // mm/s³
};

void describe(Description<PathBrake>&);

}  // namespace takt::trajectory
