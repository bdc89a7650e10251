// Commands for motions superimposed on another.
#pragma once

#include <optional>

#include "takt/core/describe_fwd.h"

namespace takt::axis {

struct MoveSuperimposed {  // MC_MoveSuperimposed
  double distance = 0;
  std::optional<double> velocity_difference{}, acceleration{}, deceleration{}, jerk{};
  bool update = false;  // of the one in progress: the distance counts from its start

  bool operator==(const MoveSuperimposed&) const = default;
};
struct HaltSuperimposed {  // MC_HaltSuperimposed
  std::optional<double> deceleration{}, jerk{};
};

void describe(Description<MoveSuperimposed>&);
void describe(Description<HaltSuperimposed>&);

}  // namespace takt::axis
