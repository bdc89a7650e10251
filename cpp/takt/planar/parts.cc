#include "takt/planar/parts.h"

#include <algorithm>
#include <cmath>

namespace takt::planar {
namespace {

// Returns the length of the overlap of two intervals; < 0: the distance between them.
double Common(double from_a, double to_a, double from_b, double to_b) noexcept {
  return std::min(to_a, to_b) - std::max(from_a, from_b);
}

// A side as an interval on an axis-parallel line.
struct Edge {
  bool along_x = false;
  double line = 0;  // the constant coordinate
  double from = 0;  // the other coordinate, ascending
  double to = 0;
};

Edge EdgeOf(const Side& s) noexcept {
  const bool along_x = s.from.y == s.to.y;
  const double from = along_x ? s.from.x : s.from.y;
  const double to = along_x ? s.to.x : s.to.y;
  return {along_x, along_x ? s.from.y : s.from.x, std::min(from, to), std::max(from, to)};
}

// Calls `what` for all sides of a part at this origin.
void AllSides(const Part& part, const Place& origin, const auto& what) noexcept {
  for (const Outline& outline : part.shape.outlines) {
    const Place* from = &outline.corners.back();
    for (const Place& to : outline.corners) {
      what(Side{*from + origin, to + origin});
      from = &to;
    }
  }
}

Extent ExtentOf(const Side& side) noexcept {
  return {{std::min(side.from.x, side.to.x), std::min(side.from.y, side.to.y)},
          {std::max(side.from.x, side.to.x), std::max(side.from.y, side.to.y)}};
}

Extent ExtentOf(const Environment& shape) noexcept {
  Extent extent{shape.stators.front(), shape.stators.front()};
  for (const Place& corner : shape.stators) {
    extent.lower = {std::min(extent.lower.x, corner.x), std::min(extent.lower.y, corner.y)};
    extent.upper = {std::max(extent.upper.x, corner.x + kStatorSide), std::max(extent.upper.y, corner.y + kStatorSide)};
  }
  return extent;
}

bool IsOn(const Edge& s, const Place& place) noexcept {
  const double along = s.along_x ? place.x : place.y, across = s.along_x ? place.y : place.x;
  return std::abs(across - s.line) < kSame && along > s.from - kSame && along < s.to + kSame;
}

bool IsThere(const Parts& parts, std::uint32_t part, std::uint32_t system) noexcept {
  return !parts.now[part].away && parts.spot(part).system == system;
}

// Appends the stretches of a side that have no other part beside them.
void KeepFree(const Parts& parts, std::uint32_t part, std::uint32_t system, const Side& side,
              std::vector<Side>& out) noexcept {
  const Edge own = EdgeOf(side);
  const bool upwards = own.along_x ? side.to.x > side.from.x : side.to.y > side.from.y;
  const auto keep = [&](double from, double to) {
    const double first = upwards ? from : to, last = upwards ? to : from;
    const Place begin = own.along_x ? Place{first, own.line} : Place{own.line, first};
    const Place end = own.along_x ? Place{last, own.line} : Place{own.line, last};
    out.push_back({begin, end});
  };
  const Extent stretch = ExtentOf(side);
  double at = own.from;
  while (at < own.to - kSame) {
    double from = own.to, to = own.to;  // next stretch beside another part
    for (std::uint32_t k = 0; k < parts.all.size(); ++k) {
      if (k == part || !IsThere(parts, k, system)) continue;
      if (Apart(stretch, Shifted(parts.all[k].extent, parts.spot(k).origin), kSame)) continue;
      AllSides(parts.all[k], parts.spot(k).origin, [&](const Side& other) {
        const Edge its = EdgeOf(other);
        const bool beside = its.along_x == own.along_x && std::abs(its.line - own.line) < kSame;
        if (!beside || its.to <= at + kSame || its.from >= from) return;
        from = its.from;
        to = its.to;
      });
    }
    if (from > at + kSame) keep(at, std::min(from, own.to));
    at = std::max(at, to);
  }
}

// Returns true if a point is on the surface or on its border. Outlines have fewer sides than there are stators.
bool InStators(const Part& part, const Place& place) noexcept {
  bool inside = false, on_border = false;
  AllSides(part, {}, [&](const Side& side) {
    on_border |= IsOn(EdgeOf(side), place);
    if (side.from.x > place.x && (side.from.y > place.y) != (side.to.y > place.y)) inside = !inside;
  });
  return inside || on_border;
}

}  // namespace

Parts::Parts(std::vector<std::string> system_names, std::vector<Part> of_parts, std::vector<PartNow> at_first)
    : systems(std::move(system_names)), all(std::move(of_parts)), now(std::move(at_first)), borders(systems.size()) {
  std::size_t sides = 0;
  for (Part& part : all) {
    part.extent = ExtentOf(part.shape);
    fixed = fixed && part.positions.size() == 1;
    for (const Outline& outline : part.shape.outlines) sides += outline.corners.size();
  }
  fixed = fixed && systems.size() <= 1;
  // Sides of the same direction on one line do not overlap, so at most this many pieces remain.
  for (std::vector<Side>& border : borders) border.reserve(3 * sides);
  MakeBorders(*this);
}

void MakeBorders(Parts& parts) noexcept {
  for (std::uint32_t system = 0; system < parts.borders.size(); ++system) {
    std::vector<Side>& border = parts.borders[system];
    border.clear();
    for (std::uint32_t i = 0; i < parts.all.size(); ++i) {
      if (!IsThere(parts, i, system)) continue;
      AllSides(parts.all[i], parts.spot(i).origin, [&](const Side& side) { KeepFree(parts, i, system, side, border); });
    }
  }
}

std::optional<Spot> Resolve(const Parts& parts, std::string_view reference) noexcept {
  if (reference.empty()) return parts.fixed ? std::optional(Spot{}) : std::nullopt;
  for (std::uint32_t i = 0; i < parts.systems.size(); ++i) {
    if (parts.systems[i] == reference) return Spot{i, {}};
  }
  for (std::uint32_t i = 0; i < parts.all.size(); ++i) {
    if (parts.all[i].name != reference) continue;
    return parts.now[i].away ? std::nullopt : std::optional(parts.spot(i));
  }
  return std::nullopt;
}

bool Carries(const Parts& parts, std::uint32_t system, const Area& area) noexcept {
  const Extent extent = ExtentOf(area);
  const Place& place = area.places[0];
  bool on = false;
  for (const Side& side : parts.borders[system]) {
    if (!Apart(extent, ExtentOf(side), -kSame) && Near(area, {.places = {side.from, side.to}, .count = 2}, -kSame)) {
      return false;
    }
    if ((side.from.y > place.y) != (side.to.y > place.y) && side.from.x > place.x) on = !on;
  }
  return on;
}

std::uint32_t PartAt(const Parts& parts, std::uint32_t system, const Place& place, std::uint32_t before) noexcept {
  const auto on = [&](std::uint32_t part) {
    return IsThere(parts, part, system) && InStators(parts.all[part], place - parts.spot(part).origin);
  };
  if (before != kNoPart && on(before)) return before;
  for (std::uint32_t i = 0; i < parts.all.size(); ++i) {
    if (on(i)) return i;
  }
  return kNoPart;
}

bool Touches(const Part& part, const Spot& spot, std::uint32_t system, const Area& area) noexcept {
  if (spot.system != system) return false;
  const Area in_its = Shifted(area, Place{} - spot.origin);
  return Crosses(part.shape, in_its, ExtentOf(in_its)) || InStators(part, in_its.places[0]);
}

bool Overlap(const Part& a, const Spot& at_a, const Part& b, const Spot& at_b) noexcept {
  if (at_a.system != at_b.system) return false;
  const Place off = at_b.origin - at_a.origin;
  return std::ranges::any_of(a.shape.stators, [&](const Place& p) {
    return std::ranges::any_of(b.shape.stators, [&](const Place& q) {
      const Place apart = q + off - p;
      return std::abs(apart.x) < kStatorSide - kSame && std::abs(apart.y) < kStatorSide - kSame;
    });
  });
}

bool IsOn(const Part& part, const Place& place) noexcept {
  return InStators(part, place);
}

bool IsOnBorder(const Part& part, const Place& place) noexcept {
  bool on = false;
  AllSides(part, {}, [&](const Side& side) { on |= IsOn(EdgeOf(side), place); });
  return on;
}

bool AreConnected(std::span<const Place> stators) {
  const auto beside = [](const Place& a, const Place& b) {
    const double x = Common(a.x, a.x + kStatorSide, b.x, b.x + kStatorSide);
    const double y = Common(a.y, a.y + kStatorSide, b.y, b.y + kStatorSide);
    return std::min(x, y) > -kSame && std::max(x, y) > kSame;
  };
  std::vector<bool> seen(stators.size());
  std::vector<std::size_t> open;
  if (!stators.empty()) open.push_back(0), seen[0] = true;
  std::size_t count = open.size();
  while (!open.empty()) {
    const std::size_t from = open.back();
    open.pop_back();
    for (std::size_t i = 0; i < stators.size(); ++i) {
      if (seen[i] || !beside(stators[from], stators[i])) continue;
      seen[i] = true;
      ++count;
      open.push_back(i);
    }
  }
  return count == stators.size();
}

}  // namespace takt::planar
