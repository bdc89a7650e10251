// Tracks on a surface made of parts (planar/parts.h): each lies on one of them, its geometry is given in the
// coordinates of that one and goes with it. Tracks of two parts are linked as long as these touch.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/planar/parts.h"
#include "takt/planar/problem.h"
#include "takt/planar/track.h"
#include "takt/track/state.h"

namespace takt::track {

// Where a track is, or is to be looked at.
struct Standing {
  std::uint32_t part = planar::kNoPart;
  std::uint32_t position = 0;  // index of the part's position, from 1; 0: that where it is now
};

// Its part's origin. Nothing: the part is on its way, or has no such position.
std::optional<planar::Spot> SpotOf(const planar::Parts& parts, const Standing& standing) noexcept;

// Brings an end of another track into the coordinates of the part where it is to be met: kApart, kNotOnBorder.
planar::Problem Meet(const planar::Parts& parts, const Standing& other, const Standing& own,
                     planar::TrackPoint& point) noexcept;

// Whether two ends, each in the coordinates of its part, are at one place where the parts are to be.
bool DoMeet(const planar::Parts& parts, std::uint32_t part_a, const planar::TrackPoint& a, std::uint32_t part_b,
            const planar::TrackPoint& b) noexcept;

// Whether all of a track lies on its part, to 1 mm. Not for the cycle.
bool LiesOn(const planar::Parts& parts, std::uint32_t part, const planar::Track& track);

}  // namespace takt::track
