// Common to all makers of segments: orientation and auxiliary axes at their ends.
#pragma once

#include "takt/path/segment.h"
#include "takt/path/vectors.h"

namespace takt::path {

// Returns true if all numbers are finite and the orientation is a rotation.
bool Sound(const Point& point) noexcept;

// Sets orientation and auxiliary axes to change linearly from one end to the other. Requires: `length` is set.
void SetEven(Segment& segment, const Point& from, const Point& to) noexcept;

// Orientation and auxiliary axes at an end, with derivatives by s.
struct Along {
  Derivatives<Vector> turn;  // from the base orientation
  AuxiliaryMotion auxiliaries;
};

// Sets orientation and auxiliary axes to match these values and derivatives at both ends. Requires: `length` is set.
void SetCurved(Segment& segment, const KDL::Rotation& base, const Along& begin, const Along& end) noexcept;

}  // namespace takt::path
