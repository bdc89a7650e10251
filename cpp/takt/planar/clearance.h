// Ranges of two tracks in which their movers come too near to each other.
#pragma once

#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/track.h"

namespace takt::planar {

// The area of a mover: a rectangle, its centre on the track.
struct Footprint {
  double width = 0;   // [mm] along the track
  double height = 0;  // [mm] across it
  // Any angle between mover and track is possible: the area is a circle.
  bool any_angle = false;
};

// [mm] along a track
struct Range {
  double from = 0;
  double to = 0;
};

// Returns the signed distance [mm] of two movers; if they overlap, minus the displacement that leaves them just
// touching.
double Separation(const TrackPoint& a, const Footprint& on_a, const TrackPoint& b, const Footprint& on_b) noexcept;

// Returns the distance [mm] of the centres, along a straight track, from which on two movers clear each other that are
// both rotated against it by `turn` [rad].
double ClearGap(const Footprint& mover, double turn) noexcept;

// Returns the least gap [mm] along a track, at least `least`, at which two such movers clear each other, both at the
// angle `turned` [rad, in the plane] and one of them between the arc lengths `from` and `to`; positions beyond the end
// of the track are not checked. Requires: `least` suffices on straight stretches. Fit for the cycle; takes some 0.1 µs
// for each cm, and some 50 µs more if `least` does not suffice.
double ClearGapAlong(const Track& track, const Footprint& mover, double turned, double from, double to,
                     double least) noexcept;

// Returns the ranges of `a`, ascending, in which a mover comes nearer than `clearance` to a mover anywhere on `b`.
// Never too small; too large only where they come nearer than `clearance` + `resolution` [mm, at least 0.001].
// Allocates; not for the cycle.
std::vector<Range> Conflicts(const Track& a, const Footprint& on_a, const Track& b, const Footprint& on_b,
                             double clearance, double resolution);

// Returns the length [mm] of the range that begins at the start (that reaches the end) of a track; 0 if there is none.
double ReachFromStart(const std::vector<Range>& ranges) noexcept;
double ReachFromEnd(const std::vector<Range>& ranges, double length) noexcept;

void describe(Description<Footprint>&);

}  // namespace takt::planar
