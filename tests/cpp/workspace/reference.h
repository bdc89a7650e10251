// The distance of two shapes without FCL: exact for balls, otherwise by alternating projections between both. Slow.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

#include "takt/workspace/shape.h"

namespace takt::workspace::testing {

// Returns the point of a box, cylinder, ball or capsule that is nearest to `point`, both in its pose.
inline KDL::Vector NearestIn(const Form& form, const KDL::Vector& p) {
  const auto round = [](const KDL::Vector& middle, const KDL::Vector& point, double radius) {
    const KDL::Vector way = point - middle;
    const double far = way.Norm();
    return far > radius ? middle + way * (radius / far) : point;
  };
  if (const auto* box = std::get_if<BoxParams>(&form)) {
    return {std::clamp(p.x(), -box->x / 2, box->x / 2), std::clamp(p.y(), -box->y / 2, box->y / 2),
            std::clamp(p.z(), -box->z / 2, box->z / 2)};
  }
  if (const auto* cylinder = std::get_if<CylinderParams>(&form)) {
    const double z = std::clamp(p.z(), -cylinder->height / 2, cylinder->height / 2);
    return round({0, 0, z}, {p.x(), p.y(), z}, cylinder->radius);
  }
  if (const auto* capsule = std::get_if<Capsule>(&form)) {
    return round({0, 0, std::clamp(p.z(), -capsule->length / 2, capsule->length / 2)}, p, capsule->radius);
  }
  return round({}, p, std::get<SphereParams>(form).radius);
}

inline double ReferenceDistance(const Form& a, const kinematics::Frame& a_at, const Form& b,
                                const kinematics::Frame& b_at) {
  KDL::Vector p = a_at.p;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 100'000; ++i) {
    const KDL::Vector q = b_at * NearestIn(b, b_at.Inverse() * p);
    p = a_at * NearestIn(a, a_at.Inverse() * q);
    const double distance = (p - q).Norm();
    if (distance < 1e-6) return 0;
    if (i % 20 == 19) {
      if (before - distance < 1e-9) return distance;
      before = distance;
    }
  }
  return before;
}

}  // namespace takt::workspace::testing
