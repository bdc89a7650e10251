// Orientations turned from a base by a vector: axis times angle. Turns about any axis that begin and end with any
// angular velocity and acceleration are polynomials of that vector.
#pragma once

#include <Eigen/Geometry>

#include "takt/path/segment.h"
#include "takt/path/vectors.h"

namespace takt::path {

Eigen::Quaterniond ToQuaternion(const KDL::Rotation& rotation) noexcept;

// The rotation by `turn`, its angular velocity and its angular acceleration, in the fixed frame.
struct Turned {
  Eigen::Quaterniond rotation;
  Vector velocity;
  Vector acceleration;
};
Turned TurnBy(const Derivatives<Vector>& turn) noexcept;

// The inverse: returns the derivatives of the vector `turn` (less than a whole turn) for this angular velocity and
// acceleration.
Derivatives<Vector> TurnOf(const Vector& turn, const Vector& velocity, const Vector& acceleration) noexcept;

}  // namespace takt::path
