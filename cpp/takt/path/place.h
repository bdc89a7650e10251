// Places by arc length.
#pragma once

#include "takt/path/segment.h"
#include "takt/path/vectors.h"

namespace takt::path {

// mm of the way between two parameters, which lie close enough together: Gauss and Legendre's rule.
double LengthBetween(const VectorPolynomial& place, double from, double to) noexcept;

// Makes `place` the place of the segment, and `length` what it is long. The cells become smaller where the speed over
// the parameter changes fast.
void SetQuintic(Segment& segment, const VectorPolynomial& place) noexcept;

// Of a quintic: the parameter after s, 0 <= s <= length.
double ParameterAt(const Segment& segment, double s) noexcept;

// Place, tangent and curvature, 0 <= s <= length.
Derivatives<Vector> PlaceAt(const Segment& segment, double s) noexcept;

}  // namespace takt::path
