// Corners as two motions that overlap: along the first line to rest at the corner, along the second one from rest
// there, the second beginning before the first ends.
//
// With g1(t) the distance [mm] that is left on the first line t before its end, g2(t) that covered on the second one t
// after its beginning, e1 and e2 the directions, P the corner and T the time for which both overlap,
//   p(t) = P - e1 g1(T - t) + e2 g2(t),   0 <= t <= T
// is a curve from the first line to the second whose tangent, curvature and accelerations go over without a step: each
// motion begins and ends at rest and without acceleration. Its deviation from the corner is |e2 - e1| g(T/2), where
// both motions are alike up to T/2. They are if their limits are and T is no more than half of either's duration: the
// first quarter of a motion from rest to rest is the same whatever its length. Where T lies within the first phase of
// jerk J the curve is the Bézier cubic with both inner control points on the corner, d = J T³ / 6 before and behind it,
// and the deviation |e2 - e1| d / 8. (Ours; the sum of a motion that ends and one that begins is known from robot
// controllers, Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and Robots, chapter 9.)
#pragma once

#include "takt/trajectory/path_planner.h"
#include "takt/trajectory/profile.h"

namespace takt::trajectory {

// Returns the longest time [s] for which the motion `first` (to rest at the corner) and `second` (from rest there) may
// overlap so that the curve comes as near to the corner as `deviation` [mm]; at most half of either's duration.
// `turn`: |e2 - e1|, 0 (straight on) to 2 (back). Requires: both go from rest to rest with the same symmetric limits.
double OverlapTime(const Profile& first, const Profile& second, double turn, double deviation) noexcept;

// Returns the derivatives by time, `t` after the beginning of an overlap of `overlap_s`, of a coordinate that changes
// by `first_slope` per mm on the first line and by `second_slope` on the second one. The jerk is that at `inside`:
// where phases meet at t, a time within the phase that is meant.
ReferenceRate OverlapRate(const Profile& first, const Profile& second, double overlap_s, double t, double inside,
                          double first_slope, double second_slope) noexcept;

// Returns the derivatives of the arc length along the curve, given those of all of its Cartesian coordinates.
ReferenceRate ArcRate(std::span<const ReferenceRate> coordinates) noexcept;

}  // namespace takt::trajectory
