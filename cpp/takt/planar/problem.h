// Why a track cannot be made.
#pragma once

#include <cstdint>
#include <string_view>

#include "takt/core/describe_fwd.h"
#include "takt/path/segment.h"

namespace takt::planar {

enum class Problem : std::uint8_t {
  kNone,           // no problem
  kNotFinite,      // a given number is NaN, infinite, or beyond 1e6 mm
  kLengthZero,     // a line ends at its start, or a position coincides with its neighbour
  kRadiusZero,     // an arc starts at its centre
  kNotOnCircle,    // start and end of an arc are not at the same distance from its centre
  kTooTight,       // an arc, or another track at a link, with a radius below kLeastRadius
  kKink,           // two pieces join with different directions
  kCurvatureJump,  // two pieces join in one direction with different curvatures
  kTooSharp,       // a transition would have a radius below kLeastRadius: the gap is too small
  kReversal,       // a transition would have to reverse the direction
  kLoop,           // a transition would cross itself, or turn by more than a full turn
  kEmpty,          // no elements that give the track a length
  kClosed,         // the track is a closed loop
  kEnded,          // the track ends at another one already: nothing can be appended
  kLinked,         // a track that is linked with another one cannot be a loop
  kNotItsStart,    // it starts elsewhere than the other track ends
  kNotItsEnd,      // it ends at another track already, elsewhere than this one starts
  kCrosses,        // the track crosses or touches itself
  kTooMany,        // more elements or links than a track, or a point, can have
  kOtherEmpty,     // the other track has no length
  kOtherClosed,    // the other track is a closed loop: it has no ends
  kInUse,          // other tracks start from it or end at it
  kNotDisabled,    // the track is not in the state Disabled
  kBusy,           // too many changes of tracks are pending
  kApart,          // the other track's part is away, or in another coordinate system
  kNotOnBorder,    // tracks of two parts do not meet on the border of both
  kOffPart,        // the track leaves its part
};

// Returns one sentence without a full stop; empty for kNone.
std::string_view Text(Problem problem) noexcept;

// Returns the problem of a track for a problem of a line or an arc.
Problem FromPath(path::Problem problem) noexcept;

void describe(Enumeration<Problem>&);

}  // namespace takt::planar
