// The clutch between Y and the slave (the manual's 3.14 to 3.16, 3.20, 3.21).
//
// Contract: from the cycle in which a closing or an opening is accepted, the demand on the slave is a known curve, over
// the master's displacement (ramp_pos) or over time (ramp_time, ramp_vel_acc). It has no step in position, velocity or
// acceleration for any motion of the master, and it is within the slave's limits for every motion of the master up to
// the published speed `fastest`. What cannot keep that is refused, or waits, and `waits` says for what.
//
// Why it holds for ramp_pos:
// - A curve begins exactly at its planned position of the master, not in the cycle that finds the master beyond it, so
//   it is as long as asked for and ends at the promised position. A sync position that leaves no room for the whole
//   distance is not used: the next turn of a rotary master is taken, else what sync_in_passed says.
// - A curve is a function of the master's position, and so is what the slave did before its begin (rest, the cam, or an
//   earlier curve). A master that turns round takes the slave back along it; behind the begin the curve is taken back
//   and the clutch waits as it did before, from then on for a master in the other sense. So it closes, and opens,
//   whichever way the master goes on. A rotary slave that gets back onto the cam is there in the turn that it left.
// - The cam is a function of the master's position because no ramp of an offset or factor is under way when a curve
//   begins, and none begins, nor does another cam, until the slave has left all curves (IsOnCurve).
// - Peak velocity, acceleration and jerk over time follow from the derivatives of the curve and the master's speed
//   (clutch_curve.h). They are compared with the slave's limits when a curve is planned and when it begins. A master
//   that gets faster on the curve leaves the slave behind, within its limits; the module warns (kSlaveLimits).
// For ramp_time: the shift between the slave and Y is a quintic over time. Where the time does not suffice for the
// slave's limits it is stretched until it does, and the module warns.
// What is asked to happen at once (absolute, relative) is followed within the slave's limits (axis/guidance.h).
//
// Without reversing (PositionControl::kMasterDirection) a curve over the master's displacement is only taken if its
// slope is not negative; else the next turn of a rotary slave is tried, then a later begin: a shorter distance is
// steeper but does not turn round. If none serves, the closing is refused, and the opening waits on the cam until one
// does.
#pragma once

#include <array>
#include <cstdint>

#include "takt/axis/params.h"
#include "takt/core/cycle.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/status.h"
#include "takt/flexcam/clutch_curve.h"
#include "takt/flexcam/outputs.h"
#include "takt/flexcam/ramp.h"
#include "takt/flexcam/settings.h"
#include "takt/flexcam/way.h"

namespace takt::flexcam {

// A curve may begin on another one, which the slave comes back to if the master turns round.
inline constexpr std::size_t kClutchCurves = 3;

struct ClutchState {
  ClutchPhase phase = ClutchPhase::kOpen;
  ClutchMode mode = ClutchMode::kAbsolute;  // in which it closes or opens
  Ramp ramp;                                // of the modes over time
  bool stretched = false;                   // it takes more time than was asked for
  double out = 0;                           // u over all turns, where the slave rests, or comes to rest

  // Over the master's displacement. The last curve is followed; each began on the one before it, the first one on the
  // cam or at rest.
  std::array<ClutchCurve, kClutchCurves> curves;
  std::uint8_t curve_count = 0;
  bool from_cam = false;

  // Waiting.
  ClutchWait waits = ClutchWait::kNothing;
  ClutchMode next = ClutchMode::kAbsolute;  // mode in which it is to close; `mode` is that of an opening still
  bool opens_still = false;                 // it had not come to its end when it was told to close
  bool leaves = false;                      // closing: it is to open as soon as it can
  double sense = 0;                         // of the master since the waiting began; 0: not known yet
  double furthest = 0;                      // master's u: where it was furthest in that sense
  double looked_from = 0;                   // master's u: a curve begins here or further on
  double planned_sense = 0;                 // of the master, for which `place` and `distance` were planned; 0: none
  double accepted_sense = 0;                // of the first plan
  double place = 0;                         // master's u, where it is to be closed
  double distance = 0;                      // master's u, before that: where the curve begins
  double waits_since = 0;                   // to open: master's u, where that began
};

// All that is not the clutch's own. Positions are over all turns.
struct ClutchContext {
  const Cycle& cycle;
  trajectory::Planner& planner;
  const Settings& settings;
  const axis::AxisParams& slave;
  const cam::Table& table;
  double master_turn = 0;  // master's u; 0: it has none
  double master_zero = 0;  // where the master's own position is 0
  bool measured = false;   // the master's position is a measured one
  double slave_zero = 0;
  KinematicState master, master_before;  // in this cycle and the one before
  KinematicState own_before;             // set point of the slave in the cycle before
  KinematicState wanted_before;          // by Y, in the cycle before
  bool in_step = false;                  // the slave's set point was what was wanted of it
  bool at_rest = false;
};

bool IsCoupled(const ClutchState& state) noexcept;  // the slave goes by the clutch
bool IsFrozen(const ClutchState& state) noexcept;   // scaling and offset of the slave stay (CAM-38)
// On a curve over the master's displacement: the cam, and scaling and offset of the master, stay, too.
bool IsOnCurve(const ClutchState& state) noexcept;
// On a curve over the master's displacement or over time.
bool IsOnRamp(const ClutchState& state) noexcept;
// The curve that the slave follows or, while the closing waits, is to follow; null: there is none, or not known yet.
const ClutchCurve* FollowedCurve(const ClutchState& state) noexcept;

void BeginClosing(const ClutchContext& c, ClutchState& state) noexcept;
void BeginOpening(const ClutchContext& c, ClutchState& state) noexcept;

// Each cycle: what the slave is to do, `wanted` being what Y says. Fails where the closing is refused (kWouldReverse,
// kSyncPassed, kSlaveLimits), and where the opening found no curve within a whole cycle of the cam (kWouldReverse,
// kSlaveLimits): then the slave stays on the cam.
Status StepClutch(const ClutchContext& c, const KinematicState& wanted, Way& way, ClutchState& state,
                  KinematicState& demand) noexcept;

void describe(Description<ClutchState>&);

}  // namespace takt::flexcam
