// Arches: half an ellipse upright over two points, with a straight piece at the lower one.
//
// Where the heights of begin and end differ the lower one is joined straight up (or down) to the height of the other;
// the ellipse stands over that height. At its ends it runs upright, so it goes on from such a piece without a corner.
// Orientation and auxiliary axes run evenly over the whole length.
#pragma once

#include "takt/path/segment.h"

namespace takt::path {

// The half ellipse is four pieces of the fifth degree with its places, tangents and curvatures where they meet;
// between them they differ from it by less than 1e-5 of its size.
inline constexpr int kArchQuintics = 4;
inline constexpr int kMostArchPieces = kArchQuintics + 1;

// `up`: a unit vector. `height`: mm of the crest above the higher of both points, >= 0. An arch without a height is
// straight between its feet; one whose points lie one above the other is the straight line between them.
int ArchPieces(const Point& begin, const Point& end, double height, const Triple& up) noexcept;

// Piece 0 begins at `begin`, the last one ends at `end`. A reason, and nothing in `out`, where there is none.
Problem MakeArchPiece(const Point& begin, const Point& end, double height, const Triple& up, int piece,
                      Segment& out) noexcept;

}  // namespace takt::path
