// External set points (PL-13).
#pragma once

#include "takt/mover/mover.h"

namespace takt::mover {

// Replaces `at`, the set point without external ones, by that of this cycle. On kNoSetPoint, kWildSetPoint,
// kOffStators, kPartDisabled or kCollision `at` is unchanged; `object` is what the mover would collide with.
ErrorId Follow(const Context& c, SetPoint& at, State& s, ObjectInfo& object) noexcept;

// Returns the offset of X and Y from the pose on the track, with its derivatives: the motion back to the track, `t` [s]
// after its start, and the relative set point `more`. Requires: the mover is on a track.
PlaneState OffTrack(const State& s, const SetPoint& more, double t) noexcept;

// Returns an upper bound [mm] of the displacement from its position on the track that external set points cause, until
// the mover rests.
double ReachOf(const Context& c, const State& s) noexcept;

// Returns true if the mover can get from one set point to the next within a cycle, and stop from there, within its
// maximum dynamics and its limits.
bool CanFollow(const Context& c, const State& s, const SetPoint& from, const SetPoint& to) noexcept;

}  // namespace takt::mover
