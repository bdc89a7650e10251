#include "takt/workspace/scene.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <set>
#include <vector>

namespace takt::workspace {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;
using Object = fcl::CollisionObjectd;
using kinematics::Frame;

Geometry GeometryOf(const BoxParams& box) {
  return std::make_shared<fcl::Boxd>(box.x, box.y, box.z);
}
Geometry GeometryOf(const CylinderParams& cylinder) {
  return std::make_shared<fcl::Cylinderd>(cylinder.radius, cylinder.height);
}
Geometry GeometryOf(const SphereParams& sphere) {
  return std::make_shared<fcl::Sphered>(sphere.radius);
}
Geometry GeometryOf(const Capsule& capsule) {
  return std::make_shared<fcl::Capsuled>(capsule.radius, capsule.length);
}
Geometry GeometryOf(const std::shared_ptr<const Mesh>& mesh) {
  std::vector<fcl::Vector3d> vertices;
  for (const KDL::Vector& v : mesh->vertices) vertices.emplace_back(v.x(), v.y(), v.z());
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh->triangles) triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

fcl::Transform3d TransformOf(const Frame& frame) {
  fcl::Transform3d transform;
  transform.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.M.data);
  transform.translation() = Eigen::Map<const fcl::Vector3d>(frame.p.data);
  transform.makeAffine();
  return transform;
}

// Distances of `within` or more are not computed exactly, and returned as `within`.
double DistanceOf(const Object& a, const Object& b, double within) {
  // FCL's other solver is occasionally wrong by many mm, and both are less accurate in metres than in mm.
  fcl::DistanceRequestd request;
  request.enable_nearest_points = false;
  request.enable_signed_distance = false;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result(within);
  try {
    const double distance = fcl::distance(&a, &b, request, result);
    if (distance > 0) return std::min(distance, within);
  } catch (const std::exception&) {
    // FCL failed: unknown is treated as touching.
  }
  return 0;
}

}  // namespace

struct Scene::Inside {
  struct Body {
    Object object;
    Frame pose;
    std::set<const Object*> ignored;

    void MoveTo(const Frame& at) {
      object.setTransform(TransformOf(at * pose));
      object.computeAABB();
    }
  };

  // Registers all objects at once. The manager's setup() would use the C library's logarithm to balance the tree.
  void MakeTree() {
    std::vector<Object*> objects;
    for (const auto& object : obstacles) objects.push_back(object.get());
    tree.clear();
    tree.registerObjects(objects);
    ready = true;
  }

  // The managers keep pointers to objects.
  std::vector<std::unique_ptr<Object>> obstacles;
  std::vector<Body> bodies;
  fcl::DynamicAABBTreeCollisionManagerd tree;
  bool ready = false;
};

Scene::Scene() : inside_(std::make_unique<Inside>()) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

std::size_t Scene::AddObstacle(const Shape& shape) {
  const Geometry geometry = std::visit([](const auto& form) { return GeometryOf(form); }, shape.form);
  inside_->obstacles.push_back(std::make_unique<Object>(geometry, TransformOf(shape.pose)));
  inside_->ready = false;
  return inside_->obstacles.size() - 1;
}

std::size_t Scene::AddBody(const Shape& shape) {
  const Geometry geometry = std::visit([](const auto& form) { return GeometryOf(form); }, shape.form);
  inside_->bodies.push_back({Object(geometry), shape.pose, {}});
  return inside_->bodies.size() - 1;
}

void Scene::Ignore(std::size_t body, std::size_t obstacle) {
  inside_->bodies[body].ignored.insert(inside_->obstacles[obstacle].get());
}

Scene::Nearest Scene::NearestObstacle(std::size_t body, const Frame& at, double within) {
  Inside::Body& moved = inside_->bodies[body];
  moved.MoveTo(at);
  if (!inside_->ready) inside_->MakeTree();

  struct Query {
    const Inside::Body& body;
    double distance;
    const Object* nearest = nullptr;
  } query{moved, within};
  const auto look = [](Object* a, Object* b, void* data, double& nearest) {
    Query& q = *static_cast<Query*>(data);
    const Object* other = a == &q.body.object ? b : a;
    if (!q.body.ignored.contains(other)) {
      const double distance = DistanceOf(q.body.object, *other, q.distance);
      if (distance < q.distance) {
        q.distance = distance;
        q.nearest = other;
      }
    }
    nearest = q.distance;
    return nearest <= 0;
  };
  inside_->tree.distance(&moved.object, &query, look);

  Nearest nearest{.distance = query.distance};
  while (query.nearest && inside_->obstacles[nearest.obstacle].get() != query.nearest) ++nearest.obstacle;
  return nearest;
}

double Scene::Between(std::size_t a, const Frame& a_at, std::size_t b, const Frame& b_at, double within) {
  inside_->bodies[a].MoveTo(a_at);
  inside_->bodies[b].MoveTo(b_at);
  return DistanceOf(inside_->bodies[a].object, inside_->bodies[b].object, within);
}

}  // namespace takt::workspace
