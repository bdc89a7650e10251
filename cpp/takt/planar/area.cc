#include "takt/planar/area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/angle.h"
#include "takt/core/describe.h"
#include "takt/core/maths.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

// Returns true if the mover, rotating in place, covers the full circle through its corners.
bool CoversCircle(const Area& area) {
  if (area.mover.any_angle) return true;
  if (!(area.most_c > area.least_c)) return false;
  // Angle between adjacent corners, seen from the centre: each corner has to reach the start of the next one.
  const double corner = 2 * maths::Atan2(area.mover.height, area.mover.width);
  return (area.most_c - area.least_c) * kDegree >= std::max(corner, std::numbers::pi - corner);
}

// The hull of an area: the Minkowski sum of the hull of its places and of the hull of all that the mover covers in
// place.
struct Hull {
  std::array<Flat, 7> places;
  int count = 0;
  double radius = 0;  // margin around it all
  // Corners of the mover in place, without their mirror images: two at the least angle, two at the largest.
  std::array<Flat, 4> corners{Flat::Zero(), Flat::Zero(), Flat::Zero(), Flat::Zero()};
  double far = 0;  // distance of the corners from the centre
  bool turns = false;
  // Normals of its sides at the middle angle; if it rotates, also the directions of its corners.
  std::array<Flat, 6> normals;
  int normal_count = 0;
};

Hull HullOf(const Area& area) {
  Hull hull;
  hull.count = area.count;
  for (int i = 0; i < hull.count; ++i)
    hull.places[static_cast<std::size_t>(i)] = ToFlat(area.places[static_cast<std::size_t>(i)]);
  hull.radius = area.margin;
  const double along = area.mover.width / 2, across = area.mover.height / 2;
  if (along == 0 && across == 0) return hull;
  hull.far = maths::Hypot(along, across);
  if (CoversCircle(area)) {
    hull.radius += hull.far;
    return hull;
  }
  hull.turns = area.most_c > area.least_c;
  const Flat middle = Heading((area.least_c + area.most_c) / 2 * kDegree);
  hull.normals = {middle, Left(middle)};
  hull.normal_count = 2;
  const auto corners = [&](const Flat& heading, std::size_t first) {
    hull.corners[first] = along * heading + across * Left(heading);
    hull.corners[first + 1] = along * heading - across * Left(heading);
  };
  corners(hull.turns ? Heading(area.least_c * kDegree) : middle, 0);
  if (!hull.turns) return hull;
  corners(Heading(area.most_c * kDegree), 2);
  for (const Flat& corner : hull.corners)
    hull.normals[static_cast<std::size_t>(hull.normal_count++)] = corner / hull.far;
  return hull;
}

// Returns true if a corner of the rotating mover passes this direction.
bool CornerPasses(const Hull& hull, const Flat& along) {
  const auto passes = [&](std::size_t from, std::size_t to) {
    return Cross(hull.corners[from], along) * Cross(along, hull.corners[to]) >= 0;
  };
  return hull.turns && (passes(0, 2) || passes(1, 3));
}

// Returns how far the mover in place reaches along a unit vector, to both sides.
double Reach(const Hull& hull, const Flat& along) {
  if (CornerPasses(hull, along)) return hull.far;
  double most = 0;
  for (const Flat& corner : hull.corners) most = std::max(most, std::abs(corner.dot(along)));
  return most;
}

// Returns a point of the hull that is farthest along a unit vector, without the radius.
Flat Furthest(const Hull& hull, const Flat& along) {
  Flat place = hull.places[0];
  for (int i = 1; i < hull.count; ++i) {
    const Flat& other = hull.places[static_cast<std::size_t>(i)];
    if (other.dot(along) > place.dot(along)) place = other;
  }
  if (CornerPasses(hull, along)) return place + hull.far * along;
  const auto less = [&](const Flat& p, const Flat& q) { return std::abs(p.dot(along)) < std::abs(q.dot(along)); };
  const Flat& corner = *std::max_element(hull.corners.begin(), hull.corners.end(), less);
  return corner.dot(along) < 0 ? Flat(place - corner) : Flat(place + corner);
}

// Returns the distance of b from a along a unit vector, or against it: the larger of both.
double Off(const Hull& a, const Hull& b, const Flat& along) {
  const auto span = [&](const Hull& hull) {
    double least = hull.places[0].dot(along), most = least;
    for (int i = 1; i < hull.count; ++i) {
      const double place = hull.places[static_cast<std::size_t>(i)].dot(along);
      least = std::min(least, place);
      most = std::max(most, place);
    }
    return std::pair{least, most};
  };
  const auto [least_a, most_a] = span(a);
  const auto [least_b, most_b] = span(b);
  return std::max(least_b - most_a, least_a - most_b) - Reach(a, along) - Reach(b, along) - a.radius - b.radius;
}

// Returns the point nearest to the origin on the line between two points.
Flat NearestOn(const Flat& from, const Flat& to) {
  const Flat way = to - from;
  const double squared = way.squaredNorm();
  return squared > 0 ? Flat(from + std::clamp(-from.dot(way) / squared, 0.0, 1.0) * way) : from;
}

// Searches for an axis along which the hulls are at least `clearance` apart.
class Axes {
 public:
  Axes(const Hull& a, const Hull& b, double clearance) : a_(a), b_(b), clearance_(clearance) {}

