// A surface made of parts: sets of stators, each at one of its positions in one of several coordinate systems. The
// position changes while the machine runs; coordinate systems are independent of each other.
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

// Position of a part, or of another object with coordinates of its own: its origin in a coordinate system.
struct Spot {
  std::uint32_t system = 0;  // index, from 0
  Place origin{};            // [mm]

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
  Extent extent{};              // of `shape`
  std::vector<Spot> positions;  // all positions that it can take
};

// State of a part.
struct PartNow {
  std::uint32_t position = 0;   // index of the current or last position, from 0
  std::uint32_t commanded = 0;  // index of the commanded position, from 0
  bool away = false;            // between positions, or at an unknown one
  bool enabled = false;
  bool enabling = false;  // about to be enabled
  bool allowed = true;    // may be enabled
  bool faulty = false;    // has an error
};

// A side of the border, with the surface to its left.
struct Side {
  Place from, to;
};

// Without parts there is one coordinate system without a border. All memory is allocated by the constructor.
struct Parts {
  Parts() = default;
  // Requires: the parts do not overlap in the state `at_first`.
  Parts(std::vector<std::string> system_names, std::vector<Part> parts, std::vector<PartNow> at_first);

  bool none() const noexcept { return all.empty(); }
  const Spot& spot(std::uint32_t part) const noexcept { return all[part].positions[now[part].position]; }
  // Its commanded position: what it carries has its area there already.
  const Spot& goal(std::uint32_t part) const noexcept { return all[part].positions[now[part].commanded]; }

  std::vector<std::string> systems;  // names
  std::vector<Part> all;
  std::vector<PartNow> now;
  bool fixed = true;                       // one coordinate system, and no part ever moves
  std::vector<std::vector<Side>> borders;  // by coordinate system, of the parts in it
};

// Computes the borders anew, after parts have moved. Fit for the cycle.
void MakeBorders(Parts& parts) noexcept;

// Returns the origin of coordinates with this reference, the name of a part or of a coordinate system; if it is empty,
// that of the only coordinate system, unless something can move. Nothing if the name is unknown, or the part is away.
std::optional<Spot> Resolve(const Parts& parts, std::string_view reference) noexcept;

// Returns true if all of an area lies on the parts in a coordinate system.
bool Carries(const Parts& parts, std::uint32_t system, const Area& area) noexcept;

// Returns the part under a point; `before` if that is one, which decides on common borders; kNoPart if there is none.
std::uint32_t PartAt(const Parts& parts, std::uint32_t system, const Place& place, std::uint32_t before) noexcept;

// Returns true if an area and a part at `spot` have points in common.
bool Touches(const Part& part, const Spot& spot, std::uint32_t system, const Area& area) noexcept;

// Returns true if two parts at these positions overlap.
bool Overlap(const Part& a, const Spot& at_a, const Part& b, const Spot& at_b) noexcept;

// Return true if a point, in the coordinates of the part, is on its border, or on the part including its border.
bool IsOnBorder(const Part& part, const Place& place) noexcept;
bool IsOn(const Part& part, const Place& place) noexcept;

// Returns true if the stators are connected by shared sides. Not for the cycle.
bool AreConnected(std::span<const Place> stators);

}  // namespace takt::planar
