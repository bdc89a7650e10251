// Axes that follow a master from load on (gantry, line shaft), in the same cycle, without a loop of their own around
// it.
//
// A follower whose loop is closed is coupled to a master whose loop is closed, in every state: its set point is the
// master's times the ratio, plus an offset that belongs to the machine, plus the skew of the set points. The offset is
// found once and never again by power on: where a follower stands elsewhere when it is powered, that is a skew. The
// skew stays as it is until it is straightened, and a master with a skewed or unpowered follower takes no motion. So
// members cannot move against one another, but where a drive fails to follow its set point; and that is watched.
#pragma once

#include <string>

#include "takt/axis/axis.h"

namespace takt::axis {

// Why `follower` could not keep up with `master` at its limits; empty: it can.
std::string CannotFollow(const AxisParams& follower, const AxisParams& master);

// Takes the set point from the master where the axis is coupled to it; couples it once both stand with closed loops.
// False: not coupled, the axis goes on by itself. A follower never leaves its limits: they were held against the
// master's at load.
bool Follow(const Context& context, State& state) noexcept;

// A coupled axis is where its master has it, and well.
bool InStep(const AxisParams& params, const State& state) noexcept;

// Every cycle of an axis that follows: measures the skew and watches it.
void WatchSkew(const Context& context, State& state) noexcept;

// Whether all that follow this axis from load on are powered, well and in step (kNotInStep). Ok: nothing follows it.
Status FollowersReady(const Context& context, const State& state) noexcept;

// Whether an axis that follows this one is on a limit switch that lies ahead in this sense. `since_before`: and was so
// in the cycle before.
bool FollowerOnLimit(const Context& context, const State& state, int sense, bool since_before = false) noexcept;

// The first follower that is on a limit switch ahead or may not move in this sense; kNoAxis: none.
std::uint32_t FollowerThatBars(const Context& context, const State& state, int sense) noexcept;

// The gate of every motion that begins: whether the axis and all that follow it, followers of followers too, may move
// in this sense. kAwayFromLimitOnly: a limit switch ahead is on. kDirection: not enabled. 0: it does not move.
Status MayMove(const Context& context, const State& state, int sense) noexcept;

// Whether an axis that follows this one is being straightened, or comes to rest from that.
bool FollowersStraighten(const Context& context, const State& state) noexcept;

// Brakes the straightening of a follower; what is left of its skew stays. Its command ends.
void StopStraightening(const Context& context, const trajectory::Limits& limits, State& state) noexcept;

// Whether MC_Power enables no motion in this sense, of this axis or of one that follows it (AX-111).
bool Bars(const Context& context, const State& state, int sense) noexcept;

// While this axis searches its reference switch: each follower that is squared by it has found its own ...
bool FollowersFound(const Context& context, const State& state) noexcept;
// ... and, it being found, stand straight.
bool FollowersSquared(const Context& context, const State& state) noexcept;

Status CarryOut(const Context& context, Ticket ticket, const Straighten& command, State& state) noexcept;

}  // namespace takt::axis
