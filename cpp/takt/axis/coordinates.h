// What an axis calls the place it is at.
#pragma once

#include "takt/axis/state.h"

namespace takt::axis {

// Adds `by` [u] to every position of an axis: nothing moves, only the numbers change. What is left to the drive and to
// axes that follow (positions over all turns) stays as it was.
void ShiftCoordinates(double by, State& s) noexcept;

}  // namespace takt::axis
