// Routes of movers over the free surface (PL-72). Which places each visits, and behind whom, is planned outside the
// cycle; here it is carried out, so that a mover that is late, or fails, holds up those behind it and no others.
//
// The invariant: a place is granted to a mover when the mover that visits it before has left it, or is ahead on its way
// straight through it, in the same direction: then it cannot be overtaken, and the guard keeps both apart. A mover is
// sent straight on as far as places are granted to it, and further while it moves.
//
// With times of a plan a mover starts a whole straight motion as soon as all of its places are expected to be free on
// arrival, given the present delays of the others: the motion of the plan, without braking. Where a place is not
// granted at the last moment at which the mover can stop before it, it stops, and places are granted one by one then.
//
// A mover in an enabled group is sent only where others have left: what it reserves there is free then.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "takt/mover/mover.h"
#include "takt/mover/route.h"
#include "takt/mover/state.h"
#include "takt/planar/rider.h"

namespace takt::mover {

// All movers with their routes.
struct Everyone {
  void* owner = nullptr;
  Context (*context)(void* owner, std::size_t mover) noexcept = nullptr;
  std::span<State> states{};
  SurfaceRoutes& routes;

  Context of(std::size_t mover) const noexcept { return context(owner, mover); }
  // Calls this for movers on their way.
  void Each(const auto& what) const {
    for (std::size_t i = 0; i < routes.of.size(); ++i) {
      if (states[i].tickets[kRoute] != 0) what(of(i), states[i], routes.of[i]);
    }
  }
};

// move: before the movers step.
void FollowRoutes(const Everyone& all) noexcept;

inline SurfaceRoute& RouteOf(const Context& c, std::size_t mover) noexcept {
  return c.fleet.routes->of[mover];
}
// The mover is on its way along a route.
inline bool IsOnRoute(const State& s) noexcept {
  return s.tickets[kRoute] != 0;
}
// The mover that visits a place of this one before, if one does.
std::optional<std::uint32_t> Before(const Context& c, const Visit& visit) noexcept;
// Notes which places it has passed. What it does besides ends its route.
void Look(const Context& c, State& s, SurfaceRoute& r) noexcept;
// It is where it was told to go, at rest.
bool Rests(const Context& c, const State& s, const SurfaceRoute& r) noexcept;
// mm between the mover and its route, from the place that it has passed to the next one.
double OffRoute(const State& s, const SurfaceRoute& r) noexcept;
// Where it comes to rest if it is told so `later` s from now, with these dynamics: mm from the place that it has
// passed.
double RestsAt(const Context& c, const State& s, const SurfaceRoute& r, const RouteDynamics& dynamics,
               double later = 0) noexcept;
// Returns the first granted visit where it can come to rest.
std::uint64_t StopsAt(const Context& c, const State& s, const SurfaceRoute& r) noexcept;
// The present motion is none of the plan any more.
void Disturb(SurfaceRoute& r) noexcept;

// Why a mover rests in a place of its route.
struct RestInPlace {
  bool held = false;                      // routes are being held
  std::uint32_t mover = planar::kNobody;  // that visits the next place before; kNobody: none
  std::uint64_t since = 0;                // cycle; 0: it does not
};
RestInPlace WhyResting(const Context& c, const State& s) noexcept;

}  // namespace takt::mover
