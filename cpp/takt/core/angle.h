// Degrees, which people write and read, in radians, which mathematics wants.
#pragma once

#include <numbers>

namespace takt {

inline constexpr double kDegree = std::numbers::pi / 180;  // rad

}  // namespace takt
