// The shapes of tracks for whoever draws them: sampled in the cycle, a few places in each, whenever one has changed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "takt/core/spsc_queue.h"
#include "takt/track/tracks.h"

namespace takt::engine {

// Some places of a track, the first ones first. They count from where its part is, or from the origin without parts.
struct TrackPlaces {
  static constexpr std::size_t kMost = 32;

  struct At {
    double position = 0;   // mm along the track
    double x = 0, y = 0;   // mm
    double direction = 0;  // rad, counterclockwise from X
  };
  std::uint64_t cycle = 0;
  std::uint32_t track = 0;
  std::uint32_t part = 0;  // number of its part, from 1; 0: none
  double length = 0;       // mm; 0: there is nothing to go along, and no place
  bool closed = false;
  std::uint32_t total = 0;  // of places in all
  std::uint32_t first = 0;  // number of the first of these, from 0
  std::uint32_t count = 0;
  std::array<At, kMost> places{};
};

// The places of a track from number `first` on.
TrackPlaces PlacesOf(std::uint64_t cycle, const track::Tracks& tracks, std::uint32_t track,
                     std::uint32_t first) noexcept;

class TrackShapes {
 public:
  explicit TrackShapes(std::size_t tracks) : known_(tracks) {}

  // Puts the next places of a track that has changed into the queue, if there is one and room. Reads the tracks alone.
  void Publish(std::uint64_t cycle, const track::Tracks& tracks, SpscQueue<TrackPlaces>& queue) noexcept;

 private:
  struct Known {
    std::optional<std::uint64_t> hash;  // of what it is given by
    const planar::Track* way = nullptr;
  };
  // Whose shape is to be sent next; none: all are known.
  std::optional<std::uint32_t> Next(const track::Tracks& tracks) noexcept;

  std::vector<Known> known_;
  bool looked_ = false;        // at all
  std::uint64_t changes_ = 0;  // of the tracks, when it did last
  bool all_known_ = false;
  std::optional<std::uint32_t> now_;  // being sent
  std::uint32_t first_ = 0;           // its place that comes next
};

}  // namespace takt::engine
