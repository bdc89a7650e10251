// Extreme values of a cam and of its slave, from the roots of its pieces (CAM-24); and the inverse, from y to x
// (CAM-71).
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

// Over the whole cam. If a value jumps, both sides count. x is that of the first one if there are several.
struct Extremes {
  Bounds y, dy, ddy, dddy;
};
Extremes ExtremesOf(const Table& table) noexcept;

// Peak values of a slave whose master has velocities up to V and accelerations up to A, both >= 0, in any combination:
// |dy| V, and |ddy| V² + |dy| A.
struct SlavePeaks {
  Bounds position;       // [slave's unit]
  Extreme velocity;      // [slave's unit/s]
  Extreme acceleration;  // [slave's unit/s²]
};
SlavePeaks SlavePeaksOf(const Table& table, double master_velocity, double master_acceleration) noexcept;
// The same for one piece, merged into `peaks`: to spread the computation over many cycles.
void Include(const Table& table, std::size_t piece, double master_velocity, double master_acceleration,
             SlavePeaks& peaks) noexcept;

// Returns every x at which the cam has this y, in ascending order; both ends of a piece that stays at y. Allocates.
std::vector<double> AllX(const Table& table, double y);
// Returns the x nearest to `near` at which the cam has this y. The cost grows with the number of pieces in between.
std::optional<double> NearestX(const Table& table, double y, double near) noexcept;
// Returns the x nearest to `near` at which the cam has this slope, at most `most` pieces away.
std::optional<double> NearestSlope(const Table& table, double slope, double near, std::size_t most) noexcept;

}  // namespace takt::cam
