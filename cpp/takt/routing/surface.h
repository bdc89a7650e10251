// Routes for many movers on the free surface at once (PL-72). Not for the cycle.
//
// Contract. Movers stand in the middle of places, and no larger than a place each; they are given runs along rows and
// columns, with times, such that
//   - all that have a target end there, and rest there from then on;
//   - no two ever overlap, nor would they if all braked at any one moment (grid.h says why);
//   - whoever keeps to the order of visits of each place gets there, however late some are: of the visits that are left
//     the one that is the first by its entry can always be made (Visit).
// If there are such runs at all, some are found, given enough effort; that there are none is said only if it is so. The
// plan depends on its problem alone: no clock is read, and all numbers are the same bits on every host.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/routing/grid.h"
#include "takt/routing/timetable.h"

namespace takt::routing {

// Movers that may take each other's targets have the same one.
using PoolIndex = std::int32_t;

struct SurfaceProblem {
  int width = 0, height = 0;  // places
  double pitch = 0;           // mm
  double mover_size = 0;      // mm, of the largest mover; no more than the pitch
  Dynamics dynamics{};
  std::vector<bool> blocked{};        // by place, row by row: no mover can be there
  std::vector<PlaceIndex> starts{};   // by mover, all different, none of them blocked
  std::vector<PlaceIndex> targets{};  // by mover; kNone: anywhere
  std::vector<PoolIndex> pools{};     // by mover; those of one may exchange their targets. kNone: its own. Empty: all
  std::int64_t effort = 0;            // states that improvements may look at
  std::uint64_t seed = 1;
};

// A mover at a place. It may be made as soon as the visit before it is over: when that mover has left the place, or is
// on its way to the next one straight ahead in the same lane.
struct Visit {
  PlaceIndex place = 0;
  double entry = 0;                   // s: from here on it cannot rest before the place any more
  double left = 0;                    // s, end of the visit; of the last one: time of arrival
  MoverIndex before = kNone;          // who is at the place before it, kNone: nobody
  std::int32_t before_index = kNone;  // the number of that visit
};

enum class Outcome : std::uint8_t {
  kPlanned,
  kUnreachable,  // no way leads a mover to its target, whatever the others do; there are too few targets in reach
  kImpossible,   // every order of passing was tried
  kGivenUp,
};

struct SurfacePlan {
  Outcome outcome = Outcome::kGivenUp;
  MoverIndex unreachable = kNone;            // a mover whose target is
  std::vector<PlaceIndex> targets{};         // by mover, where it ends
  std::vector<Legs> legs{};                  // by mover
  std::vector<std::vector<Visit>> visits{};  // by mover, from its start on
  double sum = 0;                            // s, of all arrivals
  double first_sum = 0;                      // s, of the plan that improvements began with
  double lower_bound = 0;                    // s, no sum is less: each alone, by the best assignment within pools
};

// Requires: as the members say; targets that are not blocked, and all different.
SurfacePlan PlanSurface(const SurfaceProblem& problem);

}  // namespace takt::routing
