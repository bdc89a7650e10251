#include "takt/planar/course.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "takt/core/angle.h"
#include "takt/core/maths.h"
#include "takt/planar/clearance.h"
#include "takt/planar/parts.h"
#include "takt/planar/send.h"

namespace takt::planar {
namespace {

// Largest number of chords of a stretch: beyond that the slack grows.
constexpr int kMostStrides = 24;
// Largest number of instants at which two courses are compared.
constexpr int kMostInstants = 64;

double RadiusOf(const Area& kind) {
  return maths::Hypot(kind.mover.width, kind.mover.height) / 2 + kind.margin;
}

// Returns the radius around the position of a mover on its track (EachArea) that contains it.
double ReachOf(const Area& kind) {
  double off = 0;
  for (std::size_t i = 0; i < kind.count; ++i) off = std::max(off, maths::Hypot(kind.places[i].x, kind.places[i].y));
  return RadiusOf(kind) + off;
}

// Returns an area around both: the box of their places with the larger mover, angles and margin.
Area Around(const Area& a, const Area& b) {
  Area out = a;
  Place lower = a.places[0], upper = lower;
  for (const Area* area : {&a, &b}) {
    for (std::size_t i = 0; i < area->count; ++i) {
      const Place& p = area->places[i];
      lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
      upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
    }
  }
  out.places = {lower, {upper.x, lower.y}, upper, {lower.x, upper.y}};
  out.count = 4;
  out.least_c = std::min(a.least_c, b.least_c);
  out.most_c = std::max(a.most_c, b.most_c);
  out.mover.width = std::max(a.mover.width, b.mover.width);
  out.mover.height = std::max(a.mover.height, b.mover.height);
  out.margin = std::max(a.margin, b.margin);
  return out;
}

// Returns the distance from which on any point in a direction between `from` and `to` [rad, in the frame of a rectangle
// with these half sides] lies outside the rectangle.
double MostReach(double half_width, double half_height, double from, double to) {
  const auto reach = [&](double direction) {
    return std::min(half_width / std::abs(maths::Cos(direction)), half_height / std::abs(maths::Sin(direction)));
  };
  const double corner = maths::Atan2(half_height, half_width), turn = std::numbers::pi;
  for (const double at : {corner, -corner}) {
    if (at + turn * std::ceil((from - at) / turn) <= to) return maths::Hypot(half_width, half_height);
  }
  return std::max(reach(from), reach(to));
}

struct Turned {
  TrackPoint point;
  Footprint mover;
  double margin = 0;  // [mm] for its rotation, and its displacement from the track
};

Turned TurnedAt(const Network& network, const BrakingMover& r, double s) {
  const Route& route = r.rider.route;
  std::uint32_t k = 0;
  while (k + 1 < route.count && s > network[route.tracks[k]].length) s -= network[route.tracks[k++]].length;
  const Road& road = network[route.tracks[k]];
  Turned out{At(*road.track, s), r.kind.mover, ReachOf(r.kind) - RadiusOf(r.kind) + r.kind.margin};
  out.point.place = out.point.place + road.origin;
  out.point.direction = (r.kind.least_c + r.kind.most_c) / 2 * kDegree;
  const double turns = (r.kind.most_c - r.kind.least_c) / 2 * kDegree;
  if (turns > 0) {
    out.margin += maths::Hypot(out.mover.width, out.mover.height) * maths::Sin(std::min(turns, std::numbers::pi) / 2);
  }
  return out;
}

// Returns an upper bound of the speed [mm/s], with any acceleration at the start.
double MostSpeed(const Braking& b) {
  double most = 0;
  for (const trajectory::Piece& piece : b.pieces) {
    const double jerk = std::abs(piece.jerk);
    const double more = jerk > 0 ? piece.acceleration * piece.acceleration / (2 * jerk) : 0;
    most = std::max(most, std::abs(piece.velocity) + more);
  }
  return most;
}

}  // namespace

void Add(const Area& area, Course& out) noexcept {
  if (out.count < kCourseAreas) {
    out.areas[out.count++] = area;
  } else {
    out.areas[kCourseAreas - 1] = Around(out.areas[kCourseAreas - 1], area);
  }
  const Extent& last = out.extents[out.count - 1] = ExtentOf(out.areas[out.count - 1]);
  if (out.count == 1) out.extent = last;
  Extent& all = out.extent;
  all.lower = {std::min(all.lower.x, last.lower.x), std::min(all.lower.y, last.lower.y)};
  all.upper = {std::max(all.upper.x, last.upper.x), std::max(all.upper.y, last.upper.y)};
}

void AddStretch(const Track& track, const Place& origin, double from, double to, const Area& kind,
                Course& out) noexcept {
  EachArea(track, origin, from, to, kind, kMostStrides, [&](const Area& area) { Add(area, out); });
}

Interval ReachableInterval(const Network& network, const Rider& r) noexcept {
  const double at = r.at.position;
  if (r.aim == Aim::kTarget && !r.there) {
    const double end = TargetPosition(network, r);
    if (Rests(r.at)) return {std::min(at, end), std::max(at, end)};
    // It may pass its target before it has reversed.
    const Braking braking = Brake(r.at, r.pace.brakes());
    return {std::min({at, end, braking.lowest}), std::max({at, end, braking.highest})};
  }
  if (r.aim == Aim::kFollow) {
    double length = 0;
    for (const std::uint32_t track : r.route.all()) length += network[track].length;
    return {0, length};
  }
  if (Rests(r.at)) return {at, at};
  const Braking braking = Brake(r.at, r.softly ? r.pace.brakes() : BrakesOf(r));
  return {braking.lowest, braking.highest};
}

Course CourseOn(const Network& network, const Rider& rider, double from, double to, const Area& kind) noexcept {
  Course out;
  EachStretch(network, rider.route, from, to, [&](std::uint32_t track, double begin, double end) {
    const Road& road = network[track];
    if (road.track) AddStretch(*road.track, road.origin, begin, end, kind, out);
  });
  return out;
}

bool ApartByOrder(const Network& network, const Rider& behind, const Braking& behind_brakes, const Area& behind_kind,
                  const Braking& ahead_brakes, const Area& ahead_kind, double apart) noexcept {
  const double from = behind_brakes.lowest, to = ahead_brakes.highest + apart;
  const double gap = LeastDistance(behind_brakes, ahead_brakes, apart);
  if (!(gap > 0) || !(to >= from)) return false;
  double curvature = 0, direction = 0;
  bool begins = true;
  EachStretch(network, behind.route, from, to, [&](std::uint32_t track, double begin, double end) {
    const Road& road = network[track];
    if (!road.track) return;
    curvature = std::max(curvature, 1.01 * PeakCurvature(*road.track, begin, end));
    if (begins) direction = At(*road.track, begin).direction;
    begins = false;
  });
  const double bend = curvature * (to - from);
  if (bend > std::numbers::pi) return false;
  const double chord = curvature * gap > 1e-9 ? 2 / curvature * maths::Sin(curvature * gap / 2) : gap;
  if (chord >= ReachOf(behind_kind) + ReachOf(ahead_kind)) return true;
  const bool turns = behind_kind.most_c > behind_kind.least_c || ahead_kind.most_c > ahead_kind.least_c;
  if (turns) return false;
  // Half sides of the sum of both rectangles, in the frame of the one behind, enlarged by the displacements of both
  // from the track.
  const double off = ReachOf(behind_kind) - RadiusOf(behind_kind) + behind_kind.margin + ReachOf(ahead_kind) -
                     RadiusOf(ahead_kind) + ahead_kind.margin;
  const double turned = (ahead_kind.least_c - behind_kind.least_c) * kDegree;
  const double cosine = std::abs(maths::Cos(turned)), sine = std::abs(maths::Sin(turned));
  const Footprint &own = behind_kind.mover, &its = ahead_kind.mover;
  const double half_width = (own.width + cosine * its.width + sine * its.height) / 2 + off;
  const double half_height = (own.height + sine * its.width + cosine * its.height) / 2 + off;
  const double seen = direction - behind_kind.least_c * kDegree;
  return chord >= MostReach(half_width, half_height, seen - bend, seen + bend) - kSame;
}

bool ApartInTime(const Network& network, const BrakingMover& a, const BrakingMover& b, double period_s) noexcept {
  const double end = std::max(a.braking.ends_s.back(), b.braking.ends_s.back());
  const double closing = MostSpeed(a.braking) + MostSpeed(b.braking);
  double t = 0;
  for (int i = 0; i < kMostInstants; ++i) {
    const Turned one = TurnedAt(network, a, a.braking.At(t).position);
    const Turned other = TurnedAt(network, b, b.braking.At(t).position);
    const double apart = Separation(one.point, one.mover, other.point, other.mover) - one.margin - other.margin;
    if (apart < -kSame) return false;
    if (t >= end) return true;
    const double cycles = closing > 0 ? std::floor(apart / closing / period_s) : 1e9;
    t = std::min(t + period_s * std::max(1.0, cycles), end);
  }
  return false;
}

}  // namespace takt::planar
