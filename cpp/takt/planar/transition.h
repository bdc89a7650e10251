// Transitions: what fills the gap between two pieces of a track, without a step of direction or curvature.
//
// A polynomial of the fifth degree with place, direction and curvature of both sides at its ends. How long its
// derivatives are there is chosen so that
//   L^0.75 * sqrt(integral of k² + 0.01 L² * integral of k'²)
// is least, with L the length and k the curvature, by arc length: little curvature, changing gently, without a detour.
// At a right angle with both sides as far from the corner the largest curvature is 1.17 times that of a circle. What is
// chosen depends smoothly on the gap, and is the same for gaps that are turned, moved or mirrored.
#pragma once

#include <vector>

#include "takt/path/segment.h"
#include "takt/planar/point.h"
#include "takt/planar/problem.h"

namespace takt::planar {

// No track bends more tightly than this.
inline constexpr double kLeastRadius = 1;  // mm

// A straight line where both sides lie on one. What bends so unevenly that its length would not be known to
// kLengthError is cut into pieces. Appends to `out`, or leaves it alone where there is a problem.
inline constexpr double kLengthError = 1e-10;  // mm, or of a metre where it is longer
Problem MakeTransition(const TrackPoint& begin, const TrackPoint& end, std::vector<path::Segment>& out);

}  // namespace takt::planar
