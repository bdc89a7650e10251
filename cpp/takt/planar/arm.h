// A mover that another one carries with it, as if by an arm: where it is while that one goes on its way.
#pragma once

#include "takt/planar/area.h"
#include "takt/planar/reservation.h"

namespace takt::planar {

struct Arm {
  Place off{};        // of its middle, seen from the carrier
  double c = 0;       // deg, to the carrier
  Footprint mover{};  // that is carried
};

// Where it is if the carrier is there.
Pose PoseAt(const Arm& arm, const Pose& carrier) noexcept;
// What it covers while the carrier covers no more than an area of up to 6 places. Where that turns: more than it would.
Area AreaOf(const Arm& arm, const Area& carrier) noexcept;
// How it moves while the carrier, which is at `from`, moves so. Where that turns it is to be taken anew as it goes.
Move MoveOf(const Arm& arm, const Pose& from, const Move& carrier) noexcept;

}  // namespace takt::planar
