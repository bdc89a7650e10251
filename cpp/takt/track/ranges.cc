#include "takt/track/ranges.h"

#include <algorithm>

#include "takt/planar/clearance.h"

namespace takt::track {

namespace {

constexpr double kResolution = 1;  // mm

planar::Footprint MoverOn(const TrackParams& params) {
  return {params.mover_width, params.mover_height, true};
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
    const std::vector<planar::Range> near =
        planar::Conflicts(*way, MoverOn(params), *t.ways[other], MoverOn(t.params[other]), 0, kResolution);
    if (starts) ranges.at_start = std::max(ranges.at_start, planar::ReachFromStart(near));
    if (ends) ranges.at_end = std::max(ranges.at_end, planar::ReachFromEnd(near, way->length));
  }
  return ranges;
}

}  // namespace takt::track
