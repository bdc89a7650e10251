// Following something that moves: the one way in which an axis, or a mover on a track, gets onto, and stays on, a
// demand that comes anew in each cycle (a geared master, a cam, a table over time, a motion on top of another).
#pragma once

#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/limits.h"
#include "takt/trajectory/planner.h"

namespace takt::trajectory {

// What the axis shall agree with.
enum class DemandMode : std::uint8_t {
  kVelocity,  // the demand's velocity: the distance lost on the way is not made up, and stays what it is once in step
  kPosition,  // its position
};

struct DemandFollowerState {
  // u. Velocity mode: own position minus the demand's, fixed while in step. Position mode: the caller's own.
  double offset = 0;
  bool in_step = false;  // the last set point was the demand itself
};

struct DemandFollower {
  Limits own;  // of the axis
  Planner& planner;
  Limits catching_up;  // of the command: how fast to get into step; within the axis' own
  double period_s;
};

// The set point that follows `before`, one cycle later, for a demand of that same instant.
//
// Invariant S(x): the speed of x stays within the axis' velocity even while its acceleration ends with the axis' jerk:
// |v + a|a| / 2j| <= vmax. With S(before), for every demand whatsoever:
//   - S(next) holds, and so |v| <= vmax;
//   - |a| <= acceleration while the speed grows, deceleration while it falls, or no more than before had of it; what
//     only falling speed may have is gone before the axis turns round;
//   - |a - a_before| <= jerk * period; position and velocity are those of a motion with that jerk.
// A demand that keeps all this, and continues `before`, is taken bit for bit: in step. Any other is chased: planned
// anew in each cycle in the frame of the demand as if it kept its acceleration; where limits leave no room for that,
// towards its velocity as far as the axis' own goes. SW limits are the caller's affair.
KinematicState FollowDemand(const DemandFollower& chaser, DemandMode mode, const KinematicState& before,
                            const KinematicState& demand, DemandFollowerState& state) noexcept;

// What of a demand is more than the axis can; out of step: more than leaves it room to catch up.
LimitedBy Beyond(const Limits& own, const KinematicState& demand, bool in_step) noexcept;

void describe(Description<DemandFollowerState>&);

}  // namespace takt::trajectory
