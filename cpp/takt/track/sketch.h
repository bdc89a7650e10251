// What a track is given by, without memory of its own: fit for the cycle and for queues.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "takt/core/describe_fwd.h"
#include "takt/planar/track.h"

namespace takt::track {

inline constexpr std::size_t kElements = 64;  // a track is given by at most

struct Sketch {
  std::array<planar::Element, kElements> elements{};
  std::uint32_t count = 0;
  bool closed = false;
  std::optional<planar::TrackPoint> from{};  // the end of another track
  std::optional<planar::TrackPoint> to{};    // the start of another track
};

Sketch ToSketch(const planar::Layout& layout);  // of no more than kElements
planar::Layout ToLayout(const Sketch& sketch);

// As planar::MakeTrack, and the track must not cross itself. Not for the cycle.
planar::Making MakeWay(const planar::Layout& layout, planar::Track& out);

// What a feedback that ends with kTrackGeometry has as its value, and what that says.
double ToValue(planar::Problem problem, std::uint32_t element) noexcept;
planar::Problem ProblemOf(double value) noexcept;
std::uint32_t ElementOf(double value) noexcept;  // from 1; 0: nowhere

void describe(Description<Sketch>&);

}  // namespace takt::track
