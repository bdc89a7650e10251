// Areas looked at from outside: as polygons, one for each angle.
#pragma once

#include <vector>

#include "takt/planar/area.h"
#include "takt/planar/environment.h"
#include "tracks.h"

namespace takt::planar::testing {

// Of stators, by their lower left corners.
Environment Surface(const std::vector<Place>& stators);

inline Area Standing(const Place& place, const Footprint& mover, double c = 0) {
  return {.places = {place}, .least_c = c, .most_c = c, .mover = mover};
}

// Convex, counterclockwise.
using Polygon = std::vector<Place>;
// What the mover covers turned by these angles, anywhere in its places.
Polygon HullAt(const Area& area, double least_c, double most_c);
// 0: they overlap.
double Distance(const Polygon& a, const Polygon& b);
bool IsIn(const Polygon& polygon, const Place& place);

// How near they come, by trying angles: 0 if they overlap; never less than it is, and more by less than 0.05 mm. Areas
// without margins.
double DistanceByAngles(const Area& a, const Area& b);

TrackPoint AsPoint(const Pose& pose);
// Anywhere within 400 mm; half of them turn.
Area RandomArea(Random& random);
Place RandomPlaceOf(const Area& area, Random& random);

}  // namespace takt::planar::testing
