// Course: the swept area of a mover that brakes with its maximum dynamics from now on until it rests. The guard
// (guard.h) compares the courses of movers. Fit for the cycle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "takt/planar/area.h"
#include "takt/planar/braking.h"
#include "takt/planar/network.h"
#include "takt/planar/rider.h"

namespace takt::planar {

inline constexpr std::size_t kCourseAreas = 4;
inline constexpr double kCourseSlack = 0.25;  // [mm]

struct Course {
  std::array<Area, kCourseAreas> areas{};
  std::array<Extent, kCourseAreas> extents{};  // of `areas`
  std::uint32_t count = 0;
  Extent extent{};  // of all areas

  std::span<const Area> all() const noexcept { return {areas.data(), count}; }
};

// Appends an area. If the course is full, its last area grows to contain it.
void Add(const Area& area, Course& out) noexcept;

// Calls `look` with areas whose union contains what a mover covers while its centre moves along a track from arc length
// `from` to `to` [mm], by at most `most_strides` chords; it exceeds that by at most kCourseSlack if these suffice.
// `kind`: sides and angles of the mover; its places (0 to 3) are offsets of the centre from the track [mm].
template <typename Look>
void EachArea(const Track& track, const Place& origin, double from, double to, const Area& kind, int most_strides,
              const Look& look) {
  Area area = kind;
  std::array<Place, 7> middles{};
  std::size_t count = 0;
  const auto place = [&](double s) {
    const Place p = PlaceAt(track, s);
    middles[count++] = {p.x + origin.x, p.y + origin.y};
  };
  const auto show = [&] {
    area.count = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (kind.count == 0) area.places[area.count++] = middles[i];
      for (std::size_t k = 0; k < kind.count; ++k) {
        area.places[area.count++] = {middles[i].x + kind.places[k].x, middles[i].y + kind.places[k].y};
      }
    }
    look(area);
  };
  const double length = to - from;
  if (!(length > 0)) {
    place(from);
    return show();
  }
  // The error of linear interpolation over a stride h is at most k h²/8. The curvature of a cell is known to 0.1 %.
  const double curvature = 1.01 * PeakCurvature(track, from, to);
  const double wanted = std::ceil(length * std::sqrt(curvature / (8 * kCourseSlack)));
  const int strides = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most_strides)));
  const double stride = length / strides;
  area.margin += curvature * stride * stride / 8;
  const std::size_t most = kind.count == 0 ? middles.size() : 2;
  for (int i = 0; i <= strides; ++i) {
    place(i < strides ? from + stride * i : to);
    if (count < most || i == strides) continue;
    show();
    middles[0] = middles[count - 1];
    count = 1;
  }
  show();
}

// Appends areas that contain what a mover (`kind`, as for EachArea) covers while its centre moves along a track from
// arc length `from` to `to` [mm]. Requires: 0 <= from <= to <= length. They exceed that by at most kCourseSlack while
// 24 chords suffice and the course has room. `origin` [mm]: of the coordinates of the track.
void AddStretch(const Track& track, const Place& origin, double from, double to, const Area& kind,
                Course& out) noexcept;

// Calls look(track, begin, end) for each track of a route that [from, to] meets: positions from the start of the first
// track, arc lengths on each track [mm]. Of a closed track: one turn at most, in two pieces across its start.
template <typename Look>
void EachStretch(const Network& network, const Route& route, double from, double to, const Look& look) {
  const double first = network[route.first()].length;
  if (network[route.first()].closed) {
    if (to - from >= first) return look(route.first(), 0.0, first);
    const double begin = from - first * std::floor(from / first), end = begin + (to - from);
    look(route.first(), begin, std::min(end, first));
    if (end > first) look(route.first(), 0.0, end - first);
    return;
  }
  double begin = 0;
  for (std::uint32_t k = 0; k < route.count && (k == 0 || to > begin); ++k) {
    const double length = network[route.tracks[k]].length;
    const bool is_last = k + 1 == route.count;
    if (is_last || from < begin + length) {
      look(route.tracks[k], std::clamp(from - begin, 0.0, length), std::clamp(to - begin, 0.0, length));
    }
    begin += length;
  }
}

// The range of positions that a mover may take on its route: to its target, or until it stops; the whole route if it
// follows a master.
struct Interval {
  double from = 0, to = 0;  // [mm] from the start of its first track
};
Interval ReachableInterval(const Network& network, const Rider& rider) noexcept;

// Returns the course along its route of a mover whose centre stays between two positions [mm].
Course CourseOn(const Network& network, const Rider& rider, double from, double to, const Area& kind) noexcept;

// Returns true if two movers that brake from now on stay apart, however the route bends, by their distance along the
// route alone; false if that is not proven. One is ahead of the other on the other's route; `apart` [mm] is added to
// its positions. Schur's comparison theorem: the chord of an arc of length g with a curvature up to k is no shorter
// than that of a circle, 2/k sin(k g/2), as long as k g <= pi.
bool ApartByOrder(const Network& network, const Rider& behind, const Braking& behind_brakes, const Area& behind_kind,
                  const Braking& ahead_brakes, const Area& ahead_kind, double apart) noexcept;

struct BrakingMover {
  const Rider& rider;
  const Braking& braking;
  const Area& kind;
};
// Returns true if two braking movers never overlap, checked by conservative advancement in whole cycles; false if they
// do, or if a bounded number of checks does not decide.
bool ApartInTime(const Network& network, const BrakingMover& a, const BrakingMover& b, double period_s) noexcept;

}  // namespace takt::planar
