// What commands and the mover's own steps have in common.
#pragma once

#include <algorithm>
#include <cstddef>

#include "takt/mover/mover.h"

namespace takt::mover {

void Report(const Context& c, Ticket ticket, FeedbackState state, ErrorId error, double value, State& s,
            const ObjectInfo& object = {}) noexcept;
// The command in a slot is over.
void End(const Context& c, Slot slot, FeedbackState state, ErrorId error, State& s,
         const ObjectInfo& object = {}) noexcept;
// Those of all slots, but for enabling and the like if not `power`.
void EndAll(const Context& c, bool power, FeedbackState state, ErrorId error, State& s,
            const ObjectInfo& object = {}) noexcept;
void Enter(const Context& c, planar::ObjectState state, State& s) noexcept;

// s since `begin` when this cycle begins.
inline double Elapsed(const Context& c, std::uint64_t begin) noexcept {
  return static_cast<double>(c.cycle.count - begin) * c.cycle.period_s;
}
// As planned, without set points from outside: when this cycle begins.
inline KinematicState Now(const Context& c, const CoordinateMove& move) noexcept {
  return move.profile.At(Elapsed(c, move.begin));
}
// Whether a motion is over when this cycle begins.
inline bool IsOver(const Context& c, const CoordinateMove& move) noexcept {
  return Elapsed(c, move.begin) >= move.profile.duration();
}
inline bool IsOver(const Context& c, const PlaneMove& move) noexcept {
  return !move.waits && !move.passes && Elapsed(c, move.begin) >= DurationOf(move.motion);
}
// A motion of X and Y that goes round a corner ends within this cycle.
inline bool IsAtCorner(const Context& c, const PlaneMove& move) noexcept {
  return move.passes && Elapsed(c, move.begin) + c.cycle.period_s > DurationOf(move.motion);
}
// X and Y are where a track says.
inline bool IsOnTrack(const State& s) noexcept {
  return s.mode == CommandMode::kOnTrack || s.mode == CommandMode::kCRotationOnTrack;
}
// Its track leads it on, or is going to.
bool GoesAlongTrack(const Context& c, const State& s) noexcept;
// X and Y do not move when this cycle begins, and are not going to.
bool IsPlaneResting(const Context& c, const State& s) noexcept;
// The mover is on no track any more.
void LeaveStreets(const Context& c, State& s) noexcept;

// Nothing moves or is about to when this cycle begins.
bool IsResting(const Context& c, const State& s) noexcept;

// The parameters of one of kOthers; C limited to its window where that binds it.
CoordinateParams ParamsOf(const Context& c, const State& s, std::size_t other) noexcept;

// How X and Y come to rest in the plane from this set point, where the mover is when this cycle begins.
bool PlanStop(const Context& c, const State& s, const SetPoint& at, const trajectory::Limits& limits,
              PlaneMotion& rest) noexcept;
// All coordinates come to rest from where they are, X and Y within `plane`, or all with the maximum (null). Set points
// from outside are over; a mover that they have taken off its place on a track goes back there.
void BringToRest(const Context& c, const trajectory::Limits* plane, State& s) noexcept;

// Along its track alone, with these dynamics where they do not lead it off the stators, else with the maximum.
void BringToRestOnTrack(const Context& c, const trajectory::Limits& limits, State& s) noexcept;

// Returns the smaller one of each limit.
inline trajectory::Limits SmallerOf(const trajectory::Limits& a, const trajectory::Limits& b) noexcept {
  return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration),
          std::min(a.deceleration, b.deceleration), std::min(a.jerk, b.jerk)};
}

// Returns the dynamics of commands that give none; never above the maximum.
inline trajectory::Limits StandardOf(const PlaneParams& p) noexcept {
  return SmallerOf(p.standard.value_or(p.maximum).limits(), p.maximum.limits());
}
inline trajectory::Limits StandardOf(const CoordinateParams& p) noexcept {
  return SmallerOf(p.standard.value_or(p.maximum).limits(), p.maximum.limits());
}

}  // namespace takt::mover
