// A solid of the machine file with all that can be said about it: its file is read, its pose is a frame.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "takt/kinematics/frames.h"
#include "takt/workspace/mesh.h"
#include "takt/workspace/params.h"

namespace takt::workspace {

struct Capsule {
  double radius = 0;  // mm
  double length = 0;  // mm, along Z, without the half balls
};

using Form = std::variant<BoxParams, CylinderParams, SphereParams, Capsule, std::shared_ptr<const Mesh>>;

// All places are seen from what the shape is fixed to: a link, the tool, the base.
struct Shape {
  Form form;
  kinematics::Frame pose;
  KDL::Vector inside;  // one of its points
  // It lies within the hull of balls of one radius about these points.
  std::vector<KDL::Vector> points;
  double radius = 0;
};

struct MadeShape {
  std::optional<Shape> shape;
  std::string path;     // without: which key of the solid is wrong, "mesh.file"
  std::string problem;  // and why
};

// `span`: from the link's axis to the next one; zero for what has none. `folder`: where paths of files begin.
MadeShape MakeShape(const SolidParams& solid, const KDL::Vector& span, std::string_view folder);

// Whether `inner` lies inside of the surface of `outer`. They do not touch.
bool Swallows(const Shape& outer, const kinematics::Frame& outer_at, const Shape& inner,
              const kinematics::Frame& inner_at) noexcept;

}  // namespace takt::workspace