  bool Separate() const {
    const bool round = a_.radius > 0 || b_.radius > 0 || a_.turns || b_.turns;
    if (round && clearance_ >= 0) return TryCorners();
    // The separating axis of polygons is among the normals of their sides, and the sides of a sum of polygons are those
    // of its summands.
    if (Try(Centre(b_) - Centre(a_)) || TryNormals(a_) || TryNormals(b_)) return true;
    return (round || clearance_ > kSame) && TryCorners();
  }

 private:
  static Flat Centre(const Hull& hull) {
    Flat sum = hull.places[0];
    for (int i = 1; i < hull.count; ++i) sum += hull.places[static_cast<std::size_t>(i)];
    return sum / hull.count;
  }

  bool Try(const Flat& axis) const {
    const double length = axis.norm();
    return Off(a_, b_, length > kSame ? Flat(axis / length) : Flat::UnitX()) >= clearance_;
  }

  bool TryNormals(const Hull& hull) const {
    for (int i = 0; i < hull.normal_count; ++i) {
      if (Off(a_, b_, hull.normals[static_cast<std::size_t>(i)]) >= clearance_) return true;
    }
    for (int i = 1; i < hull.count; ++i) {
      for (int k = 0; k < i; ++k) {
        if (Try(Left(hull.places[static_cast<std::size_t>(i)] - hull.places[static_cast<std::size_t>(k)]))) return true;
      }
    }
    return false;
  }

  // Corners that face each other are separated along the line between them: the steps of Gilbert, Johnson and Keerthi
  // to the shortest one.
  bool TryCorners() const {
    constexpr int kSteps = 10;
    Flat one = Centre(b_) - Centre(a_), other = one;
    for (int i = 0; i < kSteps; ++i) {
      const Flat nearest = NearestOn(one, other);
      const double length = nearest.norm();
      if (length < kSame) return false;
      if (Try(nearest)) return true;
      const Flat along = nearest / length;
      const Flat next = Furthest(b_, -along) - Furthest(a_, along);
      if (next.dot(along) >= length - kSame) return false;
      if (NearestOn(one, next).squaredNorm() < NearestOn(other, next).squaredNorm()) {
        other = next;
      } else {
        one = next;
      }
    }
    return false;
  }

  const Hull& a_;
  const Hull& b_;
  double clearance_;
};

// Returns how far the hull exceeds the area, at most: between the end of one corner's arc and the start of the next
// one's.
double SlackOf(const Area& area) {
  if (area.most_c <= area.least_c || CoversCircle(area)) return 0;
  return std::max(area.mover.width, area.mover.height) / 2 * maths::Sin((area.most_c - area.least_c) / 2 * kDegree);
}

bool Near(const Area& a, const Hull& hull_a, const Area& b, const Hull& hull_b, double clearance) {
  if (Axes(hull_a, hull_b, clearance).Separate()) return false;
  const double slack_a = SlackOf(a), slack_b = SlackOf(b);
  if (slack_a + slack_b < kSlack) return true;
  if (slack_b > slack_a) return Near(b, hull_b, a, hull_a, clearance);
  // Not separated, but the hulls may exceed the areas by the slack: bisect the angle.
  Area half = a;
  half.most_c = (a.least_c + a.most_c) / 2;
  if (Near(half, HullOf(half), b, hull_b, clearance)) return true;
  half.least_c = half.most_c;
  half.most_c = a.most_c;
  return Near(half, HullOf(half), b, hull_b, clearance);
}

}  // namespace

Extent ExtentOf(const Area& area) noexcept {
  double x = 0, y = 0;
  if (area.most_c > area.least_c || area.mover.any_angle) {
    const Hull hull = HullOf(area);
    x = Reach(hull, Flat::UnitX()) + hull.radius;
    y = Reach(hull, Flat::UnitY()) + hull.radius;
  } else {  // the same, in less time
    const Flat heading = Heading((area.least_c + area.most_c) / 2 * kDegree);
    const Flat along = area.mover.width / 2 * heading, across = area.mover.height / 2 * Left(heading);
    x = std::abs(along.x()) + std::abs(across.x()) + area.margin;
    y = std::abs(along.y()) + std::abs(across.y()) + area.margin;
  }
  Extent out{area.places[0], area.places[0]};
  for (std::size_t i = 1; i < area.count; ++i) {
    const Place& p = area.places[i];
    out.lower = {std::min(out.lower.x, p.x), std::min(out.lower.y, p.y)};
    out.upper = {std::max(out.upper.x, p.x), std::max(out.upper.y, p.y)};
  }
  return {{out.lower.x - x, out.lower.y - y}, {out.upper.x + x, out.upper.y + y}};
}

bool Near(const Area& a, const Area& b, double clearance) noexcept {
  return Near(a, HullOf(a), b, HullOf(b), clearance);
}

void describe(Description<Pose>& d) {
  d.about("Position and angle of a mover in the plane.");
  d.required<&Pose::place>("Position of its centre.");
  d.defaulted<&Pose::c>(unit::deg, "Angle, counterclockwise.");
}

void describe(Description<Extent>& d) {
  d.about("Bounding rectangle along X and Y.");
  d.internal<&Extent::lower>("Corner at the least X and Y.");
  d.internal<&Extent::upper>("Corner at the largest X and Y.");
}

}  // namespace takt::planar
