#include "areas.h"

#include <algorithm>
#include <cmath>

#include "takt/core/angle.h"

namespace takt::planar::testing {
namespace {

double Cross(const Place& o, const Place& a, const Place& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

Polygon HullOf(std::vector<Place> points) {
  std::ranges::sort(points, [](const Place& a, const Place& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  Polygon hull;
  for (int round = 0; round < 2; ++round) {
    const std::size_t first = hull.size();
    for (const Place& p : points) {
      while (hull.size() >= first + 2 && Cross(hull[hull.size() - 2], hull.back(), p) <= 1e-7) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

double FromSide(const Place& p, const Place& from, const Place& to) {
  const double x = to.x - from.x, y = to.y - from.y;
  const double t = std::clamp(((p.x - from.x) * x + (p.y - from.y) * y) / (x * x + y * y), 0.0, 1.0);
  return std::hypot(p.x - from.x - t * x, p.y - from.y - t * y);
}

void AppendCorners(const Area& area, double c, std::vector<Place>& out) {
  for (std::size_t i = 0; i < area.count; ++i) {
    for (int k = 0; k < 4; ++k) {
      const double along = ((k & 1) != 0 ? 1 : -1) * area.mover.width / 2;
      const double across = ((k & 2) != 0 ? 1 : -1) * area.mover.height / 2;
      out.push_back(Ahead(Ahead(area.places[i], c * kDegree, along), (c + 90) * kDegree, across));
    }
  }
}

}  // namespace

Environment Surface(const std::vector<Place>& stators) {
  Environment environment;
  const SurfaceResult made = MakeEnvironment(stators, environment);
  EXPECT_EQ(made.problem, StatorProblem::kNone) << made.stator << ' ' << made.other;
  return environment;
}

Polygon HullAt(const Area& area, double least_c, double most_c) {
  std::vector<Place> corners;
  constexpr int kAngles = 64;
  const int count = most_c > least_c ? kAngles : 0;
  for (int i = 0; i <= count; ++i) {
    AppendCorners(area, count > 0 ? std::lerp(least_c, most_c, static_cast<double>(i) / count) : least_c, corners);
  }
  return HullOf(corners);
}

bool IsIn(const Polygon& polygon, const Place& place) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (Cross(polygon[i], polygon[(i + 1) % polygon.size()], place) < 0) return false;
  }
  return true;
}

double Distance(const Polygon& a, const Polygon& b) {
  if (IsIn(a, b[0]) || IsIn(b, a[0])) return 0;
  double least = INFINITY;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Place &p = a[i], &q = a[(i + 1) % a.size()];
    for (std::size_t k = 0; k < b.size(); ++k) {
      const Place &r = b[k], &s = b[(k + 1) % b.size()];
      if (Cross(p, q, r) * Cross(p, q, s) < 0 && Cross(r, s, p) * Cross(r, s, q) < 0) return 0;
      least = std::min({least, FromSide(p, r, s), FromSide(q, r, s), FromSide(r, p, q), FromSide(s, p, q)});
    }
  }
  return least;
}

double DistanceByAngles(const Area& a, const Area& b) {
  struct Span {
    double least, most;
  };
  const double reach_a = std::hypot(a.mover.width, a.mover.height) / 2;
  const double reach_b = std::hypot(b.mover.width, b.mover.height) / 2;
  double best = INFINITY;
  // Branch and bound: from the middle of two ranges of angles no corner moves farther than its angle times its radius.
  const auto search = [&](const auto& again, const Span& on_a, const Span& on_b) -> void {
    const double at_a = (on_a.least + on_a.most) / 2, at_b = (on_b.least + on_b.most) / 2;
    const double distance = Distance(HullAt(a, at_a, at_a), HullAt(b, at_b, at_b));
    best = std::min(best, distance);
    const double moves_a = (on_a.most - at_a) * kDegree * reach_a, moves_b = (on_b.most - at_b) * kDegree * reach_b;
    const double least = distance - moves_a - moves_b;
    if (best == 0 || least > best - 0.05 || moves_a + moves_b < 0.05) return;
    if (moves_a >= moves_b) {
      again(again, {on_a.least, at_a}, on_b);
      again(again, {at_a, on_a.most}, on_b);
    } else {
      again(again, on_a, {on_b.least, at_b});
      again(again, on_a, {at_b, on_b.most});
    }
  };
  search(search, {a.least_c, a.most_c}, {b.least_c, b.most_c});
  return best;
}

TrackPoint AsPoint(const Pose& pose) {
  return {pose.place, pose.c * kDegree};
}

Area RandomArea(Random& random) {
  Area area;
  area.count = static_cast<std::uint8_t>(1 + random.Below(3));
  for (std::size_t i = 0; i < area.count; ++i) area.places[i] = {random.Between(-400, 400), random.Between(-400, 400)};
  area.least_c = area.most_c = random.Below(3) == 0 ? 0 : random.Between(-360, 360);
  if (random.Coin()) area.most_c += random.Between(0, random.Coin() ? 30 : 200);
  area.mover = {random.Between(50, 160), random.Between(50, 160)};
  return area;
}

Place RandomPlaceOf(const Area& area, Random& random) {
  double share[3] = {}, sum = 0;
  for (std::size_t i = 0; i < area.count; ++i) sum += share[i] = random.Below(4) == 0 ? 0 : random.Between(0, 1);
  if (sum == 0) return area.places[0];
  Place place;
  for (std::size_t i = 0; i < area.count; ++i) {
    place.x += share[i] / sum * area.places[i].x;
    place.y += share[i] / sum * area.places[i].y;
  }
  return place;
}

}  // namespace takt::planar::testing
