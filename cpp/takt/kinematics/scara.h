// SCARA: two arms that turn about vertical axes, then a vertical linear axis, then a rotation about Z.
// Axes: arm 1, arm 2, Z, C; positions in mm and rad. At 0 both arms point along X.
#pragma once

#include "takt/kinematics/chain.h"

namespace takt::kinematics {

struct Scara {
  Chain chain;
  double first_arm = 0;   // [mm]
  double second_arm = 0;  // [mm]
  double height = 0;      // [mm] Z of the tool with the Z axis at 0
};

Scara MakeScara(double first_arm, double second_arm, double height);

Configuration ConfigurationOf(const Scara& scara, const Joints& joints) noexcept;
// The elbow selects one of two: a positive one is a right arm (the elbow to the right of the line from base to tool).
// kSingular with the arms stretched or folded.
Reason Inverse(const Scara& scara, const Frame& tool, const Configuration& configuration, const Joints& near,
               Joints& joints) noexcept;

}  // namespace takt::kinematics
