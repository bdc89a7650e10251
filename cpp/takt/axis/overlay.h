// A motion superimposed on another (MC_MoveSuperimposed): a distance of its own that is added to the set points of the
// motion in progress, the base motion, which is not aware of it.
//
// The axis has two set points then: that of the base motion, as if nothing was superimposed, and that of the axis,
// which follows the sum of both. Invariants, whatever both motions are:
//   - Every set point of the axis keeps the axis' velocity, acceleration, deceleration and jerk, and continues the one
//     before (trajectory/demand_follower.h). A sum that does so itself is taken bit for bit; else the axis lags behind
//     the sum, `limited_by` says why, and it catches up as soon as the limits allow.
//   - The base motion is the same as without an overlay: its command is done when it would be done alone.
//   - From every set point a stop ends inside the SW limits. If the base motion has an end, the axis waits before them;
//     if it has none, they are the fault that they would be for that motion alone.
//   - The distance is done when all of it is added and the axis is in step with the sum. It then becomes part of the
//     base motion, whose end moves by it: the axis ends at that end + distance, exactly. The ends of commands that
//     begin meanwhile move by it, too; those of commands that begin afterwards do not.
//   - Overrides (AX-51) act on both. One that holds the axis holds the overlay, too, until the factor is raised.
//   - A command that aborts the base motion begins from the set point of the axis, and aborts the overlay: the distance
//     covered stays.
//
// So that the axis need not lag, a distance on top of a base motion that is known ahead is planned for it: with no more
// velocity than it leaves, and either with no more than it leaves of the ramps, or so late that the ramps of both do
// not meet (axis/overlay_plan.h).
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
  KinematicState base;          // set point of the base motion
  trajectory::Profile profile;  // added, from 0 on
  std::uint64_t start_cycle = 0;
  std::uint64_t base_start_cycle = 0;  // of the base motion for which it was planned
  double base_start_offset_s = 0;      // [s] of the same
  trajectory::DemandFollowerState chase;
  Ticket ticket = 0;
  Override factors;    // for which it was planned
  double target = 0;   // [u] to be added in all
  double begin = 0;    // [u] added before the command
  double covered = 0;  // [u] by the command
  // The limits of the command: [u/s], [u/s²], [u/s³].
  double velocity = 0;
  double acceleration = 0;
  double deceleration = 0;
  double jerk = 0;
  bool halting = false;
  LimitedBy limited_by = LimitedBy::kNothing;
};

// Scope in which `setpoint` is that of the base motion. Has no effect unless a motion is superimposed. Must not be
// nested; nothing in its scope may end the superimposed motion.
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

// Computes the set point of the axis; each cycle with a superimposed motion (`superimposed`), once the base motion has
// its set point.
void Superimpose(const Context& c, State& s) noexcept;
// Ends the superimposed motion, if any; the caller must replace the motion of the axis.
void AbortOverlay(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;
// Returns true if the base motion is at rest.
bool BaseAtRest(const State& s) noexcept;
// Returns true if a motion can be superimposed on this command. If it cannot, the buffered command waits for the
// overlay while the base motion is at rest, and aborts the overlay if the base motion moves.
bool Carries(const Request& r) noexcept;
// Returns the distance [u] by which the end of the motion in progress moves because of the overlay; 0 if there is none.
double AddedAtEnd(const State& s) noexcept;

// Returns kState in Homing, or if the command in control carries no overlay (torque control, a touch, a stream,
// guidance) or the axis follows another from load on; kAxisStopping, kErrorStop, kPowerOff, kNoConstants; the errors of
// MayMove; kTargetBehindLimit if the end would be outside the SW limits.
Status CarryOut(const Context& c, Ticket ticket, const MoveSuperimposed& command, State& s) noexcept;
// Done at once if nothing is superimposed.
Status CarryOut(const Context& c, Ticket ticket, const HaltSuperimposed& command, State& s) noexcept;

void describe(Description<OverlayState>&);

}  // namespace takt::axis
