// Forecast of a motion (AX-96) as it is planned now: later commands, overrides and faults change it. Pure: the axis
// does not change. Not for use in the cycle: it needs memory, and for a buffered command some time.
#pragma once

#include <cmath>

#include "takt/axis/axis.h"
#include "takt/axis/commands.h"
#include "takt/core/kinematic_state.h"
#include "takt/core/status.h"
#include "takt/trajectory/profile.h"

namespace takt::axis {

// Times are in s from the last set point, positions as the axis publishes them. Commands buffered behind the motion are
// not included: each has a forecast of its own.
struct Forecast {
  ErrorId error = ErrorId::kNone;  // the command would be rejected, or would fail before its turn
  // There is a plan. False: the axis follows something (a master, a table, a torque, a switch), a motion is
  // superimposed, or the command does not get its turn within kLongestWait_s. The other members mean nothing then.
  bool known = false;
  bool held = false;     // by an override: the profile ends where it holds the axis
  bool goes_on = false;  // keeps the velocity of its end; else it ends at rest or hands over to another command
  LimitedBy limited_by = LimitedBy::kNothing;
  double start_s = 0;  // [s] beginning of the motion; negative: it is in progress
  double modulus = 0;  // [u] of a rotary axis; linear axes: 0
  // SW limits: a motion that goes on ends there with a fault. The braking before them is not forecast.
  double lower = -HUGE_VAL, upper = HUGE_VAL;
  trajectory::Profile profile{};  // time 0 at start_s

  // Returns the time [s] until the end of the motion; infinity if it is held.
  double duration_s() const noexcept;
  // Returns the time [s] until the set point is first at `position`, not before the motion begins; NaN if never.
  double TimeTo(double position) const noexcept;
  // Returns the set point `in_s` seconds from now; before the motion begins, its first one.
  KinematicState At(double in_s) const noexcept;
};

inline constexpr double kLongestWait_s = 600;

// Returns the forecast of the motion in progress.
Forecast Foresee(const Context& context, const State& state);
// Returns the forecast of a command as if it were given now: a dry run. A command that has to wait gets its turn as
// with an ideal drive and masters at rest.
Forecast Foresee(const Context& context, const Command& command, const State& state);

}  // namespace takt::axis
