// Commands that give movers routes over the free surface, and start them at once.
#pragma once

#include <cstdint>
#include <string_view>

#include "takt/mover/follow_route.h"
#include "takt/planar/grounds.h"

namespace takt::mover {

// command: movers begin what they were told, or none: the answer says why.
planar::Verdict Start(const Everyone& all, const StartRoutes& command) noexcept;
planar::Verdict Hold(const Everyone& all, const HoldRoutes& command) noexcept;

std::uint64_t HashOf(const SurfaceRoutes& routes, std::uint64_t hash) noexcept;

// Why routes were refused: the value of a feedback with ErrorId::kRoute.
enum class RouteProblem : std::uint8_t {
  kNone,
  kTooMany,    // more than kMostVisits
  kNotNext,    // `first` of what continues is not the number behind the last one
  kNotBeside,  // a place is not beside the one before, along X or Y
  kTimes,      // a motion as planned without both times, or not straight
  kNoMover,    // there is no mover `after`
  kNoVisit,    // that mover has no visit `after_visit`
  kNumber,     // `first` is not the number of the visit where it is
  kElsewhere,  // the mover, at rest, is not in the place
  kTooLate,    // it is bound for places further on, and cannot come to rest before
  kBehind,     // it is bound for a place that a mover is to visit before, and that one does not get so far
  kMissing,    // it is behind one that changes over, and has no new route
  kNoneTold,   // no mover was told a route
  kMoves,      // it has to rest for this
  kNoRoute,    // it has no route that it could go on along
};
std::string_view MessageOf(RouteProblem problem) noexcept;

}  // namespace takt::mover
