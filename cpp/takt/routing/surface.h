// Joint planning of the routes of many movers on the free surface (PL-72). Not for the cycle.
//
// Contract. Movers rest at the centres of places and are no larger than a place; they are given runs along rows and
// columns, with times, such that
//   - all movers with a target end there, and rest there from then on;
//   - no two ever overlap, not even if all brake at any one moment (grid.h says why);
//   - movers that keep to the order of visits of each place reach their targets, however late some are: of the
//   remaining
//     visits, the first one by its entry can always be made (Visit).
// If there is a solution, one is found, given enough effort; kImpossible is returned only if there is none. The plan
// depends on its problem alone: no clock is read, and all numbers are the same bits on every host.
#pragma once

#include <cstdint>
#include <vector>

#include "takt/routing/grid.h"
#include "takt/routing/timetable.h"

namespace takt::routing {

// Movers that may exchange their targets have the same pool.
using PoolIndex = std::int32_t;

struct SurfaceProblem {
  int width = 0, height = 0;  // places
  double pitch = 0;           // [mm]
  double mover_size = 0;      // [mm] of the largest mover; no more than the pitch
  Dynamics dynamics{};
  std::vector<bool> blocked{};       // by place, row by row: closed to movers
  std::vector<CellIndex> starts{};   // by mover; pairwise different, none of them blocked
  std::vector<CellIndex> targets{};  // by mover; kNone: anywhere
  // by mover; targets may be exchanged within a pool; kNone, or empty: none
  std::vector<PoolIndex> pools{};
  std::int64_t effort = 0;  // states that improvements may expand
  std::uint64_t seed = 1;
};

// A visit of a place by a mover. It may begin as soon as the preceding visit of that place is over: when that mover has
// left the place, or moves to the next place straight ahead in the same lane.
struct Visit {
  CellIndex place = 0;
  double entry = 0;                   // [s] from here on the mover cannot come to rest before the place
  double left = 0;                    // [s] end of the visit; of the last one: time of arrival
  MoverIndex before = kNone;          // mover of the preceding visit of the place; kNone: none
  std::int32_t before_index = kNone;  // index of that visit
};

enum class Outcome : std::uint8_t {
  kPlanned,
  kUnreachable,  // a target cannot be reached, whatever the other movers do; or a pool reaches too few targets
  kImpossible,   // the complete search has found no solution
  kGivenUp,
};

struct SurfacePlan {
  Outcome outcome = Outcome::kGivenUp;
  MoverIndex unreachable = kNone;            // a mover whose target is unreachable
  std::vector<CellIndex> targets{};          // by mover: where it ends
  std::vector<Legs> legs{};                  // by mover
  std::vector<std::vector<Visit>> visits{};  // by mover: from its start on
  double sum = 0;                            // [s] sum of all arrivals
  double first_sum = 0;                      // [s] of the plan from which improvements began
  double lower_bound = 0;                    // [s] bound of `sum`: each mover alone, pools at their best
};

// Requires: as the members say; targets are not blocked, and pairwise different.
SurfacePlan PlanSurface(const SurfaceProblem& problem);

}  // namespace takt::routing
