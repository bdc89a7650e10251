// The clutch between Y and the slave (the manual's 3.14 to 3.16, 3.20, 3.21).
//
// Contract: from the cycle in which a closing or an opening is accepted, the demand on the slave is a known curve, over
// the master's displacement (ramp_pos) or over time (ramp_time, ramp_vel_acc). It has no step in position, velocity or
// acceleration for any motion of the master, and it is within the slave's limits for every motion of the master up to
// the published speed `fastest`. A request that cannot be met that way is refused, or waits; `waits` gives the reason.
//
// Why it holds for ramp_pos:
// - A curve begins exactly at its planned position of the master, not in the cycle that finds the master beyond it, so
//   it is as long as requested and ends at the promised position. A sync position that leaves no room for the whole
//   distance is not used: a rotary master closes a turn later, a linear one as sync_in_passed says.
// - A curve is a function of the master's position, and so is the slave's motion before its begin (rest, the cam, or an
//   earlier curve). A master that reverses takes the slave back along it; behind the begin the curve is discarded and
//   the clutch waits as it did before, from then on for a master in the other sense. So it closes, and opens, in
//   whichever sense the master continues. A rotary slave that returns onto the cam is in the turn in which it left it.
// - The cam is a function of the master's position because no offset or factor ramp is in progress when a curve begins,
//   and no ramp begins and the cam does not change until the slave has left all curves (IsOnCurve).
// - Peak velocity, acceleration and jerk over time follow from the derivatives of the curve and the master's speed
//   (clutch_curve.h). They are compared with the slave's limits when a curve is planned and when it begins. If the
//   master becomes faster on the curve, the slave lags behind, within its limits; the module warns (kSlaveLimits).
// For ramp_time: the shift between the slave and Y is a quintic over time. If the time does not suffice for the slave's
// limits it is stretched until it does, and the module warns. Immediate modes (absolute, relative) are followed within
// the slave's limits (axis/guidance.h).
//
// Without reversing (PositionControl::kMasterDirection) a curve over the master's displacement is only used if its
// slope is not negative; otherwise the next turn of a rotary slave is tried, then a later begin: a shorter distance is
// steeper but does not reverse. If none serves, the closing is refused, and the opening waits on the cam until a curve
// serves.
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

// A curve may begin on another one, to which the slave returns if the master reverses.
inline constexpr std::size_t kClutchCurves = 3;

struct ClutchState {
  ClutchPhase phase = ClutchPhase::kOpen;
  ClutchMode mode = ClutchMode::kAbsolute;  // mode in which it closes or opens
  Ramp ramp;                                // of the modes over time
  bool stretched = false;                   // the ramp takes more time than requested
  double out = 0;                           // [u] over all turns: where the slave rests, or comes to rest

  // Over the master's displacement. The last curve is followed; each began on the one before it, the first one on the
  // cam (from_cam) or at rest.
  std::array<ClutchCurve, kClutchCurves> curves;
  std::uint8_t curve_count = 0;
  bool from_cam = false;

  // Waiting to close or open.
  ClutchWait waits = ClutchWait::kNothing;
  ClutchMode next = ClutchMode::kAbsolute;  // mode of the closing that waits; `mode` is still that of the opening
  bool opens_still = false;                 // the opening was not complete when the closing was requested
  bool leaves = false;                      // while closing: an opening has been requested and begins as soon as it can
  double sense = 0;                         // of the master since the waiting began; 0: not known yet
  double furthest = 0;                      // [master's u] furthest position of the master in that sense
  double looked_from = 0;                   // [master's u] a curve begins here or further on
  double planned_sense = 0;                 // of the master, for which `place` and `distance` were planned; 0: no plan
  double accepted_sense = 0;                // sense of the first plan
  double place = 0;                         // [master's u] position at which it will be closed
  double distance = 0;                      // [master's u] length of the curve, which begins this far before `place`
  double waits_since = 0;                   // [master's u] position of the master when it began to wait for opening
};

// The data of a cycle from outside the clutch. Positions are over all turns.
struct ClutchContext {
  const Cycle& cycle;
  trajectory::Planner& planner;
  const Settings& settings;
  const axis::AxisParams& slave;
  const cam::Table& table;
  double master_turn = 0;  // [master's u] one turn; 0: linear
  double master_zero = 0;  // [master's u] zero of the master's own position
  bool measured = false;   // the master's position is measured
  double slave_zero = 0;
  KinematicState master, master_before;  // in this cycle and the previous one
  KinematicState own_before;             // set point of the slave in the previous cycle
  KinematicState wanted_before;          // position of the slave by Y, in the previous cycle
  bool in_step = false;                  // the slave's set point had reached its demand
  bool at_rest = false;
};

bool IsCoupled(const ClutchState& state) noexcept;  // the slave follows the clutch
bool IsFrozen(const ClutchState& state) noexcept;   // scaling and offset of the slave are frozen (CAM-38)
// Returns true on a curve over the master's displacement: the cam, and scaling and offset of the master, are frozen,
// too.
bool IsOnCurve(const ClutchState& state) noexcept;
// Returns true on a curve over the master's displacement or a ramp over time.
bool IsOnRamp(const ClutchState& state) noexcept;
// Returns the curve that the slave follows; null if it follows none.
const ClutchCurve* FollowedCurve(const ClutchState& state) noexcept;

// Request a closing or an opening, which StepClutch carries out as soon as it can.
void BeginClosing(const ClutchContext& c, ClutchState& state) noexcept;
void BeginOpening(const ClutchContext& c, ClutchState& state) noexcept;

// Each cycle: computes the demand on the slave, `wanted` being its position by Y. Fails if the closing is refused
// (kWouldReverse, kSyncPassed, kSlaveLimits), or if the opening found no curve within a whole cycle of the cam
// (kWouldReverse, kSlaveLimits): then the slave stays on the cam.
Status StepClutch(const ClutchContext& c, const KinematicState& wanted, Way& way, ClutchState& state,
                  KinematicState& demand) noexcept;

void describe(Description<ClutchState>&);

}  // namespace takt::flexcam
