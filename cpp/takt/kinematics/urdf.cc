#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "takt/kinematics/serial.h"
#include "takt/kinematics/urdf_angles.h"
#include "takt/kinematics/urdf_tree.h"
#include "takt/kinematics/xml_shape.h"

namespace takt::kinematics {
namespace {

constexpr double kMetre = 1000;           // [mm] URDF counts in metres
constexpr std::size_t kMostLevels = 100;  // nested elements; URDF itself has 6

Frame ToFrame(const KDL::Rotation& rotation, const urdf::Vector3& p) {
  return {rotation, KDL::Vector(p.x, p.y, p.z) * kMetre};
}

Frame OriginOf(const urdf::Joint& joint, const UrdfAngles& angles) {
  return ToFrame(angles.joints.at(joint.name), joint.parent_to_joint_origin_transform.position);
}

// Cuts the name between two characters of UTF-8.
Name Cut(const std::string& name) {
  std::size_t size = std::min(name.size(), Name::kCapacity);
  while (size > 0 && size < name.size() && (static_cast<unsigned char>(name[size]) & 0xC0) == 0x80) --size;
  return Name::Of(name.substr(0, size));
}

std::string Quoted(const std::string& name) {
  return "'" + name + "'";
}

// Returns null if it cannot be read; the reader has then printed the reason to stderr.
urdf::ModelInterfaceSharedPtr Parsed(const std::string& xml) {
  if (ShapeOf(xml, kMostLevels) != XmlCheck::kGood || !LinkInLoop(xml).empty()) return nullptr;
  try {
    return urdf::parseURDF(xml);
  } catch (const std::exception&) {
    return nullptr;
  }
}

// Returns the joints from base to tip; empty, with the reason in `why`, if they are not connected.
std::vector<urdf::JointConstSharedPtr> Way(const urdf::ModelInterface& model, const std::string& base,
                                           const std::string& tip, std::string& why) {
  std::vector<urdf::JointConstSharedPtr> way;
  urdf::LinkConstSharedPtr link = model.getLink(tip);
  if (!link) why = "the URDF has no link " + Quoted(tip);
  while (link && link->name != base) {
    if (!link->parent_joint) {
      why = model.getLink(base) ? "no joints lead from " + Quoted(base) + " to " + Quoted(tip)
                                : "the URDF has no link " + Quoted(base);
      return {};
    }
    way.push_back(link->parent_joint);
    link = model.getLink(link->parent_joint->parent_link_name);
  }
  std::reverse(way.begin(), way.end());
  if (why.empty() && way.empty()) why = "base and tip are the same link";
  return way;
}

// Returns the first link that is the child of two joints; empty if there is none.
std::string LinkWithTwoParents(const urdf::ModelInterface& model) {
  std::set<std::string> links;
  for (const auto& [name, joint] : model.joints_) {
    if (!links.insert(joint->child_link_name).second) return joint->child_link_name;
  }
  return {};
}

// Returns the only link without children.
std::string OnlyEnd(const urdf::ModelInterface& model, std::string& why) {
  std::string end;
  for (const auto& [name, link] : model.links_) {
    if (!link->child_joints.empty()) continue;
    if (!end.empty()) {
      why = "the URDF has several ends (" + end + ", " + name + " ...): say which one is the tip";
      return {};
    }
    end = name;
  }
  return end;
}

// Returns the pose in `base` of `base` and of each link above it up to the first joint that moves.
std::map<std::string, Frame> FixedAbove(const urdf::ModelInterface& model, const UrdfAngles& angles,
                                        const std::string& base) {
  std::map<std::string, Frame> poses;
  Frame pose;
  urdf::LinkConstSharedPtr link = model.getLink(base);
  while (link) {
    poses[link->name] = pose;
    const urdf::JointConstSharedPtr joint = link->parent_joint;
    if (!joint || joint->type != urdf::Joint::FIXED) break;
    pose = pose * OriginOf(*joint, angles).Inverse();
    link = model.getLink(joint->parent_link_name);
  }
  return poses;
}

// Returns the number of the axis whose link carries link `of`, 0 for the base, and in `pose` the pose of `of` on this
// link; nothing if an axis that does not belong to the chain lies in between.
std::optional<std::size_t> CarrierOf(const urdf::ModelInterface& model, const UrdfAngles& angles,
                                     const urdf::LinkConstSharedPtr& of,
                                     const std::vector<urdf::JointConstSharedPtr>& axes,
                                     const std::map<std::string, Frame>& above, Frame& pose) {
  urdf::LinkConstSharedPtr link = of;
  pose = Frame::Identity();
  for (;;) {
    if (const auto found = above.find(link->name); found != above.end()) {
      pose = found->second * pose;
      return 0;
    }
    const urdf::JointConstSharedPtr joint = link->parent_joint;
    if (!joint) return std::nullopt;
    if (joint->type != urdf::Joint::FIXED) {
      const auto axis = std::find(axes.begin(), axes.end(), joint);
      if (axis == axes.end()) return std::nullopt;
      return static_cast<std::size_t>(axis - axes.begin()) + 1;
    }
    pose = OriginOf(*joint, angles) * pose;
    link = model.getLink(joint->parent_link_name);
  }
}

bool TakeGeometry(const urdf::Geometry& geometry, UrdfShape& shape) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
    shape.kind = UrdfShape::Kind::kBox;
    shape.size = {box->dim.x * kMetre, box->dim.y * kMetre, box->dim.z * kMetre};
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
    shape.kind = UrdfShape::Kind::kCylinder;
    shape.size = {cylinder->radius * kMetre, cylinder->length * kMetre, 0};
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
    shape.kind = UrdfShape::Kind::kSphere;
    shape.size = {sphere->radius * kMetre, 0, 0};
  } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&geometry)) {
    shape.kind = UrdfShape::Kind::kMesh;
    shape.size = {mesh->scale.x * kMetre, mesh->scale.y * kMetre, mesh->scale.z * kMetre};
    shape.mesh = mesh->filename;
  } else {
    return false;
  }
  return true;
}

