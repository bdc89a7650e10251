// Polygons as prisms of FCL. For tests and benchmarks.
#pragma once

#include <fcl/geometry/shape/convex.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <memory>
#include <vector>

#include "takt/planar/point.h"

namespace takt::planar::testing {

using Prism = std::shared_ptr<fcl::Convexd>;

// Height 100 mm. Requires: the polygon is convex and counterclockwise.
inline Prism PrismOf(const std::vector<Place>& polygon) {
  const int n = static_cast<int>(polygon.size());
  auto corners = std::make_shared<std::vector<fcl::Vector3d>>();
  for (const double z : {-50.0, 50.0}) {
    for (const Place& p : polygon) corners->emplace_back(p.x, p.y, z);
  }
  auto faces = std::make_shared<std::vector<int>>();
  faces->push_back(n);
  for (int i = n - 1; i >= 0; --i) faces->push_back(i);
  faces->push_back(n);
  for (int i = 0; i < n; ++i) faces->push_back(n + i);
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    faces->insert(faces->end(), {4, i, next, n + next, n + i});
  }
  return std::make_shared<fcl::Convexd>(corners, n + 2, faces);
}

inline bool Collide(const fcl::Convexd& a, const fcl::Convexd& b) {
  fcl::CollisionRequestd request;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd result;
  const fcl::Transform3d here = fcl::Transform3d::Identity();
  return fcl::collide(&a, here, &b, here, request, result) > 0;
}

}  // namespace takt::planar::testing
