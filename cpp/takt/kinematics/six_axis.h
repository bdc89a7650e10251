// An articulated arm of six axes whose last three meet in one point (spherical wrist), axes 2 and 3 parallel. Positions
// of the axes in rad. With all axes at 0 the arm is upright: axis 1 is Z, axes 2, 3 and 5 point along Y, axes 4 and 6
// along Z, and so does Z of the flange.
#pragma once

#include "takt/kinematics/chain.h"

namespace takt::kinematics {

// [mm] in the upright position. Names as in the literature on these arms.
struct SixAxisLengths {
  double a1 = 0;  // X from axis 1 to axis 2
  double a2 = 0;  // X from axis 3 to the wrist
  double b = 0;   // Y from axis 1 to the wrist
  double c1 = 0;  // Z from the base to axis 2
  double c2 = 0;  // Z from axis 2 to axis 3, above 0
  double c3 = 0;  // Z from axis 3 to the wrist
  double c4 = 0;  // Z from the wrist to the flange
};

struct SixAxis {
  Chain chain;
  SixAxisLengths lengths;
  double forearm = 0;        // [mm] from axis 3 to the wrist
  double forearm_angle = 0;  // [rad] of that line from Z
};

SixAxis MakeSixAxis(const SixAxisLengths& lengths);

// Returns one of eight: shoulder front when the wrist is on the side of axis 1 to which axis 1 points; elbow positive
// when axis 3 bends the line from axis 2 to the wrist forwards (in front of the arm that is the elbow up); wrist by the
// sign of axis 5.
Configuration ConfigurationOf(const SixAxis& arm, const Joints& joints) noexcept;
// kSingular with the wrist above axis 1, with the arm stretched or folded, and with axis 5 at 0 (axes 4 and 6 in line).
Reason Inverse(const SixAxis& arm, const Frame& tool, const Configuration& configuration, const Joints& near,
               Joints& joints) noexcept;

}  // namespace takt::kinematics
