// A mover that goes along with an axis or another mover, over tracks (PL-14).
#pragma once

#include "takt/mover/mover.h"

namespace takt::mover {

// It is geared, in step or not.
inline bool IsGeared(const Context& c, const State& s) noexcept {
  return s.track != planar::kNoTrack && c.rider().on && c.rider().aim == planar::Aim::kFollow;
}
// Whether `mover` goes along with this one, be it over others.
bool IsFollowedBy(const TrackNetworkState& streets, std::uint32_t master, std::uint32_t mover) noexcept;

// Before traffic: where its master is at the end of this cycle, and where that goes. Masters that are lost end the
// gear.
void Lead(const Context& c, State& s) noexcept;
// Behind traffic: says what has become of it.
void NoteGear(const Context& c, State& s) noexcept;

}  // namespace takt::mover
