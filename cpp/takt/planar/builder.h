// A track as it is put together, step by step. A step that cannot be taken changes nothing.
#pragma once

#include <optional>

#include "takt/planar/point.h"
#include "takt/planar/problem.h"
#include "takt/planar/track.h"

namespace takt::planar {

class TrackBuilder {
 public:
  Problem AppendLine(const Place& start, const Place& end);
  // An arc that ends where it starts is a whole circle.
  Problem AppendCircle(const Place& start, const Place& end, const Place& center, bool clockwise);
  // What the track is like at a position depends on what comes behind it.
  Problem AppendPosition(const Place& position);
  Problem CloseLoop();

  // Where another track ends, or starts. If the track starts or ends there anyhow, nothing changes: a track on a part
  // that moves may meet several others at the same place.
  Problem StartFrom(const TrackPoint& end_of_other);
  Problem EndAt(const TrackPoint& start_of_other);

  void Clear();

  const Layout& layout() const { return layout_; }
  // Null as long as it has no length.
  const Track* track() const { return track_ ? &*track_ : nullptr; }

 private:
  Problem Append(const Element& element);
  Problem Take(const Layout& layout, bool may_be_empty);

  Layout layout_;
  std::optional<Track> track_;
};

}  // namespace takt::planar
