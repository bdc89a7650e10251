// Positions by arc length.
#pragma once

#include "takt/path/segment.h"
#include "takt/path/vectors.h"

namespace takt::path {

// Returns the arc length [mm] between two parameters, which must be close together: Gauss-Legendre quadrature.
double LengthBetween(const VectorPolynomial& place, double from, double to) noexcept;

// Sets the position of the segment to `place`, and its `length`. The cells are smaller where the speed over the
// parameter changes fast.
void SetQuintic(Segment& segment, const VectorPolynomial& place) noexcept;

// Returns the parameter of a quintic at the arc length s. Requires: 0 <= s <= length.
double ParameterAt(const Segment& segment, double s) noexcept;

// Returns position, tangent and curvature. Requires: 0 <= s <= length.
Derivatives<Vector> PlaceAt(const Segment& segment, double s) noexcept;

}  // namespace takt::path
