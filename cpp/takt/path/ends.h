// What makers of segments share: their ends.
#pragma once

#include "takt/path/segment.h"
#include "takt/path/vectors.h"

namespace takt::path {

// Finite numbers, and a rotation.
bool Sound(const Point& point) noexcept;

// Orientation and auxiliary axes run evenly from one end to the other. `length` must stand.
void SetEven(Segment& segment, const Point& from, const Point& to) noexcept;

// What goes along with the place at an end: derivatives by s.
struct Along {
  Derivatives<Vector> turn;  // from the base
  AuxiliaryMotion auxiliaries;
};

// Orientation and auxiliary axes go on at both ends as said. `length` must stand.
void SetCurved(Segment& segment, const KDL::Rotation& base, const Along& begin, const Along& end) noexcept;

}  // namespace takt::path
