#include "takt/engine/track_shapes.h"

#include <algorithm>
#include <cmath>

namespace takt::engine {

namespace {

constexpr double kShapeStride = 10;     // [mm] smallest distance of points; larger if there would be more than ...
constexpr std::uint32_t kPlaces = 512;  // ... this number of points

std::uint32_t CountOn(double length) {
  if (!(length > 0)) return 0;
  return static_cast<std::uint32_t>(std::clamp(std::ceil(length / kShapeStride) + 1, 2.0, double{kPlaces}));
}

}  // namespace

TrackPlaces PlacesOf(std::uint64_t cycle, const track::Tracks& tracks, std::uint32_t track,
                     std::uint32_t first) noexcept {
  const std::uint32_t part = tracks.part_of[track];
  TrackPlaces out{.cycle = cycle, .track = track, .part = part == planar::kNoPart ? 0 : part + 1, .first = first};
  const planar::Track* way = tracks.ways[track];
  if (!way) return out;
  out.length = tracks.states[track].length;
  out.closed = way->closed;
  out.total = CountOn(out.length);
  out.count = std::min<std::uint32_t>(out.total - first, TrackPlaces::kMost);
  for (std::uint32_t k = 0; k < out.count; ++k) {
    const double s = out.length * (first + k) / (out.total - 1);
    const planar::TrackPoint at = planar::At(*way, s);
    out.places[k] = {s, at.place.x, at.place.y, at.direction};
  }
  return out;
}

std::optional<std::uint32_t> TrackShapes::Next(const track::Tracks& tracks) noexcept {
  for (std::uint32_t i = 0; i < known_.size(); ++i) {
    const Known now{tracks.states[i].sketch_hash, tracks.ways[i]};
    if (known_[i].hash == now.hash && known_[i].way == now.way) continue;
    known_[i] = now;
    return i;
  }
  return std::nullopt;
}

void TrackShapes::Publish(std::uint64_t cycle, const track::Tracks& tracks, SpscQueue<TrackPlaces>& queue) noexcept {
  if (known_.empty()) return;
  if (!looked_ || tracks.changes != changes_) {
    // Starts again with its first point, whatever has changed.
    if (now_) known_[*now_] = {};
    now_.reset();
    looked_ = true;
    changes_ = tracks.changes;
    all_known_ = false;
  }
  if (!now_ && !all_known_) {
    now_ = Next(tracks);
    first_ = 0;
    all_known_ = !now_;
  }
  if (!now_) return;
  const TrackPlaces out = PlacesOf(cycle, tracks, *now_, first_);
  if (!queue.TryPush(out)) return;  // retry in one of the next cycles
  first_ += out.count;
  if (first_ == out.total) now_.reset();
}

}  // namespace takt::engine
