// Tracks on a surface made of parts (planar/parts.h): each lies on one part; its geometry is given in the coordinates
// of the part and moves with it. Tracks of two parts are linked while their ends meet.
#pragma once

#include <cstdint>
#include <optional>

#include "takt/planar/parts.h"
#include "takt/planar/problem.h"
#include "takt/planar/track.h"
#include "takt/track/state.h"

namespace takt::track {

// A part at one of its positions.
struct Standing {
  std::uint32_t part = planar::kNoPart;
  std::uint32_t position = 0;  // index of the position, from 1; 0: the current one
};

// Returns the origin of the part; nothing if the part is away, or has no such position.
std::optional<planar::Spot> SpotOf(const planar::Parts& parts, const Standing& standing) noexcept;

// Transforms an end of another track into the coordinates of `own`'s part. Returns kApart or kNotOnBorder if the tracks
// cannot meet there.
planar::Problem Meet(const planar::Parts& parts, const Standing& other, const Standing& own,
                     planar::TrackPoint& point) noexcept;

// Returns true if two ends, each in the coordinates of its part, coincide at the commanded positions of the parts.
bool DoMeet(const planar::Parts& parts, std::uint32_t part_a, const planar::TrackPoint& a, std::uint32_t part_b,
            const planar::TrackPoint& b) noexcept;

// Returns true if all of a track lies on its part, to within 2 mm. Not for the cycle.
bool LiesOn(const planar::Parts& parts, std::uint32_t part, const planar::Track& track);

}  // namespace takt::track
