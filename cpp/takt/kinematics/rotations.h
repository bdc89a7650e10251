// Rotations by an angle [rad]. KDL's own (RotX, Rot, RPY ...) take sine and cosine from the C library, which selects an
// implementation by processor; these have the same bits on every processor.
#pragma once

#include <kdl/frames.hpp>

#include "takt/core/maths.h"

namespace takt::kinematics {

inline KDL::Rotation AboutX(double angle) noexcept {
  const auto [s, c] = maths::SinCos(angle);
  return {1, 0, 0, 0, c, -s, 0, s, c};
}
inline KDL::Rotation AboutY(double angle) noexcept {
  const auto [s, c] = maths::SinCos(angle);
  return {c, 0, s, 0, 1, 0, -s, 0, c};
}
inline KDL::Rotation AboutZ(double angle) noexcept {
  const auto [s, c] = maths::SinCos(angle);
  return {c, -s, 0, s, c, 0, 0, 0, 1};
}

// Returns the rotation about a unit vector (Rodrigues' formula).
inline KDL::Rotation About(const KDL::Vector& axis, double angle) noexcept {
  const auto [s, c] = maths::SinCos(angle);
  const double x = axis.x(), y = axis.y(), z = axis.z(), rest = 1 - c;
  const double xy = rest * x * y, xz = rest * x * z, yz = rest * y * z;
  return {rest * x * x + c, xy - s * z, xz + s * y, xy + s * z,      rest * y * y + c,
          yz - s * x,       xz - s * y, yz + s * x, rest * z * z + c};
}

// Returns Rz(c) Ry(b) Rx(a): about X by a first, then about Y by b, then about Z by c, about fixed axes. URDF's roll,
// pitch and yaw.
inline KDL::Rotation RollPitchYaw(double a, double b, double c) noexcept {
  const auto [sa, ca] = maths::SinCos(a);
  const auto [sb, cb] = maths::SinCos(b);
  const auto [sc, cc] = maths::SinCos(c);
  return {cc * cb,
          cc * sb * sa - sc * ca,
          cc * sb * ca + sc * sa,
          sc * cb,
          sc * sb * sa + cc * ca,
          sc * sb * ca - cc * sa,
          -sb,
          cb * sa,
          cb * ca};
}

}  // namespace takt::kinematics
