// MC_TrackConveyorBelt and MC_TrackRotaryTable: the tool gets into sync with an object on a belt or a table, and out of
// sync again, by itself. Moves in the object's coordinate system are superimposed.
//
// Along the travel of the carrier the tool moves to the object, across it the tool keeps its position: a move in the
// object's coordinate system brings the tool onto the object.
#pragma once

#include "takt/group/group.h"

namespace takt::group {

// Check a command and let it wait. Return an error, with nothing changed, if it is refused.
ErrorId BeginTracking(const Context& c, Ticket ticket, const TrackConveyorBelt& command, State& s) noexcept;
ErrorId BeginTracking(const Context& c, Ticket ticket, const TrackRotaryTable& command, State& s) noexcept;

// Stage move, before planning.
void StepTracking(const Context& c, State& s) noexcept;
// Stage move, after the set points: updates Track::in_sync and ends tracking that is over.
void WatchTracking(const Context& c, State& s) noexcept;
// Ends tracking, if there is any, and reports its command.
void EndTracking(const Context& c, FeedbackState feedback, ErrorId error, State& s) noexcept;

// Returns true if a move waits for its object, which is not tracked yet.
bool WaitsForTracking(const State& s, const Request& move) noexcept;

TrackState TrackStateOf(const Context& c, const State& s) noexcept;

}  // namespace takt::group
