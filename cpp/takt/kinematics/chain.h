// Serial chains of links joined by prismatic or rotary axes: the functions common to all of them. Positions of the axes
// in mm and rad.
#pragma once

#include <array>
#include <cstddef>

#include "takt/kinematics/joints.h"

namespace takt::kinematics {

struct Link {
  Frame before;               // from the previous axis (or the base) to this one, with the axis at 0
  KDL::Vector axis{0, 0, 1};  // a unit vector, in that frame
  JointKind kind = JointKind::kRotary;
};

struct Chain {
  std::array<Link, kMaxJoints> links;
  std::size_t count = 0;
  Frame tool;         // from the last axis to the tool
  double length = 1;  // [mm] approximate reach: makes mm and rad comparable
};

// Appends an axis and adds its distance to `length`. Requires: count < kMaxJoints.
void Append(Chain& chain, const Link& link);

Frame Forward(const Chain& chain, const Joints& joints) noexcept;
MovingFrame Forward(const Chain& chain, const JointMotion& motion) noexcept;
Jacobian JacobianAt(const Chain& chain, const Joints& joints) noexcept;

// Computes velocity and acceleration of the axes that move the tool with the twist and acceleration of `tool`, at the
// positions in `motion`; the pose of `tool` is not used. With more axes than needed the solution with the least speeds
// is returned. kSingular; kOrientation: there are too few axes for this motion.
Reason SolveMotion(const Chain& chain, const MovingFrame& tool, JointMotion& motion) noexcept;

}  // namespace takt::kinematics
