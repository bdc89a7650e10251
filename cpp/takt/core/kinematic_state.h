// The common representation of motion: between commands, masters and followers, generators and loops.
#pragma once

#include "takt/core/describe_fwd.h"

namespace takt {

struct KinematicState {
  double position = 0;      // [u]
  double velocity = 0;      // [u/s]
  double acceleration = 0;  // [u/s²]

  constexpr bool operator==(const KinematicState&) const = default;
};

void describe(Description<KinematicState>&);

}  // namespace takt
