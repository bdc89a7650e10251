// What a machine file says about one track: a way in the plane along which movers go.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/core/describe_fwd.h"
#include "takt/planar/clearance.h"
#include "takt/planar/point.h"
#include "takt/planar/track.h"

namespace takt::track {

struct ElementParams {
  planar::ElementShape shape = planar::ElementShape::kLine;
  std::optional<planar::Place> from{};  // of a line or a circle
  planar::Place to{};                   // where it ends; the place of a position
  std::optional<planar::Place> center{};
  bool clockwise = false;  // of a circle
};

enum class CollisionRangeMode : std::uint8_t {
  kAutomatic,  // reckoned from the movers' size and the geometry
  kManual,     // as it is given
};

// A track that this one starts from or ends at, as their parts are at some of their positions.
struct LinkParams {
  std::string track;
  // Indices of positions of the parts of both, which the geometry is made for; 0: as they are at the start.
  std::uint32_t this_position_index = 0;
  std::uint32_t other_position_index = 0;
  bool only_there = false;  // the link is in force there alone, not wherever the tracks meet
};

struct TrackParams {
  std::string name;
  std::string part{};  // name of the part it lies on; empty: the only one
  std::vector<ElementParams> elements;
  bool closed_loop = false;
  std::vector<std::string> starts_from;           // names of tracks at whose ends it starts
  std::vector<std::string> ends_at;               // names of tracks at whose starts it ends
  std::vector<LinkParams> starts_from_positions;  // likewise, with positions of parts; behind those without
  std::vector<LinkParams> ends_at_positions;
  double mover_width = 155;   // mm, of the largest mover on it
  double mover_height = 155;  // mm
  // In a group: whether the areas of other tracks and the border of the environment hinder movers on it.
  bool check_collision_against_static_objects = true;
  CollisionRangeMode collision_range_mode = CollisionRangeMode::kAutomatic;
  double collision_range_at_start = 0;  // mm along the track, where it is manual
  double collision_range_at_end = 0;
};

// All that it starts from, or ends at.
std::vector<LinkParams> LinksOf(const std::vector<std::string>& names, const std::vector<LinkParams>& with_positions);

planar::Element ToElement(const ElementParams& params);
// What the largest mover on it covers, however it is turned.
planar::Footprint LargestOn(const TrackParams& params);

void describe(Enumeration<CollisionRangeMode>&);
void describe(Description<ElementParams>&);
void describe(Description<LinkParams>&);
void describe(Description<TrackParams>&);

}  // namespace takt::track
