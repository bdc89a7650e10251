// Following a demand: how an axis, or a mover on a track, synchronises with a demand that is new in each cycle (a
// geared master, a cam, a table over time, a superimposed motion) and stays on it.
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/planner.h"

namespace takt::trajectory {

// The quantity of the demand that the axis matches.
enum class DemandMode : std::uint8_t {
  kVelocity,  // the demand's velocity: distance lost while catching up is not recovered; constant offset once in step
  kPosition,  // the demand's position
};

struct DemandFollowerState {
  // [u] Velocity mode: own position minus the demand's, constant while in step. Position mode: not used here, free for
  // the caller.
  double offset = 0;
  bool in_step = false;  // the last set point was the demand itself
};

struct DemandFollower {
  Limits own;  // of the axis
  Planner& planner;
  Limits catching_up;  // of the command, for getting in step; within the limits of the axis
  double period_s;
};

// Returns the set point one cycle after `before`, for a demand of that same instant.
//
// Invariant S(x): the speed of x stays within the axis' velocity limit even while its acceleration is reduced to 0 with
// the axis' jerk: |v + a|a| / 2j| <= vmax. Given S(before), for every demand whatsoever:
//   - S(next) holds, and so |v| <= vmax;
//   - |a| <= acceleration while the speed grows, <= deceleration while it falls, or no larger than that of `before`
//     with the same sign; an excess that only a falling speed may have is gone before the axis reverses;
//   - |a - a_before| <= jerk * period; position and velocity are those of a motion with that jerk.
// A demand that satisfies all this and continues `before` is returned bit for bit: in step. Any other demand is chased:
// a motion is planned in each cycle in the frame of the demand, as if the demand kept its acceleration; where the
// limits leave no margin for that, the axis ramps towards the demand's velocity as far as its own limits allow.
// Software limits are up to the caller.
KinematicState FollowDemand(const DemandFollower& chaser, DemandMode mode, const KinematicState& before,
                            const KinematicState& demand, DemandFollowerState& state) noexcept;

// Returns the limit of the axis that the demand exceeds (velocity is checked before acceleration). While out of step
// the velocity limit is reduced by a margin for catching up.
LimitedBy Beyond(const Limits& own, const KinematicState& demand, bool in_step) noexcept;

void describe(Description<DemandFollowerState>&);

}  // namespace takt::trajectory
