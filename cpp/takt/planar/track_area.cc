#include "takt/planar/track_area.h"

#include <algorithm>
#include <numbers>

#include "takt/core/maths.h"
#include "takt/planar/flat.h"

namespace takt::planar {
namespace {

// The mover extended along its direction in the middle of the stretch, with its deviation from that as the margin.
Area Stretch(const Track& track, const Footprint& mover, const Cell& cell, double from, double to) {
  const double half = (to - from) / 2;
  const TrackPoint middle = At(track, from + half);
  const Flat along = half * Heading(middle.direction), place = ToFlat(middle.place);
  Area area;
  area.places = {ToPlace(place - along), ToPlace(place + along)};
  area.count = 2;
  area.least_c = area.most_c = middle.direction * 180 / std::numbers::pi;
  area.mover = mover;
  area.margin = StrayOf(cell, half, mover.any_angle ? 0 : maths::Hypot(mover.width, mover.height) / 2);
  return area;
}

void Append(const Track& track, const Footprint& mover, const Cell& cell, double from, double to, TrackArea& out) {
  const Area area = Stretch(track, mover, cell, from, to);
  if (area.margin > kTrackSlack / 2) {
    const double middle = (from + to) / 2;
    Append(track, mover, cell, from, middle, out);
    Append(track, mover, cell, middle, to, out);
    return;
  }
  out.stretches.push_back(area);
  out.extents.push_back(ExtentOf(area));
}

}  // namespace

TrackArea MakeTrackArea(const Track& track, const Footprint& mover, std::uint32_t network) {
  TrackArea out;
  out.network = network;
  for (const Cell& cell : track.cells) Append(track, mover, cell, cell.from, cell.to, out);
  out.extent = out.extents.front();
  for (const Extent& e : out.extents) {
    out.extent.lower = {std::min(out.extent.lower.x, e.lower.x), std::min(out.extent.lower.y, e.lower.y)};
    out.extent.upper = {std::max(out.extent.upper.x, e.upper.x), std::max(out.extent.upper.y, e.upper.y)};
  }
  return out;
}

bool Near(const Area& area, const Extent& extent, const TrackArea& track, double clearance) noexcept {
  if (Apart(extent, track.extent, clearance)) return false;
  for (std::size_t i = 0; i < track.stretches.size(); ++i) {
    if (!Apart(extent, track.extents[i], clearance) && Near(area, track.stretches[i], clearance)) return true;
  }
  return false;
}

}  // namespace takt::planar
