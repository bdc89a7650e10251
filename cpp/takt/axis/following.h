// Axes that follow a master from load on (gantry, line shaft), in the same cycle, without a control loop of their own
// around it.
//
// A follower with a closed loop is coupled to a master with a closed loop, in every state: its set point is the
// master's times the ratio, plus an offset that belongs to the machine, plus the skew of the set points. The offset is
// determined once, and not again at power on: if a follower is at another position when it is powered, that is a skew.
// The skew stays until it is straightened, and a master with a skewed or unpowered follower rejects motions. So members
// cannot move against one another unless a drive fails to follow its set point, which is supervised.
#pragma once

#include <string>

#include "takt/axis/axis.h"

namespace takt::axis {

// Returns why `follower` could not keep up with `master` at its limits; empty if it can.
std::string CannotFollow(const AxisParams& follower, const AxisParams& master);

// Takes the set point from the master if the axis is coupled; couples it once both are at rest with closed loops.
// Returns false if it is not coupled and moves by itself. A follower never exceeds its limits: they were checked
// against the master's at load.
bool Follow(const Context& context, State& state) noexcept;

// Returns true if a coupled axis is where its master requires it, without a fault.
bool InStep(const AxisParams& params, const State& state) noexcept;

// Measures and supervises the skew; each cycle of an axis that follows.
void WatchSkew(const Context& context, State& state) noexcept;

// Returns kNotInStep unless all axes that follow this one from load on are powered, without a fault and in step. Ok if
// none follows it.
Status FollowersReady(const Context& context, const State& state) noexcept;

// Returns true if a follower of this axis is on the limit switch ahead in this sense of the axis. `since_before`: and
// was so in the previous cycle.
bool FollowerOnLimit(const Context& context, const State& state, int sense, bool since_before = false) noexcept;

// Returns the first follower that is on the limit switch ahead, or may not move, in this sense; kNoAxis if none is.
std::uint32_t BlockingFollower(const Context& context, const State& state, int sense) noexcept;

// Checks that the axis and all its followers, also indirect ones, may begin a motion in this sense. Returns
// kAwayFromLimitOnly if a limit switch ahead is on, kDirection if the sense is not enabled. `sense` 0: no motion.
Status MayMove(const Context& context, const State& state, int sense) noexcept;

// Returns true while a follower of this axis is being straightened, or comes to rest from that.
bool FollowersStraighten(const Context& context, const State& state) noexcept;

// Brakes the straightening of a follower and ends its command; the remaining skew stays.
void StopStraightening(const Context& context, const trajectory::Limits& limits, State& state) noexcept;

// Returns true if MC_Power does not enable motion in this sense for this axis or for a follower (AX-111).
bool Bars(const Context& context, const State& state, int sense) noexcept;

// Returns true once each follower that is squared by this axis' search of the reference switch has found its own
// switch.
bool FollowersFound(const Context& context, const State& state) noexcept;
// Returns true once these followers, after the switches were found, are straight.
bool FollowersSquared(const Context& context, const State& state) noexcept;

Status CarryOut(const Context& context, Ticket ticket, const Straighten& command, State& state) noexcept;

}  // namespace takt::axis
