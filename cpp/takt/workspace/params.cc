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
  d.required<&BoxParams::x>(unit::mm, positive, "Edge length along X.");
  d.required<&BoxParams::y>(unit::mm, positive, "Edge length along Y.");
  d.required<&BoxParams::z>(unit::mm, positive, "Edge length along Z.");
}

void describe(Description<CylinderParams>& d) {
  d.about("A cylinder along Z.");
  d.required<&CylinderParams::radius>(unit::mm, positive, "Radius.");
  d.required<&CylinderParams::height>(unit::mm, positive, "Length from end to end.");
}

void describe(Description<SphereParams>& d) {
  d.about("A sphere.");
  d.required<&SphereParams::radius>(unit::mm, positive, "Radius.");
}

void describe(Description<CapsuleParams>& d) {
  d.about("A cylinder along Z with a hemisphere on both ends.");
  d.required<&CapsuleParams::radius>(unit::mm, positive, "Radius.");
  d.defaulted<&CapsuleParams::length>(
      unit::mm, positive,
      "Length of the cylinder alone. Unset: from the link's own axis to the next one, in every pose; links only.");
}

void describe(Description<MeshParams>& d) {
  d.about("A triangle mesh. The volume enclosed by a closed mesh belongs to it.");
  d.required<&MeshParams::file>("STL file, binary or text; relative to the machine file.");
  d.defaulted<&MeshParams::scale>(positive, "Scale from units of the file to mm: 1000 for metres.");
}

void describe(Description<SolidParams>& d) {
  using S = SolidParams;
  d.about("A body of one shape: exactly one of box, cylinder, sphere, capsule, mesh, centred in its pose.");
  d.defaulted<&S::name>("Name in messages and in `ignore`; links may leave it unset to use the name of the link.");
  d.defaulted<&S::link>(
      "Links only: the link to which it belongs, or the common beginning of the names of several (lower_arm).");
  d.defaulted<&S::box>("A box.");
  d.defaulted<&S::cylinder>("A cylinder.");
  d.defaulted<&S::sphere>("A sphere.");
  d.defaulted<&S::capsule>("A cylinder with a hemisphere on both ends.");
  d.defaulted<&S::mesh>("A triangle mesh from a file.");
  d.defaulted<&S::pose>(
      "Pose of the centre: of obstacles in the base frame of the mechanism, of others in the frame of their link or of "
      "the tool.");
}

void describe(Description<CornerParams>& d) {
  d.about("A corner of the workspace; unset coordinates are unbounded.");
  d.defaulted<&CornerParams::x>(unit::mm, "Coordinate along X.");
  d.defaulted<&CornerParams::y>(unit::mm, "Coordinate along Y.");
  d.defaulted<&CornerParams::z>(unit::mm, "Coordinate along Z.");
}

void describe(Description<BoundsParams>& d) {
  using B = BoundsParams;
  d.about("Bounds of the tool position, in the base frame of the mechanism.");
  d.defaulted<&B::lower>("Lower corner.");
  d.defaulted<&B::upper>("Upper corner.");
  d.rule<&B::upper>("must lie above lower", [](const B& b) {
    return Ordered(b.lower.x, b.upper.x) && Ordered(b.lower.y, b.upper.y) && Ordered(b.lower.z, b.upper.z);
  });
}

void describe(Description<WorkspaceParams>& d) {
  using W = WorkspaceParams;
  d.about(
      "Obstacles of the cell and shapes of the mechanism. Each path is checked before it starts: all distances must be "
      "at least the margin.");
  d.defaulted<&W::bounds>("Bounds of the tool position.");
  d.defaulted<&W::margin>(unit::mm, positive, "Smallest permitted distance between bodies.");
  d.defaulted<&W::resolution>(unit::mm, positive, "Largest violation of the margin that may remain undetected.");
  d.rule<&W::resolution>("must not be above margin", [](const W& w) { return w.resolution <= w.margin; });
  d.defaulted<&W::obstacles>("Obstacles in the cell.");
  d.rule<&W::obstacles>("must each have a name and no `link`",
                        [](const W& w) { return std::all_of(w.obstacles.begin(), w.obstacles.end(), Named); });
  d.defaulted<&W::links>(
      "Shapes of the links of the mechanism. Unset: with kinematics from URDF, its collision shapes.");
  d.rule<&W::links>("must each say which link they are on", [](const W& w) {
    return std::none_of(w.links.begin(), w.links.end(), [](const SolidParams& s) { return s.link.empty(); });
  });
  d.defaulted<&W::gripper>("Shapes that are fixed to the tool.");
  d.rule<&W::gripper>("must each have a name and no `link`",
                      [](const W& w) { return std::all_of(w.gripper.begin(), w.gripper.end(), Named); });
  d.defaulted<&W::ignore>(
      "Pairs that may come into contact, by name: obstacles, links, parts of the gripper. A name that none of them has "
      "stands for all whose names begin with it and an underscore.");
  d.defaulted<&W::self_collisions>(
      "Also checks links and gripper against one another, except for neighbours in the mechanism and pairs that are "
      "nearer than the margin with all axes of the mechanism at 0.");
}

}  // namespace takt::workspace
