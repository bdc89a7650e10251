#include "takt/track/ranges.h"

#include <algorithm>
#include <optional>

#include "takt/planar/clearance.h"

namespace takt::track {

namespace {

constexpr double kResolution = 1;  // [mm]

planar::Footprint MoverOn(const TrackParams& params) {
  return {params.mover_width, params.mover_height, true};
}

// Returns a track in the coordinates of the part of another one; nothing if they are in different coordinate systems.
std::optional<planar::Track> SeenFrom(const Tracks& t, std::size_t other, std::size_t track) {
  const planar::Spot& from = t.goal(other);
  const planar::Spot& to = t.goal(track);
  if (from.system != to.system) return std::nullopt;
  if (from == to) return *t.ways[other];
  const planar::Place by = from.origin - to.origin;
  planar::Layout layout = ToLayout(t.sketches[other]);
  for (planar::Element& element : layout.elements) {
    for (planar::Place* place : {&element.start, &element.end, &element.center}) *place = *place + by;
  }
  for (std::optional<planar::TrackPoint>* end : {&layout.from, &layout.to}) {
    if (*end) (*end)->place = (*end)->place + by;
  }
  planar::Track shifted;
  if (MakeTrackWithoutCrossings(layout, shifted).problem != planar::Problem::kNone) return std::nullopt;
  return shifted;
}

}  // namespace

CollisionRanges RangesOf(const Tracks& t, std::size_t track) {
  const TrackParams& params = t.params[track];
  const planar::Track* way = t.ways[track];
  CollisionRanges ranges;
  if (!way) return ranges;
  if (params.collision_range_mode == CollisionRangeMode::kManual) {
    return {params.collision_range_at_start, params.collision_range_at_end};
  }
  for (std::size_t other = 0; other < t.ways.size(); ++other) {
    const bool starts = t.start_nodes[other] == t.start_nodes[track];
    const bool ends = t.end_nodes[other] == t.end_nodes[track];
    if (other == track || !t.ways[other] || !(starts || ends)) continue;
    const std::optional<planar::Track> seen = SeenFrom(t, other, track);
    if (!seen) continue;
    const std::vector<planar::Range> near =
        planar::Conflicts(*way, MoverOn(params), *seen, MoverOn(t.params[other]), 0, kResolution);
    if (starts) ranges.at_start = std::max(ranges.at_start, planar::ReachFromStart(near));
    if (ends) ranges.at_end = std::max(ranges.at_end, planar::ReachFromEnd(near, way->length));
  }
  return ranges;
}

}  // namespace takt::track
