// Tables over time: MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile.
#pragma once

#include "takt/axis/request.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/demand_follower.h"

namespace takt::axis {

struct Context;
struct MotionStart;
struct State;

// The time counts as that of the motion in progress does.
struct TimeTableState {
  trajectory::DemandFollowerState chase;
  double turns = 0;       // u over all turns: where position 0 of the table's turn is
  KinematicState demand;  // of the cycle before; tables of velocity and acceleration: summed up, u over all turns
  bool over = false;      // its end was reached; the motion in progress goes on from there
};

inline bool FollowsTable(RequestKind kind) noexcept {
  return kind == RequestKind::kPositionProfile || kind == RequestKind::kVelocityProfile ||
         kind == RequestKind::kAccelerationProfile;
}
// Refuses what can be told from the lowest and highest value of the table, scaled: kTargetBehindLimit for positions
// outside the SW limits, kParameter for velocities or accelerations beyond the axis' own. What follows from them (the
// velocity of a table of positions, ...) is held against the limits on the way. kNoReference: positions mean nothing
// yet.
Status MayFollowTable(const Context& c, const Request& r, const State& s) noexcept;
// Puts a request that follows a table in control. What was in control must have been ended.
void BeginTable(const Context& c, const Request& r, const MotionStart& start, State& s) noexcept;
// Takes over from the one in control, of the same kind and table, with other scales (AX-111).
void UpdateTable(const Context& c, const Request& r, State& s) noexcept;
// The next set point; false: the table is over, the motion in progress counts.
bool FollowTime(const Context& c, State& s) noexcept;

void describe(Description<TimeTableState>&);

}  // namespace takt::axis
