// A reference for areas: polygons, one for each angle.
#pragma once

#include <vector>

#include "takt/planar/area.h"
#include "takt/planar/environment.h"
#include "tracks.h"

namespace takt::planar::testing {

// Makes a surface of stators, given by their lower left corners.
Environment Surface(const std::vector<Place>& stators);

inline Area Standing(const Place& place, const Footprint& mover, double c = 0) {
  return {.places = {place}, .least_c = c, .most_c = c, .mover = mover};
}

// Convex, counterclockwise.
using Polygon = std::vector<Place>;
// Returns what the mover covers at these angles, anywhere in its places.
Polygon HullAt(const Area& area, double least_c, double most_c);
// Returns the distance of two polygons; 0 if they overlap.
double Distance(const Polygon& a, const Polygon& b);
bool IsIn(const Polygon& polygon, const Place& place);

// Returns the distance of two areas by sampling angles; 0 if they overlap. Never less than the true distance, and
// larger by less than 0.05 mm. For areas without margins.
double DistanceByAngles(const Area& a, const Area& b);

TrackPoint AsPoint(const Pose& pose);
// A random area within 400 mm; half of them rotate.
Area RandomArea(Random& random);
Place RandomPlaceOf(const Area& area, Random& random);

}  // namespace takt::planar::testing
