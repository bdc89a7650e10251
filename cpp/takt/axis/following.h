// Axes that follow a master from load on, in the same cycle, without a loop of their own around it.
#pragma once

#include <string>

#include "takt/axis/axis.h"

namespace takt::axis {

// Why `follower` could not keep up with `master` at its limits; empty: it can.
std::string CannotFollow(const AxisParams& follower, const AxisParams& master);

// Takes the set point from the master where the axis is coupled to it; couples it once both stand with closed loops.
// False: not coupled, the axis goes on by itself. A follower never leaves its limits: they were held against the
// master's at load.
bool Follow(const Context& context, State& state) noexcept;

}  // namespace takt::axis
