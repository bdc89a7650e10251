// Execution of routes of movers over the free surface (PL-72). The places that each mover visits, and the order of
// movers at each place, are planned outside the cycle. A mover that is late or fails delays only the movers behind it.
//
// The invariant: a place is granted to a mover when the mover that visits it before has left it, or moves ahead
// straight through it in the same direction. Then it cannot be overtaken, and the guard keeps the two apart. A mover is
// sent straight on as far as places are granted to it, and further while it moves.
//
// With planned times a mover starts a whole straight motion as soon as all of its places are expected to be free on
// arrival, given the present delays of the other movers: the planned motion, without braking. If a place is not granted
// at the last moment at which the mover can stop before it, it stops, and places are granted one by one from then on.
//
// A mover in an enabled group is sent only to places that other movers have left: the area that it reserves there is
// free.
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
struct RoutedMovers {
  void* owner = nullptr;
  Context (*context)(void* owner, std::size_t mover) noexcept = nullptr;
  std::span<State> states{};
  SurfaceRoutes& routes;

  Context of(std::size_t mover) const noexcept { return context(owner, mover); }
  // Calls `what` for each mover that is on its route.
  void Each(const auto& what) const {
    for (std::size_t i = 0; i < routes.of.size(); ++i) {
      if (states[i].tickets[kRoute] != 0) what(of(i), states[i], routes.of[i]);
    }
  }
};

// Cycle stage move, before the movers step.
void FollowRoutes(const RoutedMovers& all) noexcept;

inline SurfaceRoute& RouteOf(const Context& c, std::size_t mover) noexcept {
  return c.fleet.routes->of[mover];
}
// Returns true if the mover is on its route.
inline bool IsOnRoute(const State& s) noexcept {
  return s.tickets[kRoute] != 0;
}
// Returns the other mover that visits the place before this visit, if there is one.
std::optional<std::uint32_t> Before(const Context& c, const Visit& visit) noexcept;
// Updates the last place that the mover has passed. Aborts the route if the mover is disabled, has left free movement
// or its coordinate system, or follows external set points.
void Look(const Context& c, State& s, SurfaceRoute& r) noexcept;
// Returns true if the mover rests at the last place to which it was sent.
bool Rests(const Context& c, const State& s, const SurfaceRoute& r) noexcept;
// Returns the distance [mm] between the mover and its route, between the place that it has passed and the next one.
double OffRoute(const State& s, const SurfaceRoute& r) noexcept;
// Returns where the mover comes to rest if it brakes `later` [s] from now with these dynamics: [mm] along its route
// from the place that it has passed; infinite if there is no plan.
double RestsAt(const Context& c, const State& s, const SurfaceRoute& r, const RouteDynamics& dynamics,
               double later = 0) noexcept;
// Returns the first granted visit at which the mover can come to rest.
std::uint64_t StopsAt(const Context& c, const State& s, const SurfaceRoute& r) noexcept;
// Marks the present motion as one that no longer follows the plan.
void Disturb(SurfaceRoute& r) noexcept;

// Why a mover rests at a place of its route.
struct RestInPlace {
  bool held = false;                      // routes are being held
  std::uint32_t mover = planar::kNobody;  // the mover that visits the next place before; kNobody: none
  std::uint64_t since = 0;                // cycle since which it rests there; 0: it does not
};
RestInPlace WhyResting(const Context& c, const State& s) noexcept;

}  // namespace takt::mover
