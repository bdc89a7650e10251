// Transitions: curves that fill the gap between two pieces of a track, continuous in direction and curvature.
//
// A polynomial of the fifth degree with position, direction and curvature of both sides at its ends. The lengths of its
// derivatives there minimise
//   L^0.75 * sqrt(integral of k² + 0.01 L² * integral of k'²)
// with L the length and k the curvature, by arc length: little curvature that changes gently, without a detour. At a
// right angle with both sides equally far from the corner, the largest curvature is 1.17 times that of a circle. The
// result depends smoothly on the gap, and is invariant to rotation, translation and mirroring.
#pragma once

#include <vector>

#include "takt/path/segment.h"
#include "takt/planar/point.h"
#include "takt/planar/problem.h"

namespace takt::planar {

// Least radius of a track.
inline constexpr double kLeastRadius = 1;  // [mm]

// Appends the transition to `out`: a straight line if both sides lie on one. It is cut into pieces if its length would
// not be known to kLengthError. Leaves `out` unchanged if there is a problem.
inline constexpr double kLengthError = 1e-10;  // [mm] or of a metre, for longer ones
Problem MakeTransition(const TrackPoint& begin, const TrackPoint& end, std::vector<path::Segment>& out);

}  // namespace takt::planar
