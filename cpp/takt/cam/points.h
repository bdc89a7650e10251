// Curves through points (CAM-01).
#pragma once

#include <span>
#include <vector>

#include "takt/cam/curve.h"
#include "takt/cam/params.h"

namespace takt::cam {

// Returns one curve between each two points, x in ascending order. Quintic and cubic splines choose the velocities and
// accelerations that are not given so that the integral of y'''² (cubic: y''²) over the cam is least: then the fourth
// derivative (the second) does not jump where the velocity is free, the third not where the acceleration is. Free ends
// have the third and fourth derivative (the second) 0; in a cyclic cam they are continuous across the seam. A quintic
// cam that is not cyclic, of two points and nothing else given, is a straight line.
std::vector<Curve> Interpolate(std::span<const CamPoint> points, Interpolation interpolation, bool cyclic);

}  // namespace takt::cam
