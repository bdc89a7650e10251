// Splines: smooth paths through points. Made when a machine file is loaded: not for use in the cycle.
//
// The position is a cubic spline, so tangent and curvature are continuous. At each point orientation and auxiliary axes
// have the rate and its change of a parabola (by arc length) through the point and its neighbours; between the points
// they are polynomials of the fifth degree with these at their ends.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/path/segment.h"

namespace takt::path {

// The increment of the spline's parameter from point to point.
enum class Spacing : std::uint8_t {
  kCentripetal,  // square root of their distance: bends tightly at points close together, does not overshoot
  kChord,        // their distance: wide bends
};

struct SplineOptions {
  Spacing spacing = Spacing::kCentripetal;
  // Directions at the ends, of any length; none: no curvature there (natural).
  std::optional<Triple> start_direction{};
  std::optional<Triple> end_direction{};
};

// Makes one segment between each two consecutive points. Requires: consecutive points differ in position (else
// kCoincide).
Problem MakeSpline(std::span<const Point> points, const SplineOptions& options, std::vector<Segment>& out);

void describe(Enumeration<Spacing>&);

}  // namespace takt::path
