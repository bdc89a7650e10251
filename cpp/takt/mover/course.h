// How a mover stays clear of all others, whatever moves it: its side of the guard (planar/guard.h).
#pragma once

#include "takt/mover/run.h"
#include "takt/planar/guard.h"

namespace takt::mover {

// Sets the course that the guard knows to that of a mover that brakes from its state at the beginning of this cycle.
// Traffic does this for movers that it moves.
void SetCourse(const Context& c, const State& s) noexcept;
// At the end of each step: the same for a mover that has come to rest, turns, or is displaced from its track; and the
// area where its part will bring it.
void UpdateCourseAtRest(const Context& c, const State& s) noexcept;

// Returns the mover that the course from set point `at`, in the plane, would overlap; none: that course is taken.
ObjectInfo TryCourse(const Context& c, const SetPoint& at, State& s) noexcept;
// Returns how the mover comes to rest from the beginning of this cycle, as the guard knows it.
StopMotion StopMotionOf(const Context& c, const State& s) noexcept;
// Returns the mover that this one would overlap, at its position and during its stop, with the rotation `turn`; none:
// it may turn.
ObjectInfo FindTurnObstacle(const Context& c, const State& s, const CoordinateMove& turn) noexcept;
// As TryCourse, for a mover on a track that external set points displace from its position there.
ObjectInfo TakeCourseOff(const Context& c, const State& s, const SetPoint& at) noexcept;
// Returns the mover whose course this one would overlap if it were set to `at` with the angle `turned` [deg].
ObjectInfo FindCourseObstacle(const Context& c, const planar::Spot& at, double turned) noexcept;

// X and Y brake for another mover, and continue once the path ahead is clear over the braking distance from the
// commanded velocity (IsHeld).
void Hold(const Context& c, std::uint32_t other, State& s) noexcept;
// Returns true if a mover that was held, now at rest on its line, still has another mover in its way.
bool IsHeld(const Context& c, State& s) noexcept;

}  // namespace takt::mover
