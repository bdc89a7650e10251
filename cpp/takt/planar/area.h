// What movers cover of the plane on their ways, and whether two of them come near each other. Fit for the cycle.
//
// The geometry is our own, by separating axes, and FCL the yardstick in tests and benchmark. FCL has no place in the
// cycle. Its collide() of two convex prisms allocates 11 times with libccd and, where they overlap, 3 times with its
// own solver, which takes prisms 1e-6 mm apart for touching or not as it comes. Its shapes would have to be built on
// the heap for each command. Its tree of boxes allocates nothing once it is filled, but is no plain state: it cannot be
// copied, hashed or replayed; and it takes longer to move one of 200 boxes in it than to go through all of them. libccd
// alone, without FCL, allocates nothing, but calls apart what it could not decide, and cannot tell flush from across.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/planar/clearance.h"
#include "takt/planar/point.h"

namespace takt::planar {

struct Pose {
  Place place{};
  double c = 0;  // deg, counterclockwise; counts on over whole turns
};

// A mover whose centre is anywhere in the hull of some places, turned by any angle between two.
struct Area {
  std::array<Place, 7> places{};
  std::uint8_t count = 1;  // how many of them
  double least_c = 0;      // deg
  double most_c = 0;
  Footprint mover{};
  double margin = 0;  // mm, around all that
};

// The sides of a rectangle along X and Y.
struct Extent {
  Place lower{};
  Place upper{};
};
Extent ExtentOf(const Area& area) noexcept;
// Whether they are at least so far apart. mm
inline bool Apart(const Extent& a, const Extent& b, double clearance) noexcept {
  return b.lower.x - a.upper.x >= clearance || a.lower.x - b.upper.x >= clearance ||
         b.lower.y - a.upper.y >= clearance || a.lower.y - b.upper.y >= clearance;
}

// What turns counts as larger than it is by less than this, both areas together.
inline constexpr double kSlack = 1;  // mm

// Whether they come nearer than `clearance`, mm; below 0: whether they overlap by more. Where not, there is an axis
// that separates them. Takes longest where both turn far and nearly touch.
bool Near(const Area& a, const Area& b, double clearance) noexcept;

void describe(Description<Pose>&);
void describe(Description<Extent>&);

}  // namespace takt::planar
