#include "takt/workspace/params.h"

#include <algorithm>

#include "takt/core/describe.h"

namespace takt::workspace {
namespace {

bool Ordered(const std::optional<double>& lower, const std::optional<double>& upper) {
  return !lower || !upper || *lower < *upper;
}

bool Named(const SolidParams& solid) {
  return !solid.name.empty() && solid.link.empty();
}

}  // namespace

void describe(Description<BoxParams>& d) {
  d.about("A box.");
  d.required<&BoxParams::x>(unit::mm, positive, "Its edge along X.");
  d.required<&BoxParams::y>(unit::mm, positive, "Its edge along Y.");
  d.required<&BoxParams::z>(unit::mm, positive, "Its edge along Z.");
}

void describe(Description<CylinderParams>& d) {
  d.about("A cylinder along Z.");
  d.required<&CylinderParams::radius>(unit::mm, positive, "Its radius.");
  d.required<&CylinderParams::height>(unit::mm, positive, "From end to end.");
}

void describe(Description<SphereParams>& d) {
  d.about("A ball.");
  d.required<&SphereParams::radius>(unit::mm, positive, "Its radius.");
}

void describe(Description<CapsuleParams>& d) {
  d.about("A cylinder along Z with half a ball on both ends.");
  d.required<&CapsuleParams::radius>(unit::mm, positive, "Its radius.");
  d.defaulted<&CapsuleParams::length>(
      unit::mm, positive,
      "Of the cylinder alone. Unset: from the link's own axis to the next one, whatever the pose; only for links.");
}

void describe(Description<MeshParams>& d) {
  d.about("A surface of triangles. What a closed surface encloses belongs to it.");
  d.required<&MeshParams::file>("STL file, binary or text; its place is seen from the machine file.");
  d.defaulted<&MeshParams::scale>(positive, "How many mm 1 in the file is: 1000 for metres.");
}

void describe(Description<SolidParams>& d) {
  using S = SolidParams;
  d.about("Something with a shape: exactly one of box, cylinder, sphere, capsule, mesh. Its middle lies in its pose.");
  d.defaulted<&S::name>("What it is called in messages and by `ignore`; links: unset, as the link.");
  d.defaulted<&S::link>("Links only: the link it is part of, or what the names of several begin with (lower_arm).");
  d.defaulted<&S::box>("A box.");
  d.defaulted<&S::cylinder>("A cylinder.");
  d.defaulted<&S::sphere>("A ball.");
  d.defaulted<&S::capsule>("A cylinder with half a ball on both ends.");
  d.defaulted<&S::mesh>("A surface of triangles from a file.");
  d.defaulted<&S::pose>(
      "Where its middle is: obstacles seen from the base of the mechanism, others from their link or from the tool.");
}

void describe(Description<CornerParams>& d) {
  d.about("A corner of the room; what is unset does not bound it.");
  d.defaulted<&CornerParams::x>(unit::mm, "Along X.");
  d.defaulted<&CornerParams::y>(unit::mm, "Along Y.");
  d.defaulted<&CornerParams::z>(unit::mm, "Along Z.");
}

void describe(Description<BoundsParams>& d) {
  using B = BoundsParams;
  d.about("The room in which the tool stays, seen from the base of the mechanism.");
  d.defaulted<&B::lower>("Its lower corner.");
  d.defaulted<&B::upper>("Its upper corner.");
  d.rule<&B::upper>("must lie above lower", [](const B& b) {
    return Ordered(b.lower.x, b.upper.x) && Ordered(b.lower.y, b.upper.y) && Ordered(b.lower.z, b.upper.z);
  });
}

void describe(Description<WorkspaceParams>& d) {
  using W = WorkspaceParams;
  d.about(
      "What stands in the cell and what shapes the mechanism has. Each path is checked before it starts: nothing "
      "comes nearer to anything else than the margin.");
  d.defaulted<&W::bounds>("The room in which the tool stays.");
  d.defaulted<&W::margin>(unit::mm, positive, "How far apart things must stay.");
  d.defaulted<&W::resolution>(unit::mm, positive, "By how much less than the margin can pass unseen.");
  d.rule<&W::resolution>("must not be above margin", [](const W& w) { return w.resolution <= w.margin; });
  d.defaulted<&W::obstacles>("What stands in the cell.");
  d.rule<&W::obstacles>("must each have a name and no `link`",
                        [](const W& w) { return std::all_of(w.obstacles.begin(), w.obstacles.end(), Named); });
  d.defaulted<&W::links>(
      "What shapes the links of the mechanism have. Unset: with kinematics from URDF what that says for collisions.");
  d.rule<&W::links>("must each say which link they are on", [](const W& w) {
    return std::none_of(w.links.begin(), w.links.end(), [](const SolidParams& s) { return s.link.empty(); });
  });
  d.defaulted<&W::gripper>("What is fixed to the tool.");
  d.rule<&W::gripper>("must each have a name and no `link`",
                      [](const W& w) { return std::all_of(w.gripper.begin(), w.gripper.end(), Named); });
  d.defaulted<&W::ignore>(
      "Pairs that may meet, by name: of obstacles, of links, of parts of the gripper. A name that none of them has "
      "means all whose names begin with it and an underscore.");
  d.defaulted<&W::self_collisions>(
      "Links and gripper are also checked against one another. Neighbours in the mechanism are not, nor what is nearer "
      "than the margin with all axes of the mechanism at 0.");
}

}  // namespace takt::workspace
