// Blends: a stretch of path that leaves one segment before a corner and joins the next behind it, without a step of
// tangent, curvature, and how orientation and auxiliary axes change (value, first and second derivative by s).
//
// The place is a polynomial of the fifth degree with place, tangent and curvature of both segments at its ends. How
// long the derivatives over its parameter are there decides how much it bends and how fast the curvature grows. For two
// lines that are left and joined at the same distance d from the corner, with q the cosine of half the angle between
// them, it bends least with d * q / (0.2067 + 0.393 q - 0.0345 q²): 1.14 to 1.18 times as much as a circle that begins
// and ends there. But for d up to some ten times a³ / j² it is the jerk j of drives, not their acceleration a, that
// says how fast a corner can be gone. So they are longer,
//   d * q / (0.2067 + 0.28 q)
// with which the largest curvature is up to 1.62 times the circle's and, where the corner turns by no more than a right
// angle, grows half as fast or less: 26 to 37 % more speed where that is what counts, 12 to 15 % less where it is not.
// With two distances d the length is that which puts the third of the six control points as far from the corner on the
// longer side as the rule does on the shorter one: up to a right angle at most 1.7 times the least possible curvature,
// at sharper angles more, but a fraction of what other simple rules give.
//
// Lines as chords of a curve: where two blends meet on the line between them, its curvature there need not be 0. Such a
// round blend takes its parameter for the share of its length: the derivatives at its ends are as long as the arc of a
// circle that touches both lines, with half the sum of both distances. The curvature then runs nearly evenly from one
// end to the other: for a circle's chords it is that of the circle, all the way.
//
// The orientation is turned from that of the corner by a vector, a polynomial of the fifth degree, too: between two
// great arcs the sum of the first easing out and the second easing in.
#pragma once

#include <optional>

#include "takt/path/segment.h"

namespace takt::path {

// How a motion speeds up, where what rounds a corner is to be as fast as one that brakes to it and speeds up again
// overlapping: mm/s, mm/s², mm/s³. All 0: the corner is gone at one speed. With a = min(acceleration, √(velocity jerk))
// and x the distance d from the corner over that in which the acceleration has built up, a³ / (6 jerk²) (1 at least),
// k = (1 + √(1 + 4/3 (x - 1))) / 2 is the time of the overlap over that in which it builds up. The blend begins and
// ends as such ramps do: the first derivative by its parameter is d 6 k (k - 1/2) / x and the second d 6 k² / x. Up to
// x = 1 that is the cubic with both inner control points on the corner. Where one speed is faster, the blend is as
// without.
struct Ramp {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};

// From `first` at s_first to `second` at s_second; second begins where first ends. Between segments that only turn the
// tool or only move auxiliary axes (both the same) the blend is as long as what it replaces.
Problem Blend(const Segment& first, double s_first, const Segment& second, double s_second, Segment& out,
              const Ramp& ramp = {}) noexcept;

// A round blend of two lines. Its curvatures at both ends: vectors across the line, 1/mm.
struct Bends {
  Triple first{};
  Triple second{};
};
Problem Blend(const Segment& first, double s_first, const Segment& second, double s_second, const Bends& bends,
              Segment& out) noexcept;

// The curvature, in the middle of the second one, of the curve whose chords are three lines, if round blends of both
// corners go from middle to middle. So that it may run evenly along each: where all are as long, the mean of both
// blends' mean curvatures; more where the chord is shorter than its neighbours, less where it is longer. 0 where the
// curve begins to bend to the other side. Nothing: the lines are no chords of a curve, as one corner turns by more than
// a right angle, or one is no line.
std::optional<Triple> BendBetween(const Segment& before, const Segment& chord, const Segment& after) noexcept;

// How much of each segment is there to blend in, from the corner on.
struct Room {
  double first = 0;   // of the length of the first
  double second = 0;  // of the length of the second
};

// Half of either.
Room HalfOf(const Segment& first, const Segment& second) noexcept;

// How far before and behind the corner a blend may begin and end so that it comes as near to the corner as `deviation`
// and is nowhere further than that from the path it replaces; never more than there is room, nor a piece of a curve
// that turns by more than 1 rad. 0: there is nothing to blend, as the segments go on smoothly, or there can be no
// blend. mm, or what the segments count.
double CornerDistance(const Segment& first, const Segment& second, double deviation, const Room& room,
                      const Ramp& ramp = {}) noexcept;

// The time by which two ramps overlap on a blend that begins and ends so far from the corner: what it saves beside a
// stop there, s. Infinite where the corner is gone faster at one speed, or there is no ramp.
double Overlap(const Segment& first, const Segment& second, double distance, const Ramp& ramp) noexcept;

// The deviation of a blend: the distance from the corner to it, or from it to the path where that is more. mm; between
// segments that do not move the tool, what they count, at the corner.
double Deviation(const Segment& first, const Segment& second, const Segment& blend) noexcept;

// Whether `second` goes on as `first` ends: tangent, curvature, and how orientation and auxiliary axes change.
bool Smooth(const Segment& first, const Segment& second) noexcept;

}  // namespace takt::path
