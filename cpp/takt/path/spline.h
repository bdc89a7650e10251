// Splines: smooth paths through points. Made when a machine file is loaded: not for the cycle.
//
// The place is a cubic spline; so tangent and curvature go on from piece to piece. Orientations and auxiliary axes have
// at each point the rate and the change of it of a parabola (by arc length) through the point and its neighbours, and
// run from point to point by polynomials of the fifth degree with these at their ends.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/path/segment.h"

namespace takt::path {

// What the parameter of the spline advances by from point to point.
enum class Spacing : std::uint8_t {
  kCentripetal,  // the square root of their distance: bends tightly at points close together, does not overshoot
  kChord,        // their distance: wide bends
};

struct SplineOptions {
  Spacing spacing = Spacing::kCentripetal;
  // Directions at the ends, of any length; without one the path does not bend there (natural).
  std::optional<Triple> start_direction{};
  std::optional<Triple> end_direction{};
};

// One segment between any two points that follow one another. Two points must differ in place.
Problem MakeSpline(std::span<const Point> points, const SplineOptions& options, std::vector<Segment>& out);

void describe(Enumeration<Spacing>&);

}  // namespace takt::path
