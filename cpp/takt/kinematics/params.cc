#include "takt/kinematics/params.h"

#include <algorithm>
#include <cmath>

#include "takt/core/describe.h"

namespace takt::kinematics {

void describe(Description<GantryParams>& d) {
  using G = GantryParams;
  d.about("A gantry: each axis moves one coordinate of the tool.");
  d.required<&G::axes>("Coordinate that each axis moves, in the order of the group's axes: x, y, z, c.");
  d.rule<&G::axes>("must name x, y or z, and nothing twice", [](const G& g) {
    const auto count = [&](Coordinate c) { return std::count(g.axes.begin(), g.axes.end(), c); };
    const auto linear = count(Coordinate::kX) + count(Coordinate::kY) + count(Coordinate::kZ);
    return linear > 0 && std::all_of(g.axes.begin(), g.axes.end(), [&](Coordinate c) { return count(c) == 1; });
  });
}

void describe(Description<CoreXyParams>& d) {
  using C = CoreXyParams;
  d.about("A gantry on two crossed belts (CoreXY, H-bot). X is (A1 + A2) / 2, Y is (A1 - A2) / 2; A3 on are Z and C.");
  d.defaulted<&C::with_z>("There is a Z axis.");
  d.defaulted<&C::with_c>("There is a C axis, after Z.");
}

void describe(Description<ScaraParams>& d) {
  using S = ScaraParams;
  d.about("A SCARA. Axes: arm 1, arm 2, Z, C; at 0 both arms point along X.");
  d.required<&S::first_arm>(unit::mm, positive, "Length of the first arm.");
  d.required<&S::second_arm>(unit::mm, positive, "Length of the second arm.");
  d.defaulted<&S::height>(unit::mm, "Z of the tool with the Z axis at 0.");
}

void describe(Description<DeltaParams>& d) {
  using D = DeltaParams;
  d.about("A Delta robot. Axes: three arms, level at 0 and positive downwards, then C if there is one.");
  d.required<&D::base_radius>(unit::mm, not_negative, "Distance from Z to the axes of the arms.");
  d.required<&D::platform_radius>(unit::mm, not_negative, "Distance from the tool to the joints on the platform.");
  d.required<&D::upper_arm>(unit::mm, positive, "Length of the upper arms, driven by the motors.");
  d.required<&D::lower_arm>(unit::mm, positive, "Length of the lower arms, which carry the platform.");
  d.defaulted<&D::rod_spacing>(
      unit::mm, not_negative,
      "Distance between the two rods of a lower arm. Only for checks of the workspace; no effect on the motion.");
  d.defaulted<&D::first_arm_deg>(unit::deg, "Angle of arm 1 from X about Z; the other arms are 120 and 240 further.");
  d.defaulted<&D::rotary>("There is a C axis, driven through a telescopic shaft.");
  d.rule<&D::lower_arm>(
      "must be long enough for the arms to meet: upper_arm + lower_arm above base_radius - platform_radius",
      [](const D& p) { return std::abs(p.base_radius - p.platform_radius) < p.upper_arm + p.lower_arm; });
}

void describe(Description<SixAxisParams>& d) {
  using S = SixAxisParams;
  d.about(
      "An articulated arm of six axes with a spherical wrist, axes 2 and 3 parallel. Lengths in the upright position, "
      "all axes at 0: axis 1 is Z, axes 2, 3 and 5 point along Y, axes 4 and 6 and Z of the flange along Z.");
  d.defaulted<&S::a1>(unit::mm, "X from axis 1 to axis 2.");
  d.defaulted<&S::a2>(unit::mm, "X from axis 3 to the wrist; negative: the wrist is behind.");
  d.defaulted<&S::b>(unit::mm, "Y from axis 1 to the wrist.");
  d.defaulted<&S::c1>(unit::mm, "Z from the base to axis 2.");
  d.required<&S::c2>(unit::mm, positive, "Z from axis 2 to axis 3.");
  d.required<&S::c3>(unit::mm, positive, "Z from axis 3 to the wrist.");
  d.defaulted<&S::c4>(unit::mm, "Z from the wrist to the flange.");
}

void describe(Description<SerialParams>& d) {
  using S = SerialParams;
  d.about("Any chain of up to eight axes from a URDF file, solved numerically.");
  d.required<&S::urdf>("The URDF file, relative to the machine file, or its text, which begins with <.");
  d.defaulted<&S::base>("Link at which the chain begins; empty: the root.");
  d.defaulted<&S::tip>("Link that carries the tool; empty: the only end.");
}

void describe(Description<JointParams>& d) {
  using J = JointParams;
  d.about("Zero and direction of an axis, where they differ from those of its mechanism.");
  d.defaulted<&J::zero>(unit::u, "Position of the axis at which the mechanism's own angle or position is 0.");
  d.defaulted<&J::invert>("The axis counts in the opposite direction.");
}

void describe(Description<KinematicsParams>& d) {
  using K = KinematicsParams;
  d.about("Kinematics of a group: exactly one mechanism that moves its tool.");
  d.defaulted<&K::gantry>("A gantry of one to three linear axes, with or without C.");
  d.defaulted<&K::core_xy>("A gantry on two crossed belts.");
  d.defaulted<&K::scara>("A SCARA.");
  d.defaulted<&K::delta>("A Delta robot.");
  d.defaulted<&K::six_axis>("An articulated arm with a spherical wrist.");
  d.defaulted<&K::serial>("Any serial chain from URDF.");
  d.defaulted<&K::joints>(
      "Zero and direction of each axis; empty: those of the mechanism. Lengths in mm, angles in deg.");
}

}  // namespace takt::kinematics
