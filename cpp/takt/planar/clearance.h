// Where movers on two tracks come too near to each other.
#pragma once

#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/track.h"

namespace takt::planar {

// The area of a mover: a rectangle, its centre on the track.
struct Footprint {
  double width = 0;   // mm, along the track
  double height = 0;  // mm, across it
  // The mover may stand at any angle to its track: what it may cover is a circle.
  bool any_angle = false;
};

// mm along a track.
struct Range {
  double from = 0;
  double to = 0;
};

// Signed distance of two movers: below 0, how far one has to be moved so that they only touch. mm.
double Separation(const TrackPoint& a, const Footprint& on_a, const TrackPoint& b, const Footprint& on_b) noexcept;

// From middle to middle along a straight track: so far apart two movers, both turned against it by `turn` (rad), clear
// each other. mm
double ClearGap(const Footprint& mover, double turn) noexcept;

// The least gap along a track, mm, from `least` on, at which two such movers, both turned to `turned` (rad, in the
// plane) and one of them between two arc lengths, clear each other; what is beyond the end of the track is not looked
// at. Where no bend is near, `least` has to be enough. Fit for the cycle; takes some 0.1 µs for each cm, and some 50 µs
// more where it finds one.
double ClearGapAlong(const Track& track, const Footprint& mover, double turned, double from, double to,
                     double least) noexcept;

// Where on `a` a mover comes nearer than `clearance` to a mover somewhere on `b`, in order. Never too little; too much
// only where they come nearer than `clearance` + `resolution` (mm, 0.001 or more). Allocates; not for the cycle.
std::vector<Range> Conflicts(const Track& a, const Footprint& on_a, const Track& b, const Footprint& on_b,
                             double clearance, double resolution);

// From the start or the end of a track, how far the range that begins there reaches; 0 if there is none.
double ReachFromStart(const std::vector<Range>& ranges) noexcept;
double ReachFromEnd(const std::vector<Range>& ranges, double length) noexcept;

void describe(Description<Footprint>&);

}  // namespace takt::planar
