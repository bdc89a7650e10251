// Commands that change, at run time, what an axis works with. They take no control of it: done at once, or refused.
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
  // Numbers from 1000 on are the maker's own.
  kLoopKp = 1001,
  kLoopKi = 1002,
  kLoopKd = 1003,
  kLoopKc = 1004,
  kLoopFf = 1005,
  kLoopVmax = 1006,
  kMaxPositionLagStandstill = 1007,
  kTorqueLimit = 1008,
};

// In the parameter's unit, 0 and 1 for no and yes. Nothing: there is no such parameter. The limits of the system are
// those of the machine file; those of the application may lie below them. What is switched off keeps its value; what
// there never was is infinite.
std::optional<double> ValueOf(const AxisParams& params, const State& state, std::int32_t number) noexcept;

// kTargetBehindLimit: a SW limit would lie before where the axis is, or before the end of a move that was promised.
// kParameter: a value is out of its range, or the parameter cannot be written.
Status CarryOut(const Context& c, Ticket ticket, const SetConstants& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const SetLoad& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const WriteParameter& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const ReadParameter& command, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const SetSoftLimits& command, State& s) noexcept;
// kPowerOn: only while the axis is Disabled. kState: its drive takes no voltage.
Status CarryOut(const Context& c, Ticket ticket, const DirectOutput& command, State& s) noexcept;
// Likewise; done when it is over.
Status CarryOut(const Context& c, Ticket ticket, const PulseOutput& command, State& s) noexcept;
// Each cycle of a pulse (`pulsing`): ends it.
void WatchPulse(const Context& c, State& s) noexcept;
Status CarryOut(const Context& c, Ticket ticket, const WriteOutput& command, State& s) noexcept;
// Calls where the axis is by another number: nothing moves, a motion in progress goes on to where it went. kState: in
// Homing and Stopping. kTargetBehindLimit: the axis, or the end of its motion, would lie outside the SW limits.
Status CarryOut(const Context& c, Ticket ticket, const SetPosition& command, State& s) noexcept;

}  // namespace takt::axis
