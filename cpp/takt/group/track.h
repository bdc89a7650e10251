// MC_TrackConveyorBelt and MC_TrackRotaryTable: the tool gets into step with an object on a belt or a table, and out of
// step again, by itself. Moves in the object's coordinate system run on top.
//
// Along the travel of the carrier the tool gets to where the object is, across it stays where it is: whoever wants it
// on the object moves it there, in that coordinate system.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Checks a command and lets it wait. An error: nothing has changed.
ErrorId BeginTracking(const Context& c, Ticket ticket, const TrackConveyorBelt& command, State& s) noexcept;
ErrorId BeginTracking(const Context& c, Ticket ticket, const TrackRotaryTable& command, State& s) noexcept;

// move, before anything is planned.
void StepTracking(const Context& c, State& s) noexcept;
// move, behind the set points: what came of them.
void WatchTracking(const Context& c, State& s) noexcept;
// Tracking is over, if there was any.
void EndTracking(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;

// A move in the coordinate system of an object that is not tracked yet waits for it.
bool WaitsForTracking(const State& s, const Request& move) noexcept;

TrackState TrackStateOf(const Context& c, const State& s) noexcept;

}  // namespace takt::group
