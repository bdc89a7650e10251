// Carriers of objects in the cell: a belt along a line, a table about an axis, or a body whose pose is given (another
// tool, a mover, a camera). Pure geometry and motion: pose and velocity.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/kinematics/frames.h"

namespace takt::kinematics {

enum class CarrierKind : std::uint8_t {
  kNone,      // no carrier, or its state is unknown: at rest
  kStraight,  // along X of its origin: a belt
  kTurning,   // about Z of its origin: a table
  kFree,      // by its pose
};

struct Carrier {
  CarrierKind kind = CarrierKind::kNone;
  Frame origin;           // in the world; straight and turning carriers
  KinematicState travel;  // [mm] or [rad] from the origin, counted without end; straight and turning carriers
  MovingFrame pose;       // in the world; free carriers
};

// Returns the pose of a carried object: at `on` relative to the point of the carrier that was at the origin at the
// travel `from` (free: at `on` relative to its pose). pose = origin * translate_x(travel - from) * on, with velocity
// and acceleration; a table rotates instead.
MovingFrame PoseOn(const Carrier& carrier, double from, const Frame& on) noexcept;

// Returns the carrier a time [s] later, if it keeps its present velocity: a belt along its line, a table about its
// axis, a free body with its twist.
Carrier Ahead(const Carrier& carrier, double time_s) noexcept;

void describe(Enumeration<CarrierKind>&);

}  // namespace takt::kinematics
