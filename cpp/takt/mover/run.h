// Functions that both the commands and the steps of a mover use.
#pragma once

#include <algorithm>
#include <cstddef>

#include "takt/mover/mover.h"

namespace takt::mover {

void Report(const Context& c, Ticket ticket, FeedbackState state, ErrorId error, double value, State& s,
            const ObjectInfo& object = {}) noexcept;
// Ends the command in a slot, if there is one, and reports it.
void End(const Context& c, Slot slot, FeedbackState state, ErrorId error, State& s,
         const ObjectInfo& object = {}) noexcept;
// Ends the commands in all slots and aborts the buffer; kPower only with `power`.
void EndAll(const Context& c, bool power, FeedbackState state, ErrorId error, State& s,
            const ObjectInfo& object = {}) noexcept;
void Enter(const Context& c, planar::ObjectState state, State& s) noexcept;

// Returns the time [s] from the cycle `begin` to the beginning of this cycle.
inline double Elapsed(const Context& c, std::uint64_t begin) noexcept {
  return static_cast<double>(c.cycle.count - begin) * c.cycle.period_s;
}
// Returns the planned state at the beginning of this cycle, without external set points.
inline KinematicState Now(const Context& c, const CoordinateMove& move) noexcept {
  return move.profile.At(Elapsed(c, move.begin));
}
// Returns true if the motion is over when this cycle begins.
inline bool IsOver(const Context& c, const CoordinateMove& move) noexcept {
  return Elapsed(c, move.begin) >= move.profile.duration();
}
inline bool IsOver(const Context& c, const PlaneMove& move) noexcept {
  return !move.waits && !move.passes && Elapsed(c, move.begin) >= DurationOf(move.motion);
}
// Returns true if a motion of X and Y that blends a corner ends within this cycle.
inline bool IsAtCorner(const Context& c, const PlaneMove& move) noexcept {
  return move.passes && Elapsed(c, move.begin) + c.cycle.period_s > DurationOf(move.motion);
}
// Returns true if a track determines X and Y.
inline bool IsOnTrack(const State& s) noexcept {
  return s.mode == CommandMode::kOnTrack || s.mode == CommandMode::kCRotationOnTrack;
}
// Returns true if the mover moves along its track, or is about to.
bool IsMovingAlongTrack(const Context& c, const State& s) noexcept;
// Returns true if X and Y are at rest when this cycle begins, and no motion of them is pending.
bool IsPlaneResting(const Context& c, const State& s) noexcept;
// Takes the mover off its track.
void LeaveTrackNetwork(const Context& c, State& s) noexcept;

// Returns true if all coordinates are at rest when this cycle begins, and no motion is pending.
bool IsResting(const Context& c, const State& s) noexcept;

// Returns the parameters of a coordinate, an index into kOthers; C is limited to its window if that applies in its
// mode.
CoordinateParams ParamsOf(const Context& c, const State& s, std::size_t other) noexcept;

// Plans how X and Y stop in the plane from this set point, the state at the beginning of this cycle. Returns false if
// there is no such motion.
bool PlanStop(const Context& c, const State& s, const SetPoint& at, const trajectory::Limits& limits,
              PlaneMotion& rest) noexcept;
// Brings all coordinates to rest, X and Y within `plane`; null: all with the maximum dynamics. Ends external set
// points; a mover that they have displaced from its position on a track returns there.
void BringToRest(const Context& c, const trajectory::Limits* plane, State& s) noexcept;

// Brings the mover to rest along its track only, with these dynamics if they keep it on the stators, else with the
// maximum.
void BringToRestOnTrack(const Context& c, const trajectory::Limits& limits, State& s) noexcept;

// Returns the smaller of each limit.
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
