// Extreme values of a cam and of the slave behind it, from the roots of its pieces (CAM-24); and the way back from y to
// x (CAM-71).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "takt/cam/table.h"

namespace takt::cam {

struct Extreme {
  double x = 0;
  double value = 0;
};

struct Bounds {
  Extreme least{0, std::numeric_limits<double>::infinity()};
  Extreme greatest{0, -std::numeric_limits<double>::infinity()};
};

// Over the whole cam. Where a value jumps, both sides count. The first place, where there are several.
struct Extremes {
  Bounds y, dy, ddy, dddy;
};
Extremes ExtremesOf(const Table& table) noexcept;

// What a slave meets whose master goes up to the velocity V and the acceleration A, both >= 0, in any combination:
// |dy| V at most, and |ddy| V² + |dy| A.
struct SlavePeaks {
  Bounds position;       // slave's unit
  Extreme velocity;      // slave's unit/s
  Extreme acceleration;  // slave's unit/s²
};
SlavePeaks SlavePeaksOf(const Table& table, double master_velocity, double master_acceleration) noexcept;
// The same for one piece, added to `peaks`: for whoever spreads the work over many cycles.
void Include(const Table& table, std::size_t piece, double master_velocity, double master_acceleration,
             SlavePeaks& peaks) noexcept;

// Every x at which the cam has this y, growing; both ends of a piece that stays at it. Allocates.
std::vector<double> AllX(const Table& table, double y);
// The one nearest to `near`. What it costs grows with the number of pieces between.
std::optional<double> NearestX(const Table& table, double y, double near) noexcept;
// The x nearest to `near` at which the cam has this slope, no more than `most` pieces away.
std::optional<double> NearestSlope(const Table& table, double slope, double near, std::size_t most) noexcept;

}  // namespace takt::cam
