// What the blending commands behind a positioning command allow at its end (AX-12, AX-103). Pure.
#pragma once

#include <optional>
#include <span>

#include "takt/axis/override.h"
#include "takt/axis/params.h"
#include "takt/axis/request.h"
#include "takt/core/kinematic_state.h"

namespace takt::axis {

struct LookAhead {
  bool blends = false;  // there is a command behind that blends
  double sense = 1;     // of the motion at the target
  double asked = 0;     // u/s, at the target, by the buffer mode
  double speed = 0;  // u/s, at the target without acceleration there: at most what is asked, and what the rest allows

  // Commands behind with the same limits are one motion with this one: to here, u, and there with this speed, u/s.
  // Where there are none, the target and `speed`.
  double run_end = 0;
  double run_end_speed = 0;

  std::optional<double> stops_at;  // u, where the last of them comes to rest; nothing: one of them has no end
  trajectory::Limits next;         // of the first command behind
};

// `request`, scaled by the override, positions to `target`; `queue` as commanded.
LookAhead LookAheadOf(const AxisParams& params, const Override& factors, const KinematicState& from,
                      const Request& request, double target, std::span<const Request> queue) noexcept;

// The highest speed up to `speed` from which the axis is down to `end_speed` within `room`, u.
double FastestWithin(double speed, double end_speed, const trajectory::Limits& limits, double room) noexcept;

// How far an axis at `position` may go on in this sense before its SW limit.
double RoomToLimit(const AxisLimits& limits, double position, double sense) noexcept;

}  // namespace takt::axis
