// Where two pieces of a cam meet, or its end and its beginning: what must not jump there (CAM-03).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "takt/cam/build.h"
#include "takt/cam/curve.h"

namespace takt::cam {

// One side of a joint.
struct JointSide {
  Value value;
  bool straight = false;  // a line or a dwell
  bool jumps = false;     // a law whose acceleration jumps by nature
};

struct Joint {
  std::string path;  // of what stands behind it
  double x = 0;
  JointSide before, behind;
  bool seam = false;  // of a cyclic cam: its end and its beginning
};

// Errors: a jump of position (not at the seam, where the stroke lies between) or velocity; at the seam also of
// acceleration, unless a law beside it has that by nature. Warnings: velocity or position where straight lines meet,
// in one sentence; acceleration elsewhere.
//
// `scale`: how large position, velocity and acceleration get in the cam; a difference far below is none.
void CheckJoints(std::span<const Joint> joints, const Value& scale, std::vector<Finding>& errors,
                 std::vector<Finding>& warnings);

}  // namespace takt::cam
