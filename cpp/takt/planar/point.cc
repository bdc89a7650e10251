#include "takt/planar/point.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/describe.h"
#include "takt/core/maths.h"

namespace takt::planar {
namespace {

constexpr double kSameDirection = 1e-9;          // [rad]
constexpr double kSameCurvature = 1e-9;          // [1/mm]
constexpr double kSameCurvatureRelative = 1e-7;  // of the larger one

}  // namespace

bool SamePoint(const Place& a, const Place& b) noexcept {
  return maths::Hypot(b.x - a.x, b.y - a.y) < kSame;
}

bool SameDirection(const TrackPoint& a, const TrackPoint& b) noexcept {
  return std::abs(std::remainder(b.direction - a.direction, 2 * std::numbers::pi)) < kSameDirection;
}

bool SameCurvature(const TrackPoint& a, const TrackPoint& b) noexcept {
  const double larger = std::max(std::abs(a.curvature), std::abs(b.curvature));
  return std::abs(b.curvature - a.curvature) <= kSameCurvature + kSameCurvatureRelative * larger;
}

bool Same(const TrackPoint& a, const TrackPoint& b) noexcept {
  return SamePoint(a.place, b.place) && SameDirection(a, b) && SameCurvature(a, b);
}

void describe(Description<Place>& d) {
  d.about("A point in the plane.");
  d.required<&Place::x>(unit::mm, "X.");
  d.required<&Place::y>(unit::mm, "Y.");
}

void describe(Description<TrackPoint>& d) {
  d.about("A point of a track, with direction and curvature.");
  d.internal<&TrackPoint::place>("Position of the point.");
  d.internal<&TrackPoint::direction>("Direction in rad, counterclockwise from x.");
  d.internal<&TrackPoint::curvature>("Curvature in 1/mm, above 0 to the left.");
  d.internal<&TrackPoint::curvature_rate>("Rate of the curvature by arc length in 1/mm².");
}

}  // namespace takt::planar
