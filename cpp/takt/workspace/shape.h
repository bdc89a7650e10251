// A solid of the machine file, ready for checks: its file is read, its pose is a frame.
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
  double radius = 0;  // [mm]
  double length = 0;  // [mm] along Z, without the hemispheres
};

using Form = std::variant<BoxParams, CylinderParams, SphereParams, Capsule, std::shared_ptr<const Mesh>>;

// All positions are in the frame to which the shape is fixed: a link, the tool, the base.
struct Shape {
  Form form;
  kinematics::Frame pose;
  KDL::Vector inside;  // a point of the shape
  // The shape is within the hull of balls of one radius about these points.
  std::vector<KDL::Vector> points;
  double radius = 0;
};

struct MadeShape {
  std::optional<Shape> shape;
  std::string path;     // if there is no shape: key of the wrong parameter, "mesh.file"
  std::string problem;  // and the reason
};

// `span`: from the link's axis to the next one; zero if there is none. `folder`: base of relative file paths.
MadeShape MakeShape(const SolidParams& solid, const KDL::Vector& span, std::string_view folder);

// Returns true if `inner` is inside the surface of `outer`. Requires: they do not touch.
bool Swallows(const Shape& outer, const kinematics::Frame& outer_at, const Shape& inner,
              const kinematics::Frame& inner_at) noexcept;

}  // namespace takt::workspace
