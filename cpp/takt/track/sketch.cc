#include "takt/track/sketch.h"

#include <algorithm>
#include <utility>

#include "takt/core/describe.h"
#include "takt/planar/crossing.h"

namespace takt::track {

namespace {

constexpr double kPerElement = 1000;  // greater than all numbers of problems

}  // namespace

Sketch ToSketch(const planar::Layout& layout) {
  Sketch sketch;
  sketch.count = static_cast<std::uint32_t>(std::min(layout.elements.size(), kElements));
  std::copy_n(layout.elements.begin(), sketch.count, sketch.elements.begin());
  sketch.closed = layout.closed;
  sketch.from = layout.from;
  sketch.to = layout.to;
  return sketch;
}

planar::Layout ToLayout(const Sketch& sketch) {
  const auto* first = sketch.elements.data();
  return {{first, first + sketch.count}, sketch.from, sketch.to, sketch.closed};
}

planar::Making MakeTrackWithoutCrossings(const planar::Layout& layout, planar::Track& out) {
  planar::Track track;
  const planar::Making making = planar::MakeTrack(layout, track);
  if (making.problem != planar::Problem::kNone) return making;
  // It may end at its start, like a full circle before its loop is closed.
  track.closed = layout.closed || planar::SamePoint(At(track, 0).place, At(track, track.length).place);
  if (planar::SelfCrossing(track)) return {planar::Problem::kCrosses, layout.elements.size()};
  track.closed = layout.closed;
  out = std::move(track);
  return making;
}

double ToValue(planar::Problem problem, std::uint32_t element) noexcept {
  return static_cast<double>(problem) + kPerElement * element;
}

planar::Problem ProblemOf(double value) noexcept {
  return static_cast<planar::Problem>(static_cast<std::uint64_t>(value) % static_cast<std::uint64_t>(kPerElement));
}

std::uint32_t ElementOf(double value) noexcept {
  return static_cast<std::uint32_t>(value / kPerElement);
}

void describe(Description<Sketch>& d) {
  using S = Sketch;
  d.about("Definition of a track.");
  d.internal<&S::elements>("Elements of the track.");
  d.internal<&S::count>("Number of elements.");
  d.internal<&S::closed>("True: it is a closed loop.");
  d.internal<&S::from>("End of another track at which it starts.");
  d.internal<&S::to>("Start of another track at which it ends.");
}

}  // namespace takt::track
