// The geometry of a track, by arc length: the given lines and arcs, and transitions that fill the gaps between them.
// Direction and curvature are continuous everywhere.
//
// Tracks are made when they are configured, which takes time and memory. Evaluating a point takes the logarithm of the
// number of pieces, and does not allocate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/path/segment.h"
#include "takt/planar/cells.h"
#include "takt/planar/point.h"
#include "takt/planar/problem.h"

namespace takt::planar {

enum class ElementShape : std::uint8_t { kPosition, kLine, kArc };

// An element of a track [mm]. A gap between a line or an arc and the next one is filled with a transition; without a
// gap they must join in direction and curvature. At a position, direction and curvature are those of the spline
// (path/spline.h) through all consecutive positions and the adjacent ends of their neighbours.
struct Element {
  ElementShape shape = ElementShape::kLine;
  Place start{};  // of a line or an arc
  Place end{};    // end of a line or an arc; a position
  Place center{};
  bool clockwise = false;  // of an arc; one that ends at its start is a full circle
};

struct Layout {
  std::vector<Element> elements{};
  std::optional<TrackPoint> from{};  // the end of another track
  std::optional<TrackPoint> to{};    // the start of another track
  bool closed = false;               // its end continues into its start
};

// A piece of a track.
struct Piece {
  path::Segment segment;
  double start = 0;      // [mm] arc length of its start
  double direction = 0;  // [rad] at its start; of a transition, at the middle of its parameter
  bool given = false;    // a given line or arc; false: a transition
};
// The point at arc length s [mm] from the start of the piece, limited to 0 <= s <= length of the segment.
TrackPoint At(const Piece& piece, double s) noexcept;
Place PlaceAt(const Piece& piece, double s) noexcept;  // the same without direction and curvature

// A stretch of a track with nearly constant curvature and curvature rate. Both are 0 on straight lines.
struct Bend {
  double from = 0;       // [mm] along the track, up to the next one
  double curvature = 0;  // [1/mm] largest absolute value
  double rate = 0;       // [1/mm²] largest absolute rate of the curvature
};

struct Track {
  std::vector<Piece> pieces;
  std::vector<double> ends;  // [mm] of the pieces
  std::vector<Cell> cells;   // ascending along the track
  std::vector<Bend> bends;   // ascending along the track
  double length = 0;         // [mm]
  bool closed = false;
};

// A problem and its position: in this element, or in the transition before it; element count: in the last transition.
struct Making {
  Problem problem = Problem::kNone;
  std::size_t element = 0;
};
// Leaves `out` unchanged if there is a problem.
Making MakeTrack(const Layout& layout, Track& out);

// Return the point at arc length s [mm]: periodic on a closed loop, limited to the ends of an open track. Requires:
// length > 0.
TrackPoint At(const Track& track, double s) noexcept;
Place PlaceAt(const Track& track, double s) noexcept;

// Returns s within [0, length]: periodic on a closed loop, limited to the ends of an open track.
double Within(const Track& track, double s) noexcept;

// Returns the speed [mm/s] at which the lateral acceleration is `lateral` [mm/s²]; infinite on a straight line.
double SpeedBound(const TrackPoint& point, double lateral) noexcept;

// Returns the largest absolute curvature [1/mm] of all cells that meet this stretch. Requires: 0 <= from <= to <=
// length.
double PeakCurvature(const Track& track, double from, double to) noexcept;

void describe(Enumeration<ElementShape>&);
void describe(Description<Element>&);

}  // namespace takt::planar
