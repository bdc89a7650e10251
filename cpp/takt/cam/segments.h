// Curves from segments (CAM-01, CAM-02).
#pragma once

#include <span>
#include <vector>

#include "takt/cam/curve.h"
#include "takt/cam/params.h"

namespace takt::cam {

// Returns the segments with their beginnings, the velocities and accelerations at their ends, and their law filled in.
std::vector<CamSegment> Completed(std::span<const CamSegment> segments, bool cyclic);

struct SegmentPiece {
  double begin = 0;  // [x]
  Curve curve;       // over the distance from `begin`
};
// Returns the pieces of a completed segment.
std::vector<SegmentPiece> PiecesOf(const CamSegment& segment);

}  // namespace takt::cam
