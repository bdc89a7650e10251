// Blends: a stretch of path that leaves one segment before a corner and joins the next one behind it, with continuous
// tangent, curvature, orientation and auxiliary axes (value, first and second derivative by s).
//
// The position is a polynomial of the fifth degree with position, tangent and curvature of both segments at its ends.
// The magnitude of the derivatives by its parameter there determines the largest curvature and how fast the curvature
// grows. For two lines that are left and joined at the same distance d from the corner, with q the cosine of half the
// angle between them, the curvature is least with d * q / (0.2067 + 0.393 q - 0.0345 q²): 1.14 to 1.18 times that of a
// circle that begins and ends there. But for d up to some ten times a³ / j² the jerk j of drives, not their
// acceleration a, determines the speed at a corner. So the derivatives are longer,
//   d * q / (0.2067 + 0.28 q)
// with which the largest curvature is up to 1.62 times the circle's and, where the corner turns by no more than a right
// angle, grows half as fast or less: 26 to 37 % more speed where the jerk limits it, 12 to 15 % less where it does not.
// With two distances d the length is the one that puts the third of the six control points as far from the corner on
// the longer side as the rule does on the shorter one: up to a right angle at most 1.7 times the least possible
// curvature, at sharper angles more, but a fraction of what other simple rules give.
//
// Lines as chords of a curve: where two blends meet on the line between them, the curvature there need not be 0. The
// parameter of such a round blend is approximately its share of the length: the derivatives at its ends are as long as
// the arc of a circle that touches both lines, with half the sum of both distances. The curvature then changes nearly
// linearly from one end to the other: for chords of a circle it is the circle's everywhere.
//
// The orientation is the corner's, turned by a vector, a polynomial of the fifth degree, too: between two great arcs
// the sum of the first easing out and the second easing in.
#pragma once

#include <optional>

#include "takt/path/segment.h"

namespace takt::path {

// Limits of a motion that brakes to a corner and speeds up again, overlapping, which a blend is shaped for: [mm/s],
// [mm/s²], [mm/s³]. All 0: the corner is passed at constant speed. With a = min(acceleration, √(velocity jerk)) and x
// the distance d from the corner over the distance in which the acceleration builds up, a³ / (6 jerk²) (at least 1),
// k = (1 + √(1 + 4/3 (x - 1))) / 2 is the time of the overlap over the time in which the acceleration builds up. The
// blend begins and ends as such ramps do: the first derivative by its parameter is d 6 k (k - 1/2) / x and the second d
// 6 k² / x. Up to x = 1 that is the cubic with both inner control points on the corner. Where constant speed is faster,
// the blend is the one without a ramp.
struct Ramp {
  double velocity = 0;
  double acceleration = 0;
  double jerk = 0;
};

// Makes the blend from `first` at s_first to `second` at s_second. Requires: `second` begins where `first` ends (else
// kApart). Between segments that only turn the tool or only move auxiliary axes (both the same) the blend is as long as
// the path it replaces.
Problem Blend(const Segment& first, double s_first, const Segment& second, double s_second, Segment& out,
              const Ramp& ramp = {}) noexcept;

// Curvatures at both ends of a round blend of two lines: vectors perpendicular to the line [1/mm].
struct Bends {
  Triple first{};
  Triple second{};
};
Problem Blend(const Segment& first, double s_first, const Segment& second, double s_second, const Bends& bends,
              Segment& out) noexcept;

// Returns the curvature at the middle of `chord` of the curve whose chords are three lines, if round blends of both
// corners run from middle to middle. It is chosen so that the curvature changes evenly along each of them: for equal
// lengths, the mean of both blends' mean curvatures; larger where the chord is shorter than its neighbours, smaller
// where it is longer. 0 where the curve begins to bend to the other side. Nothing if the lines are no chords of a
// curve: a corner turns by more than a right angle, or a segment is no line.
std::optional<Triple> ChordCurvature(const Segment& before, const Segment& chord, const Segment& after) noexcept;

// Length available for a blend, measured from the corner.
struct Room {
  double first = 0;   // of the first segment
  double second = 0;  // of the second segment
};

// Returns half of each segment.
Room HalfOf(const Segment& first, const Segment& second) noexcept;

// Returns the distance from the corner at which a blend may begin and end so that it stays within `deviation` of the
// corner and of the path it replaces; at most `room`, and at most a piece of a curve that turns by 1 rad. [mm], or the
// unit that the segments count. 0: there is nothing to blend, as the segments join smoothly, or no blend is possible.
double CornerDistance(const Segment& first, const Segment& second, double deviation, const Room& room,
                      const Ramp& ramp = {}) noexcept;

// Returns the time [s] by which two ramps overlap on a blend that begins and ends at this distance from the corner: the
// time saved compared with a stop there. Infinite if the corner is passed faster at constant speed, or there is no
// ramp.
double Overlap(const Segment& first, const Segment& second, double distance, const Ramp& ramp) noexcept;

// Returns the deviation of a blend [mm]: its distance from the corner, or from the path where that is larger. Between
// segments that do not move the tool: the distance from the corner in the unit that they count.
double Deviation(const Segment& first, const Segment& second, const Segment& blend) noexcept;

// Returns true if `second` continues as `first` ends: tangent, curvature, and the derivatives of orientation and
// auxiliary axes.
bool Smooth(const Segment& first, const Segment& second) noexcept;

}  // namespace takt::path
