// A mover that follows an axis or another mover on tracks (PL-14).
#pragma once

#include "takt/mover/mover.h"

namespace takt::mover {

// Returns true if the mover is geared, in sync or not.
inline bool IsGeared(const Context& c, const State& s) noexcept {
  return s.track != planar::kNoTrack && c.rider().on && c.rider().aim == planar::Aim::kFollow;
}
// Returns true if `mover` is `master`, or follows it directly or over other movers.
bool IsFollowedBy(const TrackNetworkState& streets, std::uint32_t master, std::uint32_t mover) noexcept;

// Before traffic: updates the demand and the route from the master, as of the end of this cycle. The gear ends if the
// master is lost.
void Lead(const Context& c, State& s) noexcept;
// After traffic: reports a change of in-sync, and the end of the gear where its route ends.
void NoteGear(const Context& c, State& s) noexcept;

}  // namespace takt::mover
