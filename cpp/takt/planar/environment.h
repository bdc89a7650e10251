// The surface that movers float on: stators side by side, and the border around them.
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

inline constexpr double kStatorSide = 240;         // mm
inline constexpr std::size_t kMostStators = 2000;  // of one surface

// Why there is no surface of some stators.
enum class StatorProblem : std::uint8_t {
  kNone,
  kEmpty,      // there are none
  kTooMany,    // more than kMostStators
  kNotFinite,  // a corner is NaN, infinite, or further away than 1e6 mm
  kOverlap,    // two of them overlap
};

// One sentence without a full stop; empty for kNone.
std::string_view Text(StatorProblem problem) noexcept;

// A closed polygon, the last corner leads to the first; the surface is to the left of it. Sides go along X and Y in
// turns.
struct Outline {
  std::vector<Place> corners;
  bool hole = false;  // clockwise, around what does not belong to the surface
};

// Where stators meet in a corner alone, no mover gets across: there two outlines touch, or one touches itself.
struct Environment {
  std::vector<Place> stators;  // their lower left corners
  std::vector<Outline> outlines;
};

// Which stator the problem is with, and which other one it overlaps.
struct Surfacing {
  StatorProblem problem = StatorProblem::kNone;
  std::size_t stator = 0;
  std::size_t other = 0;
};
// Stators anywhere, given by their lower left corners; what is nearer than kSame touches. Leaves `out` alone where
// there is a problem. Allocates; not for the cycle.
Surfacing MakeEnvironment(std::span<const Place> stators, Environment& out);

// Whether all of an area lies on the surface; flush with the border it does. Fit for the cycle.
bool Carries(const Environment& environment, const Area& area) noexcept;

// Whether the border gets into an area whose extent this is; else all of it is on one side. Fit for the cycle.
bool Crosses(const Environment& environment, const Area& area, const Extent& extent) noexcept;

void describe(Enumeration<StatorProblem>&);

}  // namespace takt::planar
