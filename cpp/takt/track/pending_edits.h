// Changes of geometry on their way: each is looked at, made outside the cycle (build_queues.h) and taken over, one at a
// time.
#pragma once

#include "takt/track/tracks.h"

namespace takt::track {

// False: no room.
bool Put(const Order& order, PendingEdits& works) noexcept;
bool HasPendingEdit(const PendingEdits& works, std::uint32_t track) noexcept;

// Ends what needs nobody's help, and asks about the next one.
void StepWorks(const Context& c) noexcept;

// False: nobody waits for this answer, or what was made is not there.
bool TakeAnswer(const Context& c, std::uint32_t track, const TrackMade& made) noexcept;

// Numbers the points where tracks start and end, anew, and what hangs together.
void MakeNodes(Tracks& tracks) noexcept;
// Tracks that hang together get one number.
void NameNetworks(Tracks& tracks) noexcept;

}  // namespace takt::track
