// Reference motions for tests of the path planner: over polylines with overlapped corners, and over smooth courses.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "path_courses.h"
#include "takt/trajectory/overlap.h"
#include "takt/trajectory/path_planner.h"
#include "takt/trajectory/planner.h"

namespace takt::trajectory::testing {

inline Profile RestToRest(double length, const Limits& limits) {
  Planner planner;
  Profile profile;
  if (planner.ToPosition({}, length, 0, limits, profile).error != ErrorId::kNone) std::abort();
  return profile;
}

// A planning problem: the request's spans point into it.
class Reference {
 public:
  virtual ~Reference() = default;
  virtual void Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const = 0;

  PathPlanRequest Request() const {
    PathPlanRequest request;
    request.lengths = lengths;
    request.limits = limits;
    request.motion = {[](const void* owner, std::size_t interval, double share, std::span<ReferenceRate> out) noexcept {
                        static_cast<const Reference*>(owner)->Rates(interval, share, out);
                      },
                      this};
    return request;
  }

  std::vector<double> lengths;
  std::vector<RateLimits> limits;

 protected:
  // Knots no further apart than `most_s` and at each border of a piece, `least` intervals in each.
  void Divide(double from, double to, double most_s, int least) {
    if (!(to - from > 1e-9)) return;
    const int count = std::max(least, static_cast<int>(std::ceil((to - from) / most_s - 1e-6)));
    for (int i = 0; i < count; ++i) {
      begins.push_back(from + (to - from) * i / count);
      lengths.push_back((to - from) / count);
    }
  }
  std::vector<double> begins;  // of the intervals, relative to their piece
};

using Point = std::array<double, 3>;

// Lines with corners as two motions that overlap. Coordinates: the arc length, X, Y, Z and two that bound the jerk as a
// vector: along the line, and on corners along their bisector.
class Polyline : public Reference {
 public:
  Polyline(const std::vector<Point>& points, double deviation, const Limits& l, double most_s, int per_corner = 3) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      Point e{};
      double length = 0;
      for (std::size_t d = 0; d < 3; ++d) length += std::pow(points[i + 1][d] - points[i][d], 2);
      length = std::sqrt(length);
      for (std::size_t d = 0; d < 3; ++d) e[d] = (points[i + 1][d] - points[i][d]) / length;
      directions.push_back(e);
      profiles.push_back(RestToRest(length, l));
      stops_s += profiles.back().duration();
    }
    for (std::size_t i = 0; i + 1 < profiles.size(); ++i) {
      overlaps.push_back(OverlapTime(profiles[i], profiles[i + 1], Turn(i), deviation));
    }
    for (std::size_t i = 0; i < profiles.size(); ++i) {
      const double from = i > 0 ? overlaps[i - 1] : 0;
      const double to = profiles[i].duration() - (i < overlaps.size() ? overlaps[i] : 0);
      std::vector<double> borders{from, to};
      for (int k = 0; k < profiles[i].size(); ++k) {
        const double end = profiles[i].piece_ends_s[static_cast<std::size_t>(k)];
        if (end > from && end < to) borders.insert(borders.end() - 1, end);
      }
      AddPiece(i, false, borders, most_s, 1);
      if (i >= overlaps.size()) continue;
      borders = {0, overlaps[i]};
      for (int k = 0; k < profiles[i].size(); ++k) {
        borders.push_back(profiles[i].piece_ends_s[static_cast<std::size_t>(k)] - profiles[i].duration() + overlaps[i]);
      }
      for (int k = 0; k < profiles[i + 1].size(); ++k) {
        borders.push_back(profiles[i + 1].piece_ends_s[static_cast<std::size_t>(k)]);
      }
      std::erase_if(borders, [&](double t) { return t < 0 || t > overlaps[i]; });
      std::sort(borders.begin(), borders.end());
      AddPiece(i, true, borders, most_s, per_corner);
    }
    const RateLimits axis{l.velocity, l.acceleration, l.acceleration, l.jerk};
    RateLimits path = axis, jerk;
    path.jerk = jerk.jerk;
    jerk.jerk = l.jerk;
    limits = {path, axis, axis, axis, jerk, jerk};
  }

  double Turn(std::size_t corner) const {
    double square = 0;
    for (std::size_t d = 0; d < 3; ++d) square += std::pow(directions[corner + 1][d] - directions[corner][d], 2);
    return std::sqrt(square);
  }
  // From the corner to the curve of its overlap, `t` after the beginning of that.
  Point FromCorner(std::size_t corner, double t) const {
    const Profile& first = profiles[corner];
    const double one = first.end().position - first.At(first.duration() - overlaps[corner] + t).position;
    const double two = profiles[corner + 1].At(t).position;
    Point p;
    for (std::size_t d = 0; d < 3; ++d) p[d] = -directions[corner][d] * one + directions[corner + 1][d] * two;
    return p;
  }

  void Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const override {
    const auto [line, corner] = pieces[interval];
    const double t = begins[interval] + share * lengths[interval];
    const double inside = begins[interval] + 0.5 * lengths[interval];
    const Profile& own = profiles[line];
    if (!corner) {
      const KinematicState at = own.At(t);
      const ReferenceRate along{at.velocity, at.acceleration, own.JerkAt(inside)};
      out[0] = out[4] = along;
      out[5] = {};
      for (std::size_t d = 0; d < 3; ++d) {
        const double e = directions[line][d];
        out[d + 1] = {e * along.first, e * along.second, e * along.third};
      }
      return;
    }
    Point bisector{};
    double norm = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const double one = directions[line][d], two = directions[line + 1][d];
      out[d + 1] = OverlapRate(own, profiles[line + 1], overlaps[line], t, inside, one, two);
      bisector[d] = one + two;
      norm += bisector[d] * bisector[d];
    }
    norm = std::sqrt(norm);
    out[0] = ArcRate(out.subspan(1, 3));
    out[4] = {};
    out[5] = {};
    for (std::size_t d = 0; d < 3 && norm > 1e-9; ++d) {
      const double share_of = bisector[d] / norm;
      out[5].first += share_of * out[d + 1].first;
      out[5].second += share_of * out[d + 1].second;
      out[5].third += share_of * out[d + 1].third;
    }
  }

  std::vector<Point> directions;
  std::vector<Profile> profiles;
  std::vector<double> overlaps;
  double stops_s = 0;  // with a stop at each corner

 private:
  struct Piece {
    std::size_t line;
    bool corner;
  };
  void AddPiece(std::size_t line, bool corner, const std::vector<double>& borders, double most_s, int least) {
    for (std::size_t i = 0; i + 1 < borders.size(); ++i) Divide(borders[i], borders[i + 1], most_s, least);
    pieces.resize(lengths.size(), {line, corner});
  }
  std::vector<Piece> pieces;
};

