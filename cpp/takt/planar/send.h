// Where a mover on tracks is sent.
#pragma once

#include <cstdint>

#include "takt/planar/network.h"
#include "takt/planar/rider.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {

enum class Way : std::uint8_t {
  kNonModulo,  // to the very place: on a loop turns count; elsewhere forward through the network, or back on its track
  kPositive,   // forward only
  kShortestWay,
  kNegative,  // back only
};

// A place on a loop, turns counted from the one in which `now` is: the next such place that way. To one as near as the
// tolerance the way is the shortest.
double OnLoop(Way way, double position, double modulo_tolerance, double now, double length) noexcept;

struct Destination {
  std::uint32_t track = 0;
  double position = 0;  // mm along it
  Way way = Way::kNonModulo;
  std::uint32_t additional_turns = 0;  // of a closed loop, positive and negative
  double modulo_tolerance = 0;         // mm, of a closed loop: so far it may go against its direction
};

// Why no way leads to a destination. The numbers are values of feedbacks.
enum class NoWay : std::uint8_t {
  kNotLinked = 0,  // from no place where the mover can still turn off do tracks lead there
  kDirection = 1,  // tracks lead there, but not in this direction
  kTooLong = 2,    // over more than kRouteTracks tracks
  kPartAway = 3,   // over a part of the surface that is elsewhere; found by those who know parts
};

// False: no way leads there from where the mover can still turn off; it keeps what it had.
bool Send(const Network& network, RouteSearch& search, const Destination& to, Rider& rider) noexcept;

// What is wrong where Send says that there is no way.
NoWay WhyNoWay(const Network& network, RouteSearch& search, const Destination& to, const Rider& rider) noexcept;

// mm on its first track, where its target is.
double EndOfWay(const Network& network, const Rider& rider) noexcept;
// Its way to its target, or a part of it, from a place on the first track on, with a speed and acceleration in its
// direction. At rest the direction is that of the target.
void PlanOn(trajectory::Planner& planner, const Network& network, double place, double speed, double acceleration,
            Rider& rider) noexcept;
// Returns the travel time [s] to the target without other movers: of the first two plans, and TimeOfWay for the rest.
double TimeAlone(trajectory::Planner& planner, const Network& network, Rider rider) noexcept;

}  // namespace takt::planar
