// Pending changes of geometry: each is checked, built outside the cycle (build_queues.h) and taken over, one at a time.
#pragma once

#include "takt/track/tracks.h"

namespace takt::track {

// Appends an order. Returns false if there is no room.
bool Put(const Order& order, PendingEdits& works) noexcept;
bool HasPendingEdit(const PendingEdits& works, std::uint32_t track) noexcept;

// Ends orders that need no new geometry, and requests that of the next one that does.
void StepPendingEdits(const Context& c) noexcept;

// Takes over the answer to a request. Returns false if it is not the one awaited, or the track has not been delivered.
bool TakeAnswer(const Context& c, std::uint32_t track, const TrackMade& made) noexcept;

// Numbers the nodes at the ends of tracks, and the networks, anew.
void MakeNodes(Tracks& tracks) noexcept;
// Gives linked tracks the same network number.
void NumberNetworks(Tracks& tracks) noexcept;

}  // namespace takt::track
