// What a mover covers from now on if it brakes with its greatest dynamics until it rests: its course. The guard
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
inline constexpr double kCourseSlack = 0.25;  // mm

struct Course {
  std::array<Area, kCourseAreas> areas{};
  std::uint32_t count = 0;
  Extent extent{};  // of all areas; the mover in it may be turned as it likes

  std::span<const Area> all() const noexcept { return {areas.data(), count}; }
};

// Appends an area. A full course grows around it instead.
void Add(const Area& area, Course& out) noexcept;

// Calls `look` with areas that together are what a mover covers while its middle goes along a track from one arc length
// to another, in no more than so many strides, and at most kCourseSlack mm more if these are enough. `kind`: its sides
// and angles; its places, 3 at most, are how far its middle may be off its place on the track, none: not at all.
template <typename Look>
void EachArea(const Track& track, const Place& origin, double from, double to, const Area& kind, int most_strides,
              const Look& look) {
  Area area = kind;
  std::array<Place, 7> middles{};
  std::size_t count = 0;
  const auto place = [&](double s) {
    const Place p = At(track, s).place;
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
  // Linear interpolation over a stride h is off by no more than k h²/8. The curvature of a cell is known to a
  // thousandth.
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

// Appends what a mover (`kind`, as above) covers while its middle goes along a track from one arc length
// to another, 0 <= from <= to <= length; at most kCourseSlack mm more. `origin`: of the coordinates of the track.
void AddStretch(const Track& track, const Place& origin, double from, double to, const Area& kind,
                Course& out) noexcept;

// Calls `look` with each track of a route and the arc lengths on it that lie between two positions; positions count
// from the start of the first track. Of a closed track: a whole turn at most, in two pieces if it passes the start.
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
  for (std::uint32_t k = 0; k < route.count; ++k) {
    const double length = network[route.tracks[k]].length;
    const bool is_last = k + 1 == route.count;
    const bool reaches = (k == 0 || to > begin) && (is_last || from < begin + length);
    if (reaches) {
      look(route.tracks[k], std::clamp(from - begin, 0.0, length), std::clamp(to - begin, 0.0, length));
    }
    begin += length;
  }
}

// The positions between which a mover stays on its route: on the way to its target, or until it stops; of one that goes
// along with a master, all of them.
struct Interval {
  double from = 0, to = 0;  // mm, from the start of its first track
};
Interval WayOf(const Network& network, const Rider& rider) noexcept;

// The course along its route of a mover whose middle stays between two positions.
Course CourseOn(const Network& network, const Rider& rider, double from, double to, const Area& kind) noexcept;

// Whether two movers that brake at once, one behind the other on the route of the one behind, are kept apart by their
// distance along it, however the route bends: `apart` is added to the positions of the one ahead. False: not known.
// Schur's comparison: the chord of an arc of length g with a curvature up to k is no shorter than that of a circle,
// 2/k sin(k g/2), as long as k g <= pi.
bool ApartByOrder(const Network& network, const Rider& behind, const Braking& behind_brakes, const Area& behind_kind,
                  const Braking& ahead_brakes, const Area& ahead_kind, double apart) noexcept;

// Whether two movers on tracks that brake at once never overlap: in each cycle, as exactly as it takes. False: they do,
// or it takes too long to say.
struct Rolling {
  const Rider& rider;
  const Braking& braking;
  const Area& kind;
};
bool ApartInTime(const Network& network, const Rolling& a, const Rolling& b, double period_s) noexcept;

}  // namespace takt::planar
