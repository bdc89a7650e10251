// What a motion is going to do (AX-96), as it is planned now: commands, overrides and faults to come change it. Pure:
// nothing of the axis changes. Not for the cycle: it takes memory, and for a command that waits some time.
#pragma once

#include <cmath>

#include "takt/axis/axis.h"
#include "takt/axis/commands.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

// Times are in s from the last set point on, positions as the axis publishes them. Commands that wait behind the motion
// are not in it: each is asked for by itself.
struct Forecast {
  ErrorId error = ErrorId::kNone;  // the command would be refused, or would fail before its turn has come
  // There is a plan. False: the axis follows something (a master, a table, a torque, a switch), something lies on top
  // of its motion, or the turn of the command does not come within kLongestWait_s. The rest says nothing then.
  bool known = false;
  bool held = false;     // by an override: it goes as far as where that stops it
  bool goes_on = false;  // with the velocity at its end; else another command takes over there, or it is at rest
  LimitedBy limited_by = LimitedBy::kNothing;
  double start_s = 0;  // begin of the motion; negative: it is under way
  double modulus = 0;  // u, of a rotary axis
  // SW limits: a motion that goes on ends there with a fault. How it brakes before is not foreseen.
  double lower = -HUGE_VAL, upper = HUGE_VAL;
  trajectory::Profile profile{};  // time 0 at start_s

  // Until it has come to its end. Infinity: held.
  double duration_s() const noexcept;
  // Until the set point is at `position` first, from the later of now and the motion's begin on; NaN: never.
  double TimeTo(double position) const noexcept;
  // The set point so many seconds from now, before the motion what that begins with.
  KinematicState At(double in_s) const noexcept;
};

inline constexpr double kLongestWait_s = 600;

// Of the motion in progress.
Forecast Foresee(const Context& context, const State& state);
// Of a command if it were given now: a dry run. One that waits for others gets its turn as it would if the drive were
// ideal, and masters stood still.
Forecast Foresee(const Context& context, const Command& command, const State& state);

}  // namespace takt::axis
