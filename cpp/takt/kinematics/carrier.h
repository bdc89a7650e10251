// What carries something through the cell: a belt along a line, a table about an axis, or anything whose pose comes
// from elsewhere (another tool, a mover, a camera). Pure geometry and motion: where it is and how it moves.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/kinematics/frames.h"

namespace takt::kinematics {

enum class CarrierKind : std::uint8_t {
  kNone,      // there is none, or nothing is known of it: it stands
  kStraight,  // along X of its origin: a belt
  kTurning,   // about Z of its origin: a table
  kFree,      // as its pose says
};

struct Carrier {
  CarrierKind kind = CarrierKind::kNone;
  Frame origin;           // in the world; straight and turning
  KinematicState travel;  // mm or rad from the origin's own place, counted on for ever; straight and turning
  MovingFrame pose;       // in the world; free
};

// Where something lies that is carried: at `on` from where the carrier's travel is `from` (free: at `on` from its
// pose). pose = origin * translate_x(travel - from) * on, with velocity and acceleration; a table turns instead.
MovingFrame PoseOn(const Carrier& carrier, double from, const Frame& on) noexcept;

// The same carrier a time later, if it goes on as fast as it goes now: a belt straight on, a table round, anything else
// with its twist.
Carrier Ahead(const Carrier& carrier, double time_s) noexcept;

void describe(Enumeration<CarrierKind>&);

}  // namespace takt::kinematics
