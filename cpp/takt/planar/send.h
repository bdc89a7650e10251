// Destinations of movers on tracks.
#pragma once

#include <cstdint>

#include "takt/planar/network.h"
#include "takt/planar/rider.h"
#include "takt/trajectory/planner.h"

namespace takt::planar {

enum class Way : std::uint8_t {
  kNonModulo,  // to this position: on a loop, turns count; else forwards through the network, or back on the track
  kPositive,   // forwards only
  kShortestWay,
  kNegative,  // backwards only
};

// Returns the position on a loop, turns counted from the one that `now` is in, that is reached next in this direction;
// the nearest if it is within the tolerance. kNonModulo: `position` itself.
double OnLoop(Way way, double position, double modulo_tolerance, double now, double length) noexcept;

struct Destination {
  std::uint32_t track = 0;
  double position = 0;  // [mm] along it
  Way way = Way::kNonModulo;
  std::uint32_t additional_turns = 0;  // of a closed loop; kPositive and kNegative only
  double modulo_tolerance = 0;         // [mm] of a closed loop: largest distance against the direction
};

// Why a destination cannot be reached. The numbers are values of feedbacks.
enum class UnreachableReason : std::uint8_t {
  kNotLinked = 0,  // no tracks lead there from where the mover can still turn off
  kDirection = 1,  // tracks lead there, but not in this direction
  kTooLong = 2,    // only over more than kRouteTracks tracks
  kPartAway = 3,   // only over a part of the surface that is away; found by callers that know the parts
};

// Sends a mover to a destination. Returns false, and changes nothing, if no route leads there from where it can still
// turn off.
bool Send(const Network& network, RouteSearch& search, const Destination& to, Rider& rider) noexcept;

// Returns the reason why Send failed.
UnreachableReason DiagnoseUnreachable(const Network& network, RouteSearch& search, const Destination& to,
                                      const Rider& rider) noexcept;

// Returns the position [mm] of its target, counted from the start of its first track.
double TargetPosition(const Network& network, const Rider& rider) noexcept;
// Plans its motion to its target, or a first part of it, from a position on the first track, with speed and
// acceleration in its direction. From rest the direction becomes that of the target.
void PlanOn(trajectory::Planner& planner, const Network& network, double place, double speed, double acceleration,
            Rider& rider) noexcept;
// Returns the travel time [s] to the target without other movers: of the first two plans, and EstimateTravelTime for
// the rest.
double TimeAlone(trajectory::Planner& planner, const Network& network, Rider rider) noexcept;

}  // namespace takt::planar
