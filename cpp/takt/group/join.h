// Joining a stretch to the path that is planned already: with a blend, as it is, or behind a stop.
#pragma once

#include "takt/group/plan.h"

namespace takt::group {

// Appends `ahead.next`, and a blend before it where there is one. How many inverses of the kinematics that took.
int Join(const Context& c, State& s) noexcept;

}  // namespace takt::group
