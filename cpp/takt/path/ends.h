// What makers of segments share: their ends.
#pragma once

#include "takt/path/segment.h"

namespace takt::path {

// Finite numbers, and a rotation.
bool Sound(const Point& point) noexcept;

// Orientation and auxiliary axes run evenly from one end to the other. `length` must stand.
void SetEven(Segment& segment, const Point& from, const Point& to) noexcept;

// How many of the auxiliary axes are anywhere but at 0 all the way.
void CountAuxiliaries(Segment& segment) noexcept;

}  // namespace takt::path
