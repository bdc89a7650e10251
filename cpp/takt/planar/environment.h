// The surface that movers float on: adjacent stators, and the border around them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/area.h"
#include "takt/planar/point.h"

namespace takt::planar {

inline constexpr double kStatorSide = 240;         // [mm]
inline constexpr std::size_t kMostStators = 2000;  // of one surface

// Why stators do not make a surface.
enum class StatorProblem : std::uint8_t {
  kNone,
  kEmpty,      // no stators
  kTooMany,    // more than kMostStators
  kNotFinite,  // a corner is NaN, infinite, or farther away than 1e6 mm
  kOverlap,    // two stators overlap
};

// One sentence without a full stop; empty for kNone.
std::string_view Text(StatorProblem problem) noexcept;

// A closed polygon, the last corner joined to the first, with the surface to its left. Its sides alternate between X
// and Y.
struct Outline {
  std::vector<Place> corners;
  bool hole = false;  // clockwise, around an area outside the surface
};

// Movers cannot cross between stators that meet in a corner only: two outlines touch there, or one touches itself.
struct Environment {
  std::vector<Place> stators;  // lower left corners [mm]
  std::vector<Outline> outlines;
};

// The problem, the index of the stator that causes it, and that of the stator that it overlaps.
struct SurfaceResult {
  StatorProblem problem = StatorProblem::kNone;
  std::size_t stator = 0;
  std::size_t other = 0;
};
// Makes the surface of stators given by their lower left corners; stators nearer to each other than kSame touch. Leaves
// `out` unchanged if there is a problem. Allocates; not for the cycle.
SurfaceResult MakeEnvironment(std::span<const Place> stators, Environment& out);

// Returns true if all of an area lies on the surface; it may be flush with the border. Fit for the cycle.
bool Carries(const Environment& environment, const Area& area) noexcept;

// Returns true if the border intersects an area; `extent`: that of the area. If false, the area is either all on the
// surface or all off it. Fit for the cycle.
bool Crosses(const Environment& environment, const Area& area, const Extent& extent) noexcept;

void describe(Enumeration<StatorProblem>&);

}  // namespace takt::planar
