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

// The time counts like that of the motion in progress.
struct TimeTableState {
  trajectory::DemandFollowerState chase;
  double turns = 0;       // [u] over all turns: position 0 of the table's turn
  KinematicState demand;  // of the previous cycle; tables of velocity or acceleration: integrated, [u] over all turns
  bool over = false;      // its end was reached; the motion in progress continues from there
};

// Returns true for commands that follow a table over time.
inline bool FollowsTable(RequestKind kind) noexcept {
  return kind == RequestKind::kPositionProfile || kind == RequestKind::kVelocityProfile ||
         kind == RequestKind::kAccelerationProfile;
}
// Rejects what is known from the lowest and highest value of the scaled table. Returns kTargetBehindLimit for positions
// outside the SW limits, kParameter for velocities or accelerations beyond the axis' own, kNoReference if an absolute
// position needs a reference that the axis does not have. Derived values (the velocity of a table of positions, ...)
// are limited during the motion.
Status MayFollowTable(const Context& c, const Request& r, const State& s) noexcept;
// Puts a request that follows a table in control. Requires: the command that was in control has been ended.
void BeginTable(const Context& c, const Request& r, const MotionStart& start, State& s) noexcept;
// Takes over from the request in control, of the same kind and table, with other scales (AX-111).
void UpdateTable(const Context& c, const Request& r, State& s) noexcept;
// Computes the next set point. Returns false if the table is over: the motion in progress then gives it.
bool FollowTime(const Context& c, State& s) noexcept;

void describe(Description<TimeTableState>&);

}  // namespace takt::axis
