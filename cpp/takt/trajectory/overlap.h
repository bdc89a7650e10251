// Corners as two overlapping motions: one along the first line to rest at the corner, one along the second line from
// rest there; the second begins before the first ends.
//
// With g1(t) the distance [mm] left on the first line at the time t before its end, g2(t) the distance covered on the
// second line at the time t after its beginning, e1 and e2 the directions, P the corner and T the duration of the
// overlap,
//   p(t) = P - e1 g1(T - t) + e2 g2(t),   0 <= t <= T
// is a curve from the first line to the second with continuous tangent, curvature and accelerations: each motion begins
// and ends at rest and without acceleration. Its deviation from the corner is |e2 - e1| g(T/2) where both motions are
// alike up to T/2. They are if their limits are equal and T is no more than half of either's duration: the first
// quarter of a motion from rest to rest is the same whatever its length. Where T lies within the first phase of jerk J
// the curve is the Bézier cubic with both inner control points on the corner, d = J T³ / 6 before and behind it, and
// the deviation |e2 - e1| d / 8. (Ours; the sum of a motion that ends and one that begins is known from robot
// controllers, Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and Robots, chapter 9.)
#pragma once

#include "takt/trajectory/path_planner.h"
#include "takt/trajectory/profile.h"

namespace takt::trajectory {

// Returns the longest time [s] for which the motions `first` (to rest at the corner) and `second` (from rest there) may
// overlap so that the curve stays within `deviation` [mm] of the corner; at most half of either's duration; 0 if
// `deviation` is not positive. `turn`: |e2 - e1|, 0 (straight on) to 2 (back). Requires: both are motions from rest to
// rest with the same symmetric limits.
double OverlapTime(const Profile& first, const Profile& second, double turn, double deviation) noexcept;

// Returns the derivatives by time of a coordinate, at `t` after the beginning of an overlap of duration `overlap_s`.
// The coordinate changes by `first_slope` per mm on the first line and by `second_slope` per mm on the second one. The
// jerk is taken at the time `inside`: where t is a border of two phases, a time within the wanted phase.
ReferenceRate OverlapRate(const Profile& first, const Profile& second, double overlap_s, double t, double inside,
                          double first_slope, double second_slope) noexcept;

// Returns the derivatives of the arc length along the curve, given those of all of its Cartesian coordinates; zero
// where the curve is at rest.
ReferenceRate ArcRate(std::span<const ReferenceRate> coordinates) noexcept;

}  // namespace takt::trajectory