// Returns the moving joints from `base` (empty: the root) to `tip`.
std::vector<urdf::JointConstSharedPtr> AxesOf(const urdf::ModelInterface& model, const std::string& base,
                                              const std::string& tip) {
  std::string why;
  std::vector<urdf::JointConstSharedPtr> axes = Way(model, base.empty() ? model.getRoot()->name : base, tip, why);
  std::erase_if(axes, [](const urdf::JointConstSharedPtr& joint) { return joint->type == urdf::Joint::FIXED; });
  return axes;
}

}  // namespace

UrdfNames ReadUrdfNames(const std::string& xml, const std::string& base, const std::string& tip) {
  const urdf::ModelInterfaceSharedPtr model = Parsed(xml);
  if (!model) return {};
  std::string why;
  UrdfNames names{.joints = {}, .tip = tip.empty() ? OnlyEnd(*model, why) : tip};
  for (const urdf::JointConstSharedPtr& joint : AxesOf(*model, base, names.tip)) names.joints.push_back(joint->name);
  return names;
}

std::vector<UrdfShape> ReadUrdfShapes(const std::string& xml, const std::string& base, const std::string& tip,
                                      UrdfPurpose purpose) {
  const urdf::ModelInterfaceSharedPtr model = Parsed(xml);
  if (!model) return {};
  std::string why;
  const std::string begin = base.empty() ? model->getRoot()->name : base;
  const std::vector<urdf::JointConstSharedPtr> axes = AxesOf(*model, begin, tip.empty() ? OnlyEnd(*model, why) : tip);
  const UrdfAngles angles = ReadUrdfAngles(xml);
  const std::map<std::string, Frame> above = FixedAbove(*model, angles, begin);
  std::vector<UrdfShape> shapes;
  for (const auto& [name, link] : model->links_) {
    Frame at;
    const std::optional<std::size_t> axis = CarrierOf(*model, angles, link, axes, above, at);
    if (!axis) continue;
    const auto take = [&](const auto& given, const std::vector<KDL::Rotation>& rotations) {
      for (std::size_t i = 0; i < given.size(); ++i) {
        const Frame origin = ToFrame(rotations.at(i), given[i]->origin.position);
        UrdfShape shape{.link = name, .axis = *axis, .mesh = {}, .pose = at * origin};
        if (given[i]->geometry && TakeGeometry(*given[i]->geometry, shape)) shapes.push_back(shape);
      }
    };
    if (purpose == UrdfPurpose::kCollision) {
      take(link->collision_array, angles.collisions.at(name));
    } else {
      take(link->visual_array, angles.visuals.at(name));
    }
  }
  return shapes;
}

