// Commands that change parameters of an axis at run time. They do not take control of it: done at once, or rejected.
#pragma once

#include <optional>

#include "takt/axis/axis.h"

namespace takt::axis {

// PLCopen Part 1, table of parameters.
enum class Parameter : std::int32_t {
  kCommandedPosition = 1,
  kLimitPositive = 2,
  kLimitNegative = 3,
  kEnableLimitPositive = 4,
  kEnableLimitNegative = 5,
  kEnableLagMonitoring = 6,
  kMaxPositionLag = 7,
  kMaxVelocitySystem = 8,
  kMaxVelocity = 9,
  kActualVelocity = 10,
  kCommandedVelocity = 11,
  kMaxAccelerationSystem = 12,
  kMaxAcceleration = 13,
  kMaxDecelerationSystem = 14,
  kMaxDeceleration = 15,
  kMaxJerkSystem = 16,
  kMaxJerk = 17,
  // Numbers from 1000 on are vendor-specific.
  kLoopKp = 1001,
  kLoopKi = 1002,
  kLoopKd = 1003,
  kLoopKc = 1004,
  kLoopFf = 1005,
  kLoopVmax = 1006,
  kMaxPositionLagStandstill = 1007,
  kTorqueLimit = 1008,
};

// Returns the value of a parameter in its unit, booleans as 0 and 1; empty if there is no such parameter. System limits
// are those of the machine file; application limits may be lower. A limit that is switched off keeps its value; one
// that was never set is infinite.
std::optional<double> ValueOf(const AxisParams& params, const State& state, std::int32_t number) noexcept;

// Return kTargetBehindLimit if a SW limit would be passed by the axis, its stop or a promised end of its motion,
// kParameter if a value is out of its range or the parameter cannot be written, kState if the axis is in no state for
// it.
Status CarryOut(const Context& c, Ticket ticket, const SetConstants& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const SetLoad& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const WriteParameter& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const ReadParameter& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const SetSoftLimits& command, State& s) noexcept;
// Returns kPowerOn unless the axis is Disabled, kState if its drive takes no voltage, kDirection if the direction is
// not enabled.
Status CarryOut(const Context& c, Ticket ticket, const DirectOutput& command, State& s) noexcept;
// Returns the same; done at the end of the pulse.
Status CarryOut(const Context& c, Ticket ticket, const PulseOutput& command, State& s) noexcept;
// Ends a pulse when due; each cycle of it (`pulsing`).
void WatchPulse(const Context& c, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const WriteOutput& command, State& s) noexcept;
// Renumbers the present position: nothing moves, a motion in progress ends at the same point. Returns kState in Homing,
// Stopping and ErrorStop, kTargetBehindLimit if the axis, or the end of its motion, would be outside the SW limits.
Status CarryOut(const Context& c, Ticket ticket, const SetPosition& command, State& s) noexcept;

}  // namespace takt::axis
