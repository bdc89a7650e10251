// The shapes of tracks for drawing: sampled in the cycle, a few points in each, whenever a track has changed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "takt/core/spsc_queue.h"
#include "takt/track/tracks.h"

namespace takt::engine {

// Consecutive sample points of a track. Coordinates are relative to the position of its part, or to the origin without
// parts.
struct TrackPlaces {
  static constexpr std::size_t kMost = 32;

  struct At {
    double position = 0;   // [mm] arc length along the track
    double x = 0, y = 0;   // [mm]
    double direction = 0;  // [rad] counterclockwise from X
  };
  std::uint64_t cycle = 0;
  std::uint32_t track = 0;
  std::uint32_t part = 0;  // number of its part, from 1; 0: none
  double length = 0;       // [mm]; 0: the track has no geometry, and no points
  bool closed = false;
  std::uint32_t total = 0;  // number of points of the whole track
  std::uint32_t first = 0;  // index of the first of these points, from 0
  std::uint32_t count = 0;
  std::array<At, kMost> places{};
};

// Returns the points of a track from index `first` on.
TrackPlaces PlacesOf(std::uint64_t cycle, const track::Tracks& tracks, std::uint32_t track,
                     std::uint32_t first) noexcept;

class TrackShapes {
 public:
  explicit TrackShapes(std::size_t tracks) : known_(tracks) {}

  // Queues the next points of a track that has changed, if there is one and the queue has room. Only reads the tracks.
  void Publish(std::uint64_t cycle, const track::Tracks& tracks, SpscQueue<TrackPlaces>& queue) noexcept;

 private:
  struct Known {
    std::optional<std::uint64_t> hash;  // of the geometry it is built from
    const planar::Track* way = nullptr;
  };
  // Returns the next track whose shape must be sent; nothing if all have been sent.
  std::optional<std::uint32_t> Next(const track::Tracks& tracks) noexcept;

  std::vector<Known> known_;
  bool looked_ = false;        // false until the first call
  std::uint64_t changes_ = 0;  // Tracks::changes at the last call
  bool all_known_ = false;
  std::optional<std::uint32_t> now_;  // the track that is being sent
  std::uint32_t first_ = 0;           // index of its next point
};

}  // namespace takt::engine
