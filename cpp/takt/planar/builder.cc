#include "takt/planar/builder.h"

#include <utility>

namespace takt::planar {

Problem TrackBuilder::AppendLine(const Place& start, const Place& end) {
  return Append({ElementShape::kLine, start, end});
}

Problem TrackBuilder::AppendCircle(const Place& start, const Place& end, const Place& center, bool clockwise) {
  return Append({ElementShape::kArc, start, end, center, clockwise});
}

Problem TrackBuilder::AppendPosition(const Place& position) {
  return Append({ElementShape::kPosition, {}, position});
}

Problem TrackBuilder::CloseLoop() {
  if (layout_.closed) return Problem::kClosed;
  Layout layout = layout_;
  layout.closed = true;
  return Take(layout, false);
}

Problem TrackBuilder::StartFrom(const TrackPoint& end_of_other) {
  if (layout_.closed) return Problem::kLinked;
  if (track_) return Same(end_of_other, At(*track_, 0)) ? Problem::kNone : Problem::kNotItsStart;
  if (layout_.from || !layout_.elements.empty()) return Problem::kNotItsStart;
  Layout layout = layout_;
  layout.from = end_of_other;
  return Take(layout, true);
}

Problem TrackBuilder::EndAt(const TrackPoint& start_of_other) {
  if (layout_.closed) return Problem::kLinked;
  if (layout_.to) return Same(*layout_.to, start_of_other) ? Problem::kNone : Problem::kNotItsEnd;
  Layout layout = layout_;
  layout.to = start_of_other;
  return Take(layout, false);
}

void TrackBuilder::Clear() {
  layout_ = {};
  track_.reset();
}

Problem TrackBuilder::Append(const Element& element) {
  if (layout_.closed) return Problem::kClosed;
  if (layout_.to) return Problem::kEnded;
  Layout layout = layout_;
  layout.elements.push_back(element);
  return Take(layout, true);
}

Problem TrackBuilder::Take(const Layout& layout, bool may_be_empty) {
  Track track;
  const Problem problem = MakeTrack(layout, track).problem;
  const bool empty = problem == Problem::kEmpty && may_be_empty;
  if (problem != Problem::kNone && !empty) return problem;
  layout_ = layout;
  if (!empty) track_ = std::move(track);
  return Problem::kNone;
}

}  // namespace takt::planar
