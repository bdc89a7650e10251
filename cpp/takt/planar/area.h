// Areas that movers sweep in the plane, and their clearance. Fit for the cycle.
//
// The geometry is our own, by separating axes; FCL is the reference in tests and the benchmark, but does not suit the
// cycle. Its collide() of two convex prisms allocates 11 times with libccd and, if they overlap, 3 times with its own
// solver, which reports prisms 1e-6 mm apart as touching or not at random. Its shapes would have to be built on the
// heap for each command. Its tree of boxes allocates nothing once it is filled, but is no plain state: it cannot be
// copied, hashed or replayed; and moving one of 200 boxes in it takes longer than testing all of them. libccd alone,
// without FCL, allocates nothing, but reports undecided cases as separate, and cannot tell contact from overlap.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/planar/clearance.h"
#include "takt/planar/point.h"

namespace takt::planar {

struct Pose {
  Place place{};
  double c = 0;  // [deg] counterclockwise; continuous over whole turns
};

// The area that a mover sweeps: its centre anywhere in the hull of `places`, its angle anywhere in [least_c, most_c].
struct Area {
  std::array<Place, 7> places{};
  std::uint8_t count = 1;  // number of `places` in use
  double least_c = 0;      // [deg]
  double most_c = 0;
  Footprint mover{};
  double margin = 0;  // [mm] around all of it
};

// An axis-parallel rectangle [mm].
struct Extent {
  Place lower{};
  Place upper{};
};
Extent ExtentOf(const Area& area) noexcept;
// Returns true if the two are at least `clearance` [mm] apart along X or Y.
inline bool Apart(const Extent& a, const Extent& b, double clearance) noexcept {
  return b.lower.x - a.upper.x >= clearance || a.lower.x - b.upper.x >= clearance ||
         b.lower.y - a.upper.y >= clearance || a.lower.y - b.upper.y >= clearance;
}

// Areas of rotating movers are tested as if enlarged by less than this, both areas together.
inline constexpr double kSlack = 1;  // [mm]

// Returns true if the areas come nearer than `clearance` [mm]; below 0: if they overlap by more than -clearance. If
// false, a separating axis has been found. Slowest if both rotate far and nearly touch.
bool Near(const Area& a, const Area& b, double clearance) noexcept;

void describe(Description<Pose>&);
void describe(Description<Extent>&);

}  // namespace takt::planar
