// Builds a track step by step. A step that fails changes nothing.
#pragma once

#include <optional>

#include "takt/planar/point.h"
#include "takt/planar/problem.h"
#include "takt/planar/track.h"

namespace takt::planar {

class TrackBuilder {
 public:
  Problem AppendLine(const Place& start, const Place& end);
  // An arc that ends at its start is a full circle.
  Problem AppendCircle(const Place& start, const Place& end, const Place& center, bool clockwise);
  // Direction and curvature of the track at a position depend on the elements after it, too.
  Problem AppendPosition(const Place& position);
  Problem CloseLoop();

  // Links the start of the track to the end of another one, or its end to the start of another one. A track that is
  // linked there already stays as it is: a track on a moving part may meet several others at the same point.
  Problem StartFrom(const TrackPoint& end_of_other);
  Problem EndAt(const TrackPoint& start_of_other);

  void Clear();

  const Layout& layout() const { return layout_; }
  // Null as long as the track has no length.
  const Track* track() const { return track_ ? &*track_ : nullptr; }

 private:
  Problem Append(const Element& element);
  Problem Take(const Layout& layout, bool may_be_empty);

  Layout layout_;
  std::optional<Track> track_;
};

}  // namespace takt::planar
