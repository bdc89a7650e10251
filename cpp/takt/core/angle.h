// Degrees, as users write and read them, in radians, as computations need them.
#pragma once

#include <numbers>

namespace takt {

inline constexpr double kDegree = std::numbers::pi / 180;  // [rad]

}  // namespace takt
