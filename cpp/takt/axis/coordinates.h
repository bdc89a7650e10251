// Renumbering the positions of an axis.
#pragma once

#include "takt/axis/state.h"

namespace takt::axis {

// Adds `by` [u] to every position of an axis: nothing moves, only the numbers change. Positions over all turns, which
// the drive and the axes that follow get, stay as they are.
void ShiftCoordinates(double by, State& s) noexcept;

}  // namespace takt::axis
