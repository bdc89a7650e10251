// A motion on top of another (MC_MoveSuperimposed): a distance of its own that is added to the set points of the motion
// in progress, which knows nothing of it.
//
// The axis has two set points then: that of the motion beneath, as if nothing lay on top of it, and that of the axis,
// which follows the sum of both. Invariants, whatever both motions are:
//   - Every set point of the axis keeps its velocity, acceleration, deceleration and jerk, and continues the one before
//     (trajectory/demand_follower.h). Where the sum does so itself, it is taken bit for bit; else the axis lags behind
//     the sum, `limited_by` says why, and it catches up as soon as the limits leave room.
//   - The motion beneath is what it would be alone: its command is done when it would be done alone.
//   - From every set point a stop ends inside the SW limits. Beneath a motion with an end the axis waits
//   before them;
//     beneath one without, they are the fault they would be for that motion alone.
//   - The distance is done when all of it is added and the axis is in step with the sum. It is then made part of the
//     motion beneath, which ends so much further on: the axis ends at its end + distance, exactly. Commands that
//     begin while it is in progress end so much further on, too; those that begin afterwards do not.
//   - Overrides (AX-51) act on both. One that holds the axis holds what lies on top, too, until it goes on.
//   - What aborts the motion in progress begins from the set point of the axis, and aborts what lies on top: what was
//     covered stays.
//
// So that the axis need not lag, a distance on top of a motion that is known ahead is planned for that: with no more
// velocity than is left, and either with no more than is left of the ramps or so late that the ramps of both do not
// meet (axis/overlay_plan.h).
#pragma once

#include <cstdint>

#include "takt/axis/commands/overlay.h"
#include "takt/axis/override.h"
#include "takt/core/feedback.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/demand_follower.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

struct Context;
struct Request;
struct State;

struct OverlayState {
  KinematicState base;          // the set point of the motion beneath
  trajectory::Profile profile;  // what is added, from 0 on
  std::uint64_t start_cycle = 0;
  std::uint64_t base_start_cycle = 0;  // of the motion beneath for which it was planned ...
  double base_start_offset_s = 0;      // ... and s
  trajectory::DemandFollowerState chase;
  Ticket ticket = 0;
  Override factors;    // for which it was planned
  double target = 0;   // [u] what is to be added in all
  double begin = 0;    // [u] what had been added before the command
  double covered = 0;  // [u] by the command
  // u/s ...: the limits of the command.
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;
  bool halting = false;
  LimitedBy limited_by = LimitedBy::kNothing;
};

// For what concerns the motion beneath alone: while it lives, `setpoint` is that motion's. Without a motion on top it
// does nothing. Not to be nested; nothing in its scope may end the motion on top.
class ScopedBaseMotion {
 public:
  explicit ScopedBaseMotion(State& state) noexcept;
  ~ScopedBaseMotion();
  ScopedBaseMotion(const ScopedBaseMotion&) = delete;
  ScopedBaseMotion& operator=(const ScopedBaseMotion&) = delete;

 private:
  void Swap() noexcept;
  State& state_;
};

// Each cycle in which something is on top (`superimposed`), once the motion beneath has its set point: that of the
// axis.
void Superimpose(const Context& c, State& s) noexcept;
// Ends what is on top, if anything is; its motion is the caller's to replace.
void AbortOverlay(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
// Whether the motion beneath stands.
bool StandsBeneath(const State& s) noexcept;
// Whether something can lie on top of this command. One that cannot waits for what lies on top of a standing axis, and
// aborts what lies on top of a moving one.
bool Carries(const Request& r) noexcept;
// [u] how much further the motion in progress ends because of what is on top of it.
double AddedAtEnd(const State& s) noexcept;

// kState: in Homing, while a torque is controlled, while the axis goes to where it was touched. kAxisStopping,
// kErrorStop, kPowerOff. kTargetBehindLimit: the end would lie outside the SW limits.
Status CarryOut(const Context& c, Ticket ticket, const MoveSuperimposed& command, State& s) noexcept;
// Done at once if nothing is on top.
Status CarryOut(const Context& c, Ticket ticket, const HaltSuperimposed& command, State& s) noexcept;

void describe(Description<OverlayState>&);

}  // namespace takt::axis
