// Links one behind the other, joined by axes that slide or turn: everything about them that is the same for all of
// them. Positions of the axes in mm and rad.
#pragma once

#include <array>
#include <cstddef>

#include "takt/kinematics/joints.h"

namespace takt::kinematics {

struct Link {
  Frame before;               // from the axis before (or the base) to this one, at rest
  KDL::Vector axis{0, 0, 1};  // a unit vector, in that frame
  JointKind kind = JointKind::kRotary;
};

struct Chain {
  std::array<Link, kMaxJoints> links;
  std::size_t count = 0;
  Frame tool;         // from the last axis to the tool
  double length = 1;  // mm, about the reach: makes mm and rad comparable
};

// Adds an axis at the end; there must be room. `length` grows with it.
void Append(Chain& chain, const Link& link);

Frame Forward(const Chain& chain, const Joints& joints) noexcept;
MovingFrame Forward(const Chain& chain, const JointMotion& motion) noexcept;
Jacobian JacobianAt(const Chain& chain, const Joints& joints) noexcept;

// Velocity and acceleration of the axes that move the tool as `tool` does; their positions stand in `motion` and the
// tool's place is not looked at. With more axes than needed the slowest of all answers. kSingular; kOrientation: there
// are too few axes for such a motion.
Reason SolveMotion(const Chain& chain, const MovingFrame& tool, JointMotion& motion) noexcept;

}  // namespace takt::kinematics
