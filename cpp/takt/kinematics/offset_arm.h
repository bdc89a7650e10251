// An articulated arm of six axes whose axes 2, 3 and 4 are parallel, and whose wrist is offset: axes 4, 5 and 6 do not
// meet in one point (the arms of Universal Robots and similar ones). Positions of the axes in rad. With all axes at 0
// the arm is upright: axes 1 and 5 are Z, axes 2, 3, 4 and 6 point along Y, and so does Y of the flange, whose origin
// is the intersection of axes 5 and 6.
//
// Closed form, ours: this point W is as far from the plane of the arm as axis 5 is, which gives axis 1 (two solutions);
// seen from there the turn of the flange is one about Y, Z and Y, which gives axes 5 and 6 and the sum of 2 to 4 (two
// solutions); two links in a plane remain (two solutions). The same in Hawkins: Analytic Inverse Kinematics for the
// Universal Robots UR-5/UR-10 Arms (2013).
#pragma once

#include "takt/kinematics/chain.h"

namespace takt::kinematics {

// [mm] in the upright position.
struct OffsetArmLengths {
  double a1 = 0;  // X from axis 1 to axis 2
  double b = 0;   // Y from axis 1 to axis 5
  double c2 = 0;  // Z from axis 2 to axis 3, above 0
  double c3 = 0;  // Z from axis 3 to axis 4, above 0
  double c4 = 0;  // Z from axis 4 to axis 6
};

struct OffsetArm {
  Chain chain;
  OffsetArmLengths lengths;
};

OffsetArm MakeOffsetArm(const OffsetArmLengths& lengths);

// Returns one of eight: shoulder front when W is on the side of axis 1 to which axis 1 points; elbow by the sign of
// axis 3; wrist by the sign of axis 5.
Configuration ConfigurationOf(const OffsetArm& arm, const Joints& joints) noexcept;
// kSingular with W as far from axis 1 as axis 5 is, with the arm stretched or folded, and with axis 5 at 0 or 180
// degrees (axes 4 and 6 parallel).
Reason Inverse(const OffsetArm& arm, const Frame& tool, const Configuration& configuration, const Joints& near,
               Joints& joints) noexcept;

}  // namespace takt::kinematics
