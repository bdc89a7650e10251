// Parameters of one track in the machine file: a path in the plane along which movers move.
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
  std::optional<planar::Place> from{};  // start of a line or a circle
  planar::Place to{};                   // end of a line or a circle; the point of a position
  std::optional<planar::Place> center{};
  bool clockwise = false;  // of a circle
};

enum class CollisionRangeMode : std::uint8_t {
  kAutomatic,  // computed from the size of the movers and the geometry
  kManual,     // as given
};

// A link: a track that this one starts from or ends at, with their parts at given positions.
struct LinkParams {
  std::string track;
  // Indices, from 1, of the positions of both tracks' parts for which the geometry is made; 0: the initial ones.
  std::uint32_t this_position_index = 0;
  std::uint32_t other_position_index = 0;
  bool only_there = false;  // the link holds at these positions only; false: wherever the ends meet
};

struct TrackParams {
  std::string name;
  std::string part{};  // name of the part that it lies on; empty: the only one
  std::vector<ElementParams> elements;
  bool closed_loop = false;
  std::vector<std::string> starts_from;           // names of the tracks at whose ends it starts
  std::vector<std::string> ends_at;               // names of the tracks at whose starts it ends
  std::vector<LinkParams> starts_from_positions;  // more of them, with positions of parts
  std::vector<LinkParams> ends_at_positions;
  double mover_width = 155;   // [mm] of the largest mover on it
  double mover_height = 155;  // [mm]
  // In a group: the areas of other tracks and the border of the environment are obstacles for movers on it.
  bool check_collision_against_static_objects = true;
  CollisionRangeMode collision_range_mode = CollisionRangeMode::kAutomatic;
  double collision_range_at_start = 0;  // [mm] along the track; for kManual
  double collision_range_at_end = 0;
};

// Returns all links of one end.
std::vector<LinkParams> LinksOf(const std::vector<std::string>& names, const std::vector<LinkParams>& with_positions);

planar::Element ToElement(const ElementParams& params);
// Returns the area of the largest mover on it, at any angle.
planar::Footprint LargestOn(const TrackParams& params);

void describe(Enumeration<CollisionRangeMode>&);
void describe(Description<ElementParams>&);
void describe(Description<LinkParams>&);
void describe(Description<TrackParams>&);

}  // namespace takt::track
