#include "takt/workspace/shape.h"

#include <cmath>
#include <filesystem>

namespace takt::workspace {
namespace {

using KDL::Vector;
using kinematics::Frame;

MadeShape Refused(std::string path, std::string problem) {
  return {.shape = std::nullopt, .path = std::move(path), .problem = std::move(problem)};
}

// The points are given in the frame of the pose.
MadeShape Made(Form form, const Frame& pose, std::vector<Vector> points, double radius, const Vector& inside = {}) {
  for (Vector& point : points) point = pose * point;
  return {.shape = Shape{std::move(form), pose, pose * inside, std::move(points), radius}, .path = {}, .problem = {}};
}

std::vector<Vector> Corners(const Vector& lower, const Vector& upper) {
  std::vector<Vector> corners;
  for (unsigned i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(), i & 4 ? upper.z() : lower.z());
  }
  return corners;
}

std::vector<Vector> Ends(double length) {
  return {{0, 0, -length / 2}, {0, 0, length / 2}};
}

// Returns the frame in the middle of the segment, with Z along it.
Frame Along(const Vector& way) {
  const Vector z = way / way.Norm();
  const Vector aside = std::abs(z.x()) < 0.5 ? Vector(1, 0, 0) : Vector(0, 1, 0);
  Vector y = z * aside;
  y.Normalize();
  return {KDL::Rotation(y * z, y, z), way / 2};
}

MadeShape MakeCapsule(const CapsuleParams& p, const Frame& pose, const Vector& span) {
  const double length = p.length.value_or(span.Norm());
  if (!(length > 0)) return Refused("capsule.length", "must be given: here is no link from one axis to the next");
  const Capsule capsule{p.radius, length};
  return Made(capsule, p.length ? pose : Along(span), Ends(length), p.radius);
}

MadeShape MakeMesh(const MeshParams& p, const Frame& pose, std::string_view folder) {
  const std::string path = (std::filesystem::path(folder) / p.file).string();
  std::string why;
  std::optional<Mesh> mesh = LoadStl(path, p.scale, why);
  if (!mesh) return Refused("mesh.file", path + ": " + why);
  auto shared = std::make_shared<const Mesh>(std::move(*mesh));
  const Vector& inside = shared->vertices[shared->triangles.front().front()];
  std::vector<Vector> corners = Corners(shared->lower, shared->upper);
  return Made(std::move(shared), pose, std::move(corners), 0, inside);
}

}  // namespace

MadeShape MakeShape(const SolidParams& solid, const Vector& span, std::string_view folder) {
  const int shapes = solid.box.has_value() + solid.cylinder.has_value() + solid.sphere.has_value() +
                     solid.capsule.has_value() + solid.mesh.has_value();
  if (shapes != 1) {
    return Refused(
        "", "expected exactly one of the keys box, cylinder, sphere, capsule, mesh, found " + std::to_string(shapes));
  }
  const Frame pose = ToFrame(solid.pose);
  if (solid.box) {
    const Vector half(solid.box->x / 2, solid.box->y / 2, solid.box->z / 2);
    return Made(*solid.box, pose, Corners(-half, half), 0);
  }
  if (solid.cylinder) return Made(*solid.cylinder, pose, Ends(solid.cylinder->height), solid.cylinder->radius);
  if (solid.sphere) return Made(*solid.sphere, pose, {Vector()}, solid.sphere->radius);
  if (solid.capsule) return MakeCapsule(*solid.capsule, pose, span);
  return MakeMesh(*solid.mesh, pose, folder);
}

bool Swallows(const Shape& outer, const Frame& outer_at, const Shape& inner, const Frame& inner_at) noexcept {
  const auto* mesh = std::get_if<std::shared_ptr<const Mesh>>(&outer.form);
  return mesh && Encloses(**mesh, (outer_at * outer.pose).Inverse() * (inner_at * inner.inside));
}

}  // namespace takt::workspace
