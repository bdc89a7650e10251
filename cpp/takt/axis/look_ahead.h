// What the blending commands behind a positioning command allow at its target (AX-12, AX-103). Pure.
#pragma once

#include <optional>
#include <span>

#include "takt/axis/override.h"
#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/kinematic_state.h"

namespace takt::axis {

struct LookAhead {
  bool blends = false;  // a command behind it blends
  double sense = 1;     // of the motion into the target
  double asked = 0;     // [u/s] speed at the target as the buffer mode asks for
  // [u/s] Speed at the target, with acceleration 0 there: at most `asked`, and what the commands behind allow.
  double speed = 0;

  // Commands behind with the same limits are one motion with this one: it ends at run_end [u] with run_end_speed [u/s].
  // If there are none: the target and `speed`.
  double run_end = 0;
  double run_end_speed = 0;

  std::optional<double> stops_at;  // [u] where the commands come to rest; unset: an endless motion takes over
  trajectory::Limits next;         // of the first command behind
};

// Looks ahead from `request` (scaled by the override, positioning to `target`) over `queue` (as commanded).
LookAhead LookAheadOf(const AxisParams& params, const Override& factors, const KinematicState& from,
                      const Request& request, double target, std::span<const Request> queue) noexcept;

// Returns the highest speed [u/s] up to `speed` from which the axis can slow down to `end_speed` within `room` [u].
double FastestWithin(double speed, double end_speed, const trajectory::Limits& limits, double room) noexcept;

// Returns the distance [u] from `position` to the SW limit ahead in this sense; infinity if there is no limit.
double RoomToLimit(const AxisLimits& limits, double position, double sense) noexcept;

}  // namespace takt::axis
