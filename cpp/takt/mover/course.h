// How a mover keeps off others wherever it goes: its side of the guard (planar/guard.h).
#pragma once

#include "takt/mover/run.h"
#include "takt/planar/guard.h"

namespace takt::mover {

// Tells the guard the course of a mover that brakes from where it is when this cycle begins. Traffic does so for movers
// that it moves.
void ShowCourse(const Context& c, const State& s) noexcept;
// The same once it is at rest, or turns; at the end of each step.
void ShowRest(const Context& c, const State& s) noexcept;

// A step in the plane to this set point, and whom its course from there would overlap; none: that is its course now.
ObjectInfo TakeCourse(const Context& c, const SetPoint& at, State& s) noexcept;
// How it comes to rest when this cycle begins, as the guard knows it.
Escape EscapeOf(const Context& c, const State& s) noexcept;
// Whom the mover would overlap where it is, and comes to rest, by such a rotation; none: it may turn.
ObjectInfo InTheTurn(const Context& c, const State& s, const CoordinateMove& turn) noexcept;
// The same of one on a track whose set point from outside is off its place there.
ObjectInfo TakeCourseOff(const Context& c, const State& s, const SetPoint& at) noexcept;
// Returns the mover whose course a mover would overlap that is set to this spot at the angle `turned` [deg].
ObjectInfo InTheCourse(const Context& c, const planar::Spot& at, double turned) noexcept;

// X and Y brake on their line for another mover, and go on once the way is clear as far as it takes to get fast.
void Hold(const Context& c, std::uint32_t other, State& s) noexcept;
// At rest on its line: whether another mover is still in the way of one that was held.
bool IsHeld(const Context& c, State& s) noexcept;

}  // namespace takt::mover