// Of 2 to 6 lines of 0.1 to 100 mm, turning by up to `most_turn` degrees.
inline std::vector<Point> RandomPoints(std::mt19937_64& random, double most_turn) {
  std::vector<Point> points{{0, 0, 0}};
  Point e{1, 0, 0};
  const int lines = std::uniform_int_distribution<int>(2, 6)(random);
  for (int i = 0; i < lines; ++i) {
    const double length = Between(random, 0.1, 100);
    Point p = points.back();
    for (std::size_t d = 0; d < 3; ++d) p[d] += length * e[d];
    points.push_back(p);
    // About a random axis across the direction.
    Point across;
    double along = 0, norm = 0;
    for (std::size_t d = 0; d < 3; ++d) along += (across[d] = std::normal_distribution<double>()(random)) * e[d];
    for (std::size_t d = 0; d < 3; ++d) norm += std::pow(across[d] -= along * e[d], 2);
    const double angle = Uniform(random, 1, most_turn) * std::numbers::pi / 180;
    for (std::size_t d = 0; d < 3; ++d) e[d] = std::cos(angle) * e[d] + std::sin(angle) * across[d] / std::sqrt(norm);
  }
  return points;
}

// A smooth course over one motion from rest to rest with the mean limits along it.
class Smooth : public Reference {
 public:
  Smooth(const Course& course, int intervals) : course_(course) {
    std::vector<double> v, a, j;
    for (int i = 0; i <= 100; ++i) {
      double of[3] = {course.along.velocity, std::min(course.along.acceleration, course.along.deceleration),
                      course.along.jerk};
      for (std::size_t k = 0; k < course.formulas.size(); ++k) {
        const double slope = std::abs(course.formulas[k].Derivative(1, course.length * i / 100)) + 1e-9;
        of[0] = std::min(of[0], course.limits.of[k].velocity / slope);
        of[1] = std::min(of[1], course.limits.of[k].acceleration / slope);
        of[2] = std::min(of[2], course.limits.of[k].jerk / slope);
      }
      v.push_back(of[0]);
      a.push_back(of[1]);
      j.push_back(of[2]);
    }
    for (auto* all : {&v, &a, &j}) std::nth_element(all->begin(), all->begin() + 50, all->end());
    profile_ = RestToRest(course.length, {v[50], a[50], a[50], j[50]});
    double before = 0;
    for (int i = 0; i < profile_.size(); ++i) {
      const double end = profile_.piece_ends_s[static_cast<std::size_t>(i)];
      Divide(before, end, profile_.duration() / intervals, 2);
      before = end;
    }
    limits.push_back({course.along.velocity, course.along.acceleration, course.along.deceleration, course.along.jerk});
    for (std::size_t k = 0; k < course.formulas.size(); ++k) {
      const auto& own = course.limits.of[k];
      limits.push_back({own.velocity, own.acceleration, own.acceleration, own.jerk});
    }
  }

  void Rates(std::size_t interval, double share, std::span<ReferenceRate> out) const override {
    const KinematicState at = profile_.At(begins[interval] + share * lengths[interval]);
    const double jerk = profile_.JerkAt(begins[interval] + 0.5 * lengths[interval]);
    const double v = at.velocity;
    out[0] = {v, at.acceleration, jerk};
    for (std::size_t k = 0; k < course_.formulas.size(); ++k) {
      const double d1 = course_.formulas[k].Derivative(1, at.position);
      const double d2 = course_.formulas[k].Derivative(2, at.position);
      const double d3 = course_.formulas[k].Derivative(3, at.position);
      out[k + 1] = {d1 * v, d1 * at.acceleration + d2 * v * v,
                    d1 * jerk + 3 * d2 * v * at.acceleration + d3 * v * v * v};
    }
  }

 private:
  Course course_;
  Profile profile_;
};

}  // namespace takt::trajectory::testing
