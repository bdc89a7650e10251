// A track cut into stretches that bend little: what searches along it begin with.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/path/segment.h"
#include "takt/planar/point.h"

namespace takt::planar {

// All of it lies within `off` of the straight line between its ends, and every direction within `turn` of every other.
struct Cell {
  double from = 0;  // mm along the track
  double to = 0;
  Place begin;
  Place end;
  double off = 0;        // mm
  double turn = 0;       // rad
  double curvature = 0;  // 1/mm, the largest, without sign
  std::uint32_t piece = 0;
  // Of a transition: its parameter.
  double begin_parameter = 0;
  double end_parameter = 1;
};

// rad: cells turn less.
inline constexpr double kCellTurn = 0.25;

// Something fixed to the track that reaches so far from it: how far it may come, within `half` mm around a place of the
// cell, from where it would be on the straight line through that place.
double StrayOf(const Cell& cell, double half, double radius) noexcept;

// Appends those of a piece that begins at `start` along the track.
void AppendCells(const path::Segment& segment, double start, std::uint32_t piece, std::vector<Cell>& out);

}  // namespace takt::planar
