// Arches: upright half ellipses over two points, with a straight piece at the lower one.
//
// If the heights of the points differ, a vertical line joins the lower one to the height of the other; the ellipse
// stands over that height. At its ends the ellipse is vertical, so it joins such a line without a corner. Orientation
// and auxiliary axes change linearly over the whole length.
#pragma once

#include "takt/path/segment.h"

namespace takt::path {

// The half ellipse is approximated by four pieces of the fifth degree with its positions, tangents and curvatures at
// their joints; in between they differ from it by less than 1e-5 of its size.
inline constexpr int kArchQuintics = 4;
inline constexpr int kMostArchPieces = kArchQuintics + 1;

// Returns the number of pieces. `up`: a unit vector. `height`: [mm] of the crest above the higher point, >= 0. Without
// a height the arch is straight between its feet; for points one above the other it is the straight line between them.
int ArchPieces(const Point& begin, const Point& end, double height, const Triple& up) noexcept;

// Makes one piece; piece 0 begins at `begin`, the last one ends at `end`. If there is no such piece, returns the
// problem and leaves `out` unchanged.
Problem MakeArchPiece(const Point& begin, const Point& end, double height, const Triple& up, int piece,
                      Segment& out) noexcept;

}  // namespace takt::path
