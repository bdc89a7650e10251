// The fastest legs of one mover among those of all others. SIPP (Phillips and Likhachev, ICRA 2011) over runs: a state
// is a place with the time until which it is free; the earliest arrival at each state is enough.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "takt/routing/timetable.h"

namespace takt::routing {

class Sipp {
 public:
  explicit Sipp(const Grid& grid) : grid_(grid), earliest_(static_cast<std::size_t>(grid.size())) {}

  struct Query {
    CellIndex start = 0, target = 0;
    const std::vector<double>* alone = nullptr;  // Grid::TimesTo(target)
    double bound = kForever;                     // [s] exclusive upper bound of the arrival
    double weight = 1;           // of the estimate; above 1: faster search, suboptimal up to this factor
    std::int64_t most = 30'000;  // states expanded before the search gives up
  };
  // Returns the legs to the target; nothing if none were found. Requires: the mover itself is not in the timetable.
  std::optional<Legs> Find(const Timetable& timetable, const Query& query);

  std::int64_t expanded() const noexcept { return expanded_; }  // states of all queries

 private:
  struct State {
    double time = 0, free_until = 0;
    CellIndex place = 0;
    std::int32_t parent = kNone;
    Leg leg{};
  };
  struct Earliest {
    double free_until, time;
  };
  // Returns the earliest departure in [from, latest] [s] of a run without a conflict; infinite: none.
  double Departure(const Timetable& timetable, CellIndex place, Direction lane, int count, double from,
                   double latest) const;
  bool Better(CellIndex place, double free_until, double time);

  const Grid& grid_;
  std::vector<State> states_;
  std::vector<std::vector<Earliest>> earliest_;  // by place
  std::vector<CellIndex> touched_;
  std::int64_t expanded_ = 0;
};

}  // namespace takt::routing
