#include "takt/planar/arm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "takt/core/angle.h"
#include "takt/core/maths.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

constexpr double kRound = 270;  // [deg] from which on the area swept by an arm is taken as a circle
constexpr std::size_t kApexes = 4;

struct Turning {
  double least = 0, most = 0;  // [deg]
};

// Range of what an arm sweeps along a direction.
struct Between {
  double least = 0, most = 0;
};

// Returns the range of the cosine between two angles.
Between CosineBetween(double from, double to) {
  const auto passes = [&](double angle) {
    constexpr double kTurn = 2 * std::numbers::pi;
    return angle + kTurn * std::ceil((from - angle) / kTurn) <= to;
  };
  const auto [least, most] = std::minmax({maths::Cos(from), maths::Cos(to)});
  return {passes(std::numbers::pi) ? -1 : least, passes(0) ? 1 : most};
}

struct Corners {
  std::array<Place, 4> places{};
};

// Returns the corners of a rectangle along a direction that contains all positions of the arm's end while the carrier
// is at any of these places.
Corners BoxOf(const Flat& off, std::span<const Place> places, const Turning& turning, const Flat& along) {
  const double length = off.norm(), angle = maths::Atan2(off.y(), off.x()) - maths::Atan2(along.y(), along.x());
  const auto reach = [&](const Flat& axis, double quarter) {
    const Between arm =
        CosineBetween(turning.least * kDegree + angle - quarter, turning.most * kDegree + angle - quarter);
    Between all{ToFlat(places[0]).dot(axis), ToFlat(places[0]).dot(axis)};
    for (const Place& place : places) {
      all.least = std::min(all.least, ToFlat(place).dot(axis));
      all.most = std::max(all.most, ToFlat(place).dot(axis));
    }
    return Between{all.least + length * arm.least, all.most + length * arm.most};
  };
  const Flat across = Left(along);
  const Between u = reach(along, 0), w = reach(across, std::numbers::pi / 2);
  const auto corner = [&](double a, double b) { return ToPlace(a * along + b * across); };
  return {{corner(u.least, w.least), corner(u.most, w.least), corner(u.most, w.most), corner(u.least, w.most)}};
}

// Returns the points that, with the ends of an arc, make a polygon around it.
Corners ApexesOf(const Flat& off, const Place& place, const Turning& turning) {
  const double step = (turning.most - turning.least) * kDegree / kApexes;
  const double length = off.norm() / maths::Cos(step / 2);
  Corners out;
  for (std::size_t i = 0; i < kApexes; ++i) {
    const double angle =
        turning.least * kDegree + maths::Atan2(off.y(), off.x()) + (static_cast<double>(i) + 0.5) * step;
    out.places[i] = ToPlace(ToFlat(place) + length * Heading(angle));
  }
  return out;
}

Flat DirectionBetween(const Place& from, const Place& to) {
  const Flat way = ToFlat(to) - ToFlat(from);
  return way.norm() > kSame ? Flat(way.normalized()) : Flat(Flat::UnitX());
}

Place EndOf(const Arm& arm, const Place& carrier, double c) {
  const auto [sine, cosine] = maths::SinCos(c * kDegree);
  return {carrier.x + cosine * arm.off.x - sine * arm.off.y, carrier.y + sine * arm.off.x + cosine * arm.off.y};
}

}  // namespace

Pose PoseAt(const Arm& arm, const Pose& carrier) noexcept {
  return {EndOf(arm, carrier.place, carrier.c), carrier.c + arm.c};
}

Area AreaOf(const Arm& arm, const Area& carrier) noexcept {
  Area out{.places = {},
           .count = 0,
           .least_c = carrier.least_c + arm.c,
           .most_c = carrier.most_c + arm.c,
           .mover = arm.mover,
           .margin = carrier.margin};
  const auto add = [&](const Place& place) { out.places[out.count++] = place; };
  const std::span<const Place> places(carrier.places.data(), carrier.count);
  const Turning turning{carrier.least_c, carrier.most_c};
  if (turning.most <= turning.least) {
    for (const Place& place : places) add(EndOf(arm, place, turning.least));
  } else if (places.size() == 1 && turning.most - turning.least < kRound) {
    add(EndOf(arm, places[0], turning.least));
    for (const Place& apex : ApexesOf(ToFlat(arm.off), places[0], turning).places) add(apex);
    add(EndOf(arm, places[0], turning.most));
  } else {
    const Flat along = DirectionBetween(places[0], places[places.size() > 1 ? 1 : 0]);
    for (const Place& corner : BoxOf(ToFlat(arm.off), places, turning, along).places) add(corner);
  }
  return out;
}

Move MoveOf(const Arm& arm, const Pose& from, const Move& carrier) noexcept {
  Move out = carrier;
  out.target = PoseAt(arm, carrier.target);
  if (carrier.over_c) out.over_c = *carrier.over_c + arm.c;
  Turning turning{std::min(from.c, carrier.target.c), std::max(from.c, carrier.target.c)};
  if (carrier.over_c) {
    turning = {std::min(turning.least, *carrier.over_c), std::max(turning.most, *carrier.over_c)};
  }
  if (turning.most <= turning.least) {
    if (carrier.over) out.over = EndOf(arm, *carrier.over, from.c);
    for (std::size_t i = 0; i < carrier.corner_count; ++i) out.corners[i] = EndOf(arm, carrier.corners[i], from.c);
    return out;
  }
  std::array<Place, 7> places{from.place, carrier.target.place};
  std::size_t count = 2;
  if (carrier.over) places[count++] = *carrier.over;
  for (std::size_t i = 0; i < carrier.corner_count; ++i) places[count++] = carrier.corners[i];
  const bool stays = count == 2 && SamePoint(from.place, carrier.target.place);
  const bool round = stays && !carrier.over_c && turning.most - turning.least < kRound;
  const Flat off = ToFlat(arm.off), along = DirectionBetween(from.place, carrier.target.place);
  const Corners corners =
      round ? ApexesOf(off, from.place, turning) : BoxOf(off, std::span(places.data(), count), turning, along);
  out.over.reset();
  out.corners = corners.places;
  out.corner_count = static_cast<std::uint8_t>(corners.places.size());
  return out;
}

}  // namespace takt::planar
