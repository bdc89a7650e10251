// Why a track cannot be as it is wished.
#pragma once

#include <cstdint>
#include <string_view>

#include "takt/core/describe_fwd.h"
#include "takt/path/segment.h"

namespace takt::planar {

enum class Problem : std::uint8_t {
  kNone,           // it can
  kNotFinite,      // a number given is NaN, infinite, or further away than 1e6 mm
  kLengthZero,     // a line begins where it ends, or a position is where its neighbour is
  kRadiusZero,     // start and centre of an arc are the same
  kNotOnCircle,    // start and end of an arc are not equally far from its centre
  kTooTight,       // an arc, or another track where it is met, of a smaller radius than kLeastRadius
  kKink,           // two pieces touch, but the second goes off in another direction
  kCurvatureJump,  // two pieces touch and run in one direction, but bend differently
  kTooSharp,       // a transition would bend more than a circle of kLeastRadius: the gap is too small
  kReversal,       // a transition would have to go back the way it came
  kLoop,           // a transition would cross itself, or turn by more than a whole turn
  kEmpty,          // there is nothing that a track could run along
  kClosed,         // the track is a closed loop
  kEnded,          // the track ends at another one already
  kLinked,         // a track that starts from or ends at another one is no loop
  kNotItsStart,    // it has a start already, which is not where the other track ends
  kNotItsEnd,      // it ends at another track already, which is not where this one starts
  kCrosses,        // it crosses or touches itself
  kTooMany,        // more elements or links than a track, or a point, can have
  kOtherEmpty,     // the other track has no length
  kOtherClosed,    // the other track is a closed loop: it neither starts nor ends
  kInUse,          // other tracks start from it or end at it
  kNotDisabled,    // it is enabled, or not quite disabled
  kBusy,           // too many changes of tracks wait to be made
  kApart,          // the part of the other track is not there, or not in this coordinate system
  kNotOnBorder,    // tracks of two parts meet within one of them
  kOffPart,        // the track leaves its part
};

// One sentence without a full stop; empty for kNone.
std::string_view Text(Problem problem) noexcept;

// What a problem of a line or an arc is in the plane.
Problem FromPath(path::Problem problem) noexcept;

void describe(Enumeration<Problem>&);

}  // namespace takt::planar
