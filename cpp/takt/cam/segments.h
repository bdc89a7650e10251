// Curves from segments (CAM-01, CAM-02).
#pragma once

#include <span>
#include <vector>

#include "takt/cam/curve.h"
#include "takt/cam/params.h"

namespace takt::cam {

// Segments with their beginnings and the velocities and accelerations at their ends filled in, and with the law that
// they are made with.
std::vector<CamSegment> Completed(std::span<const CamSegment> segments, bool cyclic);

struct SegmentPiece {
  double begin = 0;  // x
  Curve curve;       // over the distance from there
};
// Of a completed segment.
std::vector<SegmentPiece> PiecesOf(const CamSegment& segment);

}  // namespace takt::cam
