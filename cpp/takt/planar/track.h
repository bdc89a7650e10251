// The way of a track in the plane, by arc length: the lines and arcs given, and transitions that fill the gaps between
// them. Direction and curvature go on everywhere without a step.
//
// Tracks are made when they are configured, which may take some time and memory. Looking up a place takes the logarithm
// of the number of pieces, and allocates nothing.
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

// What a track is given by, mm. Between a line or an arc and the next a gap may be left for a transition; without a gap
// they must go on in direction and curvature. A position has the direction and the curvature of the spline
// (path/spline.h) through all positions that follow one another and the ends of their neighbours.
struct Element {
  ElementShape shape = ElementShape::kLine;
  Place start{};  // of line and arc
  Place end{};    // a position has this only
  Place center{};
  bool clockwise = false;  // an arc that ends where it starts is a whole circle
};

struct Layout {
  std::vector<Element> elements{};
  std::optional<TrackPoint> from{};  // the end of another track
  std::optional<TrackPoint> to{};    // the start of another track
  bool closed = false;               // goes on from its last element to its first
};

// A stretch of a track.
struct Piece {
  path::Segment segment;
  double start = 0;      // mm, where it begins
  double direction = 0;  // rad, at its beginning; of a transition, in the middle of its parameter
  bool given = false;    // no transition
};
// 0 <= s <= length of the segment.
TrackPoint At(const Piece& piece, double s) noexcept;
Place PlaceAt(const Piece& piece, double s) noexcept;  // that of At

// A stretch of a track whose curvature, and its rate, vary little. Both are 0 where the track is straight.
struct Bend {
  double from = 0;       // mm along the track; it reaches to the next one
  double curvature = 0;  // 1/mm, the largest, without sign
  double rate = 0;       // 1/mm², the largest rate of the curvature, without sign
};

struct Track {
  std::vector<Piece> pieces;
  std::vector<double> ends;  // mm, of the pieces
  std::vector<Cell> cells;   // in the order of the way
  std::vector<Bend> bends;   // likewise
  double length = 0;         // mm
  bool closed = false;
};

// Where `problem` is: in this element, or in the transition before it; behind the last one, in that at the end.
struct Making {
  Problem problem = Problem::kNone;
  std::size_t element = 0;
};
// Leaves `out` alone where there is a problem.
Making MakeTrack(const Layout& layout, Track& out);

// Where one is after s. A closed loop goes round, an open track ends at its ends. The track must have a length.
TrackPoint At(const Track& track, double s) noexcept;
Place PlaceAt(const Track& track, double s) noexcept;

// 0 <= s <= length: round a closed loop, to the ends of an open track.
double Within(const Track& track, double s) noexcept;

// mm/s: at this speed the lateral acceleration is `lateral` (mm/s²); infinite where the track is straight.
double SpeedBound(const TrackPoint& point, double lateral) noexcept;

// The largest curvature (1/mm, without sign) of all cells that have a part in this stretch; 0 <= from <= to <= length.
double PeakCurvature(const Track& track, double from, double to) noexcept;

void describe(Enumeration<ElementShape>&);
void describe(Description<Element>&);

}  // namespace takt::planar
