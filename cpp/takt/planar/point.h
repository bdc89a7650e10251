// Points in the plane, and the shape of a track at a point.
#pragma once

#include "takt/core/describe_fwd.h"

namespace takt::planar {

// [mm]
struct Place {
  double x = 0;
  double y = 0;
};

// A point of a track. The direction is continuous along the track, also over more than half a turn; it begins between
// -pi and pi.
struct TrackPoint {
  Place place;
  double direction = 0;       // [rad] counterclockwise from x
  double curvature = 0;       // [1/mm] > 0 where the track bends to the left
  double curvature_rate = 0;  // [1/mm²] derivative with respect to arc length
};

// Two points nearer than this are the same.
inline constexpr double kSame = 1e-6;  // [mm]

// Return true if a track may continue from one point to the other: in position, direction and curvature.
bool SamePoint(const Place& a, const Place& b) noexcept;
bool SameDirection(const TrackPoint& a, const TrackPoint& b) noexcept;
bool SameCurvature(const TrackPoint& a, const TrackPoint& b) noexcept;
bool Same(const TrackPoint& a, const TrackPoint& b) noexcept;  // in all three

void describe(Description<Place>&);
void describe(Description<TrackPoint>&);

}  // namespace takt::planar
