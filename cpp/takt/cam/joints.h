// Checks the joints between two pieces of a cam, or between its end and its beginning (CAM-03).
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
  bool jumps = false;     // a law whose acceleration jumps by its nature
};

struct Joint {
  std::string path;  // of the piece after the joint
  double x = 0;
  JointSide before, behind;
  bool seam = false;  // of a cyclic cam: its end and its beginning
};

// Errors: a jump of position (not at the seam, where the stroke lies in between) or velocity; at the seam also of
// acceleration, unless a law beside it has that by its nature. Warnings: a jump of position between straight lines; the
// jumps of velocity between straight lines, in one sentence; other jumps of acceleration, except inside the cam beside
// a law that has them by its nature.
//
// `scale`: the largest position, velocity and acceleration in the cam; differences far below are ignored.
void CheckJoints(std::span<const Joint> joints, const Value& scale, std::vector<Finding>& errors,
                 std::vector<Finding>& warnings);

}  // namespace takt::cam
