// A track divided into cells of little curvature: the first level of searches along it.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/path/segment.h"
#include "takt/planar/point.h"

namespace takt::planar {

// All of it lies within `off` of the chord between its ends; all its directions differ by at most `turn`.
struct Cell {
  double from = 0;  // [mm] along the track
  double to = 0;
  Place begin;
  Place end;
  double off = 0;        // [mm]
  double turn = 0;       // [rad]
  double curvature = 0;  // [1/mm] largest absolute value
  std::uint32_t piece = 0;
  // Parameters of a transition at both ends.
  double begin_parameter = 0;
  double end_parameter = 1;
};

// [rad] upper bound of Cell::turn.
inline constexpr double kCellTurn = 0.25;

// Returns a bound [mm] of how far a point fixed to the track, `radius` [mm] from it, deviates within `half` [mm] around
// a point of the cell from where it would be on the tangent at that point.
double StrayOf(const Cell& cell, double half, double radius) noexcept;

// Appends the cells of a piece that begins at arc length `start`.
void AppendCells(const path::Segment& segment, double start, std::uint32_t piece, std::vector<Cell>& out);

}  // namespace takt::planar
