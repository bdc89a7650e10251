// A surface made of parts: sets of stators, each at one of its positions in one of several coordinate systems. Which
// one changes while the machine runs; two coordinate systems have nothing to do with each other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "takt/planar/area.h"
#include "takt/planar/environment.h"
#include "takt/planar/point.h"

namespace takt::planar {

inline constexpr std::uint32_t kNoPart = 0xffffffff;

// Where a part, or what else has coordinates of its own, is: its origin in a coordinate system.
struct Spot {
  std::uint32_t system = 0;  // from 0
  Place origin{};            // mm

  bool operator==(const Spot& other) const noexcept {
    return system == other.system && origin.x == other.origin.x && origin.y == other.origin.y;
  }
};
inline Place operator+(const Place& a, const Place& b) noexcept {
  return {a.x + b.x, a.y + b.y};
}
inline Place operator-(const Place& a, const Place& b) noexcept {
  return {a.x - b.x, a.y - b.y};
}

inline Extent Shifted(const Extent& extent, const Place& by) noexcept {
  return {extent.lower + by, extent.upper + by};
}

inline Area Shifted(Area area, const Place& by) noexcept {
  for (std::size_t i = 0; i < area.count; ++i) area.places[i] = area.places[i] + by;
  return area;
}

struct Part {
  std::string name{};
  Environment shape{};          // in its own coordinates
  Extent extent{};              // of that
  std::vector<Spot> positions;  // where it can be
};

// A part as it is now.
struct PartNow {
  std::uint32_t position = 0;   // where it is, or was last, from 0 ...
  std::uint32_t commanded = 0;  // ... and where it is to be
  bool away = false;            // on its way, nobody knows where
  bool enabled = false;
  bool enabling = false;  // or is about to be enabled
  bool allowed = true;    // it can be enabled
  bool faulty = false;    // it has an error
};

// A stretch of the border; the surface is to the left of it.
struct Side {
  Place from, to;
};

// Without parts there is one coordinate system without a border. All memory is taken when it is made.
struct Parts {
  Parts() = default;
  // Parts that overlap nowhere as they are at first (`now`).
  Parts(std::vector<std::string> system_names, std::vector<Part> parts, std::vector<PartNow> at_first);

  bool none() const noexcept { return all.empty(); }
  const Spot& spot(std::uint32_t part) const noexcept { return all[part].positions[now[part].position]; }
  // Where it is to be: there what it brings has its place already.
  const Spot& goal(std::uint32_t part) const noexcept { return all[part].positions[now[part].commanded]; }

  std::vector<std::string> systems;  // their names
  std::vector<Part> all;
  std::vector<PartNow> now;
  bool fixed = true;                       // one coordinate system, and no part ever moves
  std::vector<std::vector<Side>> borders;  // by coordinate system, of the parts that are there
};

// Makes the borders anew, after parts have moved. Fit for the cycle.
void MakeBorders(Parts& parts) noexcept;

// Where coordinates with this reference, the name of a part or of a coordinate system, count from; without one: those
// of the only coordinate system, unless something can move. Nothing: not known, or the part is on its way.
std::optional<Spot> Resolve(const Parts& parts, std::string_view reference) noexcept;

// Whether all of an area lies on the parts that are in a coordinate system.
bool Carries(const Parts& parts, std::uint32_t system, const Area& area) noexcept;

// The part under a place; on a border that where it was before. kNoPart: there is none.
std::uint32_t PartAt(const Parts& parts, std::uint32_t system, const Place& place, std::uint32_t before) noexcept;

// Whether an area has something in common with a part, if the part were there.
bool Touches(const Part& part, const Spot& spot, std::uint32_t system, const Area& area) noexcept;

// Whether two parts would overlap if they were there.
bool Overlap(const Part& a, const Spot& at_a, const Part& b, const Spot& at_b) noexcept;

// Whether a place in its own coordinates is on the border of a part; on it, borders included.
bool IsOnBorder(const Part& part, const Place& place) noexcept;
bool IsOn(const Part& part, const Place& place) noexcept;

// Whether one gets from any stator to any other over sides that they share. Not for the cycle.
bool HangTogether(std::span<const Place> stators);

}  // namespace takt::planar
