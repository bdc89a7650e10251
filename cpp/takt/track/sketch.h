// The definition of a track, without dynamic memory: fit for the cycle and for queues.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "takt/core/describe_fwd.h"
#include "takt/planar/track.h"

namespace takt::track {

inline constexpr std::size_t kElements = 64;  // largest number of elements of a track

struct Sketch {
  std::array<planar::Element, kElements> elements{};
  std::uint32_t count = 0;
  bool closed = false;
  std::optional<planar::TrackPoint> from{};  // end of another track where it starts
  std::optional<planar::TrackPoint> to{};    // start of another track where it ends
};

Sketch ToSketch(const planar::Layout& layout);  // Requires: at most kElements
planar::Layout ToLayout(const Sketch& sketch);

// Like planar::MakeTrack; the track must not cross itself, either. Not for the cycle.
planar::Making MakeTrackWithoutCrossings(const planar::Layout& layout, planar::Track& out);

// Conversion to and from the value of a feedback that ends with kTrackGeometry.
double ToValue(planar::Problem problem, std::uint32_t element) noexcept;
planar::Problem ProblemOf(double value) noexcept;
std::uint32_t ElementOf(double value) noexcept;  // from 1; 0: none

void describe(Description<Sketch>&);

}  // namespace takt::track
