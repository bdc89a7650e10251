// A mover rigidly attached to a carrier mover, as if by an arm: its pose, area and move follow from the carrier's.
#pragma once

#include "takt/planar/area.h"
#include "takt/planar/reservation.h"

namespace takt::planar {

struct Arm {
  Place off{};        // of its centre, in the frame of the carrier
  double c = 0;       // [deg] relative to the carrier
  Footprint mover{};  // the attached mover
};

// Returns its pose for a pose of the carrier.
Pose PoseAt(const Arm& arm, const Pose& carrier) noexcept;
// Returns the area that it sweeps while the carrier sweeps `carrier`. Requires: at most 6 places in `carrier`.
// Conservative if the carrier rotates.
Area AreaOf(const Arm& arm, const Area& carrier) noexcept;
// Returns its move while the carrier, at pose `from`, makes the move `carrier`. If that rotates, it has to be computed
// anew as the move proceeds.
Move MoveOf(const Arm& arm, const Pose& from, const Move& carrier) noexcept;

}  // namespace takt::planar