std::optional<UrdfChain> ReadUrdf(const std::string& xml, const std::string& base, const std::string& tip,
                                  std::string& why) {
  why.clear();
  const urdf::ModelInterfaceSharedPtr model = Parsed(xml);
  if (!model) {
    why = "this is no URDF that can be read";
    if (ShapeOf(xml, kMostLevels) == XmlCheck::kTooDeep) {
      why += ": its elements nest deeper than " + std::to_string(kMostLevels) + " levels";
    } else if (const std::string link = LinkInLoop(xml); !link.empty()) {
      why += ": link " + Quoted(link) + " is in a loop of joints, or hangs on one";
    }
    return std::nullopt;
  }
  if (const std::string link = LinkWithTwoParents(*model); !link.empty()) {
    why = "link " + Quoted(link) + " hangs on two joints, which a chain cannot";
    return std::nullopt;
  }
  const std::string end = tip.empty() ? OnlyEnd(*model, why) : tip;
  if (!why.empty()) return std::nullopt;
  const UrdfAngles angles = ReadUrdfAngles(xml);
  UrdfChain out;
  Frame rest;  // after the last axis
  for (const urdf::JointConstSharedPtr& joint : Way(*model, base.empty() ? model->getRoot()->name : base, end, why)) {
    rest = rest * OriginOf(*joint, angles);
    if (joint->type == urdf::Joint::FIXED) continue;
    const bool slides = joint->type == urdf::Joint::PRISMATIC;
    if (!slides && joint->type != urdf::Joint::REVOLUTE && joint->type != urdf::Joint::CONTINUOUS) {
      why = "joint " + Quoted(joint->name) + " neither slides nor turns about one axis";
    } else if (joint->mimic) {
      why = "joint " + Quoted(joint->name) + " copies another one, which a chain cannot";
    } else if (out.chain.count == kMaxJoints) {
      why = "the chain has more than " + std::to_string(kMaxJoints) + " axes";
    }
    KDL::Vector axis(joint->axis.x, joint->axis.y, joint->axis.z);
    if (why.empty() && !(axis.Normalize() > 1e-9))
      why = "joint " + Quoted(joint->name) + " has an axis without a direction";
    if (!why.empty()) return std::nullopt;
    if (joint->limits && joint->type != urdf::Joint::CONTINUOUS) {
      const double unit = slides ? kMetre : 1;
      out.limits[out.chain.count] = {joint->limits->lower * unit, joint->limits->upper * unit};
    }
    out.links[out.chain.count] = Cut(joint->child_link_name);
    Append(out.chain, {rest, axis, slides ? JointKind::kLinear : JointKind::kRotary});
    rest = Frame::Identity();
  }
  if (why.empty() && out.chain.count == 0) why = "the chain has no axes";
  if (!why.empty()) return std::nullopt;
  out.chain.tool = rest;
  out.chain.length += rest.p.Norm();
  return out;
}

}  // namespace takt::kinematics
