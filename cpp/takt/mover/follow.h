// Set points from outside (PL-13).
#pragma once

#include "takt/mover/mover.h"

namespace takt::mover {

// Takes the set point of this cycle into `at`, which holds where the mover would be without it. kNoSetPoint,
// kWildSetPoint, kOffStators, kPartDisabled, kCollision: `at` means nothing.
ErrorId Follow(const Context& c, SetPoint& at, State& s, ObjectInfo& object) noexcept;

// Returns the offset of X and Y from the pose on the track, with its derivatives: the motion back to the track, `t` [s]
// after its start, and the relative set point `more`. Requires: the mover is on a track.
PlaneState OffTrack(const State& s, const SetPoint& more, double t) noexcept;

// mm, no more than that a mover may get off its place on a track by set points from outside, as those are now.
double ReachOf(const Context& c, const State& s) noexcept;

// Whether the mover can go from one set point to the next within a cycle, and stop from there, by its maximum dynamics
// and within its limits.
bool CanFollow(const Context& c, const State& s, const SetPoint& from, const SetPoint& to) noexcept;

}  // namespace takt::mover
