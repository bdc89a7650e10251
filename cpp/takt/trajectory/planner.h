// Time-optimal jerk-limited motion from any state to a position or a velocity.
#pragma once

#include <cstdint>

#include "takt/core/status.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/profile.h"
#include "takt/trajectory/ramp.h"

namespace takt::trajectory {

struct PlannerCounters {
  std::uint64_t plans = 0;         // asked for
  std::uint64_t second_scale = 0;  // solved only at the second scale
  std::uint64_t failures = 0;      // solved at none, though the input was sound
};

// What holds for every plan, whatever the start:
//
// The start is `from`, bit for bit, and the end is the target, bit for bit. What is computed misses the target by less
// than 1e-8 of the motion's own length (and 32 roundings of the position) before it is put there.
//
// The speed stays within limits.velocity. A start faster than that is braked to it at once; it grows no further than
// the acceleration it begins with makes unavoidable.
//
// The acceleration stays within limits.acceleration while the speed grows and limits.deceleration while it falls. Where
// a motion reverses and the two differ, the smaller one holds for the acceleration that passes standstill. An
// acceleration beyond its limit at the start is brought inside at full jerk and never gets larger. With limits.jerk 0
// the acceleration may step, also at the start.
//
// "Within" is to 1e-9 of the limit; to 1e-5 where limits lie further apart than those of drives (ramps of minutes and
// jerk times of microseconds). Jerk times below 1 ns count as 1 ns; below 1e-30 s planning may fail. Speeds below 1e-9
// of limits.velocity count as standstill.
//
// Every call answers kParameter, `out` untouched, where a number is not finite, a limit is not positive (jerk:
// negative), the end velocity lies beyond limits.velocity, or the result does not fit into a double. No call allocates
// or throws. Not for two threads at once; knows nothing of any axis.
class Planner {
 public:
  // To `position` with `end_velocity` and no acceleration; the motion may overshoot or run back first where it must. On
  // failure `out` is untouched and the status says kPlanning: whoever asked keeps the motion it has.
  Status ToPosition(const KinematicState& from, double position, double end_velocity, const Limits& limits,
                    Profile& out) noexcept;
  // To a velocity and no acceleration, wherever that is. Closed form.
  Status ToVelocity(const KinematicState& from, double velocity, const Limits& limits, Profile& out) noexcept;
  // The same for a motion seen from something that moves itself: there the sign of an acceleration, not the speed, says
  // which limit it has to keep. `velocity_limit` holds between both ends.
  Status ToPosition(const KinematicState& from, double position, double velocity_limit, const Bounds& bounds,
                    Profile& out) noexcept;
  Status ToVelocity(const KinematicState& from, double velocity, const Bounds& bounds, Profile& out) noexcept;
  // To standstill as soon as limits.deceleration and limits.jerk allow; the other limits are not looked at. Closed
  // form, the last resort: it does not fail on sound input.
  Status Stop(const KinematicState& from, const Limits& limits, Profile& out) noexcept;

  const PlannerCounters& counters() const noexcept { return counters_; }

 private:
  // False: not at any scale; `out` is of no use then.
  bool Solve(const KinematicState& from, double position, double end_velocity, double velocity_limit,
             const Bounds& bounds, Profile& out) noexcept;

  PlannerCounters counters_;
};

// Where an axis in `from` comes to rest at the earliest (deceleration and jerk from `limits`): the end of
// Planner::Stop, without planning.
double StopPosition(const KinematicState& from, const Limits& limits) noexcept;

}  // namespace takt::trajectory
