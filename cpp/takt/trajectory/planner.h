// Time-optimal jerk-limited motion from any state to a position or a velocity.
#pragma once

#include <cstdint>

#include "takt/core/status.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/profile.h"
#include "takt/trajectory/ramp.h"

namespace takt::trajectory {

struct PlannerCounters {
  std::uint64_t plans = 0;         // calls
  std::uint64_t second_scale = 0;  // solved at the second scale only
  std::uint64_t failures = 0;      // solved at neither scale, though the input was valid
};

// Guarantees for every plan, whatever the start:
//
// The start is `from`, bit for bit, and the end is the target, bit for bit. The computed end misses the target by less
// than 1e-8 of the motion's own length (and 32 roundings of the position) before it is set to the target.
//
// The speed stays within limits.velocity. A faster start is braked to it at once; its speed grows no further than the
// initial acceleration makes unavoidable.
//
// The acceleration stays within limits.acceleration while the speed grows and limits.deceleration while it falls. Where
// a motion reverses and the two differ, the smaller one holds for the acceleration while it passes standstill. An
// initial acceleration beyond its limit is brought inside at full jerk and never gets larger. With limits.jerk 0 the
// acceleration may step, also at the start.
//
// "Within" is to 1e-9 of the limit; to 1e-5 where limits lie further apart than those of drives (ramps of minutes and
// jerk times of microseconds). Jerk times below 1 ns count as 1 ns; below 1e-30 s planning may fail. Speeds below 1e-9
// of limits.velocity count as standstill.
//
// Every call returns kParameter, with `out` unchanged, if a number is not finite, a limit is not positive (jerk:
// negative), the end velocity lies beyond limits.velocity, or the result does not fit into a double. No call allocates
// or throws. Not thread-safe; independent of any axis.
class Planner {
 public:
  // Plans a motion to `position` with `end_velocity` and no acceleration; it may overshoot or move back first where it
  // must. Returns kPlanning if no plan is found, with `out` unchanged: the caller keeps its motion.
  Status ToPosition(const KinematicState& from, double position, double end_velocity, const Limits& limits,
                    Profile& out) noexcept;
  // Plans a motion to a velocity and no acceleration, at any position. Closed form.
  Status ToVelocity(const KinematicState& from, double velocity, const Limits& limits, Profile& out) noexcept;
  // The same for a motion relative to a moving frame: there the sign of an acceleration, not the speed, decides which
  // limit holds. `velocity_limit` holds between both ends; the end velocity is 0.
  Status ToPosition(const KinematicState& from, double position, double velocity_limit, const Bounds& bounds,
                    Profile& out) noexcept;
  Status ToVelocity(const KinematicState& from, double velocity, const Bounds& bounds, Profile& out) noexcept;
  // Plans to standstill as soon as limits.deceleration and limits.jerk allow; the other limits are ignored. Closed
  // form, the last resort: does not fail on valid input.
  Status Stop(const KinematicState& from, const Limits& limits, Profile& out) noexcept;

  const PlannerCounters& counters() const noexcept { return counters_; }

 private:
  // Returns false if there is no solution at any scale; `out` is unusable then.
  bool Solve(const KinematicState& from, double position, double end_velocity, double velocity_limit,
             const Bounds& bounds, Profile& out) noexcept;

  PlannerCounters counters_;
};

// Returns the earliest position [u] of rest of an axis in `from` (deceleration and jerk from `limits`): the end of
// Planner::Stop, without planning.
double StopPosition(const KinematicState& from, const Limits& limits) noexcept;

}  // namespace takt::trajectory
