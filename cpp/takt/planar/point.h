// Places in the plane, and how a track runs through one.
#pragma once

#include "takt/core/describe_fwd.h"

namespace takt::planar {

// mm.
struct Place {
  double x = 0;
  double y = 0;
};

// Of a track, at one place. The direction counts on where the track turns by more than half a turn: it makes no jump
// along a track, and begins between -pi and pi.
struct TrackPoint {
  Place place;
  double direction = 0;       // rad, counterclockwise from x
  double curvature = 0;       // 1/mm, above 0 where the track bends to the left
  double curvature_rate = 0;  // 1/mm², by arc length
};

// Nearer than this, two places are the same.
inline constexpr double kSame = 1e-6;  // mm

// Whether a track may go on from one of these to the other: in place, direction and curvature.
bool SamePlace(const Place& a, const Place& b) noexcept;
bool SameDirection(const TrackPoint& a, const TrackPoint& b) noexcept;
bool SameCurvature(const TrackPoint& a, const TrackPoint& b) noexcept;
bool Same(const TrackPoint& a, const TrackPoint& b) noexcept;  // in all three

void describe(Description<Place>&);
void describe(Description<TrackPoint>&);

}  // namespace takt::planar
