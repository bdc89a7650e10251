// Delta robot: three arms a third of a turn apart carry a platform that stays level; with or without a rotary C through
// a telescopic shaft. Axes: the three arms, then C; positions in rad. An arm at 0 is level, positive angles point down.
// The axes of the arms lie in Z = 0, the platform moves below.
#pragma once

#include <array>

#include "takt/kinematics/joints.h"

namespace takt::kinematics {

struct DeltaLengths {
  double base_radius = 0;      // [mm] from Z to the axes of the arms
  double platform_radius = 0;  // [mm] from the tool to the joints on the platform
  double upper_arm = 0;        // [mm] above 0
  double lower_arm = 0;        // [mm] above 0
  double rod_spacing = 0;      // [mm] between the two rods of a lower arm; does not affect the motion
};

struct Delta {
  DeltaLengths lengths;
  std::array<KDL::Vector, 3> outward;  // from Z to each arm, unit vectors
  bool rotary = false;                 // has a C axis
};

// `first_arm`: [rad] angle of arm 1 from X about Z; the others follow in the positive sense.
Delta MakeDelta(const DeltaLengths& lengths, double first_arm, bool rotary);

// kOutOfReach: the arms do not meet. kSingular: the lower arms and the platform lie in one plane.
Reason Forward(const Delta& delta, const Joints& joints, Frame& tool) noexcept;
Reason Forward(const Delta& delta, const JointMotion& motion, MovingFrame& tool) noexcept;
Reason JacobianAt(const Delta& delta, const Joints& joints, Jacobian& columns) noexcept;
// Returns only positions with the knees pointing outwards and the platform hanging below them. Without a C axis the
// pose's C is ignored. kSingular also where an upper and a lower arm are in line.
Reason Inverse(const Delta& delta, const Frame& tool, const Configuration&, const Joints& near,
               Joints& joints) noexcept;
Reason SolveMotion(const Delta& delta, const MovingFrame& tool, JointMotion& motion) noexcept;

}  // namespace takt::kinematics
